"""A certificate: a baseline with a verdict, made here and compared with another installation.

It holds claims with their evidence, what no evidence covers, and the fingerprint of a subject: fourteen short
motions, less those of a slab and of a tendon where it has none, how exactly they repeat, and how long they
can agree. Two
installations of one subject differ by rounding, and two versions of an engine by a little more. What that
becomes in time is told by copies of a case whose start or record is off by the tolerance of the subject: a
difference counts where it is larger than ten times theirs. Where the copies differ by 1 % of alpha themselves
the agreement ends, and the tilts of many copies are kept instead, for their largest from then on. Those
copies are ten times further off: so much may two versions differ.
"""

from __future__ import annotations

import json
import math
from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field, replace
from pathlib import Path
from random import Random
from types import ModuleType

import numpy as np
from numpy.typing import NDArray

from rockwobble import reduced
from rockwobble.models import (
    AGREEMENT,
    Case,
    Cylinder,
    GroundMotion,
    InitialState,
    Run,
    Tendon,
    Trace,
    el_centro_1940,
)
from rockwobble.models.cylinder import PIER
from rockwobble.models.members import perturbed
from rockwobble.models.support import SUPPORTS

from ..check import GROUPS, NOT_RUN, Result, Subject, engine, reduced_model
from ..check.measurement import FRAME
from ..runs.progress import ProgressCallback, stages
from ..storage.files import replace_files
from ..storage.provenance import commit, package_versions
from .verdict import (
    KIND,
    SAME,
    Certificate,
    Described,
    Entry,
    FingerprintVerdict,
    Sample,
    compare,
    compare_entries,
    read,
    require_whole,
)

Array = NDArray[np.float64]
_SAMPLES = 40  # of each motion
_BEYOND = 10.0  # what counts is so many times larger than the difference of the copies
_MEMBERS = 16
_REPEATS = 10.0  # times the tolerance of a subject: how closely a number repeats
G = 9.81
_SLENDER = Cylinder(semidiagonal=1.0, tan_alpha=0.2)
_SQUAT = Cylinder(semidiagonal=1.0, tan_alpha=1.0)
_HOLLOW = Cylinder(semidiagonal=4.0, tan_alpha=0.35, transverse_inertia=7.0, axial_inertia=3.0)
SIGNALS = ("tilt", "lean_x", "lean_y", "twist", "energy", "force_x", "force_y", "force_z", "moment")


@dataclass(frozen=True, slots=True, kw_only=True)
class ShortCase:
    """One case of a fingerprint.

    Parameters
    ----------
    name : str
    claim : str
        What holds while it is the same.
    term : str
        What it adds to the cases before it.
    case : Case
    support : {"recess", "flat"}
    options : mapping
        Of the reduced models alone.
    """

    name: str
    claim: str
    term: str
    case: Case
    support: str = "recess"
    options: Mapping[str, object] = field(default_factory=dict)


