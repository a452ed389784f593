"""What the checks take from motions, and the output of somebody's model as a trace."""

from __future__ import annotations

import math
from collections.abc import Mapping
from functools import partial

import numpy as np
from numpy.typing import NDArray

from rockwobble.models import Case, Run, Trace
from rockwobble.models.trace_source import Known

Array = NDArray[np.float64]
_VERTEX = 3  # samples on either side of a turning point


def largest(values: Array | float) -> float:
    """Return the largest size of values of any shape; NaN of none."""
    return float(np.abs(values).max()) if np.size(values) else math.nan


def lean(trace: Trace) -> NDArray[np.complex128]:
    """Return sin(tilt) exp(i rolling angle) over sin(alpha) (n,): smooth where the angle jumps, 0 at rest."""
    turn = np.exp(1j * np.nan_to_num(trace.rolling_angle))
    return np.asarray(np.sin(trace.tilt) / math.sin(trace.case.cylinder.alpha) * turn)


def turning_points(time: Array, tilt: Array, angle: Array) -> Array:
    """Return time, tilt, rolling angle and 1 or -1 of each maximum and minimum of sampled tilts (k, 4).

    The vertex of the polynomial through seven samples: exact to rounding where they are dense.
    """
    rising = np.diff(tilt) > 0.0
    rows = []
    for index in (1 + np.flatnonzero(rising[1:] != rising[:-1])).tolist():
        low = min(max(index - _VERTEX, 0), len(time) - 2 * _VERTEX - 1)
        around = slice(low, low + 2 * _VERTEX + 1)
        unit = float(time[around][-1] - time[around][0])
        at = (time[around] - time[index]) / unit
        fit = partial(np.polynomial.Polynomial.fit, at, deg=2 * _VERTEX)
        curve, turn = fit(y=tilt[around]), fit(y=np.nan_to_num(angle[around]))
        roots = curve.deriv().roots()
        vertex = float(min(roots[np.abs(roots.imag) < 1e-9].real, key=abs, default=0.0))
        kind = -1.0 if float(curve.deriv(2)(vertex)) > 0.0 else 1.0
        turned = float(turn(vertex)) if np.isfinite(angle[around]).all() else math.nan
        rows.append([time[index] + vertex * unit, float(curve(vertex)), turned, kind])
    return np.array(rows).reshape(-1, 4)


def trace_of(result: object, case: Case, support: str) -> Trace:
    """Return the output of somebody's model as a trace.

    Raises
    ------
    ValueError
        If time or tilt is missing, or an array has another length or no finite numbers.
    """

    def taken(*names: str) -> Array | None:
        get = result.get if isinstance(result, Mapping) else partial(getattr, result)
        found = next((value for name in names if (value := get(name, None)) is not None), None)
        return None if found is None else np.asarray(found, dtype=np.float64)

    time, tilt, angle, energy = (
        taken(*names) for names in (("time",), ("tilt",), ("azimuth", "rolling_angle"), ("energy",))
    )
    if time is None or tilt is None:
        lacking = "time" if time is None else "tilt"
        raise ValueError(f"the model must return {lacking}, got {type(result).__name__} without it")
    for name, column in (("time", time), ("tilt", tilt)):
        if column.ndim != 1 or not np.isfinite(column).all():
            raise ValueError(f"{name} must be finite numbers in one dimension, got {column!r:.60}")
    if not (len(time) > 1 and (np.diff(time) > 0.0).all()):
        raise ValueError("time must rise")
    for name, other in (("tilt", tilt), ("azimuth", angle), ("energy", energy)):
        if other is not None and len(other) != len(time):
            raise ValueError(f"{name} must be as long as time, {len(time)}, got {len(other)}")
    unknown = np.full(len(time), math.nan)
    azimuth = unknown if angle is None else angle
    extrema = turning_points(time, tilt, azimuth) if len(time) > 2 * _VERTEX else np.empty((0, 4))
    return Trace(
        case=case,
        run=Run("external", support),
        version="",
        time=time,
        tilt=tilt,
        tilt_rate=unknown,
        rolling_angle=azimuth,
        twist=unknown,
        contact_point=np.full((len(time), 2), math.nan),
        centre_of_mass=np.full((len(time), 3), math.nan),
        extrema=extrema,
        peak_tilt=float(tilt.max()),
        outcome="",
        uplift_time=math.nan,
        uplift_direction=math.nan,
        source=Known({} if energy is None else {"energy": energy}),
    )
