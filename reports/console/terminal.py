"""A command as it was typed, and how it ends: exit codes, a line for bad input, Ctrl-C, a lost terminal."""

from __future__ import annotations

import codecs
import io
import os
import shlex
import sys
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import TYPE_CHECKING, TextIO

import typer

import rockwobble.compare as rc

if TYPE_CHECKING:
    from _typeshed import ReadableBuffer

FAILED, BAD_INPUT, INTERRUPTED = 1, 2, 130
# what is printed where the encoding has no such character
_PLAIN = {
    **{
        "α": "alpha",
        "π": "pi",
        "√": "sqrt",
        "±": "+-",
        "×": "x",
        "°": " deg",
        "−": "-",
        "–": "-",
        "…": "...",
    },
    **{"▲": "^", "✓": "ok", "\u00a0": " ", "é": "e"},
    **dict(zip("⁻⁰¹²³⁴⁵⁶⁷⁸⁹", "-0123456789", strict=True)),
}


def command_line() -> str:
    """Return the command that runs, as it would be typed."""
    return shlex.join(["rockwobble", *sys.argv[1:]])


def complain(message: str) -> None:
    """Print one line on standard error."""
    print(f"rockwobble: {' '.join(message.split())}", file=sys.stderr)


@contextmanager
def user_input() -> Iterator[None]:
    """Turn a ValueError, which is what bad input raises, into one line and exit code 2.

    Only what depends on the user's input belongs in the block: a ValueError elsewhere is a defect
    and keeps its traceback.
    """
    try:
        yield
    except ValueError as error:
        complain(str(error))
        raise typer.Exit(BAD_INPUT) from None


@contextmanager
def interruptible(kept: Path | None = None) -> Iterator[None]:
    """Turn Ctrl-C into one line and exit code 130, and tasks that cannot be finished into one and code 1.

    `kept` is the folder of runs that need no repetition.
    """
    try:
        yield
    except rc.IncompleteError as error:
        complain(str(error))
        raise typer.Exit(FAILED) from None
    except KeyboardInterrupt:
        if kept is not None and kept.is_dir():
            complain(f"interrupted, the finished runs are kept in {kept}, and the same command goes on")
        else:
            complain("interrupted, nothing was written")
        raise typer.Exit(INTERRUPTED) from None


def forgive_output() -> None:
    """Let no output stop a command: results outlive a closed pipe, a full device and a poor encoding."""
    codecs.register_error("rockwobble", _plain)
    _open_standard_files()
    sys.stdout, sys.stderr = _forgiving(sys.stdout, "standard output"), _forgiving(sys.stderr, "")


def _open_standard_files() -> None:
    """Put the null device in the place of standard files that are closed: a later file would take theirs."""
    for descriptor in range(3):
        try:
            os.fstat(descriptor)
        except OSError:
            os.dup2(os.open(os.devnull, os.O_RDWR), descriptor)


def _forgiving(stream: TextIO | None, name: str) -> TextIO:
    if stream is None:  # closed when Python started
        return Path(os.devnull).open("w", encoding="utf-8")
    if not isinstance(stream, io.TextIOWrapper):
        return stream
    if stream.isatty():
        stream.reconfigure(errors="rockwobble")
        return stream
    try:
        raw = _Forgiving(stream.fileno(), "w", closefd=False)
    except OSError:  # in memory, as in a test
        return stream
    raw.said = name
    return io.TextIOWrapper(
        io.BufferedWriter(raw), encoding=stream.encoding, errors="rockwobble", line_buffering=True
    )


class _Forgiving(io.FileIO):
    """A file that says once that it cannot be written, and then takes everything."""

    said = ""

    def write(self, data: ReadableBuffer, /) -> int:
        try:
            return super().write(data)
        except BrokenPipeError:
            pass  # whoever read it has seen enough
        except OSError as error:
            if self.said:
                complain(f"{self.said} cannot be written: {error.strerror}")
                self.said = ""
        return memoryview(data).nbytes


def _plain(error: UnicodeError) -> tuple[str, int]:
    if not isinstance(error, UnicodeEncodeError):
        raise error
    wanting = error.object[error.start : error.end]
    return "".join(_PLAIN.get(character, "?") for character in wanting), error.end
