"""Parallel tasks: in this process, in others, or on the workers of a Dask scheduler.

The processes of the standard library start by running the caller's main script again, so a plain script
without a main guard would start itself without end; and one that dies breaks a whole pool. A `Worker` runs
only `serve`, and if it dies only its own call fails.
"""

from __future__ import annotations

import contextlib
import gc
import importlib
import logging
import math
import os
import pickle
import platform
import queue
import re
import subprocess
import sys
import tempfile
import threading
import time
import traceback
from collections import Counter
from collections.abc import Callable, Iterator, Mapping, Sequence
from concurrent.futures import FIRST_COMPLETED, CancelledError, Future, ThreadPoolExecutor, wait
from contextlib import contextmanager
from functools import partial
from typing import Any, BinaryIO, TypeVar

from rockwobble.models.cpus import usable_cpus

from ..storage.provenance import reduced_makers
from .cache import Cache
from .progress import Clock, FailedTask, ProgressCallback

T = TypeVar("T")
R = TypeVar("R")
Call = tuple[Callable[..., object], tuple[object, ...]]
_LOOK = 0.5  # time between two checks of the running tasks [s]
_SERVE = "from rockwobble.compare.runs.scheduler import serve; serve()"


# submit function, number of calls at a time, and the exception of a call whose process died
Backend = tuple[Callable[..., Future[Any]], Callable[[], int], tuple[type[BaseException], ...]]
# seconds to wait for the scheduler: a machine that is there answers in a fraction of one
_PATIENCE = 15.0
# tasks submitted for each worker, so that none waits
_AHEAD = 2


class ClusterError(RuntimeError):
    """Error of a scheduler that is gone, or without suitable workers; finished tasks stay stored."""


class WorkerDiedError(RuntimeError):
    """Error of a call whose process ended before it did."""


class Worker:
    """One process, with the pipes to and from it.

    Functions and arguments travel as pickles, so a function must be importable by name.
    """

    def __init__(self) -> None:
        # engines write log files to the working folder, and text to the standard output
        self._folder = tempfile.TemporaryDirectory(prefix="rockwobble-")
        self._log = tempfile.TemporaryFile()  # noqa: SIM115 (closed with the process)
        self._process = subprocess.Popen(
            [sys.executable, "-c", _SERVE],
            stdin=subprocess.PIPE,
            stdout=subprocess.PIPE,
            stderr=self._log,
            cwd=self._folder.name,
            start_new_session=True,  # Ctrl-C reaches the caller, which ends this process
        )

    def call(self, function: Callable[..., T], *arguments: object) -> T:
        """Result or exception of the function, called in the process.

        Raises
        ------
        WorkerDiedError
            If the process ended: it cannot be called again.
        """
        message = pickle.dumps((function, arguments))
        stdin, stdout = self._process.stdin, self._process.stdout
        assert stdin is not None
        assert stdout is not None
        try:
            stdin.write(message)
            stdin.flush()
            succeeded, value = pickle.load(stdout)
        except (OSError, EOFError, ValueError, pickle.UnpicklingError):
            status = self._process.wait()
            last = self._last_words()
            self.close()
            raise WorkerDiedError(f"the process ended with status {status}" + last) from None
        if not succeeded:
            raise value
        result: T = value
        return result

    def kill(self) -> None:
        """End the process at once; a call under way fails."""
        self._process.kill()

    def close(self) -> None:
        """End the process."""
        for stream in (self._process.stdin, self._process.stdout):
            if stream is not None:
                with contextlib.suppress(OSError):
                    stream.close()
        self._process.wait()
        self._log.close()
        self._folder.cleanup()

    def _last_words(self) -> str:
        self._log.seek(0)
        lines = self._log.read().decode(errors="replace").split("\n")
        words = next((line.strip() for line in reversed(lines) if line.strip()), "")
        return f": {words}" if words else ""


def serve() -> None:
    """Body of the process: answer calls from the standard input until it closes."""
    gc.set_threshold(500_000)  # as in the command itself
    answers = os.fdopen(os.dup(1), "wb")
    os.dup2(2, 1)  # output of an engine must not mix with the answers
    calls: queue.SimpleQueue[Call] = queue.SimpleQueue()
    threading.Thread(target=_listen, args=(sys.stdin.buffer, calls), daemon=True).start()
    while True:
        function, arguments = calls.get()
        try:
            answer = pickle.dumps((True, function(*arguments)))
        except Exception as error:
            answer = _failure(error)
        answers.write(answer)
        answers.flush()


