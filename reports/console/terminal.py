"""How a command ends: exit codes, one clear line for bad input, and a clean stop on Ctrl-C."""

from __future__ import annotations

import sys
from collections.abc import Iterator
from contextlib import contextmanager

import typer

FAILED, BAD_INPUT, INTERRUPTED = 1, 2, 130


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
def interruptible(left: str = "nothing was written") -> Iterator[None]:
    """Turn Ctrl-C into one line, which says what is left behind, and exit code 130."""
    try:
        yield
    except KeyboardInterrupt:
        complain(f"interrupted, {left}")
        raise typer.Exit(INTERRUPTED) from None
