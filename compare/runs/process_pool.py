"""Calls in other processes, behind the interface of `concurrent.futures`.

The pool of the standard library starts its processes by running the caller's main script again, so
a plain script without a main guard would start itself without end; and a process that dies breaks
the whole pool. Here each process runs only `serve`, and one that dies fails only its own call.
"""

from __future__ import annotations

import contextlib
import os
import pickle
import queue
import subprocess
import sys
import tempfile
import threading
import traceback
from collections.abc import Callable
from concurrent.futures import Executor, Future
from typing import Any, BinaryIO, TypeVar

T = TypeVar("T")

_SERVE = "from rockwobble.compare.runs.process_pool import serve; serve()"


class WorkerDiedError(RuntimeError):
    """The process of a call ended before the call did."""


class ProcessPool(Executor):
    """A fixed number of processes, each started with its first call and kept for the next.

    Functions and arguments travel as pickles, so a function must be importable by name. Leaving the
    `with` block by an exception, Ctrl-C included, ends the processes at once.

    Parameters
    ----------
    workers : int
        Number of processes.
    """

    def __init__(self, workers: int) -> None:
        self._calls: queue.SimpleQueue[tuple[Future[Any], Callable[..., Any], Any, Any] | None] = (
            queue.SimpleQueue()
        )
        self._processes: list[subprocess.Popen[bytes]] = []
        self._lock = threading.Lock()
        self._closed = False
        self._cancelled = False
        # daemons: a call that was given up must not hold back the end of the interpreter
        self._threads = [threading.Thread(target=self._work, daemon=True) for _ in range(workers)]
        for thread in self._threads:
            thread.start()

    def submit(self, fn: Callable[..., T], /, *args: Any, **kwargs: Any) -> Future[T]:
        """Queue a call; the future holds what it returns or raises.

        Raises
        ------
        RuntimeError
            If the pool was shut down.
        """
        if self._closed:
            raise RuntimeError("calls cannot be submitted after shutdown")
        future: Future[T] = Future()
        self._calls.put((future, fn, args, kwargs))
        return future

    def shutdown(self, wait: bool = True, *, cancel_futures: bool = False) -> None:
        """End the processes: after the last call, or at once with `cancel_futures`."""
        with self._lock:
            self._closed = True
            if cancel_futures:
                self._cancelled = True
                with contextlib.suppress(queue.Empty):
                    while call := self._calls.get_nowait():
                        call[0].cancel()
                for process in self._processes:
                    process.kill()
        for _ in self._threads:
            self._calls.put(None)
        if wait:
            for thread in self._threads:
                thread.join()

    def __exit__(self, kind: object, *_: object) -> None:
        """Wait for the calls, unless an exception passes through."""
        self.shutdown(cancel_futures=kind is not None)

    def _work(self) -> None:
        worker: _Worker | None = None
        try:
            while call := self._calls.get():
                future, function, args, kwargs = call
                if not future.set_running_or_notify_cancel():
                    continue
                try:
                    if worker is None:
                        worker = self._start()
                    future.set_result(worker.call(function, args, kwargs))
                except WorkerDiedError as error:
                    worker = None
                    future.set_exception(error)
                except BaseException as error:  # what the call raised, whatever it is, belongs to its future
                    future.set_exception(error)
        finally:
            if worker is not None:
                worker.close()

    def _start(self) -> _Worker:
        with self._lock:
            if self._cancelled:
                raise WorkerDiedError("the pool was shut down")
            worker = _Worker()
            self._processes.append(worker.process)
            return worker


class _Worker:
    """One process, and what it is told and tells."""

    def __init__(self) -> None:
        # engines drop log files where they run, and write to the standard output
        self._folder = tempfile.TemporaryDirectory(prefix="rockwobble-")
        self._log = tempfile.TemporaryFile()  # noqa: SIM115 (closed with the process)
        self.process = subprocess.Popen(
            [sys.executable, "-c", _SERVE],
            stdin=subprocess.PIPE,
            stdout=subprocess.PIPE,
            stderr=self._log,
            cwd=self._folder.name,
            start_new_session=True,  # Ctrl-C reaches the caller, and the caller ends this one
        )

    def call(self, function: Callable[..., Any], args: Any, kwargs: Any) -> Any:
        """Return or raise what the function does there."""
        message = pickle.dumps((function, args, kwargs))
        stdin, stdout = self.process.stdin, self.process.stdout
        assert stdin is not None
        assert stdout is not None
        try:
            stdin.write(message)
            stdin.flush()
            succeeded, value = pickle.load(stdout)
        except (OSError, EOFError, pickle.UnpicklingError):
            status = self.process.wait()
            last = self._last_words()
            self.close()
            raise WorkerDiedError(f"the process ended with status {status}" + last) from None
        if not succeeded:
            raise value
        return value

    def close(self) -> None:
        """End the process."""
        for stream in (self.process.stdin, self.process.stdout):
            if stream is not None:
                with contextlib.suppress(OSError):
                    stream.close()
        self.process.wait()
        self._log.close()
        self._folder.cleanup()

    def _last_words(self) -> str:
        self._log.seek(0)
        lines = self._log.read().decode(errors="replace").split("\n")
        words = next((line.strip() for line in reversed(lines) if line.strip()), "")
        return f": {words}" if words else ""


def serve() -> None:
    """Answer calls from the standard input until it closes; the body of a worker process."""
    answers = os.fdopen(os.dup(1), "wb")
    os.dup2(2, 1)  # what an engine prints must not mix with the answers
    calls: queue.SimpleQueue[tuple[Callable[..., Any], Any, Any]] = queue.SimpleQueue()
    threading.Thread(target=_listen, args=(sys.stdin.buffer, calls), daemon=True).start()
    while True:
        function, args, kwargs = calls.get()
        try:
            answer = pickle.dumps((True, function(*args, **kwargs)))
        except Exception as error:
            answer = _failure(error)
        answers.write(answer)
        answers.flush()


def _failure(error: Exception) -> bytes:
    error.add_note(traceback.format_exc())  # the traceback itself does not travel
    try:
        pickle.loads(answer := pickle.dumps((False, error)))
    except Exception:  # an exception class whose arguments do not make it again
        return pickle.dumps((False, RuntimeError(f"{type(error).__name__}: {error}")))
    return answer


def _listen(stdin: BinaryIO, calls: queue.SimpleQueue[Any]) -> None:
    """Pass calls on, and end the process when the caller is gone, even in the middle of a call."""
    try:
        while True:
            calls.put(pickle.load(stdin))
    except EOFError:
        os._exit(0)
    except BaseException:  # such as a function that cannot be imported here: nobody would ever answer
        traceback.print_exc()
        sys.stderr.flush()
        os._exit(1)
