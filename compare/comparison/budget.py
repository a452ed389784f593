"""Error budget: the parts of a difference between an engine and a reduced model, sample by sample.

    engine - reference = (engine - limit) + (limit - own) + (own - reference)
                       =     numerics     +  unexplained  +   model form

limit is the engine extrapolated to a time step of zero, own the reduced model of the engine's support
(see `own_model_of`) or, where that goes through upright itself, planar motion with the loss of a base that
lands flat. The three are signed traces of the tilt, and add up exactly.
Tilt itself is never negative, so it folds where a motion goes past upright; as long as two motions agree
within the tolerance of `tolerance_of` they are on the same side of that fold, which is why the budget ends
with the agreement.

Numerics and unexplained rest on the limit. Where it cannot be known they are not stated: see
`ErrorBudget.not_split`.
"""

from __future__ import annotations

import dataclasses
import math
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from rockwobble.models import Case, Run, Trace
from rockwobble.models.frames import column_meanings, pd
from rockwobble.models.shown import CompactRepr
from rockwobble.models.support import RECESS
from rockwobble.multibody.auto_step import common_count, linear_extrapolation, measured_order, to_zero_step
from rockwobble.multibody.engines.registry import engine_facts
from rockwobble.multibody.extrapolated_step import EXTRAPOLATED

from ..metrics.pair import (
    Agreement,
    agreement_of,
    first_unresolved_pass,
    landings,
    make_pair,
    rms,
    start_of,
    tolerance_of,
)
from ..runs.choice import Compared, at_step
from ..runs.execution import SAMPLE_STEP, Job

Array = NDArray[np.float64]

# share of the agreement over which the RMS of a budget is taken: at its end all parts grow at once
COVERED = 0.8
# smaller differences are not worth explaining [alpha]
WORTH_EXPLAINING = 1e-4
# largest share of the whole that may stay unexplained
LARGEST_SHARE = 0.2
# smallest order in the step at which finer runs tend to a limit
LEAST_ORDER = 0.5
# samples are multiples of one step; two that differ by less are the same [s]
_SAME_TIME = 1e-9

# number of halvings of the step: always two, and one more where the limit is uncertain
_ALWAYS, _AT_MOST = 2, 3
# uncertainty of a limit, over the whole difference, that requires a finer step
_UNCERTAIN = 0.1
# planar in the x z plane, with the loss of a base that lands flat
_IMPACT = Run(None, RECESS, plane=0.0, restitution="momentum")
# name: (unit, meaning), beside case, run and reference
BUDGET_COLUMNS = column_meanings("rockwobble.compare", "budget")
Simulate = Callable[[list[Job]], list[Trace]]
Key = tuple[str, str]


@dataclass(frozen=True, slots=True, kw_only=True, eq=False, repr=False)
class Limit(CompactRepr):
    """An engine extrapolated in its time step.

    Parameters
    ----------
    time : ndarray, shape (n,)
        [s]
    tilt : ndarray, shape (n,)
        [rad]; an extrapolation may be slightly negative next to upright.
    error : ndarray, shape (n,)
        By how much the finest step has moved it [rad]: its uncertainty.
    steps : tuple of float
        Time steps that it rests on, the coarsest first [s].
    order : float
        Order in the step as measured from the three finest runs; NaN where there are only two.
    """

    time: Array
    tilt: Array
    error: Array
    steps: tuple[float, ...]
    order: float


