"""Another process that answers calls, one after the other.

The processes of the standard library start by running the caller's main script again, so a plain script
without a main guard would start itself without end; and one that dies breaks a whole pool. This one runs only
`serve`, and if it dies only its own call fails.
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
from typing import BinaryIO, TypeVar

T = TypeVar("T")
Call = tuple[Callable[..., object], tuple[object, ...]]
_SERVE = "from rockwobble.compare.runs.worker import serve; serve()"


class WorkerDiedError(RuntimeError):
    """The process of a call ended before the call did."""


class Worker:
    """One process, and what it is told and tells.

    Functions and arguments travel as pickles, so a function must be importable by name.
    """

    def __init__(self) -> None:
        # engines drop log files where they run, and write to the standard output
        self._folder = tempfile.TemporaryDirectory(prefix="rockwobble-")
        self._log = tempfile.TemporaryFile()  # noqa: SIM115 (closed with the process)
        self._process = subprocess.Popen(
            [sys.executable, "-c", _SERVE],
            stdin=subprocess.PIPE,
            stdout=subprocess.PIPE,
            stderr=self._log,
            cwd=self._folder.name,
            start_new_session=True,  # Ctrl-C reaches the caller, and the caller ends this one
        )

    def call(self, function: Callable[..., T], *arguments: object) -> T:
        """Return or raise what the function does there.

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
        """End the process at once, whatever it does; a call under way fails."""
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
    """Answer calls from the standard input until it closes; the body of the process."""
    answers = os.fdopen(os.dup(1), "wb")
    os.dup2(2, 1)  # what an engine prints must not mix with the answers
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
    error.add_note(traceback.format_exc())  # the traceback itself does not travel
    try:
        pickle.loads(answer := pickle.dumps((False, error)))
    except Exception:  # an exception class whose arguments do not make it again
        return pickle.dumps((False, RuntimeError(f"{type(error).__name__}: {error}")))
    return answer


def _listen(stdin: BinaryIO, calls: queue.SimpleQueue[Call]) -> None:
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
