"""A case in words: the input as understood, in numbers."""

from __future__ import annotations

from typing import TYPE_CHECKING

from .wording import sentence

# heavy imports stand in the functions: the help of the command line needs no numpy
if TYPE_CHECKING:
    from collections.abc import Iterable, Sequence

    from rockwobble.models import Case, GroundMotion, RockingBody
    from rockwobble.models.plain_json import Facts


def case_lines(case: Case, mass: float | None = None, *, record: bool = True) -> list[str]:
    """Lines that describe a case and the mass of a column [t].

    Without `record` there is none on the files of the ground motion.
    """
    from rockwobble.models.finding import Finding
    from rockwobble.studies.stated import case_findings

    stated = [each for each in case_findings(case) if record or each.key != "input.record"]
    if case.motion is None or case.length != case.motion.duration:
        stated.append(Finding(key="input.length", values={"duration": case.length}))
    return [*map(sentence, stated), *case_warnings([case], mass)]


def conditions(facts: Facts) -> list[str]:
    """One line for each condition of a study that differs from the default, see `condition_findings`."""
    from rockwobble.studies.stated import condition_findings

    return list(map(sentence, condition_findings(facts)))


def record_lines(motions: Iterable[GroundMotion | None]) -> list[str]:
    """One line on the source of each ground motion."""
    from rockwobble.models.ground_motion import sources_of

    return source_lines(sources_of(motions))


def source_lines(sources: Sequence[str]) -> list[str]:
    """A line on each of the first sources of records, and one on how many more there are."""
    from rockwobble.studies.stated import source_findings

    return list(map(sentence, source_findings(sources)))


def case_warnings(cases: Iterable[Case], mass: float | None = None) -> list[str]:
    """One line for each doubt about cases and the mass of a column [t]."""
    from rockwobble.models.doubts import doubts_of_cases

    from .diagnostics import warnings

    return warnings(doubts_of_cases(cases, mass))


def warnings_about(
    motions: Iterable[GroundMotion], cylinders: Iterable[RockingBody] = (), gravity: float = 9.81
) -> list[str]:
    """One line for each doubt about motions, cylinders and gravity [m/s^2]."""
    from rockwobble.models.doubts import doubts_about

    from .diagnostics import warnings

    return warnings(doubts_about(motions=motions, cylinders=cylinders, gravities=[gravity]))


def group_of(name: str) -> str:
    """Group of a case: its name up to the first colon or comma."""
    return name.split(":")[0].split(",")[0].strip()