def short_cases(*, slab: bool = True, tendon: bool = True) -> tuple[ShortCase, ...]:
    """Return the cases, the simplest first; those of a frame and of a tendon where a subject has them."""
    # so strong and long that an engine with a slab 1 % heavier is off by more than it repeats
    pushes = [[0.0, 0.0, 0.0], [2.6, 0.6, -1.2], [1.2, 2.2, 1.2]]
    frame = _shaken("frame", "mass of the slab, in (18) and in the forces", pushes, 1.0, 3.5, body=FRAME)
    return (
        _release("tilting", "restoring moment p^2 sin(alpha - theta)", PIER, 0.0, 1.0),
        _release("rolling", "B and B'/2A of (18) and (19)", PIER, 0.8, 2.0),
        _release("near-pass", "J, the limit of B near upright", PIER, 1e-2, 2.0),
        _release("inertias", "I1 and I2 of (16)", _HOLLOW, 0.7, 2.0),
        _release(
            "flat-ground",
            "twist of the flat-ground model, N1, and terms in the radius b",
            _SQUAT,
            1.5,
            1.0,
            support="flat",
        ),
        _shaken("uplift", "uplift (25), (26) and a_r of (18)", [[0.0, 0.0], [1.6, 1.9]], 1.4),
        _shaken("turning-push", "a_t of (19)", [[0.0, 0.0], [2.2, 0.5], [1.0, 1.8]], 0.7),
        _shaken("vertical", "g + az", [[0.0, 0.0, 0.0], [2.2, 0.5, -1.0], [1.0, 1.8, 1.0]], 0.7),
        *([frame] if slab else []),
        *([_with_tendon()] if tendon else []),
        ShortCase(
            name="planar",
            claim="the planar model, with the loss of an impact",
            term="impact, by the momentum about the new pivot",
            # small and long, so that in an engine its impacts turn rounding into another motion
            case=Case(_SLENDER, initial=InitialState(0.5 * _SLENDER.alpha, 0.0, 0.3), duration=12.0),
            options={"plane": 0.3, "restitution": "momentum"},
        ),
        _record("el-centro", "all terms together", 1.4, 12.0),
        _shaken("resting", "rest threshold", [[0.0, 0.0], [1.3, 1.6], [0.0, 0.0]], 1.0, 3.0, rest_tilt=0.02),
        _record("close-passes", "a hundred passes near upright", 1.05, 9.0),
    )


def _release(
    name: str, term: str, body: Cylinder, spin: float, length: float, *, support: str = "recess"
) -> ShortCase:
    start = InitialState(0.5 * body.alpha, 0.0, 0.3, spin)
    claim = f"free response {'by (18) and (19)' if SUPPORTS[support].guided else 'on flat ground'}"
    case = Case(body, initial=start, duration=length)
    return ShortCase(name=name, claim=claim, term=term, case=case, support=support)


def _shaken(
    name: str,
    term: str,
    samples: list[list[float]],
    step: float,
    length: float | None = None,
    *,
    body: Cylinder = PIER,
    **options: float,
) -> ShortCase:
    motion = GroundMotion(np.array(samples), step)
    case = Case(body, motion, duration=motion.duration if length is None else length)
    claim = "uplift and motion under a ramp of the ground"
    return ShortCase(name=name, claim=claim, term=term, case=case, options=options)


def _with_tendon() -> ShortCase:
    pushes = [[0.0, 0.0, 0.0], [2.6, 1.4, -1.2], [1.2, 2.2, 1.2]]
    term = "prestress and stiffness of a tendon: uplift, couple, load and energy"
    short = _shaken("tendon", term, pushes, 1.0, 2.5)
    return replace(short, case=replace(short.case, tendon=Tendon(prestress=0.3, stiffness=2.0)))


def _record(name: str, term: str, strength: float, length: float) -> ShortCase:
    """Return a case under El Centro, so many times as strong as what lifts the pier."""
    record = el_centro_1940()
    motion = record.scaled(strength * G * PIER.tan_alpha / record.peak)
    case = Case(PIER, motion, duration=length)
    return ShortCase(name=name, claim="response to shaking", term=term, case=case)


def fingerprint(subject: Subject, progress: ProgressCallback | None = None) -> Iterator[Entry]:
    """Yield the entries, each when it is computed."""
    shorts = short_cases(slab=subject.carries_slab, tendon=subject.has_tendon)
    stage = stages(progress, [short.case.length for short in shorts])
    for short in shorts:
        with stage(short.name):
            whole = entry_of(short, subject)
        yield whole


def entry_of(short: ShortCase, subject: Subject) -> Entry:
    """Return the entry of a case."""
    trace = _run(subject, short, short.case)
    found, values = entry(short, trace), _signals(trace)
    copies = [_signals(_run(subject, short, copy)) for copy in _copies(short.case, subject.tolerance)]
    spread = _BEYOND * np.array([_difference(copy, values) for copy in copies]).max(axis=0)
    lost = np.flatnonzero(spread[:, SIGNALS.index("tilt")] > AGREEMENT)
    allowed = _REPEATS * subject.tolerance * np.maximum(1.0, np.abs(np.nan_to_num(values))) + spread
    if len(lost):  # from there on copies are no measure
        allowed[lost[0] :] = allowed[max(lost[0] - 1, 0)]
    whole: Entry = {
        **found,
        "agreement_time": found["time"][lost[0]] if len(lost) else None,
        "repeats": _REPEATS * subject.tolerance,
        "allowed": {name: _rounded(allowed[:, k]) for k, name in enumerate(SIGNALS)},
    }
    if len(lost):
        whole["copies"] = copied_tilts(short, subject)
    return whole


