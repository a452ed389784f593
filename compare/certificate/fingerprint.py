"""Fingerprint of a subject: twelve short motions, how exactly they repeat, and how long they can agree.

Two installations of one subject differ by rounding, and two versions of an engine by a little more. What that
becomes in time is told by copies of a case whose start or record is off by the tolerance of the subject: a
difference counts where it is larger than ten times theirs. Where the copies differ by 1 % of alpha themselves
the agreement ends, and the tilts of many copies are kept instead, for their largest from then on. Those
copies are ten times further off: so much may two versions differ.
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from random import Random

import numpy as np
from numpy.typing import NDArray

from rockwobble.models import AGREEMENT, Case, Cylinder, GroundMotion, InitialState, Trace, el_centro_1940
from rockwobble.models.members import perturbed

from ..check import Subject
from .verdict import SAME, Entry, Sample, compare_entries

Array = NDArray[np.float64]
_SAMPLES = 40  # of each motion
_BEYOND = 10.0  # what counts is so many times larger than the difference of the copies
_MEMBERS = 16
_REPEATS = 10.0  # times the tolerance of a subject: how closely a number repeats
G = 9.81
_PIER = Cylinder(semidiagonal=6.0, tan_alpha=0.2)
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


def short_cases() -> tuple[ShortCase, ...]:
    """Return the twelve cases, the simplest first."""
    return (
        _release("tilting", "restoring moment p^2 sin(alpha - theta)", _PIER, 0.0, 1.0),
        _release("rolling", "B and B'/2A of (18) and (19)", _PIER, 0.8, 2.0),
        _release("near-pass", "J, the limit of B near upright", _PIER, 1e-2, 2.0),
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
    claim = "free response by (18) and (19)" if support == "recess" else "free response on flat ground"
    case = Case(body, initial=start, duration=length)
    return ShortCase(name=name, claim=claim, term=term, case=case, support=support)


def _shaken(
    name: str,
    term: str,
    samples: list[list[float]],
    step: float,
    length: float | None = None,
    **options: float,
) -> ShortCase:
    motion = GroundMotion(np.array(samples), step)
    case = Case(_PIER, motion, duration=motion.duration if length is None else length)
    claim = "uplift and motion under a ramp of the ground"
    return ShortCase(name=name, claim=claim, term=term, case=case, options=options)


def _record(name: str, term: str, strength: float, length: float) -> ShortCase:
    """Return a case under El Centro, so many times as strong as what lifts the pier."""
    record = el_centro_1940()
    motion = record.scaled(strength * G * _PIER.tan_alpha / record.peak)
    case = Case(_PIER, motion, duration=length)
    return ShortCase(name=name, claim="response to shaking", term=term, case=case)


def fingerprint(subject: Subject) -> Iterator[Entry]:
    """Yield the twelve entries, each when it is computed."""
    for short in short_cases():
        trace = _run(subject, short, short.case)
        found, values = entry(short, trace), _signals(trace)
        copies = [_signals(_run(subject, short, copy)) for copy in _copies(short.case, subject.tolerance)]
        spread = _BEYOND * np.array([_apart(copy, values) for copy in copies]).max(axis=0)
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
        yield whole


def repeated(subject: Subject, old: Sequence[Entry]) -> Iterator[Sample]:
    """Yield the parts of the entries needed to hold them against older ones: the copies are theirs."""
    for short, one in zip(short_cases(), old, strict=True):
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
        "uplift_time": _known(trace.uplift_time),
        "uplift_direction": _known(trace.uplift_direction),
        # as the signals, of the run alone
        "peak_tilt": _known(trace.peak_within_run / short.case.cylinder.alpha),
        "time": _rounded(trace.time),
        "signals": {name: _listed(values[:, k]) for k, name in enumerate(SIGNALS)},
    }


def copied_tilts(short: ShortCase, subject: Subject) -> list[list[float | None]]:
    """Return the tilts of many copies, over alpha."""
    members = _members(short.case, _BEYOND * subject.tolerance)
    return [_listed(_run(subject, short, member).tilt / member.cylinder.alpha) for member in members]


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


def _apart(copy: Array, values: Array) -> Array:
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


def _known(value: float) -> float | None:
    return float(value) if math.isfinite(value) else None


def _listed(values: Array) -> list[float | None]:
    return [value if math.isfinite(value) else None for value in _rounded(values)]


def _rounded(values: Array) -> list[float]:
    return [float(f"{value:.12g}") for value in values]
