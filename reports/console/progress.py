"""Progress on standard error: a bar in a terminal, lines elsewhere."""

from __future__ import annotations

import math
import sys
import time
from collections.abc import Iterator
from contextlib import contextmanager
from typing import TYPE_CHECKING

from ..pages.table import number
from .terminal import complain

if TYPE_CHECKING:
    from rockwobble.compare.runs.progress import Progress, ProgressCallback

# up to so many tasks have a line each where there is no terminal
_FEW = 12
_PAUSE = 10.0  # between two lines of more [s]


@contextmanager
def shown_progress(what: str = "runs", *, heading: str = "") -> Iterator[ProgressCallback]:
    """Yield a callback that shows how far tasks are; `what` they are, and what for, in words.

    It names each file of finished tasks that is damaged, once.
    """
    if heading:
        _say(f"{heading} ...")
    named: set[str] = set()
    with _bar(what) if sys.stderr.isatty() else _lines(what) as show:

        def tell(event: Progress) -> None:
            for path in event.damaged:
                if path not in named:
                    named.add(path)
                    complain(f"{path} is damaged, what it held is computed again")
            show(event)

        yield tell


def sentence(event: Progress, what: str = "runs") -> str:
    """Return how far it is, in words."""
    words = f"{event.done:,} of {event.total:,} {what}"
    if event.found:
        words += f" ({event.found:,} of them found finished)"
    if event.done < event.total and math.isfinite(event.left):
        words += f", about {number(event.left, 'duration')} left"
    return words


def _say(words: str) -> None:
    print(words, file=sys.stderr, flush=True)


@contextmanager
def _bar(what: str) -> Iterator[ProgressCallback]:
    from rich.console import Console
    from rich.progress import BarColumn, TextColumn, TimeElapsedColumn
    from rich.progress import Progress as Bars

    columns = (
        BarColumn(),
        TextColumn("{task.fields[far]}"),
        TimeElapsedColumn(),
        # a name may have brackets, which would be markup
        TextColumn("{task.description}", markup=False),
    )
    with Bars(*columns, console=Console(stderr=True), transient=True) as bars:
        task = bars.add_task("", total=None, far="")
        running: dict[str, None] = {}

        def tell(event: Progress) -> None:
            if event.state == "started":
                running[event.label] = None
            else:
                running.pop(event.label, None)
            # of one task that tells how far it is, the share says more than the count
            done = event.share * event.total if event.found == 0 else event.done
            far = sentence(event, what)
            bars.update(
                task, total=event.total, completed=done, far=far, description=next(reversed(running), "")
            )

        yield tell


@contextmanager
def _lines(what: str) -> Iterator[ProgressCallback]:
    begun: dict[str, float] = {}
    last = time.monotonic()

    def tell(event: Progress) -> None:
        nonlocal last
        now = time.monotonic()
        if event.total - event.found <= _FEW:
            if event.state == "started":
                begun[event.label] = now
                _say(f"running {event.label} ...")
            else:
                took = now - begun.get(event.label, now)
                _say(f"  done {event.label} in {took:.1f} s ({event.done} of {event.total})")
        elif now - last >= _PAUSE or (event.state == "finished" and event.done == event.total):
            last = now
            _say(sentence(event, what))

    yield tell
