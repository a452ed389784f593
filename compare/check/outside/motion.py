"""Measures on the motion of an external model, at whatever times it is sampled."""

from __future__ import annotations

import math

import numpy as np

from ...external.motion import Motion

_REACH = 3  # samples on each side of a maximum


def first_maximum(given: Motion) -> tuple[float, float, float]:
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
    if given.lean is not None:
        turned = np.unwrap(np.angle(given.lean))[near]
        azimuth = float(np.polyval(np.polyfit(time, turned, 2 * _REACH), best))
    return float(given.time[i]) + best * unit, float(np.polyval(fit, best)), azimuth


def apart(one: Motion, other: Motion, alpha: float, end: float, *, stretch: float = 1.0) -> float:
    """Return the root mean square difference of the leans up to `end` [s], over sin(alpha).

    The second is read at `stretch` times the time of the first. Where either does not tell the azimuth, their
    leans are sin(tilt) alone.
    """
    from scipy.interpolate import CubicSpline

    within = one.time <= min(end, float(other.time[-1]) / stretch)
    at = one.time[within]
    if len(at) < 2 * _REACH:
        return math.inf
    ours, theirs = one.lean, other.lean
    if ours is None or theirs is None:
        ours, theirs = np.sin(one.tilt), np.sin(other.tilt)
    difference = np.abs(ours[within] - CubicSpline(other.time, theirs)(stretch * at))
    mean = np.trapezoid(difference**2, at) / (at[-1] - at[0])
    return math.sqrt(float(mean)) / math.sin(alpha)


def rises(given: Motion, level: float) -> float:
    """Return when the tilt first exceeds a level [s]; its cube root is linear in between. NaN if never."""
    beyond = np.flatnonzero(given.tilt > level)
    if not len(beyond) or not beyond[0]:
        return math.nan
    i = int(beyond[0])
    low, high = np.cbrt(np.maximum(given.tilt[i - 1 : i + 1], 0.0))
    share = float((np.cbrt(level) - low) / (high - low))
    return float(given.time[i - 1] + (given.time[i] - given.time[i - 1]) * share)