def repeat(
    subject: Subject, old: Sequence[Entry], progress: ProgressCallback | None = None
) -> Iterator[Sample]:
    """Yield the parts of the entries needed to compare them with older ones: the copies are theirs."""
    cases = {short.name: short for short in short_cases()}
    shorts = [cases[one["name"]] for one in old]
    stage = stages(progress, [short.case.length for short in shorts])
    for one, short in zip(old, shorts, strict=True):
        with stage(short.name):
            found = entry(short, _run(subject, short, short.case))
            if one["agreement_time"] is not None and compare_entries(one, found).word != SAME:
                found["copies"] = copied_tilts(short, subject)
        yield found


def _run(subject: Subject, short: ShortCase, case: Case) -> Trace:
    return subject.simulate(case, short.support, sample_step=case.length / _SAMPLES, **short.options)


def entry(short: ShortCase, trace: Trace) -> Sample:
    """Return the samples and the events of one case."""
    values = _signals(trace)
    return {
        "name": short.name,
        "claim": short.claim,
        "term": short.term,
        "support": short.support,
        "outcome": trace.outcome,
        "uplift_time": _finite_or_none(trace.uplift_time),
        "uplift_direction": _finite_or_none(trace.uplift_direction),
        # as the signals, of the run alone
        "peak_tilt": _finite_or_none(trace.peak_within_run / short.case.cylinder.alpha),
        "time": _rounded(trace.time),
        "signals": {name: _finite_list(values[:, k]) for k, name in enumerate(SIGNALS)},
    }


def copied_tilts(short: ShortCase, subject: Subject) -> list[list[float | None]]:
    """Return the tilts of many copies, over alpha."""
    members = _members(short.case, _BEYOND * subject.tolerance)
    return [_finite_list(_run(subject, short, member).tilt / member.cylinder.alpha) for member in members]


def _signals(trace: Trace) -> Array:
    """Return the signals (n, 9): over alpha, sin(alpha), g R, weights and b."""
    body = trace.case.cylinder
    lean = np.sin(trace.tilt) * np.exp(1j * np.nan_to_num(trace.rolling_angle)) / math.sin(body.alpha)
    return np.column_stack(
        [
            trace.tilt / body.alpha,
            lean.real,
            lean.imag,
            trace.twist,
            trace.energy / (G * body.semidiagonal),
            trace.contact_force,
            trace.restraining_moment / body.base_radius,
        ]
    )


def _difference(copy: Array, values: Array) -> Array:
    """Return the difference (n, 9), of a copy that ended earlier as far as it goes."""
    apart = np.zeros_like(values)
    count = min(len(copy), len(values))
    apart[:count] = np.nan_to_num(np.abs(copy[:count] - values[:count]))
    running = np.maximum.accumulate(apart, axis=0)  # a difference that is zero by chance says nothing
    return np.asarray(running, dtype=np.float64)


def _copies(case: Case, share: float) -> list[Case]:
    return [perturbed(case, 1.0 + share, 1.0 + share), perturbed(case, 1.0 - share, 1.0 + 0.5 * share)]


def _members(case: Case, share: float) -> list[Case]:
    random = Random(1940)
    factors = [(1.0 + share * random.gauss(0, 1), 1.0 + share * random.gauss(0, 1)) for _ in range(_MEMBERS)]
    return [perturbed(case, *pair) for pair in factors]


def _finite_or_none(value: float) -> float | None:
    return float(value) if math.isfinite(value) else None


def _finite_list(values: Array) -> list[float | None]:
    return [value if math.isfinite(value) else None for value in _rounded(values)]


