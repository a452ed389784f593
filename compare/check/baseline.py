"""Baselines and certificates: fingerprints stored with the package, and those stored by a user.

A baseline was looked at once and is kept in the folder `baselines`, with the reason for each change, the last
one last, and the versions that each was made with: one for the reduced models, one for each engine. Results
differ between versions of an engine, and in the last digits between machines. Another version of an engine is
held to the same baseline: that it changed something is said, with the versions, and is no failure.

A certificate is a baseline with claims, their evidence, and what no evidence covers; another installation is
compared with it, and the answer is a verdict.
"""

from __future__ import annotations

import dataclasses
import json
import math
from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass
from importlib.resources import files
from pathlib import Path
from types import ModuleType
from typing import Any

import numpy as np

from rockwobble import reduced
from rockwobble.models.case import RECESS_MODEL
from rockwobble.models.finding import Finding, Findings, Value
from rockwobble.multibody.engines.registry import find_engine

from ..runs.progress import ProgressCallback
from ..storage.files import replace_files
from ..storage.provenance import commit, other_versions, package_versions
from .fingerprint import as_json, fingerprint, repeat, short_cases
from .measurement import NO_BASELINE, NOT_RUN, Bound, Result, at_most, not_run
from .subject import Subject, engine, reduced_model
from .verdict import (
    FORMAT,
    KIND,
    SAME,
    Certificate,
    Described,
    Entry,
    FingerprintVerdict,
    Sample,
    compare,
    compare_entries,
)

_LONGEST = 4.0  # [s] longest case of an engine, whose steps are slow
_BOUND = Bound(1.0, "ten times its tolerance and what copies differ by", "of what is allowed")


@dataclass(frozen=True, slots=True, kw_only=True)
class Baseline:
    """Stored fingerprint of a subject, with versions, date and reason.

    Parameters
    ----------
    fingerprint : tuple of Entry
    reasons : tuple of mapping
        date, reason, version of the engine ("" of the reduced models) and versions of the packages, for each
        time that it was written.
    """

    fingerprint: tuple[Entry, ...] = ()
    reasons: tuple[Mapping[str, Any], ...] = ()

    @property
    def version(self) -> str:
        """Version of the engine at the time of the baseline; empty for the reduced models."""
        return str(self.reasons[-1]["version"]) if self.reasons else ""

    @property
    def versions(self) -> Mapping[str, str]:
        """Versions of the packages at the time of the baseline."""
        return self.reasons[-1]["versions"] if self.reasons else {}


def baseline_path(subject: Subject) -> Path:
    """Path of the baseline of a subject."""
    name = f"{subject.label.replace(' ', '_')}.json"
    return Path(str(files("rockwobble.compare.check"))) / "baselines" / name


def read_baseline(subject: Subject) -> Baseline:
    """Stored baseline of a subject; an empty one where there is none."""
    path = baseline_path(subject)
    if not path.exists():
        return Baseline()
    content = json.loads(path.read_text(encoding="utf-8"))
    return Baseline(fingerprint=tuple(content["fingerprint"]), reasons=tuple(content["reasons"]))


def new_fingerprint(subject: Subject, progress: ProgressCallback | None = None) -> tuple[Entry, ...]:
    """New fingerprint of a subject, in the form of a baseline."""
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
        notes = [] if verdict.word == SAME else [str(verdict), *others]
        result = at_most(one["name"], share, _BOUND)
        if version != kept.version:
            notes.insert(0, f"the baseline is of {subject.label} {kept.version}, this is {version}")
            if result.failed:
                result = dataclasses.replace(result, outcome=NO_BASELINE)
        yield dataclasses.replace(result, note="; ".join(notes))


def baseline_changes(old: Baseline, new: tuple[Entry, ...], subject: Subject) -> list[str]:
    """Changes by a new fingerprint: versions, cases that differ, and new cases."""
    before, after = ({one["name"]: one for one in each} for each in (old.fingerprint, new))
    verdicts = [compare_entries(before[name], after[name]) for name in before if name in after]
    lines = [str(verdict) for verdict in verdicts if verdict.word != SAME]
    for words, ours, theirs in (("new", after, before), ("gone", before, after)):
        if names := [name for name in ours if name not in theirs]:
            lines.append(f"{words}: {', '.join(names)}")
    if old.fingerprint and _version(subject) != old.version:
        lines.insert(0, f"version {old.version}, now {_version(subject)}")
    return lines


def updated_baseline(
    old: Baseline, new: tuple[Entry, ...], subject: Subject, *, reason: str, date: str
) -> str:
    """Text of the file with a new fingerprint, and the reason for it.

    Raises
    ------
    ValueError
        If no reason is given.
    """
    reason = " ".join(reason.split())
    if not reason:
        raise ValueError("a reason must be given for changing a baseline, got none")
    origin = {"date": date, "reason": reason, "version": _version(subject), "versions": package_versions()}
    return as_json({"reasons": [*old.reasons, origin], "fingerprint": list(new)})


def _version(subject: Subject) -> str:
    return "" if subject.run is None or subject.run.is_model else find_engine(subject.label).version()


def _share(verdict: FingerprintVerdict, old: Entry, new: Sample) -> float:
    """Difference of a case over the allowed one; NaN where a quantity is in only one of both."""
    if verdict.word != SAME:
        return verdict.difference / verdict.allowed
    wanted, got = (np.array(list(each["signals"].values()), dtype=np.float64) for each in (old, new))
    return float(np.nan_to_num(np.abs(wanted - got) / np.array(list(old["allowed"].values()))).max())