def _failure(error: Exception) -> bytes:
    error.add_note(traceback.format_exc())  # a traceback cannot be pickled
    try:
        pickle.loads(answer := pickle.dumps((False, error)))
    except Exception:  # an exception class that cannot be rebuilt from its arguments
        return pickle.dumps((False, RuntimeError(f"{type(error).__name__}: {error}")))
    return answer


def _listen(stdin: BinaryIO, calls: queue.SimpleQueue[Call]) -> None:
    """Pass calls on, and end the process when the caller is gone, even in the middle of a call."""
    try:
        while True:
            calls.put(pickle.load(stdin))
    except EOFError:
        os._exit(0)
    except BaseException:  # such as a function that cannot be imported here: the caller would wait for ever
        traceback.print_exc()
        sys.stderr.flush()
        os._exit(1)


def run_tasks(
    function: Callable[[T], R],
    tasks: Sequence[T],
    *,
    workers: int | None = None,
    scheduler: str | None = None,
    cost: Callable[[T], float] | None = None,
    label: Callable[[T], str] = str,
    progress: ProgressCallback | None = None,
    cache: Cache[T, R] | None = None,
    tries: int = 1,
    makers: Callable[[], Mapping[str, str]] = reduced_makers,
    here: Callable[[T], bool] = lambda task: False,
) -> list[R | FailedTask]:
    """Results of a function for each task, in the order of the tasks.

    Parameters
    ----------
    function : callable
        Importable by name, and depending on nothing but its task.
    tasks : sequence
        Picklable.
    workers : int, optional
        Processes, of which no more than tasks are started; 1 runs one task after the other in this one.
        Default: one for each processor that this process may use, and this one for a single task.
    scheduler : str, optional
        Address of a Dask scheduler, such as `tcp://10.0.0.1:8786`; then `workers` has no part in it.
    cost : callable, optional
        Rough computing time of a task in any unit, by which the longest begin first; infinite: before all, of
        unknown length. Default: all alike, in their order.
    label : callable, optional
        Name of a task, for the progress callback.
    progress : callable, optional
        Told in this thread of the start and the end of each task that runs.
    cache : Cache, optional
        A task found there does not run again, and one that runs is kept there at its end.
    tries : int, optional
        How often a task begins whose process dies: it may have been ended from outside.
    makers : callable, optional
        Versions and code that results depend on, as they are where it is called: workers of another machine
        must have the same.
    here : callable, optional
        Whether a task is run in this process while others run elsewhere: one of milliseconds, for which no
        process need be started or taught.

    Returns
    -------
    list
        `FailedTask` for a task whose process died.

    Raises
    ------
    ValueError
        If there is no such scheduler; and what a task raises, whatever it is: the others are given up.

    Examples
    --------
    >>> run_tasks(abs, [-1, 2, -3], workers=1)
    [1, 2, 3]
    """
    results: dict[int, R | FailedTask] = {}
    if cache is not None:
        cache.expect(len(tasks))
        finished = {index: cache.find(task) for index, task in enumerate(tasks)}
        results |= {index: result for index, result in finished.items() if result is not None}
    costs = [1.0 if cost is None else cost(task) for task in tasks]
    waiting = [index for index in reversed(range(len(tasks))) if index not in results]
    waiting.sort(key=lambda index: costs[index])  # the longest are taken first, from the end
    known = {index: costs[index] if math.isfinite(costs[index]) else 0.0 for index in waiting}
    damaged = [] if cache is None else [str(path) for path in cache.damaged]
    tell = Clock(progress, list(known.values()), len(results), damaged)
    # a given number of processes holds even for one task: a process can be ended during a long call
    count = min(usable_cpus(), len(waiting)) if workers is None else workers
    brief = [index for index in waiting if count > 1 and scheduler is None and here(tasks[index])]
    waiting = [index for index in waiting if index not in brief]
    tried: Counter[int] = Counter()
    running: dict[Future[R], int] = {}

    def begin(index: int, submit: Callable[..., Future[R]]) -> None:
        if not tried[index]:
            tell("started", label(tasks[index]))
        tried[index] += 1
        running[submit(function, tasks[index])] = index

    if scheduler is not None:
        backend = on_cluster(scheduler, makers)
    else:
        backend = _in_processes(max(1, min(count, len(waiting)))) if count > 1 else _here()
    with backend as (submit, capacity, losses):
        while waiting or running or brief:
            for _ in range(min(len(waiting), capacity() - len(running))):
                begin(waiting.pop(), submit)
            if brief:
                begin(brief.pop(), _call_here)
            for future in wait(running, timeout=_LOOK, return_when=FIRST_COMPLETED).done:
                index = running.pop(future)
                try:
                    results[index] = result = future.result()
                except losses as error:
                    if tried[index] < tries:
                        waiting.append(index)
                        continue
                    results[index] = FailedTask(str(error).partition("\n")[0] or type(error).__name__)
                else:
                    if cache is not None:
                        cache.keep(tasks[index], result)
                tell("finished", label(tasks[index]), known[index])
    return [results[index] for index in range(len(tasks))]


