"""Fingerprint of a subject: short motions, the repeatability of their numbers, and their agreement times.

Two installations of one subject differ by rounding, and two versions of an engine by a little more. What that
becomes in time is told by copies of a case whose start or record is off by the tolerance of the subject: a
difference counts where it is larger than ten times theirs. Where the copies differ by 1 % of alpha themselves
the agreement ends, and the tilts of many copies are kept instead, for their largest from then on. Those
copies are ten times further off: so much may two versions differ.

A baseline is a fingerprint that this package keeps, a certificate one that somebody takes along.
"""

from __future__ import annotations

import json
import math
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from random import Random

import numpy as np
from numpy.typing import NDArray

from rockwobble.models import (
    AGREEMENT,
    Case,
    Cylinder,
    GroundMotion,
    InitialState,
    Tendon,
    Trace,
    el_centro_1940,
)
from rockwobble.models.cylinder import PIER, RockingBody
from rockwobble.models.members import perturbed
from rockwobble.models.support import FLAT, RECESS, RING, SUPPORTS

from ..runs.progress import ProgressCallback, stages
from .measurement import FRAME, GRAVITY, SQUAT, release_case
from .subject import SLAB, UPLIFT, Subject
from .verdict import SAME, Entry, Sample, compare_entries

Array = NDArray[np.float64]
_SAMPLES = 40  # samples stored of each motion
_BEYOND = 10.0  # ratio to the difference of the copies above which a difference counts
_MEMBERS = 16
_REPEATS = 10.0  # ratio of the repeatability of a number to the tolerance of a subject
_SLENDER = Cylinder(semidiagonal=1.0, tan_alpha=0.2)
_LOW = Cylinder(semidiagonal=1.0, tan_alpha=1.0)
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
        Options of the reduced models only.
    """

    name: str
    claim: str
    term: str
    case: Case
    support: str = RECESS
    options: Mapping[str, object] = field(default_factory=dict)


def short_cases() -> tuple[ShortCase, ...]:
    """Cases of a fingerprint, the simplest first."""
    # strong and long enough that a slab 1 % heavier exceeds the repeatability of an engine
    pushes = [[0.0, 0.0, 0.0], [2.6, 0.6, -1.2], [1.2, 2.2, 1.2]]
    tied = [[0.0, 0.0, 0.0], [2.6, 1.4, -1.2], [1.2, 2.2, 1.2]]
    flat = "twist of the flat-ground model, N1, and terms in the radius b"
    tendon = Tendon(prestress=0.3, stiffness=2.0)
    # small and long, so that in an engine the impacts amplify rounding to another motion
    planar = Case(_SLENDER, initial=InitialState(0.5 * _SLENDER.alpha, 0.0, 0.3), duration=12.0)
    return (
        _release("tilting", "restoring moment p^2 sin(alpha - theta)", PIER, 0.0, 1.0),
        _release("rolling", "B and B'/2A of (18) and (19)", PIER, 0.8, 2.0),
        _release("near-pass", "J, the limit of B near upright", PIER, 1e-2, 2.0),
        _release("inertias", "I1 and I2 of (16)", _HOLLOW, 0.7, 2.0),
        _release("flat-ground", flat, _LOW, 1.5, 1.0, FLAT),
        _shaken("uplift", "uplift (25), (26) and a_r of (18)", [[0.0, 0.0], [1.6, 1.9]], 1.4, 1.4),
        _shaken("turning-push", "a_t of (19)", [[0.0, 0.0], [2.2, 0.5], [1.0, 1.8]], 0.7, 1.4),
        _shaken("vertical", "g + az", [[0.0, 0.0, 0.0], [2.2, 0.5, -1.0], [1.0, 1.8, 1.0]], 0.7, 1.4),
        _shaken("frame", "mass of the slab, in (18) and in the forces", pushes, 1.0, 3.5, body=FRAME),
        _shaken(
            "tendon",
            "prestress and stiffness of a tendon: uplift, couple, load and energy",
            tied,
            1.0,
            2.5,
            tendon=tendon,
        ),
        ShortCase(
            name="planar",
            claim="the planar model, with the loss of an impact",
            term="impact, by the momentum about the new pivot",
            case=planar,
            options={"plane": 0.3, "restitution": "momentum"},
        ),
        _record("el-centro", "all terms together", 1.4, 12.0),
        _shaken("resting", "rest threshold", [[0.0, 0.0], [1.3, 1.6], [0.0, 0.0]], 1.0, 3.0, rest_tilt=0.02),
        _record("close-passes", "a hundred passes near upright", 1.05, 9.0),
        ShortCase(
            name="ring",
            claim="walls that are touched keep the cylinder in its place",
            term="walls of a recess with clearance",
            case=release_case(0.5, 0.5, 4.0, SQUAT),
            support=RING,
        ),
    )


def cases_of(subject: Subject, longest: float = math.inf) -> list[ShortCase]:
    """Cases that a subject can run, up to a length [s]."""
    return [
        short
        for short in short_cases()
        if short.support in subject.supports
        and short.case.length <= longest
        and (UPLIFT in subject.features or short.case.is_release)
        and (SLAB in subject.features or not short.case.cylinder.carries_slab)
        and subject.features.issuperset(short.case.terms)
    ]


def _release(
    name: str, term: str, body: RockingBody, spin: float, length: float, support: str = RECESS
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
    length: float,
    *,
    body: RockingBody = PIER,
    tendon: Tendon | None = None,
    **options: float,
) -> ShortCase:
    case = Case(body, GroundMotion(np.array(samples), step), duration=length, tendon=tendon)
    claim = "uplift and motion under a ramp of the ground"
    return ShortCase(name=name, claim=claim, term=term, case=case, options=options)


def _record(name: str, term: str, strength: float, length: float) -> ShortCase:
    """Case under El Centro, scaled to a multiple of the uplift intensity of the pier."""
    record = el_centro_1940()
    motion = record.scaled(strength * GRAVITY * PIER.tan_alpha / record.peak)
    case = Case(PIER, motion, duration=length)
    return ShortCase(name=name, claim="response to shaking", term=term, case=case)


def fingerprint(
    subject: Subject, progress: ProgressCallback | None = None, *, longest: float = math.inf
) -> Iterator[Entry]:
    """Entries of the cases that a subject can run, each when it is computed."""
    shorts = cases_of(subject, longest)
    stage = stages(progress, [short.case.length for short in shorts])
    for short in shorts:
        with stage(short.name):
            whole = entry_of(short, subject)
        yield whole


def entry_of(short: ShortCase, subject: Subject) -> Entry:
    """Entry of a case."""
    trace = _run(subject, short, short.case)
    sample, values, share = entry(short, trace), _signals(trace), subject.tolerance
    pairs = (1.0 + share, 1.0 + share), (1.0 - share, 1.0 + 0.5 * share)
    copies = [_signals(_run(subject, short, perturbed(short.case, *pair))) for pair in pairs]
    spread = _BEYOND * np.array([_difference(copy, values) for copy in copies]).max(axis=0)
    lost = np.flatnonzero(spread[:, SIGNALS.index("tilt")] > AGREEMENT)
    allowed = _REPEATS * share * np.maximum(1.0, np.abs(np.nan_to_num(values))) + spread
    if len(lost):  # the copies are no measure from there on
        allowed[lost[0] :] = allowed[max(lost[0] - 1, 0)]
    whole: Entry = {
        **sample,
        "agreement_time": sample["time"][lost[0]] if len(lost) else None,
        "repeats": _REPEATS * share,
        "allowed": {name: _round(allowed[:, k], 3) for k, name in enumerate(SIGNALS)},
    }
    if len(lost):
        whole["copies"] = copied_tilts(short, subject)
    return whole


def repeat(
    subject: Subject, old: Sequence[Entry], progress: ProgressCallback | None = None
) -> Iterator[Sample]:
    """Entries without perturbed copies, for comparison with a stored baseline (which has its own)."""
    cases = {short.name: short for short in short_cases()}
    shorts = [cases[one["name"]] for one in old]
    stage = stages(progress, [short.case.length for short in shorts])
    for one, short in zip(old, shorts, strict=True):
        with stage(short.name):
            computed = entry(short, _run(subject, short, short.case))
            if one["agreement_time"] is not None and compare_entries(one, computed).word != SAME:
                computed["copies"] = copied_tilts(short, subject)
        yield computed


def _run(subject: Subject, short: ShortCase, case: Case) -> Trace:
    return subject.simulate(case, short.support, sample_step=case.length / _SAMPLES, **short.options)


def entry(short: ShortCase, trace: Trace) -> Sample:
    """Samples and events of one case."""
    values = _signals(trace)
    return {
        "name": short.name,
        "claim": short.claim,
        "term": short.term,
        "support": short.support,
        "outcome": trace.outcome,
        "uplift_time": _finite_or_none(trace.uplift_time),
        "uplift_direction": _finite_or_none(trace.uplift_direction),
        # samples of the run alone, as those of the signals
        "peak_tilt": _finite_or_none(trace.peak_within_run / short.case.cylinder.alpha),
        "time": _round(trace.time),
        "signals": {name: _finite_list(values[:, k]) for k, name in enumerate(SIGNALS)},
    }


def copied_tilts(short: ShortCase, subject: Subject) -> list[list[float | None]]:
    """Tilts of many copies, over alpha."""
    random, share, entries = Random(1940), _BEYOND * subject.tolerance, []
    for _ in range(_MEMBERS):
        copy = perturbed(short.case, *(1.0 + share * random.gauss(0, 1) for _ in range(2)))
        entries.append(_finite_list(_run(subject, short, copy).tilt / copy.cylinder.alpha))
    return entries


def _signals(trace: Trace) -> Array:
    """Signals (n, 9): over alpha, sin(alpha), g R, weights and b."""
    body = trace.case.cylinder
    lean = np.sin(trace.tilt) * np.exp(1j * np.nan_to_num(trace.rolling_angle)) / math.sin(body.alpha)
    return np.column_stack(
        [
            trace.tilt / body.alpha,
            lean.real,
            lean.imag,
            trace.twist,
            trace.energy / (GRAVITY * body.semidiagonal),
            trace.contact_force,
            trace.restraining_moment / body.base_radius,
        ]
    )


def _difference(copy: Array, values: Array) -> Array:
    """Largest difference so far (n, 9), up to the end of the shorter motion."""
    apart = np.zeros_like(values)
    count = min(len(copy), len(values))
    apart[:count] = np.nan_to_num(np.abs(copy[:count] - values[:count]))
    running = np.maximum.accumulate(apart, axis=0)  # a difference that is zero by chance has no meaning
    return np.asarray(running, dtype=np.float64)


def _finite_or_none(value: float) -> float | None:
    return float(value) if math.isfinite(value) else None


def _finite_list(values: Array) -> list[float | None]:
    return [value if math.isfinite(value) else None for value in _round(values)]


def _round(values: Array, digits: int = 12) -> list[float]:
    return [float(f"{value:.{digits}g}") for value in values]


def as_json(content: Mapping[str, object]) -> str:
    """Text of the file of a certificate or a baseline: each claim or case is a line."""
    parts = []
    for name, part in content.items():
        text = json.dumps(part)
        if isinstance(part, list):
            text = "[\n  " + ",\n  ".join(json.dumps(each, separators=(",", ":")) for each in part) + "\n ]"
        parts.append(f" {json.dumps(name)}: {text}")
    return "{\n" + ",\n".join(parts) + "\n}\n"
