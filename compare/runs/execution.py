"""The runs of a comparison, in parallel."""

from __future__ import annotations

import math
import os
import queue
from collections.abc import Callable, Sequence
from concurrent.futures import Future
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, Any, Literal, Protocol

from rockwobble.models import Case, Run
from rockwobble.multibody.engines.registry import engine_facts

from .process_pool import ProcessPool, WorkerDiedError

if TYPE_CHECKING:
    from rockwobble.multibody import Trajectory

SAMPLE_STEP = 0.01
# a model for jobs: planar in the x z plane, with the loss of a base that lands flat
IMPACT = "planar with impact"


@dataclass(frozen=True, slots=True, kw_only=True)
class Job:
    """One run of one case: of an engine, or of a reduced model where `method` is a name.

    Parameters
    ----------
    case : Case
    method : Run or str
    label : str
        For tables and figures, different for each job of a case.
    """

    case: Case
    method: Run | str
    label: str


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


@dataclass(frozen=True, slots=True)
class Crash:
    """A run that took its process with it."""

    message: str


class FinishedRuns(Protocol):
    """Where finished runs are kept, as a `RunStore` does."""

    def find(self, job: Job) -> Any:
        """Return the run of a job, or None if it is not there."""

    def keep(self, job: Job, trace: Any) -> None:
        """Keep the run of a job."""


def simulate(job: Job) -> Any:
    """Run one job in this process; return a Response or a Trajectory."""
    case, method = job.case, job.method
    return _reduced(case, method) if isinstance(method, str) else run_engine(case, method)


def run_engine(case: Case, run: Run, *, sample_step: float = SAMPLE_STEP) -> Trajectory:
    """Run an engine on a case, with all that the case says: friction and gravity, too."""
    from rockwobble import multibody

    return multibody.simulate(
        case.cylinder,
        case.motion,
        initial=case.initial,
        duration=case.duration,
        engine=run.engine,
        support=run.support,
        time_step=run.time_step,
        friction=case.friction,
        sample_step=sample_step,
        gravity=case.gravity,
        **run.settings,
    )


def _reduced(case: Case, model: str) -> Any:
    from rockwobble import reduced

    impact: dict[str, Any] = {"model": "planar", "restitution": "momentum"} if model == IMPACT else {}
    response = reduced.simulate(
        case.cylinder,
        case.motion,
        initial=case.initial,
        duration=case.duration,
        sample_step=SAMPLE_STEP,
        gravity=case.gravity,
        friction=case.friction,
        **(impact or {"model": model}),
    )
    _ = response.energy  # computed here, so that it travels with the response
    return response


def simulate_all(
    jobs: Sequence[Job],
    *,
    workers: int | None = None,
    progress: ProgressCallback | None = None,
    store: FinishedRuns | None = None,
) -> list[Any]:
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
    list
        A Response, a Trajectory, a StoredTrace where it was found in the store or, where the process
        died in a run, a Crash.

    Raises
    ------
    ValueError
        What a job raises for bad input; the other jobs are given up.
    """
    results: list[Any] = [None if store is None else store.find(job) for job in jobs]
    open_jobs = [index for index, result in enumerate(results) if result is None]
    found = len(jobs) - len(open_jobs)

    def told(event: Progress) -> None:
        if progress is not None:
            progress(replace(event, done=found + event.done, total=len(jobs)))

    def finished(index: int, result: Any) -> None:
        results[open_jobs[index]] = result
        if store is not None and not isinstance(result, Crash):
            store.keep(jobs[open_jobs[index]], result)

    _run_all([jobs[index] for index in open_jobs], workers, told, finished)
    return results


def _run_all(
    jobs: Sequence[Job], workers: int | None, tell: ProgressCallback, finished: Callable[[int, Any], None]
) -> None:
    count = min(_cores(), len(jobs)) if workers is None else workers
    if count > 1 and jobs:
        _in_parallel(jobs, count, tell, finished)
        return
    for done, job in enumerate(jobs):
        tell(_progress(job, "started", done, len(jobs)))
        finished(done, simulate(job))
        tell(_progress(job, "finished", done + 1, len(jobs)))


def _in_parallel(
    jobs: Sequence[Job], workers: int, tell: ProgressCallback, keep: Callable[[int, Any], None]
) -> None:
    # the callback is called from the caller's thread, so that it may draw, raise or be interrupted
    finished: queue.SimpleQueue[int] = queue.SimpleQueue()
    futures: dict[int, Future[Any]] = {}
    # the longest first, so that no core is idle at the end
    waiting = sorted(range(len(jobs)), key=lambda index: _cost(jobs[index]))
    with ProcessPool(workers) as pool:

        def start(done: int) -> None:
            index = waiting.pop()
            tell(_progress(jobs[index], "started", done, len(jobs)))
            futures[index] = pool.submit(simulate, jobs[index])
            futures[index].add_done_callback(lambda _: finished.put(index))

        for _ in range(min(workers, len(jobs))):
            start(0)
        for done in range(1, len(jobs) + 1):
            index = finished.get()
            try:
                result = futures.pop(index).result()
            except WorkerDiedError as error:
                result = Crash(str(error))
            keep(index, result)
            tell(_progress(jobs[index], "finished", done, len(jobs)))
            if waiting:
                start(done)


def _progress(job: Job, state: Literal["started", "finished"], done: int, total: int) -> Progress:
    return Progress(case=job.case.name, label=job.label, state=state, done=done, total=total)


def _cost(job: Job) -> float:
    """Rough computing time of a job, [s]."""
    if isinstance(job.method, str):
        return math.inf  # may compile
    step = job.method.time_step or 1e-4
    # the usual search ends at half of the default step
    steps = job.case.length / (2.5e-5 if step == "auto" else step)
    return steps * engine_facts(job.method.engine).step_time


def _cores() -> int:
    if hasattr(os, "sched_getaffinity"):
        return len(os.sched_getaffinity(0))
    return os.cpu_count() or 1
