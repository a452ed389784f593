"""Two motions of one case on one time axis: what every metric starts from."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from rockwobble.models import Case, Cylinder, Trace
from rockwobble.models.shown import Brief

FloatArray = NDArray[np.float64]

# samples are multiples of one step; two that differ by less are the same [s]
_SAME_TIME = 1e-9


@dataclass(frozen=True, slots=True, kw_only=True, eq=False, repr=False)
class Pair(Brief):
    """A trial held against a reference, sample by sample.

    The samples are those of the reference, up to the earliest of: the end of either trace, the
    first value that is not finite, and the window that was asked for.

    Parameters
    ----------
    cylinder : Cylinder
    start : float
        Uplift or release of the reference [s]; 0 where it never uplifts.
    time : ndarray, shape (n,)
        [s].
    tilt, reference_tilt : ndarray, shape (n,)
        [rad].
    rolling_angle, reference_rolling_angle : ndarray, shape (n,)
        Unwrapped [rad]; NaN at rest.
    contact_point, reference_contact_point : ndarray, shape (n, 2)
        Relative to O [m]; NaN at rest.
    """

    cylinder: Cylinder
    start: float
    time: FloatArray
    tilt: FloatArray
    reference_tilt: FloatArray
    rolling_angle: FloatArray
    reference_rolling_angle: FloatArray
    contact_point: FloatArray
    reference_contact_point: FloatArray

    @property
    def tilt_difference(self) -> FloatArray:
        """Trial minus reference, shape (n,), in units of alpha."""
        return (self.tilt - self.reference_tilt) / self.cylinder.alpha

    @property
    def end(self) -> float:
        """Time up to which both are compared [s]."""
        return float(self.time[-1])


def make_pair(cylinder: Cylinder, reference: Trace, trial: Trace, *, until: float | None = None) -> Pair:
    """Put `trial` on the samples of `reference`, as far as both reach.

    Parameters
    ----------
    cylinder : Cylinder
    reference, trial : Trace
    until : float, optional
        End of the window, in the time of the run [s]. Default: all that both have.

    Returns
    -------
    Pair

    Raises
    ------
    ValueError
        If `until` leaves no sample, or a trace has none.

    Examples
    --------
    >>> import rockwobble as rw
    >>> pier = rw.Cylinder(semidiagonal=6.0, tan_alpha=0.2)
    >>> release = rw.InitialState(0.5 * pier.alpha, rolling_rate=0.5)
    >>> case = rw.Case(pier, initial=release, duration=4.0)
    >>> pair = make_pair(pier, rw.simulate(case), rw.simulate(case, support="flat"))
    >>> pair.time.shape == pair.tilt.shape == pair.reference_tilt.shape
    True
    """
    end = min(_finite_end(reference), _finite_end(trial))
    if until is not None:
        end = min(end, until)
    keep = int(np.searchsorted(reference.time, end + _SAME_TIME, side="right"))
    if keep == 0:
        raise ValueError(f"there must be at least one sample to compare, got none up to {end:g} s")
    time = reference.time[:keep]
    return Pair(
        cylinder=cylinder,
        start=start_of(reference),
        time=time,
        tilt=_sampled(trial.time, trial.tilt, time),
        reference_tilt=reference.tilt[:keep],
        rolling_angle=_sampled(trial.time, trial.rolling_angle, time),
        reference_rolling_angle=reference.rolling_angle[:keep],
        contact_point=_sampled(trial.time, trial.contact_point, time),
        reference_contact_point=reference.contact_point[:keep],
    )


def start_of(trace: Trace) -> float:
    """Return uplift or release of a trace [s]; 0 where there is none."""
    return trace.uplift_time if math.isfinite(trace.uplift_time) else 0.0


def is_release(case: Case) -> bool:
    """Return whether a case starts tilted."""
    return case.initial is not None and case.initial.tilt > 0.0


def _finite_end(trace: Trace) -> float:
    """Time of the last sample before the first tilt that is not a number [s]."""
    bad = np.flatnonzero(~np.isfinite(trace.tilt))
    count = int(bad[0]) if len(bad) else len(trace.tilt)
    return float(trace.time[count - 1]) if count else -math.inf


def _sampled(own: FloatArray, values: FloatArray, time: FloatArray) -> FloatArray:
    """Return `values` given at the times `own`, at the times `time`; linear where they differ."""
    count = len(time)
    if len(own) >= count and bool(np.all(np.abs(own[:count] - time) < _SAME_TIME)):
        return values[:count]
    if values.ndim == 1:
        return np.interp(time, own, values)
    return np.column_stack([np.interp(time, own, column) for column in values.T])
