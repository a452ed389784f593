"""Runs of an engine at finer steps, and the limit that they tend to.

A budget needs the engine's limit for a vanishing step. Each run is repeated at half and a quarter of its
step, and where the limit is still uncertain at an eighth and so on; none longer than its traces agree. A run
that is extrapolated itself is no run at a step: what it tends to rests on further ones, from its finest on.
"""

from __future__ import annotations

import dataclasses
import math
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from rockwobble.models import Case, Run, Trace
from rockwobble.multibody.engines.registry import engine_facts
from rockwobble.multibody.time_step.extrapolated import EXTRAPOLATED

from ..metrics.pair import is_release, start_of
from ..metrics.tilt import rms
from ..runs.execution import SAMPLE_STEP, Job
from ..runs.run_settings import at_step
from .error_budget import COVERED, WORTH_EXPLAINING, Limit, common_count, extrapolated

# of the step of the run: always two, and one more where the limit is uncertain
_ALWAYS, _AT_MOST = 2, 3
# uncertainty of a limit, over the whole difference, that asks for a finer step
_UNCERTAIN = 0.1

Simulate = Callable[[list[Job]], list[Trace]]


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Refined:
    """A run that is to be extrapolated.

    Parameters
    ----------
    case : Case
    run : Run
    label : str
    trajectory : Trace
        Of the engine.
    end : float
        Until when the limit is needed [s].
    difference : ndarray
        Engine minus model, as far as they agree [alpha]: the whole that is to be explained.
    """

    case: Case
    run: Run
    label: str
    trajectory: Trace
    end: float
    difference: NDArray[np.float64]

    @property
    def smooth(self) -> bool:
        """Whether the error of the run is a power series in the step: from rest not in every engine."""
        assert self.run.engine is not None  # only runs of engines are refined
        return is_release(self.case) or engine_facts(self.run.engine).smooth_uplift

    @property
    def extrapolated(self) -> bool:
        """Whether the run is itself what others tend to."""
        return self.run.time_step == EXTRAPOLATED

    def levels(self, asked: Sequence[int]) -> Sequence[int]:
        """Return how often the step is to be halved: not at all, too, where no run was at the step itself."""
        return (0, *asked) if self.extrapolated and 1 in asked else asked


def limits(refined: Sequence[Refined], simulate: Simulate) -> Mapping[tuple[str, str], Limit]:
    """Return the limit of each run, by names of case and run.

    A run whose finer runs fail or crash has none.

    Parameters
    ----------
    refined : sequence of Refined
    simulate : callable
        Runs jobs, and returns their results in the same order.
    """
    found: dict[tuple[str, str], list[Trace]] = {
        (r.case.name, r.label): [] if r.extrapolated else [r.trajectory] for r in refined
    }
    waiting = list(refined)
    levels: Sequence[int] = range(1, _ALWAYS + 1)
    while waiting:
        jobs = [[_job(each, level) for level in each.levels(levels)] for each in waiting]
        results = iter(simulate([job for some in jobs for job in some]))
        for each, some in zip(waiting, jobs, strict=True):
            found[each.case.name, each.label] += [next(results) for _ in some]
        next_level = levels[-1] + 1
        if next_level > _AT_MOST:
            break
        levels = (next_level,)
        waiting = [each for each in waiting if _is_uncertain(each, found[each.case.name, each.label])]
    made = {(r.case.name, r.label): _limit(r, found[r.case.name, r.label]) for r in refined}
    return {key: limit for key, limit in made.items() if limit is not None}


def finer_case(refined: Refined) -> Case:
    """Return the problem of the finer runs: as long as needed."""
    case = refined.case
    end = min(case.length, math.ceil(refined.end / SAMPLE_STEP - 1e-6) * SAMPLE_STEP)
    return dataclasses.replace(case, duration=max(end, SAMPLE_STEP))


def _job(refined: Refined, level: int) -> Job:
    return Job(
        case=finer_case(refined),
        run=at_step(refined.run, refined.trajectory.time_step * 0.5**level),
        label=f"{refined.label}, step/{2**level}",
    )


def _limit(refined: Refined, traces: Sequence[Trace]) -> Limit | None:
    if any(trace.outcome == "failed" for trace in traces):
        return None
    # a run that uplifts by chance has no part in the limit
    used = traces if refined.smooth else traces[1:]
    count = common_count([trace.time for trace in used])
    tilts = [trace.tilt[:count] for trace in used]
    if count == 0 or not all(np.isfinite(tilt).all() for tilt in tilts):
        return None
    steps = [trace.time_step for trace in used]
    return extrapolated(used[0].time[:count], tilts, steps, smooth=refined.smooth)


def _is_uncertain(refined: Refined, traces: Sequence[Trace]) -> bool:
    limit = _limit(refined, traces)
    if limit is None or not refined.smooth:
        return False
    # the stretch that the budget covers, from the uplift on: before it there is nothing to err in
    start = start_of(refined.trajectory)
    covered = (limit.time >= start) & (limit.time <= start + COVERED * (refined.end - start))
    error = rms(limit.error[covered]) / refined.case.cylinder.alpha
    whole = rms(refined.difference[: math.ceil(COVERED * len(refined.difference))])
    return whole > WORTH_EXPLAINING and error > _UNCERTAIN * whole
