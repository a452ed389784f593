"""How far a result is fixed by what a user knows: many runs of one problem, each a little different."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from rockwobble import reduced
from rockwobble.models import Case, Run, Trace

from ...metrics.agreement import agreement_time
from ...metrics.distributions import Contrast, contrast
from ...traces.pair import make_pair
from ..ensemble.members import perturbed_starts

Array = NDArray[np.float64]

COUNT = 100  # members: quantiles of 5 % then rest on five runs
PERTURBATION = 0.01  # nobody knows a record or a release better than to a percent
SEED = 1
LOW, HIGH = 0.05, 0.95
# A trace is lost where the members are spread over half of the peak tilt. A percent of alpha, the limit of
# agreement between methods, would be exceeded by the percent that the members differ by itself.
LOST = 0.5
_SAMPLE_STEP = 0.05  # [s] enough to draw a swing of a second


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Spread:
    """Peak tilts and traces of perturbed members, by the model of the support and by another one.

    Attributes
    ----------
    model, other : Run
        The two reduced models.
    count, perturbation, seed
        As in `perturbed_starts`.
    peaks, other_peaks : ndarray, shape (count,)
        [alpha]; pi/2 over alpha where overturned, NaN where a run failed.
    overturned, other_overturned : ndarray of bool, shape (count,)
    time : ndarray, shape (m,)
        [s]
    low, high : ndarray, shape (m,)
        Tilt that 5 % and 95 % of the members do not exceed at that time [alpha].
    followed_until : float
        Time at which the members are spread over half of the peak tilt [s]; the end where they never are.
    agreed_until : float
        Time at which both models, unperturbed, differ by 1 % of alpha [s]; the end where they never do.
    """

    model: Run
    other: Run
    count: int
    perturbation: float
    seed: int
    peaks: Array
    other_peaks: Array
    overturned: NDArray[np.bool_]
    other_overturned: NDArray[np.bool_]
    time: Array
    low: Array
    high: Array
    followed_until: float
    agreed_until: float

    def quantile(self, share: float, *, other: bool = False) -> float:
        """Return the peak tilt that `share` of the members do not exceed [alpha]; NaN where all failed."""
        peaks = self.other_peaks if other else self.peaks
        known = peaks[np.isfinite(peaks)]
        return float(np.quantile(known, share, method="inverted_cdf")) if len(known) else math.nan

    def overturning_share(self, *, other: bool = False) -> float:
        """Return the share of the members that overturn, of those that did not fail [-]."""
        peaks = self.other_peaks if other else self.peaks
        fell = self.other_overturned if other else self.overturned
        known = np.isfinite(peaks)
        return float(fell[known].mean()) if known.any() else math.nan

    def contrast(self) -> Contrast:
        """Hold the peak tilts of both models against each other, member by member: the other's first."""
        return contrast(self.other_peaks, self.peaks, self.other_overturned, self.overturned)


def spread_of_starts(
    case: Case,
    response: Trace,
    other_response: Trace,
    *,
    models: tuple[Run, Run],
    count: int = COUNT,
    perturbation: float = PERTURBATION,
    seed: int = SEED,
) -> Spread:
    """Run perturbed starts of a case by two reduced models.

    Parameters
    ----------
    case : Case
    response, other_response : Trace
        Unperturbed runs of the two models.
    models : tuple of Run
    count, perturbation, seed
        As in `perturbed_starts`.
    """
    members = perturbed_starts(case, count, perturbation=perturbation, seed=seed)
    alpha = case.cylinder.alpha
    time = np.arange(0.0, case.length, _SAMPLE_STEP)
    tilts = np.full((count, len(time)), math.nan)
    runs = [_run(member, models[0]) for member in members]
    for row, run in zip(tilts, runs, strict=True):
        row[:] = np.interp(time, run.time, run.tilt / alpha)  # one that fell stays on its side
    known = [row for row, run in zip(tilts, runs, strict=True) if run.outcome != "failed"]
    low, high = np.quantile(known, [LOW, HIGH], axis=0) if known else np.full((2, len(time)), math.nan)
    others = [_run(member, models[1]) for member in members]
    pair = make_pair(case.cylinder, response, other_response)
    divergence = agreement_time(pair)
    return Spread(
        model=models[0],
        other=models[1],
        count=count,
        perturbation=perturbation,
        seed=seed,
        peaks=_peaks(runs, alpha),
        other_peaks=_peaks(others, alpha),
        overturned=np.array([run.outcome == "overturned" for run in runs]),
        other_overturned=np.array([run.outcome == "overturned" for run in others]),
        time=time,
        low=low,
        high=high,
        followed_until=_lost_from(time, high - low, response.peak_tilt / alpha, case.length),
        agreed_until=divergence.end if divergence.diverged else case.length,
    )


def _run(case: Case, model: Run) -> Trace:
    return reduced.simulate(
        Case(case.cylinder, case.motion, initial=case.initial, duration=case.duration, gravity=case.gravity),
        support=model.support,
        sample_step=_SAMPLE_STEP,
    )


def _peaks(runs: Sequence[Trace], alpha: float) -> Array:
    return np.array([run.peak_tilt / alpha for run in runs])


def _lost_from(time: Array, width: Array, peak: float, length: float) -> float:
    wide = np.flatnonzero(width > LOST * min(peak, 1.0))
    return float(time[wide[0]]) if len(wide) else length