@dataclass(frozen=True, slots=True, kw_only=True, eq=False, repr=False)
class ErrorBudget(CompactRepr):
    """Signed parts of a tilt difference, in units of alpha.

    Parameters
    ----------
    time : ndarray, shape (n,)
        From uplift or release to the end of the agreement [s].
    whole : ndarray, shape (n,)
        Engine minus reference: the sum of the three parts.
    model_form, numerics, unexplained : ndarray, shape (n,)
    limit_error : ndarray, shape (n,)
        Uncertainty of the extrapolation, by which numerics and unexplained may be off.
    covered : float
        End of the stretch that the RMS values cover, 80 % of the agreement [s].
    steps, order : tuple of float, float
        Steps and order of the `Limit` that the numerics rest on.
    unresolved : float
        First pass of the engine that is closer to upright than its contact resolves [s]; infinite if none.
    """

    time: Array
    whole: Array
    model_form: Array
    numerics: Array
    unexplained: Array
    limit_error: Array
    covered: float
    steps: tuple[float, ...]
    order: float
    unresolved: float = math.inf

    @property
    def not_split(self) -> str:
        """Reason why numerics and unexplained are not stated; empty where they are.

        Where the model form is nearly all of the difference, they are. Else "unresolved_pass": a pass within
        the agreement is left to chance, at any step; "order": finer runs tend to no limit, in an order below
        a half; "error": the uncertainty of the limit is larger than both parts.
        """
        parts, error = max(self.rms("numerics"), self.rms("unexplained")), self.rms("limit_error")
        if max(parts, error) <= LARGEST_SHARE * self.rms("whole"):
            return ""
        if len(self.time) and self.unresolved <= self.time[-1]:
            return "unresolved_pass"
        return "order" if self.order < LEAST_ORDER else "error" if error > parts else ""

    def rms(self, part: str) -> float:
        """Return the RMS of one part until 80 % of the agreement [alpha]; NaN without a sample."""
        return rms(getattr(self, part)[self.time <= self.covered + _SAME_TIME])

    def columns(self) -> dict[str, float | str]:
        """Values of `BUDGET_COLUMNS`; NaN for what is not stated."""
        whole, lack = self.rms("whole"), self.not_split
        numerics, unexplained = (math.nan if lack else self.rms(part) for part in ("numerics", "unexplained"))
        return {
            "whole_rms": whole,
            "model_form_rms": self.rms("model_form"),
            "numerics_rms": numerics,
            "unexplained_rms": unexplained,
            "unexplained_share": unexplained / whole if whole > 0.0 else math.nan,
            "limit_error": self.rms("limit_error"),
            "step_order": self.order,
            "finest_step": self.steps[-1],
            "not_split": lack,
        }

    def to_frame(self) -> pd.DataFrame:
        """Return the samples as a table, in units of alpha."""
        names = ("time", "whole", "model_form", "numerics", "unexplained", "limit_error")
        return pd.DataFrame({name: getattr(self, name) for name in names})


def error_budget(
    engine: Trace, reference: Trace, own: Trace, limit: Limit, agreement: Agreement
) -> ErrorBudget:
    """Return the budget of `engine` minus `reference` over their agreement.

    Parameters
    ----------
    engine : Trace
        Trajectory of the engine.
    reference : Trace
        Response of the reduced model that it is compared with.
    own : Trace
        Response of the reduced model of the engine's support; may be the reference itself.
    limit : Limit
        The engine extrapolated in its step.
    agreement : Agreement
        Agreement of engine and reference.
    """
    start = start_of(reference)
    motions = (engine, reference, own, limit)
    time = engine.time[: common_count([each.time for each in motions])]
    keep = slice(*np.searchsorted(time, [start - _SAME_TIME, agreement.end + _SAME_TIME]))
    alpha = engine.case.cylinder.alpha
    measured, asked, explained, extrapolated = (each.tilt[keep] / alpha for each in motions)
    return ErrorBudget(
        time=engine.time[keep],
        whole=measured - asked,
        model_form=explained - asked,
        numerics=measured - extrapolated,
        unexplained=extrapolated - explained,
        limit_error=limit.error[keep] / alpha,
        covered=start + COVERED * (agreement.end - start),
        steps=limit.steps,
        order=limit.order,
        unresolved=first_unresolved_pass(engine, start=start),
    )


