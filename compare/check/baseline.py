"""Baselines: numbers of a subject that were looked at once and are kept, with the reason for each change.

They stand in `baselines.json` beside this module: values by name, in one group for the reduced models and
one for each version of an engine, and the reasons why they were written, the last one last. Results differ
between versions of an engine, and in the last digits between machines. A version without a baseline is
compared with the last known one with loose bounds, and that is said; it is no failure.
"""

from __future__ import annotations

import dataclasses
import json
import math
from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass
from importlib.resources import files
from pathlib import Path

import numpy as np

from rockwobble.models import Case, Trace, el_centro_1940

from .agreement import RECORD
from .result import NO_BASELINE, Bound, Result, at_most
from .scenes import PIER, RELEASE, SQUAT, released
from .subject import Subject

Values = Mapping[str, float]
FILE = "baselines.json"
_VERTICAL = Case(PIER, el_centro_1940(vertical=True).scaled(2.0), duration=8.0, name="El Centro doubled")
# case, whether a model alone runs it, and times the tolerance: rounding of another machine, which grows as
# the error of the contact does
_CASES: tuple[tuple[Case, bool, float], ...] = (
    (RELEASE, False, 0.1),
    (released(0.5, 0.5, 4.0, SQUAT, "release, tan alpha = 1"), False, 1.0),
    (RECORD, False, 10.0),
    (_VERTICAL, True, 10.0),
)
_INSTANTS = 8  # evenly over the run
_RING = 500.0  # times the tolerance: the impact on a wall comes a step earlier or later
_LOOSE = 20.0  # times as much for a version that has no baseline


@dataclass(frozen=True, slots=True, kw_only=True)
class Baseline:
    """A file of baselines.

    Parameters
    ----------
    values : mapping
        Values of each group by name: one group for the reduced models, one for each engine version.
    reasons : tuple of mapping
        date, reason, and the versions that the values were made with.
    """

    values: Mapping[str, Values]
    reasons: tuple[Mapping[str, object], ...] = ()


def kept_numbers(subject: Subject, support: str) -> Iterator[Result]:
    """Tilts, peak and uplift of a few runs are those that are kept."""
    kept = read_baseline()
    for case, trace, times in _runs(subject, support):
        group = _group(subject, trace)
        # its own version, else the last of its engine, else none
        others = (name for name in reversed(list(kept.values)) if name.rsplit(" ", 1)[0] == subject.label)
        known = group if group in kept.values else next(others, "")
        before: Values = kept.values.get(known, {})
        apart = {key: value - before.get(key, math.nan) for key, value in _numbers(case, support, trace)}
        worst = max(apart, key=lambda key: abs(apart[key]) if math.isfinite(apart[key]) else math.inf)
        most = (1.0 if known == group else _LOOSE) * (_RING if support == "ring" else times)
        bound = Bound(most * subject.tolerance, "the number that is kept", "alpha")
        found = at_most(case.name, abs(apart[worst]), bound, note=worst)
        if known != group:
            words = f"compared with {known}, loosely: {found.outcome}" if known else "none of any version"
            note = f"no baseline for {group}; {words}"
            found = dataclasses.replace(found, outcome=NO_BASELINE, note=note)
        yield found


def measure(subjects: Iterable[Subject]) -> dict[str, dict[str, float]]:
    """Return the numbers that are kept, by group."""
    found: dict[str, dict[str, float]] = {}
    for subject in subjects:
        for support in subject.supports:
            for case, trace, _ in _runs(subject, support):
                found.setdefault(_group(subject, trace), {}).update(_numbers(case, support, trace))
    return found


def _runs(subject: Subject, support: str) -> Iterator[tuple[Case, Trace, float]]:
    for case, of_models, times in _CASES:
        # planar motion has no rolling rate, and some engines cannot start from a cylinder that stands
        fits = support != "planar" if case.initial is not None else subject.uplifts
        fits &= support != "ring" or case.cylinder is SQUAT  # which reaches the walls
        if fits and not (of_models and subject.run is not None):
            yield case, subject.simulate(case, support), times


def _group(subject: Subject, trace: Trace) -> str:
    return subject.label if subject.run is None else f"{subject.label} {trace.version}"


def _numbers(case: Case, support: str, trace: Trace) -> Iterator[tuple[str, float]]:
    alpha, times = case.cylinder.alpha, case.length * np.arange(1, _INSTANTS + 1) / _INSTANTS
    name = f"{case.name}, {support}"
    for time, tilt in zip(times, np.interp(times, trace.time, trace.tilt), strict=True):
        yield f"{name}: tilt at {time:g} s [alpha]", float(tilt) / alpha
    yield f"{name}: peak tilt [alpha]", trace.peak_tilt / alpha
    if case.initial is None:
        yield f"{name}: uplift [s]", trace.uplift_time


def folder() -> Path:
    """Return the folder of the data file: where an update writes."""
    return Path(str(files("rockwobble.compare.check")))


def read_baseline() -> Baseline:
    """Return the baselines that are kept; empty if there is no file."""
    place = folder() / FILE
    if not place.is_file():
        return Baseline(values={})
    content = json.loads(place.read_text(encoding="utf-8"))
    return Baseline(values=content["values"], reasons=tuple(content["reasons"]))


def changes(old: Baseline, new: Mapping[str, Values]) -> list[tuple[str, str, float | None, float | None]]:
    """Return what would change if the groups of `new` took the place of those of `old`.

    Returns
    -------
    list of (group, name, before, after)
        None where there is no value.
    """
    return [
        (group, name, before.get(name), values.get(name))
        for group, values in new.items()
        for before in [old.values.get(group, {})]
        for name in dict.fromkeys([*before, *values])
        if before.get(name) != values.get(name)
    ]


def updated(
    old: Baseline, new: Mapping[str, Values], *, reason: str, date: str, versions: Mapping[str, str]
) -> str:
    """Return the text of the file with the groups of `new` in place, and the reason kept.

    Raises
    ------
    ValueError
        If no reason is given.
    """
    reason = " ".join(reason.split())
    if not reason:
        raise ValueError("a reason must be given for changing a baseline, got none")
    entry = {"date": date, "reason": reason, "groups": sorted(new), "versions": dict(versions)}
    content = {
        "reasons": [*old.reasons, entry],
        "values": {**old.values, **{group: dict(values) for group, values in new.items()}},
    }
    return json.dumps(content, indent=1, allow_nan=False) + "\n"
