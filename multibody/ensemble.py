"""Many runs of one engine on all cores, each the same bit for bit as a run of its own.

MuJoCo's rollouts leave the interpreter free while they step, so runs go side by side in threads of this
process: nothing is copied, nothing is started, and each run keeps its own scene, guard and outcome. An
engine says that its runs may do so by a member `together`. Bullet steps in a loop of Python and keeps one
table of clients for a process, so its runs go one after the other here; run such cases in processes.

Whatever the sizes, cases of one tan(alpha) are one scene to the engine, by Froude scaling.
"""

from __future__ import annotations

import queue
import threading
from collections.abc import Callable, Sequence
from concurrent.futures import Future, ThreadPoolExecutor
from contextlib import AbstractContextManager
from typing import Any

from rockwobble.models import Case, Trace
from rockwobble.models.case import TimeStep
from rockwobble.models.cpus import usable_cpus

from .engines.registry import DEFAULT_ENGINE, find_engine
from .simulation import simulate
from .stepping import Progress

_Run = Callable[[Case, Progress], Trace]
_Together = Callable[[], AbstractContextManager[None]]


class _StoppedError(Exception):
    """Ends a run that nobody waits for any more."""


def simulate_many(
    cases: Sequence[Case],
    *,
    engine: str = DEFAULT_ENGINE,
    support: str = "recess",
    time_step: TimeStep = None,
    sample_step: float = 0.01,
    progress: Progress | None = None,
    workers: int | None = None,
    **settings: Any,
) -> list[Trace]:
    """Run many cases in one engine with one support and the same settings.

    Parameters
    ----------
    cases : sequence of Case
        Any mixture of cylinders, motions and initial states; friction and gravity are those of each case.
    engine, support, time_step, sample_step, **settings
        As for `simulate`. Without a time step each size gets its own default.
    progress : callable, optional
        Called in this thread with the fraction done of all runs.
    workers : int, optional
        Number of runs side by side in an engine that allows it. Default: one for each core.

    Returns
    -------
    list of Trace
        In the order of the cases, each equal to that of `simulate` but for its wall time. A run that
        fails is an outcome and leaves the others alone.

    Raises
    ------
    ValueError
        What `simulate` raises, with the name of the case before it; the other runs are given up, within
        some ten thousand steps, as they are on Ctrl-C.

    Examples
    --------
    >>> from rockwobble.models import Case, Cylinder, InitialState
    >>> pier = Cylinder(semidiagonal=6.0, tan_alpha=0.2)
    >>> starts = [InitialState(share * pier.alpha, rolling_rate=0.3) for share in (0.2, 0.4, 0.6)]
    >>> cases = [Case(pier, initial=start, duration=1.0, name=f"start {n}") for n, start in enumerate(starts)]
    >>> [run.outcome for run in simulate_many(cases)]
    ['stands', 'stands', 'stands']
    """
    if workers is not None and (type(workers) is not int or workers < 1):
        raise ValueError(f"workers must be a positive whole number, got {workers!r}")
    together: _Together | None = getattr(find_engine(engine), "together", None)

    def run(case: Case, report: Progress) -> Trace:
        try:
            return simulate(
                case,
                engine=engine,
                support=support,
                time_step=time_step,
                sample_step=sample_step,
                progress=report,
                **settings,
            )
        except ValueError as error:
            raise ValueError(f"{case.name}: {error}") from error

    count = min(usable_cpus() if workers is None else workers, len(cases))
    tally = _Tally(cases, progress)
    if together is None or count < 2:
        return [run(case, lambda done, at=at: tally(at, done)) for at, case in enumerate(cases)]  # type: ignore[misc]
    with together():
        return _side_by_side(cases, run, tally, count)


class _Tally:
    """Fraction done of all runs; each counts by its length in the time of its own fall."""

    def __init__(self, cases: Sequence[Case], progress: Progress | None) -> None:
        self.shares = [case.length * (case.gravity / case.cylinder.semidiagonal) ** 0.5 for case in cases]
        self._done = [0.0] * len(cases)
        self._progress = progress

    def __call__(self, index: int, done: float) -> None:
        self._done[index] = done
        if self._progress is not None:
            finished = sum(share * part for share, part in zip(self.shares, self._done, strict=True))
            self._progress(finished / sum(self.shares))


def _side_by_side(cases: Sequence[Case], run: _Run, tally: _Tally, count: int) -> list[Trace]:
    reports: queue.SimpleQueue[tuple[int, float | None]] = queue.SimpleQueue()
    stop = threading.Event()

    def tell(index: int, done: float) -> None:
        if stop.is_set():
            raise _StoppedError
        reports.put((index, done))

    def one(index: int) -> Trace:
        try:
            tell(index, 0.0)
            return run(cases[index], lambda done: tell(index, done))
        finally:
            reports.put((index, None))

    futures: dict[int, Future[Trace]] = {}
    with ThreadPoolExecutor(count) as pool:
        try:
            # the longest first, so that no core is idle at the end
            for index in sorted(range(len(cases)), key=lambda index: -tally.shares[index]):
                futures[index] = pool.submit(one, index)
            left = len(cases)
            while left:
                index, done = reports.get()
                if done is not None:
                    tally(index, done)
                    continue
                futures[index].result()  # raises what the run raised
                left -= 1
        finally:
            # where a run or the caller's progress raised, or on Ctrl-C: the pool waits for its threads
            stop.set()
            pool.shutdown(wait=False, cancel_futures=True)
    return [futures[index].result() for index in range(len(cases))]
