"""Measures on the motion of a model of somebody else, sampled as it likes."""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from .outputs import Outputs

Array = NDArray[np.float64]
_REACH = 3  # samples on each side of a maximum


def first_maximum(given: Outputs) -> tuple[float, float, float]:
    """Return time [s], tilt and azimuth [rad] of the first tilt maximum after the start; NaN without one."""
    tilt = given.tilt
    inner = np.flatnonzero((tilt[1:-1] > tilt[:-2]) & (tilt[1:-1] >= tilt[2:])) + 1
    inner = inner[(inner >= _REACH) & (inner < len(tilt) - _REACH)]
    if not len(inner):
        return math.nan, math.nan, math.nan
    i = int(inner[0])
    near = slice(i - _REACH, i + _REACH + 1)
    unit = float(given.time[i + _REACH] - given.time[i - _REACH])
    time = (given.time[near] - given.time[i]) / unit
    fit = np.polyfit(time, tilt[near], 2 * _REACH)
    roots = np.roots(np.polyder(fit))
    best = float(min(roots[np.abs(roots.imag) < 1e-9].real, key=abs, default=0.0))
    azimuth = math.nan
    if given.azimuth is not None:
        turned = np.unwrap(given.azimuth[near])
        azimuth = float(np.polyval(np.polyfit(time, turned, 2 * _REACH), best))
    return float(given.time[i]) + best * unit, float(np.polyval(fit, best)), azimuth


def lean(given: Outputs) -> Array:
    """Return sin(tilt) times the direction of the lean, (n, 2); the tilt alone where it is not told."""
    if given.azimuth is None:
        return np.column_stack([np.sin(given.tilt), np.zeros_like(given.tilt)])
    azimuth = np.nan_to_num(given.azimuth)
    direction = np.column_stack([np.cos(azimuth), np.sin(azimuth)])
    return np.asarray(np.sin(given.tilt)[:, None] * direction, dtype=np.float64)


def apart(one: Outputs, other: Outputs, alpha: float, end: float, *, stretch: float = 1.0) -> float:
    """Return the root mean square difference of the leans up to `end` [s], over sin(alpha).

    The second is read at `stretch` times the time of the first.
    """
    from scipy.interpolate import CubicSpline

    within = one.time <= min(end, float(other.time[-1]) / stretch)
    at = one.time[within]
    if len(at) < 2 * _REACH:
        return math.inf
    wanted = CubicSpline(other.time, lean(other))(stretch * at)
    difference = np.hypot(*(lean(one)[within] - wanted).T)
    mean = np.trapezoid(difference**2, at) / (at[-1] - at[0])
    return math.sqrt(float(mean)) / math.sin(alpha)


def rises(given: Outputs, level: float) -> float:
    """Return when the tilt first exceeds a level [s]; its cube root is linear in between. NaN if never."""
    beyond = np.flatnonzero(given.tilt > level)
    if not len(beyond) or not beyond[0]:
        return math.nan
    i = int(beyond[0])
    low, high = np.cbrt(np.maximum(given.tilt[i - 1 : i + 1], 0.0))
    share = float((np.cbrt(level) - low) / (high - low))
    return float(given.time[i - 1] + (given.time[i] - given.time[i - 1]) * share)


def turned(given: Outputs, angle: float, *, mirrored: bool = False) -> Outputs:
    """Return the motion mirrored in x and then turned by an angle [rad] about the vertical."""
    if given.azimuth is None:
        return given
    azimuth = (-given.azimuth if mirrored else given.azimuth) + angle
    return Outputs(time=given.time, tilt=given.tilt, azimuth=azimuth, energy=given.energy)