_RTOL = 1e-8  # the default of `reduced.simulate`
# groups of checks of a protocol or of a baseline, not of the motion
NOT_CLAIMING = ("protocol", "baseline")
_BETWEEN = "agreement"  # group that compares two independent formulations
NOT_COVERED = (
    "no claim is validated: no experiment was compared",
    "ground that deforms, or is not plane; a base that is not rigid",
    "sliding while it rocks: the reduced models say how much friction is needed",
    "single peaks and traces after the agreement time: there only distributions are compared",
)


def certify(
    subject: Subject, results: Iterable[Result], progress: ProgressCallback | None = None
) -> Certificate:
    """Certificate of a subject.

    Parameters
    ----------
    subject : Subject
        The reduced models, or an engine.
    results : iterable of Result
        Results of its checks, which become claims.
    progress : callable, optional
        Called with a `Progress` at the start and the end of each case of the fingerprint.

    Returns
    -------
    dict

    Raises
    ------
    ValueError
        If a check failed, or none bears a claim out.
    """
    claims, open_points = claims_of(results)
    if not claims:
        raise ValueError("a certificate needs a claim, and none of the checks makes one")
    run = subject.run or RECESS_MODEL
    method = Described(engine=run.engine, time_step=run.time_step, settings=dict(run.settings))
    return {
        "kind": KIND,
        "format": FORMAT,
        "method": method,
        "versions": package_versions(),
        "commit": commit(),
        "claims": claims,
        "not_covered": open_points,
        "fingerprint": list(fingerprint(subject, progress)),
    }


def subject_of(certificate: Certificate) -> Subject:
    """Subject of a certificate, as installed here.

    Raises
    ------
    ValueError
        If it is not installed.
    """
    given = certificate["method"]
    name = given["engine"]
    return models() if name is None else engine(name, given["time_step"], **given["settings"])


def models(module: ModuleType = reduced) -> Subject:
    """Reduced models at their default tolerance; also from a copy of the package, for its tests."""
    return reduced_model(module, rtol=_RTOL)


def verify(
    certificate: Certificate, subject: Subject | None = None, progress: ProgressCallback | None = None
) -> FingerprintVerdict:
    """Verdict on the fingerprint computed here, up to the first change.

    Parameters
    ----------
    certificate : mapping
    subject : Subject, optional
        Default: that of the certificate, as it is installed here.
    progress : callable, optional
        Called with a `Progress` at the start and the end of each case.

    Returns
    -------
    FingerprintVerdict

    Raises
    ------
    ValueError
        If the subject is not installed, or its cases are others than in this version.
    """
    old = certificate["fingerprint"]
    known = {short.name for short in short_cases()}
    if unknown := [one["name"] for one in old if one["name"] not in known]:
        raise ValueError(f"the certificate has a case {unknown[0]}, this version has none: make it anew")
    checked = subject_of(certificate) if subject is None else subject
    return compare(old, repeat(checked, old, progress))


def certificate_findings(certificate: Certificate, verdict: FingerprintVerdict) -> Findings:
    """Verdict on a certificate, and the versions that differ from those in it."""
    values: dict[str, Value] = {
        "name": verdict.case,
        "name_quantity": verdict.quantity,
        "name_claim": verdict.claim,
        "name_term": verdict.term,
        "time": verdict.time,
        "size": verdict.difference,
        "bound": verdict.allowed,
    }
    others = other_versions(certificate["versions"], certificate["method"]["engine"])
    word = Finding(
        key=f"certificate.{verdict.word}",
        level="not satisfied" if verdict.exit_code else "satisfied",
        values=values if verdict.case else {},
    )
    versions = Finding(key="certificate.versions", values={"names": others})
    return Findings([word, versions if others else Finding(key="certificate.same_versions")])


def write_certificate(certificate: Mapping[str, object], path: Path) -> None:
    """Write a certificate, whole or not at all; each claim is a line."""
    replace_files(path.parent, {path.name: as_json(certificate).encode()})


def claims_of(results: Iterable[Result]) -> tuple[list[dict[str, object]], list[str]]:
    """Claims supported by results, and the points that they do not cover.

    A claim is verified, against exact solutions, or cross-validated, between independent formulations; none
    is validated, against an experiment.

    Raises
    ------
    ValueError
        If one of them failed: nothing is certified then.
    """
    claims, open_points = list[dict[str, object]](), list(NOT_COVERED)
    for result in results:
        if result.failed:
            raise ValueError(f"a check failed, and nothing is certified: {result.name}")
        if result.outcome == NOT_RUN:
            open_points.append(f"{result.name}: {result.note}")
        elif result.group not in NOT_CLAIMING and math.isfinite(result.value):
            claims.append(
                {
                    "quantity": result.name,
                    "domain": "the problems of this check",
                    "bound": result.bound,
                    "measured": result.value,
                    "unit": result.unit,
                    "evidence": f"rockwobble check --only {result.group}: {result.reason}",
                    "status": "cross-validated" if result.group == _BETWEEN else "verified",
                    "data_sha256": "",  # hash of the data of an experiment
                }
            )
    return claims, open_points
