"""time_step="extrapolated": the limit of a run for a vanishing step, from runs at steps that halve.

Three runs, at h = 4, 2 and 1 times the finest step. The two finest give the limit, sample by sample, the
third its order p and the error that is left, see `auto_step`. p is 1 or 2. After a release, and wherever the
rim only rolls, it is 1 and the limit 2 x(h) - x(2 h); under shaking the near passes of upright take over, in
which a step of h is a share of a short time, and their error is of order 2. The error is what one halving has
moved the extrapolation by: of a pure series it is a third or a seventh of that, but near passes mix the
orders.

It means something as far as the runs agree: to the last pass before two of them part by 1 % of alpha, no
further than a halving moves the extrapolation by less than it moves the run, and not beyond a swing that ends
below what contact resolves, or what contact makes or takes of the energy. Beyond that the trace is the finest
run, and a diagnostic says from when on. What contact did (force, slip, walls) is that of the finest run
throughout: no power series of the step.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import replace
from itertools import pairwise
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from rockwobble.models import Diagnostic, Trace
from rockwobble.models.trace_file import EagerSource

from .auto_step import (
    Attempt,
    Progress,
    closeness,
    common_count,
    measured_order,
    part_of,
    shares,
    to_zero_step,
    unknown_from,
)
from .guard import LARGEST_STEP
from .scene import Array

if TYPE_CHECKING:
    import pandas as pd


EXTRAPOLATED = "extrapolated"
FINEST = 1.75e-4  # [s] at the reference size: all three together cost one run at the default step
_RUNS = 3
_FIRST_OR_SECOND = 1.5  # order between first and second
_SAMPLED = ("tilt", "tilt_rate", "rolling_angle", "twist", "contact_point", "centre_of_mass")
_LATE = ("rolling_rate", "energy", "energy_error", "energy_lost")
_OF_NO_ACCOUNT = 1e-6  # difference over alpha below which mixed orders do not matter
_ONE_TURN = math.pi  # [rad] two rolling angles further apart went past upright on different sides


def require_finest(finest: float, unit_time: float) -> None:
    """Refuse a finest step [s] whose coarsest run no contact can follow.

    Raises
    ------
    ValueError
        Saying what is allowed for this size and gravity.
    """
    allowed = LARGEST_STEP * unit_time / 2.0 ** (_RUNS - 1)
    if finest > allowed * (1.0 + 1e-9):
        raise ValueError(
            f"finest_step must be at most {allowed:.3g} s, a quarter of the largest step for contact at this "
            f"size and gravity, got {finest:g}"
        )


def extrapolate(attempt: Attempt, finest: float, alpha: float, progress: Progress | None) -> Trace:
    """Limit of runs at three steps, as far as they agree.

    Parameters
    ----------
    attempt : callable
        Runs with a time step [s] and a callback for its fraction done.
    finest : float
        The smallest of the steps [s].
    alpha : float
        Slenderness angle of the cylinder [rad].
    progress : callable, optional
        Called with the fraction done.
    """
    steps = [finest * 2.0**level for level in reversed(range(_RUNS))]
    parts = shares(steps)
    runs = [
        attempt(step, part_of(progress, *part)) for step, part in zip(steps, pairwise(parts), strict=True)
    ]
    spent = sum(run.wall_time for run in runs)
    return replace(extrapolation(runs, alpha), wall_time=spent)


def extrapolation(runs: Sequence[Trace], alpha: float) -> Trace:
    """Limit of three runs, the coarsest first, each at half the step of the one before."""
    finest = runs[-1]
    if finest.outcome == "failed":
        return finest
    if any(run.outcome == "failed" for run in runs):
        return _with_facts(finest, Diagnostic(code="not_extrapolated", time=0.0, detail="fails"))
    agree = min(closeness(coarse, fine, alpha).until for coarse, fine in pairwise(runs))
    unknown, code = unknown_from(finest)
    until = min(agree, unknown)
    count = int(np.searchsorted(finest.time[: common_count([run.time for run in runs])], until, side="right"))
    tilts = [run.tilt[:count] for run in runs]
    order = 2 if measured_order(tilts) >= _FIRST_OR_SECOND else 1
    moved = np.abs(to_zero_step(tilts[1:], order) - to_zero_step(tilts[:-1], order))
    good = _meaningful(moved, np.maximum(np.abs(tilts[-1] - tilts[-2]), _OF_NO_ACCOUNT * alpha))
    whole = good == len(finest.time)
    why = "no_closer" if good < count else code if unknown < agree else "diverged"
    if good == 0:
        return _with_facts(finest, Diagnostic(code="not_extrapolated", time=0.0, detail=why))
    end, left = float(finest.time[good - 1]), float(moved[:good].max())
    facts = [Diagnostic(code="extrapolated", duration=end, size=left / alpha, bound=order)]
    if not whole:
        facts.append(Diagnostic(code="not_extrapolated", time=end, detail=why))
    merged = _merge(runs[-2:], order, good)
    return replace(_with_facts(merged, *facts), error_estimate=left, settled_until=end)


def _meaningful(moved: Array, difference: Array) -> int:
    """Number of samples in which halving the step moves the extrapolation less than the run itself."""
    holds = np.maximum.accumulate(moved) <= np.maximum.accumulate(difference)
    return int(np.flatnonzero(holds)[-1]) + 1 if holds.any() else 0


def _with_facts(run: Trace, *facts: Diagnostic) -> Trace:
    return replace(run, facts=(*run.facts, *facts))


def _merge(pair: Sequence[Trace], order: int, good: int) -> Trace:
    """Finer run with every quantity extrapolated in its first `good` samples."""
    fine = pair[-1]
    whole = good == len(fine.time)
    # a tilt is never negative, and rolling angles on two sides of upright have no common limit
    apart = np.abs(pair[0].rolling_angle[:good] - fine.rolling_angle[:good]) > _ONE_TURN
    kept = (to_zero_step([run.tilt[:good] for run in pair], order) < 0.0) | apart

    sampled: dict[str, Any] = {
        name: _samples([getattr(run, name) for run in pair], order, good, kept)
        for name in (*_SAMPLED, *_LATE)
    }
    late = {name: sampled.pop(name) for name in _LATE}
    end = float(fine.time[good - 1])
    extrema = [run.extrema[run.extrema[:, 0] <= end] for run in pair]
    peaks_alike = whole and pair[0].outcome == fine.outcome
    return replace(
        fine,
        **sampled,
        source=EagerSource({**fine.late, **late}, fine.assumptions),
        passes=_passes([run.passes for run in pair], order, end),
        extrema=np.vstack([_rows(extrema, order), fine.extrema[len(extrema[-1]) :]]),
        peak_tilt=_number(pair, "peak_tilt", order) if peaks_alike else fine.peak_tilt,
        uplift_time=_number(pair, "uplift_time", order),
        uplift_direction=_limit(_one_branch([np.array(run.uplift_direction) for run in pair]), order),
        peak_displacement=math.nan,  # set by the samples
        residual_displacement=math.nan,
    )


def _samples(values: Sequence[Array], order: int, good: int, kept: NDArray[np.bool_]) -> Array:
    angles = values[-1].copy()
    reached = to_zero_step([value[:good] for value in values], order)
    reached[kept] = angles[:good][kept]
    angles[:good] = np.where(np.isfinite(reached), reached, angles[:good])
    return angles


def _number(pair: Sequence[Trace], name: str, order: int) -> float:
    return _limit([np.array(getattr(run, name)) for run in pair], order)


def _limit(values: Sequence[Array], order: int) -> float:
    reached = float(to_zero_step(values, order))
    return reached if math.isfinite(reached) else float(values[-1])


def _one_branch(angles: Sequence[Array]) -> list[Array]:
    """The two angles, each row of the coarser shifted by whole turns to be nearest to the finer."""
    coarse, fine = angles
    return [coarse - 2.0 * math.pi * np.round((coarse - fine) / (2.0 * math.pi)), fine]


def _rows(tables: Sequence[Array], order: int) -> Array:
    """Limit of turning points with the same rows, else those of the finest run."""
    coarse, fine = tables
    if len(coarse) != len(fine) or (coarse[:, 3] != fine[:, 3]).any():
        return fine
    limits = to_zero_step(tables, order)
    limits[:, 2] = to_zero_step(_one_branch([table[:, 2] for table in tables]), order)
    return limits


def _passes(tables: Sequence[pd.DataFrame], order: int, end: float) -> pd.DataFrame:
    fine = tables[-1].copy()
    early = [table[table["time"] <= end] for table in tables]
    if len(early[0]) != len(early[-1]):
        return fine
    for name in ("time", "minimum_tilt", "angle_of_turn"):
        reached = to_zero_step([table[name].to_numpy() for table in early], order)
        good = reached >= 0.0 if name == "minimum_tilt" else np.isfinite(reached)
        fine.loc[fine.index[: len(reached)][good], name] = reached[good]
    return fine
