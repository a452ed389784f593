"""Agreement time of two traces.

Each near pass of upright may turn one motion to the left and its neighbour to the right, so two
traces of one problem diverge at some time however good both are. What counts is when.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from rockwobble.models import Trace

from .pair import Pair

# tilt difference that ends the agreement, in units of alpha
AGREEMENT = 0.01


@dataclass(frozen=True, slots=True, kw_only=True)
class Agreement:
    """The length of an agreement.

    Parameters
    ----------
    length : float
        From uplift or release to the divergence [s]; the length of the run where there is none.
    end : float
        The same in the time of the run [s].
    diverged : bool
        Whether there was a divergence.
    """

    length: float
    end: float
    diverged: bool


def agreement_time(pair: Pair, *, broken: bool = False, allowance: float = 0.0) -> Agreement:
    """Return the time from uplift or release to the first |tilt difference| > 1 % of alpha.

    Where one of the two traces is `broken` off by a failure, agreement ends with it at the latest. The
    `allowance` for the noise of a measurement is added to the bound [alpha].
    """
    beyond = np.flatnonzero(np.abs(pair.tilt_difference) > AGREEMENT + allowance)
    if not len(beyond) and broken:
        return Agreement(length=max(0.0, pair.end - pair.start), end=pair.end, diverged=True)
    if not len(beyond):
        return Agreement(length=pair.end, end=pair.end, diverged=False)
    end = float(pair.time[beyond[0]])
    # a trial that moves before the reference uplifts has no agreement at all
    return Agreement(length=max(0.0, end - pair.start), end=end, diverged=True)


def agreed_passes(reference: Trace, agreement: Agreement) -> int:
    """Return how many passes of the reference lie within the agreement."""
    times = np.asarray(reference.passes["time"], dtype=np.float64)
    return int(np.count_nonzero(times <= agreement.end))


def closest_pass(reference: Trace, agreement: Agreement) -> float:
    """Return the smallest minimum tilt of the passes within the agreement [rad]; NaN without a pass."""
    minima = np.asarray(reference.passes["minimum_tilt"], dtype=np.float64)[
        : agreed_passes(reference, agreement)
    ]
    return float(minima.min()) if len(minima) else math.nan
