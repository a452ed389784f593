"""The twelve short cases of a fingerprint, from one term of the equations to all of them.

Each adds something to those before it, so that the first of them that changes points to what did.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field

import numpy as np

from rockwobble.models import Case, Cylinder, GroundMotion, InitialState, el_centro_1940

G = 9.81
_PIER = Cylinder(semidiagonal=6.0, tan_alpha=0.2)
_SLENDER = Cylinder(semidiagonal=1.0, tan_alpha=0.2)
_SQUAT = Cylinder(semidiagonal=1.0, tan_alpha=1.0)
_HOLLOW = Cylinder(semidiagonal=4.0, tan_alpha=0.35, transverse_inertia=7.0, axial_inertia=3.0)


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
