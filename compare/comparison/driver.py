"""Comparison of runs with reference models, or with one another, on the same problem."""

from __future__ import annotations

from collections.abc import Iterable
from contextlib import nullcontext
from functools import partial
from pathlib import Path

from rockwobble.models import AGREEMENT, Case, Run, Suite, Trace
from rockwobble.models.argument_kinds import with_argument_kinds
from rockwobble.models.case import RECESS_MODEL
from rockwobble.models.frames import pd

from ..external.trajectory import External, read_trajectories
from ..external.verdict import VERDICT_COLUMNS, Row
from ..metrics.pair import tolerance_of
from ..runs.choice import compared_runs, default_runs, labels_beside_references, require_runnable
from ..runs.execution import Job, open_trace_cache, simulate_all
from ..runs.progress import ProgressCallback
from ..storage.manifest import require_writable
from ..storage.provenance import package_versions
from .budget import ErrorBudget, case_budgets
from .peak_error import copies_of_input, peak_error
from .prediction import Simulate, estimated_error, measured_error, predict
from .result import Comparison, comparison_of
from .summary import KEYS, SUMMARY_COLUMNS, external_row, lost_row, summary_row


@with_argument_kinds
def comparison(
    case_or_suite: Case | Suite,
    *,
    runs: Iterable[Run] | None = None,
    reference: Run | None = None,
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
    reference : Run, optional
        What every run is compared with, such as ``Run(None, "flat")`` or another engine. Default: the recess
        model; runs on flat ground also the flat-ground model, or where they slide the sliding model alone;
        those in a recess with clearance themselves at half the step. From rest in one plane: the planar model
        with impacts by the moment of momentum.
    out : str or Path, optional
        Folder to save the results in; checked before anything runs.
    until : float, optional
        End of the window of the RMS columns, in the time of the run [s]. Default: the whole run.
    workers : int, optional
        Number of processes; 1 runs everything in this one. Default: one for each core.
    progress : callable, optional
        Called with a `Progress` at the start and at the end of each run.
    resume : str or Path, optional
        Folder, such as that of `out`, that keeps each run in `finished` as soon as it is there. A second
        call with the same inputs, after whatever ended the first, repeats none that is there.
    external : iterable of External, str or Path, optional
        CSV files of trajectories of this case from a shake table or another code, each one more run; what
        they may hold is said in `rockwobble.compare.external.table`. With them, `runs` may be empty.
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
        If an argument is of another kind, or an engine, a support, a setting, a file or the folder is not
        usable; nothing is written then.

    Examples
    --------
    >>> from rockwobble.models import Case, Cylinder, InitialState, Run
    >>> pier = Cylinder(semidiagonal=6.0, tan_alpha=0.2)
    >>> release = InitialState(tilt=0.5 * pier.alpha, rolling_rate=0.5)
    >>> case = Case(pier, initial=release, duration=0.5)
    >>> found = comparison(case, runs=[Run("mujoco", "recess", 1e-3)], workers=1)
    >>> found.summary[["engine", "support", "reference_support", "diverged"]].values.tolist()
    [['mujoco', 'recess', 'recess', False]]
    """
    if out is not None:
        require_writable(out)
    if until is not None and not until > 0.0:
        raise ValueError(f"until must be positive [s], got {until!r}")
    suite = case_or_suite if isinstance(case_or_suite, Suite) else Suite((case_or_suite,), ())
    cases, external, chosen = suite.cases, tuple(external), tuple(runs or ())
    if not chosen and (runs is None or not external):
        chosen = suite.runs or default_runs(cases=cases)
        if not chosen:
            raise ValueError("there must be at least one engine to compare with, found none installed")
    compared = compared_runs(cases, chosen, reference)
    for each in compared:
        for run in (each.run, each.own, *(() if reference is None else (reference,))):
            require_runnable(each.case, run)
    references = {
        labels_beside_references(chosen, reference)[1] or str(RECESS_MODEL): reference or RECESS_MODEL
    }
    runs_of = [(cases[0], references)] if external else []
    runs_of += [(each.case, {**each.references, str(each.own): each.own}) for each in compared]
    runs_of += [(each.case, {each.label: each.run}) for each in compared]
    jobs = {
        (case.name, label): Job(case=case, run=run, label=label)
        for case, labelled in runs_of
        for label, run in labelled.items()
    }
    brought = read_trajectories(external, cases, taken={label for _, label in jobs})
    with nullcontext() if resume is None else open_trace_cache(resume, Comparison.kind) as cache:

        def run_all(jobs: list[Job]) -> list[Trace]:
            return simulate_all(jobs, workers=workers, progress=progress, cache=cache)

        traces = dict(zip(jobs, run_all(list(jobs.values())), strict=True))
        budgets = case_budgets(compared, traces, run_all) if budget else {}

        def copy_of(case: Case, run: Run) -> Trace:
            # a run of milliseconds needs neither a process nor progress
            return simulate_all([Job(case=case, run=run, label="copy")], workers=1, cache=cache)[0]

        rows = [
            comparison_row(
                case,
                name,
                traces[case.name, name],
                label,
                traces[case.name, label],
                own=traces[case.name, str(own)],
                simulate=copy_of,
                budget=budgets.get((case.name, label, name)),
                until=until,
            )
            for case, label, _, own, against in compared
            for name in against
        ]
    verdicts = [
        external_row(cases[0], other, traces[name, other], label, trajectory, until=until)
        for (name, label), trajectory in brought.items()
        for other in references
    ]
    table = pd.DataFrame([*rows, *verdicts], columns=list(SUMMARY_COLUMNS))
    comparison = comparison_of(
        table.astype({"diverged": bool, "left_tolerance": bool, "agreed_passes": int}),
        cases={case.name: case for case in cases},
        traces=traces | brought,
        versions=package_versions(),
        until=until,
        budgets=budgets,
        external=pd.DataFrame(verdicts, columns=[*KEYS, *VERDICT_COLUMNS]),
    )
    if out is not None:
        comparison.save(out)
    return comparison


def comparison_row(
    case: Case,
    name: str,
    reference: Trace,
    label: str,
    trial: Trace,
    *,
    own: Trace,
    simulate: Simulate,
    budget: ErrorBudget | None = None,
    until: float | None = None,
) -> Row:
    """Row of the summary for one run and one reference, with the prediction of their agreement.

    Parameters
    ----------
    case : Case
    name : str
        Label of the reference.
    reference : Trace
    label : str
        Label of the run.
    trial : Trace
        The run; one whose process died has no samples, and its row says no more than that.
    own : Trace
        Response of the reduced model of the run's support; may be the reference itself.
    simulate : callable
        Runs a reduced model on a case; for the perturbed copies of the prediction.
    budget : ErrorBudget, optional
        Of run and reference. Without one the error of the run is estimated.
    until : float, optional
        End of the window of the RMS columns, in the time of the run [s]. Default: the whole run.

    Returns
    -------
    dict
        Value of each of `SUMMARY_COLUMNS`.
    """
    if not len(trial.time) or not len(reference.time):
        return lost_row(case, name, reference, label, trial)
    error = (
        estimated_error(case, trial.run, trial.time_step) if budget is None else measured_error(case, budget)
    )

    times = [reference.wall_time]  # a run of a millisecond is timed by the fastest of several

    def timed(case: Case, run: Run) -> Trace:
        trace = simulate(case, run)
        times.extend([trace.wall_time] if run == reference.run else [])
        return trace

    own_prediction = partial(
        predict,
        case,
        reference=reference,
        own=own,
        contact_resolution=trial.contact_resolution,
        error=error,
        simulate=timed,
    )
    copies = [timed(copy, own.run) for copy in copies_of_input(case)]
    prediction, tolerance = own_prediction(), tolerance_of(reference, trial)
    return summary_row(
        case,
        name,
        reference,
        label,
        trial,
        prediction=prediction,
        within=own_prediction(tolerance=tolerance) if tolerance < AGREEMENT else prediction,
        estimated_error=error,
        until=until,
        reference_time=min(times),
        error=peak_error(case, trial, own, reference, copies=copies, simulate=simulate),
    )
