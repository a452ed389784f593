"""Samples, peak, passes and places of an external trajectory, from its poses."""

from __future__ import annotations

import math

import numpy as np
import pandas as pd

from rockwobble.models import Cylinder
from rockwobble.multibody.recording.passes import TurningPoint, passes_between, turning_points

from ..runs.execution import SAMPLE_STEP
from .file import Array
from .pose import SAME_TIME, Poses


def sample_times(end: float) -> Array:
    """Multiples of the sample step of a comparison, and the exact end [s]."""
    time: Array = SAMPLE_STEP * np.arange(math.floor(end / SAMPLE_STEP + SAME_TIME) + 1, dtype=np.float64)
    return time if end - time[-1] < SAME_TIME else np.append(time, end)


def resampled(poses: Poses, time: Array) -> tuple[Array, Array, Array]:
    """Tilt, rolling angle and axis at other times: a local cubic through the axis, smooth at upright."""
    own = poses.time
    if len(own) == len(time) and bool((np.abs(own - time) < SAME_TIME).all()):
        return poses.tilt.copy(), poses.rolling_angle, poses.axis
    if not np.isfinite(poses.rolling_angle).any() and bool((poses.axis[:, 0] >= 0.0).all()):
        # an unsigned tilt alone has a corner at each pass, where its square is a parabola
        tilt = np.sqrt(np.maximum(_interpolated(own, poses.tilt**2, time), 0.0))
        axis = np.column_stack([np.sin(tilt), np.zeros_like(tilt), np.cos(tilt)])
        return tilt, np.full(len(time), np.nan), axis
    axis = _interpolated(own, poses.axis, time)
    axis /= np.linalg.norm(axis, axis=1)[:, None]
    tilt = np.arctan2(np.hypot(axis[:, 0], axis[:, 1]), axis[:, 2])
    azimuth = np.arctan2(axis[:, 1], axis[:, 0])
    # the branch that was followed from sample to sample
    branch = np.round((np.interp(time, own, poses.rolling_angle) - azimuth) / (2.0 * np.pi))
    return tilt, azimuth + 2.0 * np.pi * branch, axis


def _interpolated(own: Array, values: Array, time: Array) -> Array:
    from scipy.interpolate import Akima1DInterpolator

    # the first sample may stand a rounding after the start
    return np.asarray(Akima1DInterpolator(own, values)(np.clip(time, own[0], own[-1])))


def peak(poses: Poses) -> float:
    """Vertex of the parabola through the largest sample and its neighbours [rad]."""
    at = int(np.argmax(poses.tilt))
    if at in (0, len(poses.tilt) - 1):
        return float(poses.tilt[at])
    left, top, right = (float(value) for value in poses.tilt[at - 1 : at + 2])
    bend, slope = left - 2.0 * top + right, 0.5 * (right - left)
    return top - 0.5 * slope * slope / bend if bend < 0.0 else top


def passes(poses: Poses, start: float, stands: float) -> pd.DataFrame:
    """Tilt minima between two maxima; one next to a guessed change of azimuth is not resolved."""
    points = turning_points(poses.time, poses.tilt, poses.rolling_angle)
    if poses.tilt[0] > stands and poses.tilt[0] >= poses.tilt[1]:  # released at rest: a maximum
        time, tilt, angle = (float(each[0]) for each in (poses.time, poses.tilt, poses.rolling_angle))
        points.insert(0, TurningPoint(time=time, tilt=tilt, rolling_angle=angle, is_maximum=True))
    found = passes_between(
        [point for point in points if point.time >= min(start, float(poses.time[0]))], stands
    )
    guesses = poses.time[~poses.followed]
    near = 1.5 * float(np.median(np.diff(poses.time)))
    names = ("time", "minimum_tilt", "angle_of_turn")
    table = {name: np.array([getattr(item, name) for item in found], dtype=float) for name in names}
    resolved = [not bool((np.abs(guesses - item.time) < near).any()) for item in found]
    return pd.DataFrame({**table, "resolved": np.array(resolved, dtype=bool)})


def places(
    poses: Poses, time: Array, axis: Array, angle: Array, cylinder: Cylinder
) -> tuple[Array, Array, float]:
    """Contact point and mass centre [m], and how far the base centre has moved at the end [m]."""
    b, h = cylinder.base_radius, cylinder.mass_centre_height
    rests = np.isnan(angle)[:, None]
    outward = np.column_stack([np.cos(angle), np.sin(angle)])
    if poses.position is not None:
        centre = _interpolated(poses.time, poses.position, time)
        base = centre - h * axis
        contact = np.where(rests, np.nan, base[:, :2] + b * axis[:, 2:] * outward)
        return contact, centre, float(np.hypot(base[-1, 0], base[-1, 1]))
    lean, rise = np.hypot(axis[:, 0], axis[:, 1]), 1.0 - axis[:, 2:]
    centre = np.column_stack([np.where(rests, 0.0, b * rise * outward), b * lean]) + h * axis
    if not np.isfinite(poses.rolling_angle).any():
        centre[:, :2] = np.nan  # the tilt alone tells how high it is, not where
    return np.where(rests, np.nan, b * outward), centre, math.nan
