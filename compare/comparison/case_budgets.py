"""The error budgets of all runs of a comparison."""

from __future__ import annotations

import dataclasses
import math
from collections.abc import Mapping, Sequence

from rockwobble.models import Case, Run, Trace

from ..metrics.agreement import Agreement, agreement_time, tolerance_of
from ..metrics.pair import make_pair
from ..runs.choice import own_model, references_of
from ..runs.execution import Job
from .error_budget import ErrorBudget, error_budget
from .prediction import landings
from .refinement import Refined, Simulate, limits

Key = tuple[str, str]
# planar in the x z plane, with the loss of a base that lands flat
_IMPACT = Run(None, "recess", plane=0.0, restitution="momentum")


def case_budgets(
    cases: Sequence[Case],
    runs: Mapping[str, Run],
    reference: Run | None,
    results: Mapping[Key, Trace],
    simulate: Simulate,
    *,
    named: str = "",
) -> dict[tuple[str, str, str], ErrorBudget]:
    """Return the budget of each run and reference: by name of the case, label and label of the reference.

    What crashed, failed or never moved has none.

    Parameters
    ----------
    cases : sequence of Case
    runs : mapping
        Run of each label.
    reference : Run or None
        What every run is held against; None is what its support asks for.
    results : mapping
        Traces by name of the case and label.
    simulate : callable
        Runs jobs, and returns their results in the same order.
    """
    agreements: dict[tuple[str, str, str], Agreement] = {}
    refined = []
    for case in cases:
        for label, run in runs.items():
            trajectory = results[case.name, label]
            if run.engine is None or trajectory.outcome == "failed":
                continue
            found = {
                model: agreement
                for model in references_of(case, run, label, reference, named=named)
                if (agreement := _agreement(case, results[case.name, model], trajectory)) is not None
            }
            if not found:
                continue
            agreements |= {(case.name, label, model): agreement for model, agreement in found.items()}
            model, agreement = max(found.items(), key=lambda item: item[1].end)
            pair = make_pair(case.cylinder, results[case.name, model], trajectory, until=agreement.end)
            refined.append(
                Refined(
                    case=case,
                    run=run,
                    label=label,
                    trajectory=trajectory,
                    end=agreement.end,
                    difference=pair.tilt_difference[pair.time >= pair.start],
                )
            )
    extrapolations = limits(refined, simulate) if refined else {}
    by_name = {case.name: case for case in cases}
    landings = _landings(cases, runs, results, simulate)

    def own(name: str, label: str) -> Trace:
        key = name, str(own_model(runs[label]))
        return landings.get(key, results[key])

    return {
        (name, label, model): error_budget(
            by_name[name].cylinder,
            results[name, label],
            results[name, model],
            own(name, label),
            extrapolations[name, label],
            agreement,
        )
        for (name, label, model), agreement in agreements.items()
        if (name, label) in extrapolations
    }


def _landings(
    cases: Sequence[Case], runs: Mapping[str, Run], results: Mapping[Key, Trace], simulate: Simulate
) -> dict[Key, Trace]:
    """Return planar motion with impacts, for models that go through upright: by names of case and model.

    Motion in one vertical plane passes upright itself, and there the base lands flat. The recess and
    flat-ground models go on without loss, as the limit of a vanishing spin does. A rigid base takes the
    angular momentum about its new edge (Housner), on any support, and so do the engines: the difference is
    model form.
    """
    keys, jobs = [], []
    for case in cases:
        for model in dict.fromkeys(str(own_model(run)) for run in runs.values()):
            response = results[case.name, model]
            if not len(landings(response)):
                continue
            direction, motion, initial = response.uplift_direction, case.motion, case.initial
            plane = dataclasses.replace(
                case,
                motion=None if motion is None else motion.rotated(-direction),
                initial=None if initial is None else dataclasses.replace(initial, rolling_angle=0.0),
            )
            keys.append((case.name, model))
            jobs.append(Job(case=plane, run=_IMPACT, label="planar with impact"))
    return dict(zip(keys, simulate(jobs), strict=True)) if jobs else {}


def _agreement(case: Case, response: Trace, trajectory: Trace) -> Agreement | None:
    if response.outcome == "failed" or not math.isfinite(response.uplift_time):
        return None
    pair = make_pair(case.cylinder, response, trajectory, until=case.length)
    agreement = agreement_time(pair, tolerance=tolerance_of(response, trajectory))
    return agreement if agreement.length > 0.0 else None