def extrapolated(time: Array, tilts: Sequence[Array], steps: Sequence[float], *, smooth: bool) -> Limit:
    """Return the limit of a run for a vanishing step, from runs at steps that halve.

    Parameters
    ----------
    time : ndarray, shape (n,)
        [s]
    tilts : sequence of ndarray, shape (n,)
        One for each step [rad], at least two.
    steps : sequence of float
        The coarsest first [s], each half the one before.
    smooth : bool
        Whether the error is a power series in the step, as after a release: then its first and its
        second order are removed, which takes three runs. From rest the instant of uplift falls
        anywhere within a step, and that error has no series: then only the first order is removed,
        with as little weight on the single runs as that takes.

    Raises
    ------
    ValueError
        If there are fewer than two runs.
    """
    if len(tilts) < 2:
        raise ValueError(f"an extrapolation needs runs at two steps or more, got {len(tilts)}")
    now = _intercept(tilts, smooth=smooth)
    before = _intercept(tilts[:-1], smooth=smooth) if len(tilts) > 2 else tilts[-1]
    return Limit(
        time=time, tilt=now, error=np.abs(now - before), steps=tuple(steps), order=measured_order(tilts)
    )


def _intercept(tilts: Sequence[Array], *, smooth: bool) -> Array:
    """Value at step zero of a polynomial through the finest runs."""
    if smooth and len(tilts) > 2:
        # first order is removed, then second
        return to_zero_step([to_zero_step(tilts[-3:-1], 1), to_zero_step(tilts[-2:], 1)], 2)
    if smooth or len(tilts) == 2:
        return to_zero_step(tilts[-2:], 1)
    return linear_extrapolation(tilts)


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Refined:
    """A run that is to be extrapolated.

    Parameters
    ----------
    case : Case
    run : Run
    label : str
    trajectory : Trace
        Trajectory of the engine.
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
        """Whether the error of the run is a power series in the step; from rest in some engines it is not."""
        return self.case.is_release or engine_facts(self.run.engine_name).smooth_uplift

    @property
    def extrapolated(self) -> bool:
        """Whether the run is extrapolated itself."""
        return self.run.time_step == EXTRAPOLATED


def limits(refined: Sequence[Refined], simulate: Simulate) -> list[Limit | None]:
    """Limit of each run; None for a run whose finer runs fail or crash.

    Parameters
    ----------
    refined : sequence of Refined
    simulate : callable
        Runs jobs, and returns their results in the same order.
    """
    traces = [[] if each.extrapolated else [each.trajectory] for each in refined]

    def halve(wanted: Sequence[tuple[int, int]]) -> None:
        finer = simulate([_job(refined[index], times) for index, times in wanted]) if wanted else []
        for (index, _), trace in zip(wanted, finer, strict=True):
            traces[index].append(trace)

    # zero halvings, too, where no run was at the step itself
    every = list(enumerate(refined))
    halve([(index, times) for index, each in every for times in range(not each.extrapolated, _ALWAYS + 1)])
    halve([(index, _AT_MOST) for index, each in every if _is_uncertain(each, traces[index])])
    return [_limit(each, traces[index]) for index, each in every]


def _job(refined: Refined, times: int) -> Job:
    """Run with its step halved several times, up to the time for which its limit is needed."""
    case = refined.case
    end = min(case.length, math.ceil(refined.end / SAMPLE_STEP - 1e-6) * SAMPLE_STEP)
    return Job(
        case=dataclasses.replace(case, duration=max(end, SAMPLE_STEP)),
        run=at_step(refined.run, refined.trajectory.time_step * 0.5**times),
        label=f"{refined.label}, step/{2**times}",
    )


def _limit(refined: Refined, traces: Sequence[Trace]) -> Limit | None:
    if any(trace.outcome == "failed" for trace in traces):
        return None
    # a run that uplifts by chance is left out of the limit
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
    # the part of the agreement under the budget begins at the uplift: before it there is no motion
    start = start_of(refined.trajectory)
    covered = (limit.time >= start) & (limit.time <= start + COVERED * (refined.end - start))
    error = rms(limit.error[covered]) / refined.case.cylinder.alpha
    whole = rms(refined.difference[: math.ceil(COVERED * len(refined.difference))])
    return whole > WORTH_EXPLAINING and error > _UNCERTAIN * whole


def case_budgets(
    compared: Sequence[Compared], traces: Mapping[Key, Trace], simulate: Simulate
) -> dict[tuple[str, str, str], ErrorBudget]:
    """Budget of each run and reference: by name of the case, label and label of the reference.

    What crashed, failed or never moved has none.

    Parameters
    ----------
    compared : sequence of Compared
    traces : mapping
        Traces by name of the case and label.
    simulate : callable
        Runs jobs, and returns their results in the same order.
    """
    agreements: list[tuple[Compared, dict[str, Agreement]]] = []
    refined = []
    for each in compared:
        case, trajectory = each.case, traces[each.case.name, each.label]
        if each.run.is_model or trajectory.outcome == "failed":
            continue
        agreed = {
            model: agreement
            for model in each.references
            if (agreement := _agreement(case, traces[case.name, model], trajectory)) is not None
        }
        if not agreed:
            continue
        agreements.append((each, agreed))
        model = max(agreed, key=lambda model: agreed[model].end)
        end = agreed[model].end
        pair = make_pair(case.cylinder, traces[case.name, model], trajectory, until=end)
        refined.append(
            Refined(
                case=case,
                run=each.run,
                label=each.label,
                trajectory=trajectory,
                end=end,
                difference=pair.tilt_difference[pair.time >= pair.start],
            )
        )
    extrapolations = limits(refined, simulate)
    own = {key: traces[key] for key in ((each.case.name, str(each.own)) for each in compared)}
    own |= _impacts(own, simulate)
    return {
        (each.case.name, each.label, model): error_budget(
            traces[each.case.name, each.label],
            traces[each.case.name, model],
            own[each.case.name, str(each.own)],
            limit,
            agreement,
        )
        for (each, agreed), limit in zip(agreements, extrapolations, strict=True)
        for model, agreement in agreed.items()
        if limit is not None
    }


def _impacts(own: Mapping[Key, Trace], simulate: Simulate) -> dict[Key, Trace]:
    """Planar motion with impacts, for models that pass upright: by names of case and model.

    Motion in one vertical plane passes upright itself, and there the base lands flat. The recess and
    flat-ground models go on without loss, as the limit of a vanishing spin does. A rigid base takes the
    angular momentum about its new edge (Housner), on any support, and so do the engines: the difference is
    model form.
    """
    jobs = {}
    for key, response in own.items():
        if response.run.loses_at_impact or not len(landings(response)):
            continue
        direction, motion, initial = response.uplift_direction, response.case.motion, response.case.initial
        plane = dataclasses.replace(
            response.case,
            motion=None if motion is None else motion.rotated(-direction),
            initial=None if initial is None else dataclasses.replace(initial, rolling_angle=0.0),
        )
        jobs[key] = Job(case=plane, run=_IMPACT, label="planar with impact")
    return dict(zip(jobs, simulate(list(jobs.values())), strict=True)) if jobs else {}


def _agreement(case: Case, response: Trace, trajectory: Trace) -> Agreement | None:
    if response.outcome == "failed" or not math.isfinite(response.uplift_time):
        return None
    tolerance = tolerance_of(response, trajectory)
    agreement = agreement_of(response, trajectory, until=case.length, tolerance=tolerance)
    return agreement if agreement.length > 0.0 else None


def unexplained_rows(budgets: pd.DataFrame) -> pd.DataFrame:
    """Rows of a table of budgets with too large an unexplained share, the worst first.

    Rows whose whole difference is below 1e-4 alpha, or is not split, are left out.

    Parameters
    ----------
    budgets : DataFrame
        `Comparison.budget_rms`.

    Returns
    -------
    DataFrame
    """
    rows = budgets[(budgets["whole_rms"] > WORTH_EXPLAINING) & (budgets["unexplained_share"] > LARGEST_SHARE)]
    return rows.sort_values("unexplained_share", ascending=False)
