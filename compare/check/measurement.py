"""Problems of the checks, measurements of their motions, and results: a value, its bound, the reason."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass
from functools import partial
from typing import Literal

import numpy as np
from numpy.typing import ArrayLike, NDArray

from rockwobble.models import (
    Case,
    Cylinder,
    GroundMotion,
    InitialState,
    RockingBody,
    Run,
    Trace,
    WobblingFrame,
)
from rockwobble.models.cylinder import PIER
from rockwobble.models.finding import Finding, Value
from rockwobble.models.shown import CompactRepr
from rockwobble.models.trace_file import EagerSource

Outcome = Literal["passed", "FAILED", "no baseline", "not run"]
PASSED: Outcome = "passed"
FAILED: Outcome = "FAILED"
NO_BASELINE: Outcome = "no baseline"
NOT_RUN: Outcome = "not run"


@dataclass(frozen=True, slots=True)
class Bound:
    """Upper bound of a measured value.

    Parameters
    ----------
    most : float
    reason : str
        Where the bound comes from.
    unit : str, optional
        Empty for a ratio.
    """

    most: float
    reason: str
    unit: str = ""


@dataclass(frozen=True, slots=True, kw_only=True, repr=False)
class Result(CompactRepr):
    """Result of one check of one subject.

    Parameters
    ----------
    group : str
        One of `GROUPS`; empty until the check is run as one of them.
    subject : str
        Label of what was checked.
    name : str
        What was measured.
    value, bound : float
        The check holds where the value is at most the bound. NaN holds nowhere.
    unit : str
        Unit of both; empty for a ratio.
    reason : str
        Where the bound comes from.
    cause : str
        Likely cause of a failure; empty where the check cannot tell.
    outcome : {"passed", "FAILED", "no baseline", "not run"}
    note : str
        Further facts, such as the place of the largest error.
    """

    group: str = ""
    subject: str = ""
    name: str
    value: float
    bound: float
    unit: str = ""
    reason: str
    cause: str = ""
    outcome: Outcome
    note: str = ""

    @property
    def failed(self) -> bool:
        """Whether the check failed."""
        return self.outcome == FAILED

    def finding(self) -> Finding:
        """Finding of the measured and the allowed value; its level is that of the outcome."""
        values: dict[str, Value] = {"name": self.name, "demand": self.value, "bound": self.bound}
        values |= {"detail": self.note, "detail_unit": self.unit}
        values |= {"detail_reason": self.reason, "detail_cause": self.cause}
        return Finding(
            key="check.result",
            level="not satisfied" if self.failed else "satisfied" if self.outcome == PASSED else "not tested",
            values=values,
            runs=self.subject,
        )


def at_most(name: str, value: float, bound: Bound, cause: str = "", note: str = "") -> Result:
    """Result of the comparison of `value` with `bound`; NaN fails."""
    value = float(value)
    return Result(
        name=name,
        value=value,
        bound=bound.most,
        unit=bound.unit,
        reason=bound.reason,
        cause=cause,
        outcome=PASSED if math.isfinite(value) and value <= bound.most else FAILED,
        note=note,
    )


def worst_of(name: str, errors: Mapping[str, float], bound: Bound) -> Result:
    """Result for the largest of several errors, and its place; NaN fails."""
    place = max(errors, key=lambda key: abs(errors[key]) if math.isfinite(errors[key]) else math.inf)
    return at_most(name, abs(errors[place]), bound, note=f"largest of {len(errors)}: {place}")


def not_run(name: str, note: str) -> Result:
    """Result of a check that could not run, with the reason: no failure."""
    return Result(name=name, value=math.nan, bound=math.nan, reason="", outcome=NOT_RUN, note=note)


GRAVITY = 9.81  # [m/s^2], the default of a case
SQUAT = Cylinder(semidiagonal=6.0, tan_alpha=1.0)
FRAME = WobblingFrame(PIER, 1.0, columns=1)
THRESHOLD = GRAVITY * PIER.tan_alpha  # ground acceleration of its uplift [m/s^2]


def release_case(
    share: float, spin: float, duration: float, cylinder: RockingBody = PIER, name: str = ""
) -> Case:
    """Release from rest at a share of alpha, with a rolling rate [rad/s]."""
    initial = InitialState(tilt=share * cylinder.alpha, rolling_angle=0.3, rolling_rate=spin)
    return Case(cylinder, initial=initial, duration=duration, name=name)


def polyline(times: ArrayLike, values: ArrayLike, step: float) -> GroundMotion:
    """Piecewise linear motion through knots.

    Parameters
    ----------
    times : array_like, shape (k,)
        Times of the knots, multiples of `step`, from 0 on [s].
    values : array_like, shape (k, 2) or (k, 3)
        Acceleration there [m/s^2].
    step : float
        Spacing of the samples [s]; every knot is a sample, so the function of time is the same for each.
    """
    knots, columns = np.asarray(times, dtype=float), np.asarray(values, dtype=float).T
    at = step * np.arange(round(knots[-1] / step) + 1)
    return GroundMotion(np.column_stack([np.interp(at, knots, column) for column in columns]), step)


def refined(motion: GroundMotion, times: int) -> GroundMotion:
    """Motion sampled `times` as finely, as a function of time unchanged."""
    knots = motion.time_step * np.arange(len(motion.acceleration))
    return polyline(knots, motion.acceleration, motion.time_step / times)


def steady(acceleration: ArrayLike, duration: float) -> GroundMotion:
    """Ground with a constant acceleration (2,) or (3,) [m/s^2] for `duration` [s]."""
    return GroundMotion(np.tile(np.asarray(acceleration, dtype=float), (2, 1)), duration)


# one near-upright pass, at 0.1 alpha
RELEASE = release_case(0.5, 0.5, 3.0, name="release")
FRAME_RELEASE = release_case(0.5, 0.5, 3.4, FRAME, "release of a frame")
# rocks in three dimensions from rest, through several passes that are not near; one for each component
SHOCK_TIMES = (0.0, 0.5, 1.0, 1.5, 2.0)
SHOCK = THRESHOLD * np.array(
    [[0.0, 0.0, 0.0], [1.6, 1.2, 0.0], [-0.5, 1.5, 0.5], [-0.6, -0.9, -0.5], [0.0, 0.0, 0.0]]
)


Array = NDArray[np.float64]
_VERTEX = 3  # samples on either side of a turning point


def largest(values: Array | float) -> float:
    """Largest absolute value; NaN of an empty array."""
    return float(np.abs(values).max()) if np.size(values) else math.nan


def lean(trace: Trace) -> NDArray[np.complex128]:
    """Tilt vector sin(tilt) exp(i rolling angle) over sin(alpha) (n,): smooth upright, 0 at rest."""
    turn = np.exp(1j * np.nan_to_num(trace.rolling_angle))
    return np.asarray(np.sin(trace.tilt) / math.sin(trace.case.cylinder.alpha) * turn)


def lean_difference(trace: Trace, model: Trace, end: float = math.inf, *, clock: float = 1.0) -> Array:
    """Difference of the tilt vectors until a time (n,), over sin(alpha) of the first.

    Of the tilt alone without an azimuth; `clock` stretches the time of `trace`.
    """
    from scipy.interpolate import CubicSpline

    at = trace.time * clock
    at = at[at <= min(end, float(model.time[-1]))]
    share = math.sin(model.case.cylinder.alpha) / math.sin(trace.case.cylinder.alpha)
    lean_of_trace, other = lean(trace)[: len(at)], share * lean(model)
    if not np.isfinite(trace.rolling_angle).any():
        lean_of_trace, other = np.abs(lean_of_trace), np.abs(other)
    return np.asarray(np.abs(lean_of_trace - CubicSpline(model.time, other)(at)), dtype=np.float64)


def turning_points(time: Array, tilt: Array, angle: Array) -> Array:
    """Time, tilt, rolling angle and 1 or -1 of each maximum and minimum of sampled tilts (k, 4).

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
    """Trace from the output of an external model.

    Raises
    ------
    ValueError
        If time or tilt is missing, or an array has another length or no finite numbers.
    """

    def take(*names: str) -> Array | None:
        get = result.get if isinstance(result, Mapping) else partial(getattr, result)
        first = next((value for name in names if (value := get(name, None)) is not None), None)
        return None if first is None else np.asarray(first, dtype=np.float64)

    time, tilt, angle, energy = (
        take(*names) for names in (("time",), ("tilt",), ("azimuth", "rolling_angle"), ("energy",))
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
        source=EagerSource({} if energy is None else {"energy": energy}),
    )


def why(trace: Trace) -> str:
    """Reason for the end of a run, for a note."""
    return "; ".join(fact.meaning for fact in trace.facts)