def _call_here(function: Callable[[T], R], task: T) -> Future[R]:
    done: Future[R] = Future()
    done.set_result(function(task))
    return done


@contextmanager
def _here() -> Iterator[Backend]:
    yield _call_here, lambda: 1, ()


@contextmanager
def _in_processes(count: int) -> Iterator[Backend]:
    """Threads, each of which has its calls made by a process of its own."""
    own, opened = threading.local(), list[Worker]()
    lock, stopped = threading.Lock(), threading.Event()

    def call(function: Callable[..., object], task: object) -> object:
        if not hasattr(own, "worker"):
            with lock:
                if stopped.is_set():
                    raise WorkerDiedError("the tasks were given up")
                own.worker = Worker()
                opened.append(own.worker)
        worker: Worker = own.worker
        try:
            return worker.call(function, task)
        except WorkerDiedError:
            del own.worker
            raise

    pool = ThreadPoolExecutor(count)
    try:
        yield lambda *task: pool.submit(call, *task), lambda: count, (WorkerDiedError,)
    except BaseException:  # on an error or Ctrl-C: no process outlives its tasks
        with lock:
            stopped.set()
            for worker in opened:
                worker.kill()
        raise
    finally:
        pool.shutdown(cancel_futures=True)
        for worker in opened:
            worker.close()


@contextmanager
def on_cluster(address: str, makers: Callable[[], Mapping[str, str]]) -> Iterator[Backend]:
    """Open a Dask scheduler whose workers have the code and versions of the caller; see `run_tasks`."""
    if re.fullmatch(r"\w+://\S+", address) is None:
        raise ValueError(f"a Dask scheduler has an address such as tcp://10.0.0.1:8786, got {address!r}")
    try:
        distributed = importlib.import_module("distributed")
    except ImportError:
        raise ValueError("--scheduler needs Dask: pip install 'dask[distributed]'") from None
    # the client logs each failed and lost connection; one clear line follows
    for name in ("distributed.comm", "distributed.client"):
        logging.getLogger(name).setLevel(logging.CRITICAL)
    try:
        client = distributed.Client(address, timeout=_PATIENCE, set_as_default=False)
    except (OSError, ValueError) as error:
        why = str(error).partition("\n")[0]
        raise ValueError(f"no Dask scheduler answers at {address!r}: {why}") from None
    seen = time.monotonic()

    def capacity() -> int:
        nonlocal seen
        try:
            threads: int = sum(client.nthreads().values())
        except (OSError, ValueError, RuntimeError) as error:  # raised by a client without a scheduler
            raise ClusterError(f"the Dask scheduler at {address} does not answer any more: {error}") from None
        seen = time.monotonic() if threads else seen
        if time.monotonic() - seen > _PATIENCE:
            raise ClusterError(
                f"the Dask scheduler at {address} has had no worker for {_PATIENCE:g} s: start one by "
                f"dask worker {address}"
            )
        return max(1, _AHEAD * threads)

    completed = False
    executor = client.get_executor(pure=False)
    try:
        submit = partial(executor.submit, _with_the_same_code, dict(makers()), makers)
        yield submit, capacity, (distributed.KilledWorker, CancelledError)
        completed = True
    finally:
        executor.shutdown(wait=completed)
        client.close()


def _with_the_same_code(
    expected: Mapping[str, str], makers: Callable[[], Mapping[str, str]], function: Callable[[T], R], task: T
) -> R:
    """Run a task on a worker that has the same code; else the result would be stored under a wrong hash."""
    here = makers()
    for name, value in expected.items():
        if here.get(name) != value:
            raise ClusterError(
                f"a worker on {platform.node()} must have what the caller has: {name} is "
                f"{here.get(name)} there and {value} here"
            )
    return function(task)
