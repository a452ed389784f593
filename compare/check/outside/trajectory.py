"""The checks of one external trajectory, as far as one motion allows."""

from __future__ import annotations

import dataclasses
import math
from collections.abc import Iterator
from functools import partial

import numpy as np

from rockwobble.models import AGREEMENT, Case, Trace

from ...external.motion import Motion
from ...external.trajectory import measurement, own_samples
from ..finding import Finding
from .model import NEVER, TOLERANCE, held, left_out, ours
from .motion import apart, rises

_ONLY_MODELS = ("exact", "invariance")
_LEVEL = 1e-3  # of alpha


def check_trajectory(
    trajectory: Trace, *, support: str = "recess", tolerance: float = TOLERANCE
) -> Iterator[Finding]:
    """Yield the findings of the checks on one motion; what one motion cannot tell is listed.

    Parameters
    ----------
    trajectory : Trace
        Of `read_trajectory`, with the case that it answers; it is held at the samples of its file.
    support : {"recess", "flat"}
    tolerance : float
        How exact it claims to be.

    Raises
    ------
    ValueError
        If its file tells no tilt.
    """
    source = measurement(trajectory)
    if "tilt" not in source.poses.given:
        raise ValueError(f"{source.given.path.name} must have tilt, or qw, qx, qy and qz")
    finding, given, case = partial(held, tolerance), own_samples(trajectory), trajectory.case
    model, alpha = ours(case, support), case.cylinder.alpha
    if case.initial is None:
        seen = [rises(one, _LEVEL * alpha) for one in (given, model)]
        off = 0.0 if all(map(math.isnan, seen)) else abs(seen[0] - seen[1])
        yield finding("rest", "time of uplift [s]", off, "(25), or the offset of the clock")
    else:
        off = abs(float(given.tilt[0]) - case.initial.tilt) / alpha
        yield finding("rest", "tilt at release", off, "start, or units")
    if given.lean is None:
        yield left_out("agreement", "azimuth", "(19)", "the file has no azimuth")
    end = _agreement(model, case, support)
    value = apart(given, model, alpha, end)
    yield finding("agreement", f"lean up to {end:.4g} s", value, "the equations, body or axes")
    peaks = [float(one.tilt[one.time <= end].max()) / alpha for one in (given, model)]
    yield finding("agreement", "peak tilt", abs(peaks[0] - peaks[1]), "the equations")
    yield left_out("conserved", "energy", "energy", "the file has no energy")
    for layer in _ONLY_MODELS:
        note = "one motion does not tell: give a model that can be called"
        yield left_out(layer, f"checks of the layer {layer}", "the model", note)
    for layer, note in NEVER.items():
        yield left_out(layer, f"checks of the layer {layer}", "the model", note)


def _agreement(model: Motion, case: Case, support: str) -> float:
    """Return until when a copy that is off by 0.1 % stays within 1 % of alpha [s]."""
    other = case
    if case.motion is not None:
        other = dataclasses.replace(case, motion=case.motion.scaled(1.001))
    elif case.initial is not None:
        start = dataclasses.replace(case.initial, tilt=1.001 * case.initial.tilt)
        other = dataclasses.replace(case, initial=start)
    copy = ours(other, support)
    count = min(len(copy.tilt), len(model.tilt))
    beyond = np.flatnonzero(np.abs(copy.tilt[:count] - model.tilt[:count]) > AGREEMENT * case.cylinder.alpha)
    return float(model.time[beyond[0]] if len(beyond) else model.time[-1])
