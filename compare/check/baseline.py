"""Baselines: fingerprints that the package keeps, one for the reduced models and one for each engine.

They were looked at once and are kept in the folder `baselines`, with the reason for each change, the last one
last, and the versions that each was made with. Results differ between versions of an engine, and in the last
digits between machines. Another version of an engine is held to the same baseline: that it changed something
is said, with the versions, and is no failure.
"""

from __future__ import annotations

import dataclasses
import json
import math
from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from importlib.resources import files
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from rockwobble.multibody.engines.registry import find_engine

from ..runs.progress import ProgressCallback
from ..storage.provenance import other_versions, package_versions, version_words
from .fingerprint import as_json, fingerprint, repeat
from .measurement import NO_BASELINE, Bound, Result, at_most, not_run
from .subject import Subject
from .verdict import SAME, Entry, FingerprintVerdict, Sample, compare_entries

_LONGEST = 4.0  # [s] cases of an engine, whose steps take time
_BOUND = Bound(1.0, "ten times its tolerance and what copies differ by", "of what is allowed")


@dataclass(frozen=True, slots=True, kw_only=True)
class Baseline:
    """The baseline of a subject.

    Parameters
    ----------
    fingerprint : tuple of Entry
    reasons : tuple of mapping
        date, reason, version of the engine ("" of the reduced models) and versions of the packages, for each
        time that it was written.
    """

    fingerprint: tuple[Entry, ...] = ()
    reasons: tuple[Mapping[str, object], ...] = ()

    @property
    def version(self) -> str:
        """The version of the engine that made it; empty for the reduced models and for an empty baseline."""
        return str(self.reasons[-1]["version"]) if self.reasons else ""

    @property
    def versions(self) -> Mapping[str, str]:
        """The versions of the packages that it was made with."""
        found = self.reasons[-1]["versions"] if self.reasons else {}
        assert isinstance(found, dict)
        return found


def baseline_path(subject: Subject) -> Path:
    """Return the file of the baseline of a subject."""
    name = f"{subject.label.replace(' ', '_')}.json"
    return Path(str(files("rockwobble.compare.check"))) / "baselines" / name


def read_baseline(subject: Subject) -> Baseline:
    """Return the stored baseline of a subject; an empty one where there is none."""
    path = baseline_path(subject)
    if not path.exists():
        return Baseline()
    content = json.loads(path.read_text(encoding="utf-8"))
    return Baseline(fingerprint=tuple(content["fingerprint"]), reasons=tuple(content["reasons"]))


def new_fingerprint(subject: Subject, progress: ProgressCallback | None = None) -> tuple[Entry, ...]:
    """Return the new fingerprint of a subject, as a baseline stores it."""
    longest = math.inf if subject.run is None else _LONGEST
    return tuple(fingerprint(subject, progress, longest=longest))


def same_as_baseline(subject: Subject, support: str) -> Iterator[Result]:
    """A few short motions equal those of the baseline."""
    if subject.run is not None and (subject.run.time_step is not None or subject.run.settings):
        yield not_run("baseline", "kept at the default time step and settings")
        return
    kept, version = read_baseline(subject), _version(subject)
    old = [one for one in kept.fingerprint if one["support"] == support]
    if not old:
        note = f"no baseline for {subject.label} {version}".rstrip()
        yield dataclasses.replace(at_most("baseline", math.nan, _BOUND, note=note), outcome=NO_BASELINE)
    others = other_versions(kept.versions, subject.label)
    for one, new in zip(old, repeat(subject, old), strict=True):
        verdict = compare_entries(one, new)
        share = _share(verdict, one, new)
        notes = [] if verdict.word == SAME else [verdict.words(), version_words(others)]
        found = at_most(one["name"], share, _BOUND)
        if version != kept.version:
            notes.insert(0, f"the baseline is of {subject.label} {kept.version}, this is {version}")
            if found.failed:
                found = dataclasses.replace(found, outcome=NO_BASELINE)
        yield dataclasses.replace(found, note="; ".join(notes))


def baseline_changes(old: Baseline, new: tuple[Entry, ...], subject: Subject) -> list[str]:
    """Return what a new fingerprint changes: of the version, of each case that differs, of new ones."""
    before, after = ({one["name"]: one for one in each} for each in (old.fingerprint, new))
    verdicts = [compare_entries(before[name], after[name]) for name in before if name in after]
    lines = [verdict.words() for verdict in verdicts if verdict.word != SAME]
    for words, ours, theirs in (("new", after, before), ("gone", before, after)):
        if names := [name for name in ours if name not in theirs]:
            lines.append(f"{words}: {', '.join(names)}")
    if old.fingerprint and _version(subject) != old.version:
        lines.insert(0, f"version {old.version}, now {_version(subject)}")
    return lines


def updated_baseline(
    old: Baseline, new: tuple[Entry, ...], subject: Subject, *, reason: str, date: str
) -> str:
    """Return the text of the file with a new fingerprint, and the reason kept.

    Raises
    ------
    ValueError
        If no reason is given.
    """
    reason = " ".join(reason.split())
    if not reason:
        raise ValueError("a reason must be given for changing a baseline, got none")
    made = {"date": date, "reason": reason, "version": _version(subject), "versions": package_versions()}
    return as_json({"reasons": [*old.reasons, made], "fingerprint": list(new)})


def _version(subject: Subject) -> str:
    return "" if subject.run is None or subject.run.is_model else find_engine(subject.label).version()


def _share(verdict: FingerprintVerdict, old: Entry, new: Sample) -> float:
    """Return the difference of a case over the allowed one; NaN where a quantity is in one of both only."""
    if verdict.word != SAME:
        return verdict.difference / verdict.allowed
    apart = [
        np.abs(_numbers(wanted) - _numbers(new["signals"][name])) / np.array(old["allowed"][name])
        for name, wanted in old["signals"].items()
    ]
    return float(np.nan_to_num(apart).max())


def _numbers(values: list[float | None]) -> NDArray[np.float64]:
    return np.array(values, dtype=np.float64)