def _rounded(values: Array) -> list[float]:
    return [float(f"{value:.12g}") for value in values]


FORMAT = 3
_RTOL = 1e-8  # the default of `reduced.simulate`
# groups of checks that say something of the motion, and not of a protocol or of stored numbers
CLAIMING = tuple(group for group in GROUPS if group not in ("protocol", "baseline"))
_BETWEEN = "agreement"  # compares two independent formulations
NOT_COVERED = (
    "no claim is validated: no experiment was compared",
    "ground that deforms, or is not plane; a base that is not rigid",
    "sliding of the reduced models: they say how much friction is needed, and do not slide",
    "single peaks and traces after the agreement time: there only distributions are compared",
)


def certify(
    subject: Subject, results: Iterable[Result], progress: ProgressCallback | None = None
) -> Certificate:
    """Make a certificate.

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
    return {
        "kind": KIND,
        "format": FORMAT,
        "method": description(subject),
        "versions": package_versions(),
        "commit": commit(),
        "claims": claims,
        "not_covered": open_points,
        "fingerprint": list(fingerprint(subject, progress)),
    }


def description(subject: Subject) -> Described:
    """Return the method of a subject as a certificate has it."""
    run = subject.run or Run(None, "recess")
    return {"engine": run.engine, "time_step": run.time_step, "settings": dict(run.settings)}


def subject_of(certificate: Certificate) -> Subject:
    """Return the subject that a certificate is of, as it is installed here.

    Raises
    ------
    ValueError
        If it is not installed.
    """
    given = certificate["method"]
    if given["engine"] is None:
        return models()
    return engine(given["engine"], given["time_step"], **given["settings"])


def models(module: ModuleType = reduced) -> Subject:
    """Return the reduced models at their default tolerance; of a copy of the package, for its tests."""
    return reduced_model(module, rtol=_RTOL)


def verify(
    certificate: Certificate, subject: Subject | None = None, progress: ProgressCallback | None = None
) -> FingerprintVerdict:
    """Compute the fingerprint here, up to the first change, and return the verdict.

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
    names = [one["name"] for one in old]
    # of what carries no slab or has no tendon, or made before either was a case, it has none
    kinds = [short_cases(slab=slab, tendon=tendon) for slab in (True, False) for tendon in (True, False)]
    if all(names != [short.name for short in shorts] for shorts in kinds):
        raise ValueError("the certificate has other cases than this version: make it anew")
    own = subject_of(certificate) if subject is None else subject
    return compare(old, repeat(own, old, progress))


def read_certificate(path: Path) -> Certificate:
    """Read a certificate.

    Raises
    ------
    ValueError
        If the file cannot be read, is no certificate, or one of a later format.
    """
    found = read(path)
    if found["format"] != FORMAT:
        raise ValueError(f"{path} has format {found['format']}, this version reads {FORMAT}")
    require_whole(found, path)
    return found


def write_certificate(certificate: Mapping[str, object], path: Path) -> None:
    """Write a certificate, perhaps with more, whole or not at all; a claim is a line."""
    parts = []
    for name, part in certificate.items():
        text = json.dumps(part)
        if isinstance(part, list):
            text = "[\n  " + ",\n  ".join(json.dumps(each, separators=(",", ":")) for each in part) + "\n ]"
        parts.append(f" {json.dumps(name)}: {text}")
    replace_files(path.parent, {path.name: ("{\n" + ",\n".join(parts) + "\n}\n").encode()})


def claims_of(results: Iterable[Result]) -> tuple[list[dict[str, object]], list[str]]:
    """Return the claims that results bear out, and what they do not cover.

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
        elif result.group in CLAIMING and math.isfinite(result.value):
            claims.append(
                {
                    "quantity": result.name,
                    "domain": "the problems of this check",
                    "bound": result.bound,
                    "measured": result.value,
                    "unit": result.unit,
                    "evidence": f"rockwobble check --only {result.group}: {result.reason}",
                    "status": "cross-validated" if result.group == _BETWEEN else "verified",
                    "data_sha256": "",  # of an experiment
                }
            )
    return claims, open_points
