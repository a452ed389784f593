"""The releases and ground motions of the report, and cases made of them."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import replace
from functools import cache

from rockwobble import reduced
from rockwobble.models import (
    Case,
    Cylinder,
    GroundMotion,
    InitialState,
    el_centro_1940,
    p695_far_field,
    synthetic_motions,
)
from rockwobble.models.records.p695 import missing_packages

EL_CENTRO = "El Centro 1940"
REFERENCE_SIZE = 6.0  # [m] of free responses: they scale with size (Froude)
GRAVITY = 9.81
AMPLE = 3.0  # friction, so that a squat cylinder uplifts and does not slip
_SYNTHETIC_SEED = 1940


def release_case(tan_alpha: float, release: float, spin: float, periods: float = 1.0) -> Case:
    """Return a free response.

    Parameters
    ----------
    tan_alpha : float
    release : float
        Tilt over alpha.
    spin : float
        Rolling rate over that of steady wobble at the tilt; below 1 the release is a tilt maximum.
    periods : float, optional
        Length, in times from tilt maximum to next maximum of the recess model.
    """
    cylinder = Cylinder(semidiagonal=REFERENCE_SIZE, tan_alpha=tan_alpha)
    tilt = release * cylinder.alpha
    initial = InitialState(tilt=tilt, rolling_rate=spin * reduced.steady_wobble_rate(cylinder, tilt))
    period = reduced.free_response(cylinder, initial).period
    return Case(cylinder, initial=initial, duration=periods * period)


def record_names(members: int) -> list[str]:
    """Return the names of an ensemble's motions: records where they are installed, else synthetic ones."""
    kind = "synthetic" if missing_packages() else "record"
    return [f"{kind} {number}" for number in range(1, members + 1)]


def source_of(names: Iterable[str]) -> str:
    """Return the source of the motions of an ensemble, in words."""
    kinds = {name.rsplit(" ", 1)[0] for name in names}
    return "FEMA P-695 far-field records" if kinds == {"record"} else "synthetic records"


@cache
def motion_named(name: str) -> GroundMotion:
    """Return a motion: El Centro with its vertical component, "record n" or "synthetic n" without one."""
    if name == EL_CENTRO:
        return el_centro_1940(vertical=True)
    kind, number = name.rsplit(" ", 1)
    if kind == "record" and not missing_packages():
        return p695_far_field(int(number))
    # each with a seed of its own: a larger ensemble begins with a smaller one
    return synthetic_motions(2, peak=1.0, seed=_SYNTHETIC_SEED + int(number))[0]


def shaken_case(
    name: str,
    tan_alpha: float,
    semidiagonal: float,
    intensity: float,
    *,
    duration: float | None = None,
    vertical: bool = False,
    turn: float = 0.0,
) -> Case:
    """Return a cylinder at rest under a motion by name.

    Its peak resultant is `intensity` times g tan(alpha), and it is turned by an azimuth [rad].
    """
    whole = motion_named(name)
    motion = whole if vertical else GroundMotion(whole.acceleration[:, :2], whole.time_step, whole.name)
    motion = motion.scaled(intensity * GRAVITY * tan_alpha / motion.peak)
    cylinder = Cylinder(semidiagonal=semidiagonal, tan_alpha=tan_alpha)
    length = motion.duration if duration is None else min(duration, motion.duration)
    label = f"{name}, tan α {tan_alpha:g}, R {semidiagonal:g} m, {intensity:g} g tan α"
    case = Case(cylinder, motion, duration=length, friction=AMPLE, name=label)
    return replace(case, motion=motion.rotated(turn)) if turn else case
