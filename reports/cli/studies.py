"""What the report command can draw again: each kind of stored results, and how its pages come from them."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path

Draw = Callable[[], dict[str, bytes]]


@dataclass(frozen=True, slots=True, kw_only=True)
class Study:
    """One kind of stored results.

    Attributes
    ----------
    command : str
        That stores them.
    file : str
        By which a folder of them is known.
    read : callable
        Reads them from a folder, and returns what draws their pages: name and content of each file. Raises a
        ValueError where a file is missing or is something else.
    """

    command: str
    file: str
    read: Callable[[Path], Draw]


def _comparison(folder: Path) -> Draw:
    from rockwobble.compare import Comparison

    from ..pages.comparison.report import comparison_files
    from ..pages.provenance import command_line

    found = Comparison.load(folder)
    return lambda: comparison_files(found, command_line())


def _validity(folder: Path) -> Draw:
    from rockwobble.compare.studies.validity import read_validity

    from ..pages.validity.output import validity_pages

    found = read_validity(folder)
    return lambda: validity_pages(found)


def _tradeoff(folder: Path) -> Draw:
    from rockwobble.compare.studies.tradeoff import read_tradeoff

    from ..pages.tradeoff.page import tradeoff_pages

    found = read_tradeoff(folder)
    return lambda: tradeoff_pages(found)


def _extremes(folder: Path) -> Draw:
    from rockwobble.compare.studies.extremes import read_extremes

    from ..pages.extremes.page import extremes_pages

    found = read_extremes(folder)
    return lambda: extremes_pages(found)


def _ensemble(folder: Path) -> Draw:
    from rockwobble.compare import read_ensemble

    from ..console.ensemble_output import ensemble_pages

    found = read_ensemble(folder)
    return lambda: ensemble_pages(found)


STUDIES = (
    Study(command="compare", file="comparison.json", read=_comparison),
    Study(command="ensemble", file="ensemble.json", read=_ensemble),
    Study(command="validity", file="validity.json", read=_validity),
    Study(command="tradeoff", file="tradeoff.json", read=_tradeoff),
    Study(command="extremes", file="extremes.json", read=_extremes),
)


def read_studies(folder: Path) -> list[Draw]:
    """Read everything in a folder that pages can be drawn from.

    Raises
    ------
    ValueError
        If there is nothing, or it cannot be read.
    """
    held = [study for study in STUDIES if (folder / study.file).is_file()]
    if not held:
        files = ", ".join(f"{study.file} ({study.command})" for study in STUDIES)
        raise ValueError(f"a report is drawn from a folder with one of {files} in it, got {folder}")
    return [study.read(folder) for study in held]
