"""Drives both sides with the same case."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from contextlib import nullcontext
from pathlib import Path
from typing import Any

from rockwobble.models import Case, Run, Suite

from ..runs.choice import default_runs, own_model, references_of, require_runnable, run_labels
from ..runs.execution import Crash, Job, ProgressCallback, simulate_all
from ..runs.run_store import open_run_store
from ..storage.files import require_writable
from ..storage.provenance import package_versions
from ..traces.trajectory import External, read_trajectories
from .case_budgets import case_budgets
from .error_budget import ErrorBudget
from .prediction import Simulate, estimated_error, measured_error, predict_horizon
from .result import Comparison
from .summary import SUMMARY_COLUMNS, crashed_row, external_row, summary_row


def compare(
    case_or_suite: Case | Suite,
    *,
    runs: Iterable[Run] | None = None,
    reference: str = "recess",
    out: str | Path | None = None,
    until: float | None = None,
    workers: int | None = None,
    progress: ProgressCallback | None = None,
    resume: str | Path | None = None,
    external: Iterable[External | str | Path] = (),
    budget: bool = False,
) -> Comparison:
    """Run engines and reduced models on the same problem, and report how they differ.

    Parameters
    ----------
    case_or_suite : Case or Suite
    runs : iterable of Run, optional
        Default: those of the suite, else every installed engine with supports "recess" and "flat".
    reference : str, optional
        Reduced model that each run is held against. A run on open ground ("flat") is also held
        against the model that is free to roll out, "flat", and so is one in a ring of walls ("ring").
    out : str or Path, optional
        Folder to save the results in; checked before anything runs.
    until : float, optional
        End of the window of the RMS columns, in the time of the run [s]. Default: the whole run.
    workers : int, optional
        Number of processes; 1 runs everything in this one. Default: one for each core.
    progress : callable, optional
        Called with a `Progress` at the start and at the end of each run.
    resume : str or Path, optional
        Folder, such as that of `out`, that keeps each run in `runs` as soon as it is finished. A second
        call with the same inputs, after whatever ended the first, repeats none that is there.
    external : iterable of External, str or Path, optional
        CSV files of trajectories of this case from a shake table or another code, each one more run; what
        they may hold is said in `rockwobble.compare.traces.file`. With them, `runs` may be empty.
    budget : bool, optional
        Whether to repeat each run at finer time steps, as far as traces agree, and split its difference
        into model form, numerics and what stays unexplained: see `ErrorBudget`. Takes some seven times
        as long for runs that agree to their end.

    Returns
    -------
    Comparison

    Raises
    ------
    ValueError
        If an engine, a support, a setting, a file or the folder is not usable; nothing is written then.

    Examples
    --------
    >>> from rockwobble.models import Case, Cylinder, InitialState, Run
    >>> pier = Cylinder(semidiagonal=6.0, tan_alpha=0.2)
    >>> release = InitialState(tilt=0.5 * pier.alpha, rolling_rate=0.5)
    >>> case = Case("release", pier, initial=release, duration=0.5)
    >>> found = compare(case, runs=[Run("mujoco", "recess", 1e-3)], workers=1)
    >>> found.summary[["engine", "support", "reference", "diverged"]].values.tolist()
    [['mujoco', 'recess', 'recess', False]]
    """
    if out is not None:
        require_writable(out)
    cases = case_or_suite.cases if isinstance(case_or_suite, Suite) else (case_or_suite,)
    chosen = _runs(case_or_suite, runs, needed=not (external := tuple(external)))
    for case in cases:
        for run in chosen:
            require_runnable(case, run)
    labels = run_labels(chosen)
    brought = read_trajectories(external, cases, taken=labels)
    models = [reference] if brought else []
    for run in chosen:
        models += [*references_of(run, reference), own_model(run.support)]
    models = list(dict.fromkeys(models))
    jobs = [Job(case=case, method=model, label=model) for case in cases for model in models]
    jobs += [
        Job(case=case, method=run, label=label)
        for case in cases
        for run, label in zip(chosen, labels, strict=True)
    ]
    with nullcontext() if resume is None else open_run_store(resume) as store:

        def run_all(jobs: list[Job]) -> list[Any]:
            return simulate_all(jobs, workers=workers, progress=progress, store=store)

        by_label = {
            (job.case.name, job.label): result for job, result in zip(jobs, run_all(jobs), strict=True)
        }
        by_run = dict(zip(labels, chosen, strict=True))
        budgets = case_budgets(cases, by_run, reference, by_label, run_all) if budget else {}

        def twin(case: Case, model: str) -> Any:
            # milliseconds: not worth a process, nor a word about its progress
            job = Job(case=case, method=model, label=f"twin of {model}")
            return simulate_all([job], workers=1, store=store)[0]

        rows = [
            _row(case, model, by_label, label, run, budgets.get((case.name, label, model)), twin, until)
            for case in cases
            for run, label in zip(chosen, labels, strict=True)
            for model in references_of(run, reference)
        ]
    rows += [
        external_row(cases[0], reference, by_label[name, reference], label, trajectory, until=until)
        for (name, label), trajectory in brought.items()
    ]
    comparison = Comparison(
        summary=_table(rows),
        cases={case.name: case for case in cases},
        responses={key: result for key, result in by_label.items() if key[1] in models},
        trajectories={
            key: result
            for key, result in by_label.items()
            if key[1] in labels and not isinstance(result, Crash)
        }
        | brought,
        versions=package_versions(),
        until=until,
        budgets=budgets,
    )
    if out is not None:
        comparison.save(out)
    return comparison


def _runs(case_or_suite: Case | Suite, runs: Iterable[Run] | None, *, needed: bool) -> tuple[Run, ...]:
    chosen = tuple(runs) if runs is not None else ()
    if runs is not None and not chosen and not needed:
        return ()
    if not chosen and isinstance(case_or_suite, Suite):
        chosen = case_or_suite.runs
    chosen = chosen or default_runs()
    if not chosen:
        raise ValueError("there must be at least one engine to compare with, found none installed")
    return chosen


def _row(
    case: Case,
    model: str,
    results: Mapping[tuple[str, str], Any],
    label: str,
    run: Run,
    budget: ErrorBudget | None,
    twin: Simulate,
    until: float | None,
) -> dict[str, Any]:
    reference, own, trial = (
        results[case.name, model],
        results[case.name, own_model(run.support)],
        results[case.name, label],
    )
    for name, response in ((model, reference), (own_model(run.support), own)):
        if isinstance(response, Crash):
            # the reduced models have no way to end a process: this is no result, but a broken installation
            raise RuntimeError(  # noqa: TRY004
                f"the {name} model left no response: {response.message}"
            )
    if isinstance(trial, Crash):
        return crashed_row(case, model, reference, label, run, trial.message)
    error = (
        estimated_error(case, run.engine, trial.time_step) if budget is None else measured_error(case, budget)
    )
    prediction = predict_horizon(
        case,
        reference=reference,
        own=own,
        own_model=own_model(run.support),
        contact_resolution=trial.contact_resolution,
        error=error,
        simulate=twin,
    )
    return summary_row(
        case,
        model,
        reference,
        label,
        trial,
        prediction=prediction,
        estimated_error=error,
        budget=budget,
        until=until,
    )


def _table(rows: list[dict[str, Any]]) -> Any:
    import pandas as pd

    return pd.DataFrame(rows, columns=list(SUMMARY_COLUMNS)).astype({"diverged": bool, "agreed_passes": int})
