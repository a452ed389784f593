"""Overturning by the peak tilt, and differences of the tilt."""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import ArrayLike, NDArray

from rockwobble.models import Cylinder, Trace

from ..traces.pair import Pair, make_pair


def overturned(peak_tilts: ArrayLike) -> NDArray[np.bool_]:
    """Return where a run of a reduced model overturned, by its peak tilt [rad]; False where it failed.

    The models decide, also where a run ends in the middle of a fall, and then give pi/2 and no less.
    """
    return np.asarray(peak_tilts, dtype=np.float64) >= 0.5 * math.pi


def rms(values: NDArray[np.float64]) -> float:
    """Return the root mean square of values (n,); NaN of none."""
    return float(np.sqrt(np.mean(np.square(values)))) if len(values) else math.nan


def tilt_rms(pair: Pair) -> float:
    """Root mean square of the tilt difference over all samples, in units of alpha."""
    return rms(pair.tilt_difference)


def tilt_rms_relative(pair: Pair) -> float:
    """RMS(difference)/RMS(tilt of the reference); NaN where the reference never tilts."""
    scale = rms(pair.reference_tilt) / pair.cylinder.alpha
    return tilt_rms(pair) / scale if scale > 0.0 else math.nan


def relative_rms(cylinder: Cylinder, reference: Trace, trial: Trace, *, until: float | None = None) -> float:
    """Return RMS(difference of tilt)/RMS(tilt of the reference) from uplift to `until`.

    Parameters
    ----------
    cylinder : Cylinder
    reference, trial : Trace
    until : float, optional
        In the time of the run [s]. Default: as far as both reach.

    Returns
    -------
    float
        Dimensionless; 0 is identity, sqrt(2) two motions that know nothing of each other.

    Raises
    ------
    ValueError
        If the reference never tilts, or not before `until`.

    Examples
    --------
    >>> import rockwobble as rw
    >>> pier = rw.Cylinder(semidiagonal=6.0, tan_alpha=0.2)
    >>> release = rw.InitialState(0.5 * pier.alpha, rolling_rate=0.5)
    >>> case = rw.Case(pier, initial=release, duration=4.0)
    >>> recess, flat = rw.simulate(case), rw.simulate(case, support="flat")
    >>> relative_rms(pier, recess, recess), bool(relative_rms(pier, recess, flat) < 0.01)
    (0.0, True)
    """
    pair = make_pair(cylinder, reference, trial, until=until)
    value = tilt_rms_relative(pair)
    if math.isnan(value):
        raise ValueError(f"the reference must tilt before the end of the window, {pair.end:g} s")
    return value
