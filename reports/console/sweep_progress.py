"""How far a sweep is and how long it will take, on standard error."""

from __future__ import annotations

import math
import sys
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from rockwobble.compare import SweepProgress

Tell = Callable[["SweepProgress"], None]

# between two lines where there is no terminal to draw a bar in [s]
_PAUSE = 10.0


@contextmanager
def shown_sweep() -> Iterator[Tell]:
    """Yield a callback that shows the progress: a bar in a terminal, a line now and then elsewhere."""
    with _bar() if sys.stderr.isatty() else _lines() as tell:
        yield tell


@contextmanager
def _bar() -> Iterator[Tell]:
    from rich.console import Console
    from rich.progress import BarColumn, Progress, TextColumn, TimeElapsedColumn

    columns = (BarColumn(), TextColumn("{task.description}"), TimeElapsedColumn(), TextColumn("so far"))
    with Progress(*columns, console=Console(stderr=True), transient=True) as bars:
        task = bars.add_task("starting", total=None)

        def tell(event: SweepProgress) -> None:
            bars.update(task, total=event.total, completed=event.done, description=sentence(event))

        yield tell


@contextmanager
def _lines() -> Iterator[Tell]:
    last = -math.inf

    def tell(event: SweepProgress) -> None:
        nonlocal last
        now = time.monotonic()
        if now - last >= _PAUSE or event.done == event.total:
            last = now
            print(sentence(event), file=sys.stderr, flush=True)

    yield tell


def sentence(event: SweepProgress) -> str:
    """Return the progress in words."""
    words = f"{event.done:,} of {event.total:,} runs"
    if event.found:
        words += f" ({event.found:,} of them found finished)"
    if event.done < event.total and math.isfinite(event.left):
        words += f", about {_duration(event.left)} left"
    return words


def _duration(seconds: float) -> str:
    if seconds < 90.0:
        return f"{seconds:.0f} s"
    if seconds < 5400.0:
        return f"{seconds / 60.0:.0f} min"
    return f"{seconds / 3600.0:.1f} h"
