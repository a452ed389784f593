"""The error budgets of all runs of a comparison."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from typing import Any

from rockwobble.models import Case, Run

from .error_budget import ErrorBudget, error_budget
from .execution import Crash
from .horizon import Horizon, agreement_horizon
from .refinement import Refined, Simulate, limits
from .runs import own_model, references_of
from .traces import make_pair

Key = tuple[str, str]


def case_budgets(
    cases: Sequence[Case],
    runs: Mapping[str, Run],
    reference: str,
    results: Mapping[Key, Any],
    simulate: Simulate,
) -> dict[tuple[str, str, str], ErrorBudget]:
    """Return the budget of each run and reference: by names of case, run and reduced model.

    What crashed, failed or never moved has none.

    Parameters
    ----------
    cases : sequence of Case
    runs : mapping
        Run of each label.
    reference : str
        Reduced model that every run is held against.
    results : mapping
        Responses by names of case and model, trajectories by names of case and run.
    simulate : callable
        Runs jobs, and returns their results in the same order.
    """
    agreements: dict[tuple[str, str, str], Horizon] = {}
    refined = []
    for case in cases:
        for label, run in runs.items():
            trajectory = results[case.name, label]
            if isinstance(trajectory, Crash) or trajectory.outcome == "failed":
                continue
            found = {
                model: horizon
                for model in references_of(run, reference)
                if (horizon := _agreement(case, results[case.name, model], trajectory)) is not None
            }
            if not found:
                continue
            agreements |= {(case.name, label, model): horizon for model, horizon in found.items()}
            model, horizon = max(found.items(), key=lambda item: item[1].end)
            pair = make_pair(case.cylinder, results[case.name, model], trajectory, until=horizon.end)
            refined.append(
                Refined(
                    case=case,
                    run=run,
                    label=label,
                    trajectory=trajectory,
                    end=horizon.end,
                    difference=pair.tilt_difference[pair.time >= pair.start],
                )
            )
    extrapolations = limits(refined, simulate) if refined else {}
    by_name = {case.name: case for case in cases}
    return {
        (name, label, model): error_budget(
            by_name[name].cylinder,
            results[name, label],
            results[name, model],
            results[name, own_model(runs[label].support)],
            extrapolations[name, label],
            horizon,
        )
        for (name, label, model), horizon in agreements.items()
        if (name, label) in extrapolations
    }


def _agreement(case: Case, response: Any, trajectory: Any) -> Horizon | None:
    if response.outcome == "failed" or not math.isfinite(response.uplift_time):
        return None
    horizon = agreement_horizon(make_pair(case.cylinder, response, trajectory))
    return horizon if horizon.length > 0.0 else None
