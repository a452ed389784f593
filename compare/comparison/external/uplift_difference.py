"""The uplift of an external trajectory against that of a model, as far as its samples tell it.

A cylinder may rock for a while below the tilt that its samples can show. So what is held against a model is
when both lean that far, and the model, which knows all, tells how well noise and samples tell that time.
"""

from __future__ import annotations

import math

import numpy as np

from rockwobble.models import Trace

from ...traces.trajectory import measurement
from ...traces.uplift import CONFIDENCE
from .difference import Part


def uplift_differences(trajectory: Trace, reference: Trace) -> tuple[Part | None, Part | None]:
    """Return time [s] and azimuth [rad] at which a trajectory leans first, minus those of a model.

    The size of each is the difference and its bound the uncertainty; both are None for a release, or where
    one of the two never leans.
    """
    told = measurement(trajectory)
    stands, blur = told.stands, CONFIDENCE * told.noise
    seen = told.first_lean
    passed = [first_passage(reference, tilt) for tilt in (stands - blur, stands, stands + blur)]
    if not (seen > 0.0 and passed[1] > 0.0):
        return None, None
    early, middle, late = passed
    # a tilt that the model only just reaches may be missed: until its largest, nobody knows
    late = late if math.isfinite(late) else float(reference.time[int(np.argmax(reference.tilt))])
    half = 0.5 * trajectory.time_step
    apart = seen - half - middle
    uncertainty = half + max(late - middle, middle - early)
    time = Part(first_time=seen if abs(apart) > uncertainty else math.nan, size=apart, bound=uncertainty)
    if not math.isfinite(trajectory.uplift_direction):
        return time, None
    around = seen + uncertainty * np.linspace(-1.0, 1.0, 9)
    angle = np.interp(
        [seen, *around],
        reference.time,
        np.nan_to_num(reference.rolling_angle, nan=reference.uplift_direction),
    )
    turned = float(np.abs(angle[1:] - angle[0]).max())
    off = math.remainder(trajectory.uplift_direction - float(angle[0]), 2.0 * math.pi)
    bound = turned + blur / stands
    return time, Part(first_time=seen if abs(off) > bound else math.nan, size=off, bound=bound)


def first_passage(trace: Trace, tilt: float) -> float:
    """Return when a trace leans first by this tilt [s]; NaN if never. Its cube root is linear in between."""
    beyond = np.flatnonzero(trace.tilt > tilt)
    if not len(beyond):
        return math.nan
    at = int(beyond[0])
    if at == 0:
        return float(trace.time[0])
    before, after = np.cbrt(trace.tilt[at - 1 : at + 1])
    # from rest the growth begins at the uplift, not at the sample before it
    begin = max(float(trace.time[at - 1]), trace.uplift_time if before == 0.0 else 0.0)
    return begin + (float(trace.time[at]) - begin) * float((np.cbrt(tilt) - before) / (after - before))
