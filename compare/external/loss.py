"""Loss of energy of an external trajectory, and the rolling resistance that would explain it.

The models of recess and flat ground lose nothing. Over still ground each maximum of the tilt is then as high
as the one before, whatever becomes of the azimuths in the passes between: maxima that fall from swing to
swing are a loss, and no sensitivity of passes.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, replace

import numpy as np

from rockwobble.models import Case, Trace
from rockwobble.models.case import MOST_RESISTANCE

from ..runs.execution import simulate_run
from .mistakes import Mistake
from .motion import Difference, Motion, Reference, motion_at
from .table import Array

LEAST_LOSS = 5e-3  # smallest relative loss of a maximum from swing to swing that is reported
FEWEST_MAXIMA = 3
LESS_DIFFERENCE = 0.25  # largest share of the tilt difference left by a resistance that explains it
LEAST = 1e-4  # smallest resistance tried, over b
_COARSE, _FINE, _ROUNDS = 17, 7, 4
ENERGY_LOSS, ROLLING_RESISTANCE = "energy_loss", "rolling_resistance"
CODES = (ENERGY_LOSS, ROLLING_RESISTANCE)


@dataclass(frozen=True, slots=True, kw_only=True)
class Loss(Mistake):
    """A loss that the model does not have: no mistake of the file.

    Attributes
    ----------
    code : str
        "energy_loss" (value: share of its tilt that it loses from one maximum to the next) or
        "rolling_resistance" (value: that of the case with which the model follows it [m]).
    """

    @property
    def words(self) -> str:
        """The loss in words."""
        if self.code == ENERGY_LOSS:
            return f"it loses energy, {100.0 * self.value:.2g} % of its tilt from each swing to the next"
        return f"as with a rolling resistance of {self.value:.2g} m"


def losses(
    motion: Motion, reference: Reference, trace: Trace, case: Case
) -> tuple[tuple[Loss, ...], Difference]:
    """Return the loss that explains how the tilts differ, if one does, and what differs without it.

    Parameters
    ----------
    motion : Motion
        Motion of the external trajectory.
    reference : Reference
        The model, whose motion that of `trace` is.
    trace : Trace
        Trace of the model, of which the run says how it is simulated.
    case : Case
    """
    before = reference.difference(motion)
    share = loss_of(motion, reference)
    if not (before.tilt.differs and share > LEAST_LOSS and trace.run.is_model):
        return (), before
    found: tuple[Loss, ...] = (Loss(code=ENERGY_LOSS, concerns="tilt", value=share),)
    resistance, follows = _resistance(motion, reference, trace, case)
    after = follows.difference(motion)
    if after.tilt.size > LESS_DIFFERENCE * before.tilt.size:
        return found, before
    return (*found, Loss(code=ROLLING_RESISTANCE, concerns="tilt", value=resistance)), after


def loss_of(motion: Motion, reference: Reference) -> float:
    """Return the share of a maximum of the tilt that is lost to the next, the median; 0 where none is known.

    That of a release on still ground alone: elsewhere the ground makes and takes energy. 0 too where a
    maximum is higher than the one before by more than noise.
    """
    if not reference.is_free:
        return 0.0
    height = maxima(motion.tilt, 5.0 * motion.noise + 1e-3 * float(motion.tilt.max(initial=0.0)))
    if len(height) < FEWEST_MAXIMA:
        return 0.0
    lost = 1.0 - height[1:] / height[:-1]
    return float(np.median(lost)) if lost.min() > -0.5 * LEAST_LOSS else 0.0


def maxima(tilt: Array, least: float) -> Array:
    """Return the maxima of a tilt from which it falls by more than `least` [rad], the first included."""
    entries: list[float] = []
    highest, lowest = float(tilt[0]), math.inf
    for value in tilt.tolist():
        if lowest == math.inf:  # rising, or just behind a maximum
            highest = max(highest, value)
            if value < highest - least:
                entries.append(highest)
                lowest = value
        else:
            lowest = min(lowest, value)
            if value > lowest + least:
                highest, lowest = value, math.inf
    return np.array(entries)


def _resistance(motion: Motion, reference: Reference, trace: Trace, case: Case) -> tuple[float, Reference]:
    """Return the rolling resistance with which the model comes closest [m], and that model."""
    run, radius = trace.run, case.cylinder.base_radius

    def with_resistance(length: float) -> tuple[float, float, Reference]:
        other = simulate_run(replace(case, rolling_resistance=length), run)
        moved = motion_at(other.time, other.tilt, other.rolling_angle, other.centre_of_mass)
        follows = replace(reference, motion=moved)
        return follows.difference(motion).tilt.size, length, follows

    low, high, count = LEAST * radius, MOST_RESISTANCE * radius, _COARSE
    for _ in range(_ROUNDS):
        lengths = np.geomspace(low, high, count).tolist()
        tried = [with_resistance(length) for length in lengths]
        best = min(range(count), key=lambda at: tried[at][0])
        low, high, count = lengths[max(best - 1, 0)], lengths[min(best + 1, count - 1)], _FINE
    _, length, follows = tried[best]
    return length, follows
