"""The checks of one trajectory of somebody else, as far as one motion allows."""

from __future__ import annotations

import dataclasses
import math
from collections.abc import Iterator

import numpy as np

from rockwobble.models import Case

from ..finding import Finding
from .model import NEVER, TOLERANCE, Outside, left_out
from .motion import apart, rises
from .outputs import Outputs

_ONLY_MODELS = ("exact", "invariance")
_LEVEL = 1e-3  # of alpha


def check_trajectory(
    given: Outputs, case: Case, *, support: str = "recess", tolerance: float = TOLERANCE
) -> Iterator[Finding]:
    """Yield the findings of the checks on one motion; what one motion cannot tell is listed.

    Parameters
    ----------
    given : Outputs
    case : Case
        The problem that it answers.
    support : {"recess", "flat"}
    tolerance : float
        How exact it claims to be.
    """
    outside = Outside(model=_none, support=support, tolerance=tolerance)
    ours, alpha = outside.ours(case), case.cylinder.alpha
    if case.initial is None:
        seen = [rises(one, _LEVEL * alpha) for one in (given, ours)]
        off = 0.0 if all(map(math.isnan, seen)) else abs(seen[0] - seen[1])
        yield outside.finding("rest", "time of uplift [s]", off, "(25), or the offset of the clock")
    else:
        off = abs(given.tilt[0] - case.initial.tilt) / alpha
        yield outside.finding("rest", "tilt at release", off, "start, or units")
    if given.azimuth is None:
        ours = dataclasses.replace(ours, azimuth=None)
        yield left_out("agreement", "azimuth", "(19)", "the file has no azimuth")
    end = _agreement(ours, case, support)
    value = apart(given, ours, alpha, end)
    yield outside.finding("agreement", f"lean up to {end:.4g} s", value, "the equations, body or axes")
    peaks = [float(one.tilt[one.time <= end].max()) / alpha for one in (given, ours)]
    yield outside.finding("agreement", "peak tilt", abs(peaks[0] - peaks[1]), "the equations")
    if given.energy is None:
        yield left_out("conserved", "energy", "energy", "the file has no energy")
    for layer in _ONLY_MODELS:
        note = "one motion does not tell: give a model that can be called"
        yield left_out(layer, f"checks of the layer {layer}", "the model", note)
    for layer, note in NEVER.items():
        yield left_out(layer, f"checks of the layer {layer}", "the model", note)


def _agreement(ours: Outputs, case: Case, support: str) -> float:
    """Return until when a copy that is off by 0.1 % stays within 1 % of alpha [s]."""
    other = case
    if case.motion is not None:
        other = dataclasses.replace(case, motion=case.motion.scaled(1.001))
    elif case.initial is not None:
        start = dataclasses.replace(case.initial, tilt=1.001 * case.initial.tilt)
        other = dataclasses.replace(case, initial=start)
    copy = Outside(model=_none, support=support, tolerance=1.0).ours(other)
    count = min(len(copy.tilt), len(ours.tilt))
    beyond = np.flatnonzero(np.abs(copy.tilt[:count] - ours.tilt[:count]) > 0.01 * case.cylinder.alpha)
    return float(ours.time[beyond[0]] if len(beyond) else ours.time[-1])


def _none(case: Case, support: str) -> Outputs:
    raise NotImplementedError
