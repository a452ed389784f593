"""Overturning by the peak tilt, and differences of the tilt."""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import ArrayLike, NDArray

from rockwobble.models import Trace

from ..runs.choice import support_of
from .pair import Pair


def overturned(peak_tilts: ArrayLike) -> NDArray[np.bool_]:
    """Return where a run of a reduced model overturned, by its peak tilt [rad]; False where it failed.

    The models decide, also where a run ends in the middle of a fall, and then give pi/2 and no less.
    """
    return np.asarray(peak_tilts, dtype=np.float64) >= 0.5 * math.pi


def outcome_of(trace: Trace) -> str:
    """Return the outcome of a run for a study: the walls of a ring have no top, and hold what has overturned.

    One that leans on a wall beyond its balance at the end of its run counts as overturned: after it the
    ground is still, as where a fall is decided.
    """
    leans = support_of(trace.run).walls and len(trace.tilt) and trace.tilt[-1] > trace.case.cylinder.alpha
    return "overturned" if leans and trace.outcome != "failed" else trace.outcome


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
