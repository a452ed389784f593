"""Extreme conditions: one parameter of a plain run at a time, from far too small to far too large."""

from __future__ import annotations

import dataclasses
import math
from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np

from rockwobble.models import Case, Cylinder, GroundMotion, InitialState
from rockwobble.multibody.scene import froude_scale

EXTREMES = (
    "spin",
    "slenderness",
    "size",
    "gravity",
    "intensity",
    "sample spacing",
    "duration",
    "time step",
    "contact stiffness",
    "friction",
)
_TAN_ALPHA, _SIZE, _GRAVITY = 0.2, 6.0, 9.81
_RATE = 0.5  # [rad/s] at 6 m
# [s] at 6 m: more than a period of the tilt, so that an angle of turn can be held against the exact one
_LENGTH = 2.6


@dataclass(frozen=True, slots=True, kw_only=True)
class Condition:
    """One extreme at one value.

    Parameters
    ----------
    extreme, value : str
        What is extreme, and how much, with its unit.
    case : Case
    time_step : float
        Over that of the default; 1 is the default. Reduced models have none.
    contact : float
        Contact time constant over the step; NaN is the default.
    sample_step : float
        At which the run is sampled [s].
    only_engines : bool
        Whether a reduced model has nothing of the kind.
    """

    extreme: str
    value: str
    case: Case
    time_step: float = 1.0
    contact: float = math.nan
    sample_step: float = 0.01
    only_engines: bool = False


def conditions(*, quick: bool = False) -> list[Condition]:
    """Return all conditions; `quick` keeps the first and the last of each extreme."""
    found = list(_all())
    if not quick:
        return found
    kept = []
    for extreme in EXTREMES:
        own = [each for each in found if each.extreme == extreme]
        kept += [own[0], own[-1]]
    return kept


def _all() -> Iterator[Condition]:
    for spin, length in ((0.0, 2.0), (1e-9, 2.0), (1e-3, 2.0), (3.0, 2.0), (10.0, 1.0), (1e3, 0.05)):
        yield Condition(extreme="spin", value=f"{spin:g} rad/s", case=_release(rate=spin, length=length))
    for tan_alpha in (1e-3, 0.01, 0.05, 1.0, 3.0, 10.0, 100.0):
        case = _release(tan_alpha=tan_alpha)
        yield Condition(extreme="slenderness", value=f"tan α = {tan_alpha:g}", case=case)
    for size in (1e-3, 0.01, 100.0, 1e4):
        yield Condition(extreme="size", value=f"R = {size:g} m", case=_release(size=size))
    for gravity in (1e-3, 1.62, 1e3):
        yield Condition(extreme="gravity", value=f"{gravity:g} m/s²", case=_release(gravity=gravity))
    for peak in (0.0, 0.199, 0.205, 1.0, 10.0, 100.0):
        yield Condition(extreme="intensity", value=f"{peak:g} g", case=_shaken(peak))
    for spacing in (1e-4, 0.02, 0.5):
        case = _shaken(0.5, spacing=spacing)
        yield Condition(extreme="sample spacing", value=f"record {spacing:g} s", case=case)
    for step in (1e-4, 1.0, 100.0):
        yield Condition(
            extreme="sample spacing", value=f"output {step:g} s", case=_release(), sample_step=step
        )
    for length in (1e-6, 1e-3, 20.0, 60.0):
        yield Condition(extreme="duration", value=f"{length:g} s", case=_release(length=length))
    for part, length in ((0.01, 0.05), (0.1, 0.5), (5.0, 2.0), (10.0, 2.0), (100.0, 2.0)):
        yield Condition(
            extreme="time step", value=f"{part:g} times the default", case=_release(length=length),
            time_step=part, only_engines=True,
        )  # fmt: skip
    for contact in (0.1, 1.0, 10.0, 1e3, 1e5):
        yield Condition(
            extreme="contact stiffness", value=f"time constant {contact:g} steps", case=_release(),
            contact=contact, only_engines=True,
        )  # fmt: skip
    for friction in (0.0, 0.01, 0.15, 0.25, 10.0):
        yield Condition(extreme="friction", value=f"{friction:g}", case=_release(friction=friction))


def _release(
    *,
    tan_alpha: float = _TAN_ALPHA,
    size: float = _SIZE,
    gravity: float = _GRAVITY,
    rate: float = _RATE,
    length: float = _LENGTH,
    friction: float = 5.0,
) -> Case:
    """A release at alpha/2; rate and length scale with size and gravity in Froude's sense."""
    unit = froude_scale(size, gravity).time
    cylinder = Cylinder(semidiagonal=size, tan_alpha=tan_alpha)
    release = InitialState(0.5 * cylinder.alpha, rolling_rate=rate / unit)
    return Case(
        cylinder, initial=release, duration=length * unit, gravity=gravity, friction=friction, name="release"
    )


def _shaken(peak: float, *, spacing: float = 0.01) -> Case:
    """Two seconds of two sines with a peak [g]."""
    time = np.arange(0.0, _LENGTH + 0.5 * spacing, spacing)
    wave = np.column_stack([np.sin(6.0 * time), 0.6 * np.cos(5.0 * time) * np.minimum(1.0, 4.0 * time)])
    motion = GroundMotion(wave, spacing)
    scaled = motion.scaled(_GRAVITY * peak / motion.peak)
    cylinder = Cylinder(semidiagonal=_SIZE, tan_alpha=_TAN_ALPHA)
    return Case(cylinder, scaled, duration=_LENGTH, friction=5.0, name="shaken")


def without_spin(case: Case) -> Case:
    """Return the case as one vertical plane can hold it."""
    if case.initial is None:
        return case
    return dataclasses.replace(case, initial=dataclasses.replace(case.initial, rolling_rate=0.0))
