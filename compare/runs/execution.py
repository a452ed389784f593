"""The runs of a comparison, in parallel."""

from __future__ import annotations

import inspect
import math
import os
import queue
from collections.abc import Callable, Sequence
from concurrent.futures import Future
from dataclasses import dataclass, replace
from typing import Any, Literal, Protocol

from rockwobble.models import Case, Run, Trace
from rockwobble.models.trace import lost_trace

from .process_pool import ProcessPool, WorkerDiedError

SAMPLE_STEP = 0.01


@dataclass(frozen=True, slots=True, kw_only=True)
class Job:
    """One run of one case.

    Parameters
    ----------
    case : Case
    run : Run
    label : str, optional
        For tables and figures, different for each job of a case. Default: engine and support.
    """

    case: Case
    run: Run
    label: str = ""

    def __post_init__(self) -> None:
        object.__setattr__(self, "label", self.label or str(self.run))


@dataclass(frozen=True, slots=True, kw_only=True)
class Progress:
    """What a progress callback is told, at the start and at the end of each run.

    Parameters
    ----------
    case, label : str
        Which run.
    state : {"started", "finished"}
    done, total : int
        Runs finished so far, and in all.
    """

    case: str
    label: str
    state: Literal["started", "finished"]
    done: int
    total: int


ProgressCallback = Callable[[Progress], None]


class FinishedRuns(Protocol):
    """Where finished runs are kept, as a `RunStore` does."""

    def find(self, job: Job) -> Trace | None:
        """Return the run of a job, or None if it is not there."""

    def keep(self, job: Job, trace: Trace) -> None:
        """Keep the run of a job."""


def simulate(
    case: Case,
    *,
    support: str = "recess",
    engine: str | None = None,
    time_step: float | Literal["auto"] | None = None,
    sample_step: float = SAMPLE_STEP,
    **settings: Any,
) -> Trace:
    """Run a case in a reduced model or an engine.

    Parameters
    ----------
    case : Case
    support : {"recess", "flat", "ring"}, optional
    engine : str, optional
        Such as "mujoco" or "pybullet". Default: the reduced model.
    time_step : float or "auto", optional
        Of an engine [s].
    sample_step : float, optional
        Spacing of the samples [s].
    **settings
        Of `reduced.simulate` or `multibody.simulate`.

    Returns
    -------
    Trace

    Raises
    ------
    ValueError
        If the engine or the support is unknown, or a setting is unknown or out of range.

    Examples
    --------
    >>> import rockwobble as rw
    >>> pier = rw.Cylinder(semidiagonal=6.0, tan_alpha=0.2)
    >>> release = rw.InitialState(tilt=0.5 * pier.alpha, rolling_rate=0.5)
    >>> rw.simulate(rw.Case(pier, initial=release, duration=2.0), support="flat").outcome
    'completed'
    """
    return simulate_run(case, Run(engine, support, time_step, **settings), sample_step=sample_step)


def simulate_run(case: Case, run: Run, *, sample_step: float = SAMPLE_STEP) -> Trace:
    """Run a reduced model or an engine on a case, as `run` says.

    Raises
    ------
    ValueError
        What `reduced.simulate` or `multibody.simulate` raises.
    """
    if run.engine is None:
        from rockwobble import reduced

        if run.time_step is not None:
            raise ValueError(f"a reduced model has no time_step, but a tolerance rtol, got {run.time_step!r}")
        known = set(inspect.signature(reduced.simulate).parameters) - {"case", "support", "sample_step"}
        for name in run.settings.keys() - known:
            raise ValueError(f"a reduced model has the settings {', '.join(sorted(known))}, got {name!r}")
        found = reduced.simulate(case, support=run.support, sample_step=sample_step, **run.settings)
        _ = found.late  # computed here, so that it travels with the trace
        return found
    from rockwobble import multibody

    return multibody.simulate(
        case,
        engine=run.engine,
        support=run.support,
        time_step=run.time_step,
        sample_step=sample_step,
        **run.settings,
    )


