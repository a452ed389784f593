"""Agreement time of two traces.

Each near pass of upright may turn one motion to the left and its neighbour to the right, so two
traces of one problem diverge at some time however good both are. What counts is when.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from rockwobble.models import AGREEMENT, Trace

from .pair import Pair

# share of the peak tilt: motions that stay below 1 % of alpha agree within that whatever they do
PEAK_SHARE = 0.1


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
    tested : bool
        Whether the tilt of the reference changes within it by more than the tolerance; if it does not,
        anything that moves no more agrees.
    """

    length: float
    end: float
    diverged: bool
    tested: bool


def tolerance_of(reference: Trace, trial: Trace | None = None) -> float:
    """Return the smaller of 1 % of alpha and a tenth of the peak tilt [alpha].

    The peak is that of the reference, or of the trial where the reference stays at rest.
    """
    for trace in (reference, trial):
        if trace is not None and math.isfinite(trace.uplift_time) and trace.peak_tilt > 0.0:
            return min(AGREEMENT, PEAK_SHARE * trace.peak_tilt / trace.case.cylinder.alpha)
    return AGREEMENT


def agreement_time(
    pair: Pair, *, tolerance: float = AGREEMENT, broken: bool = False, allowance: float = 0.0
) -> Agreement:
    """Return the time from uplift or release to the first tilt difference above a tolerance.

    Parameters
    ----------
    pair : Pair
    tolerance : float, optional
        [alpha]
    broken : bool, optional
        Whether one of the two traces is broken off by a failure: agreement ends with it at the latest.
    allowance : float, optional
        For the noise of a measurement, added to the tolerance [alpha].
    """
    beyond = np.flatnonzero(np.abs(pair.tilt_difference) > tolerance + allowance)
    count = int(beyond[0]) if len(beyond) else len(pair.time)
    end = float(pair.time[count]) if len(beyond) else pair.end
    diverged = broken or len(beyond) > 0
    agreed = pair.reference_tilt[:count]
    return Agreement(
        # a trial that moves before the reference uplifts has no agreement at all
        length=max(0.0, end - pair.start) if diverged else end,
        end=end,
        diverged=diverged,
        tested=count > 0 and float(np.ptp(agreed)) > tolerance * pair.cylinder.alpha,
    )


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
