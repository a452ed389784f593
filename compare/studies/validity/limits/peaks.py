"""Two sets of peak tilts of the same cells held against each other."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from .limit import Array, quantile


@dataclass(frozen=True, slots=True, kw_only=True)
class PeakDifference:
    """How far peaks differ.

    Attributes
    ----------
    half, nine_in_ten : float
        Difference over the peak that half and nine in ten of the cells do not exceed; cells that
        stand in both and rock in the first.
    standing : int
        Their number.
    verdicts : float
        Share of the cells in which one overturns and the other does not, of those where either overturns.
    falls : int
        Number of the latter.
    """

    half: float
    nine_in_ten: float
    standing: int
    verdicts: float
    falls: int


def peak_difference(peaks: Array, others: Array, overturning: Array) -> PeakDifference:
    """Compare peak tilts over alpha cell by cell; an overturned one has reached `overturning`."""
    known = np.isfinite(peaks) & np.isfinite(others)
    peaks, others, overturning = peaks[known], others[known], overturning[known]
    fell, other_fell = (values >= overturning * (1.0 - 1e-9) for values in (peaks, others))
    rocks = ~fell & ~other_fell & (peaks > 0.0)
    relative = np.abs(others[rocks] / peaks[rocks] - 1.0)
    either = fell | other_fell
    return PeakDifference(
        half=quantile(relative, 0.5),
        nine_in_ten=quantile(relative, 0.9),
        standing=int(rocks.sum()),
        verdicts=float((fell != other_fell)[either].mean()) if either.any() else 0.0,
        falls=int(either.sum()),
    )