def run_job(job: Job) -> Trace:
    """Run one job in this process."""
    return simulate_run(job.case, job.run)


def simulate_all(
    jobs: Sequence[Job],
    *,
    workers: int | None = None,
    progress: ProgressCallback | None = None,
    store: FinishedRuns | None = None,
) -> list[Trace]:
    """Run all jobs; return their results in the same order.

    Parameters
    ----------
    jobs : sequence of Job
    workers : int, optional
        Number of processes; 1 runs one job after the other in this process. Default: one for each
        core, but no more than jobs.
    progress : callable, optional
        Told of the start and the end of each job that runs, in this thread.
    store : FinishedRuns, optional
        A job found there does not run again, and one that runs is kept there at its end.

    Returns
    -------
    list of Trace
        One whose process died has no samples, the outcome "failed" and the diagnostic "died".

    Raises
    ------
    ValueError
        What a job raises for bad input; the other jobs are given up.
    """
    results: list[Trace | None] = [None if store is None else store.find(job) for job in jobs]
    open_jobs = [index for index, result in enumerate(results) if result is None]
    found = len(jobs) - len(open_jobs)

    def told(event: Progress) -> None:
        if progress is not None:
            progress(replace(event, done=found + event.done, total=len(jobs)))

    def finished(index: int, result: Trace) -> None:
        results[open_jobs[index]] = result
        if store is not None and len(result.time):
            store.keep(jobs[open_jobs[index]], result)

    _run_all([jobs[index] for index in open_jobs], workers, told, finished)
    return [result for result in results if result is not None]


def _run_all(
    jobs: Sequence[Job], workers: int | None, tell: ProgressCallback, finished: Callable[[int, Trace], None]
) -> None:
    count = min(_cores(), len(jobs)) if workers is None else workers
    if count > 1 and jobs:
        _in_parallel(jobs, count, tell, finished)
        return
    for done, job in enumerate(jobs):
        tell(_progress(job, "started", done, len(jobs)))
        finished(done, run_job(job))
        tell(_progress(job, "finished", done + 1, len(jobs)))


def _in_parallel(
    jobs: Sequence[Job], workers: int, tell: ProgressCallback, keep: Callable[[int, Trace], None]
) -> None:
    # the callback is called from the caller's thread, so that it may draw, raise or be interrupted
    finished: queue.SimpleQueue[int] = queue.SimpleQueue()
    futures: dict[int, Future[Trace]] = {}
    # the longest first, so that no core is idle at the end
    waiting = sorted(range(len(jobs)), key=lambda index: _cost(jobs[index]))
    with ProcessPool(workers) as pool:

        def start(done: int) -> None:
            index = waiting.pop()
            tell(_progress(jobs[index], "started", done, len(jobs)))
            futures[index] = pool.submit(run_job, jobs[index])
            futures[index].add_done_callback(lambda _: finished.put(index))

        for _ in range(min(workers, len(jobs))):
            start(0)
        for done in range(1, len(jobs) + 1):
            index = finished.get()
            try:
                result = futures.pop(index).result()
            except WorkerDiedError as error:
                result = lost_trace(jobs[index].case, jobs[index].run, str(error))
            keep(index, result)
            tell(_progress(jobs[index], "finished", done, len(jobs)))
            if waiting:
                start(done)


def _progress(job: Job, state: Literal["started", "finished"], done: int, total: int) -> Progress:
    return Progress(case=job.case.name, label=job.label, state=state, done=done, total=total)


def _cost(job: Job) -> float:
    """Rough computing time of a job, in steps of MuJoCo."""
    if job.run.engine is None:
        return math.inf  # may compile
    per_step = 1.0 if job.run.engine == "mujoco" else 3.0
    step = job.run.time_step or 1e-4
    # the usual search ends at half of the default step
    return job.case.length / (2.5e-5 if step == "auto" else step) * per_step


def _cores() -> int:
    if hasattr(os, "sched_getaffinity"):
        return len(os.sched_getaffinity(0))
    return os.cpu_count() or 1
