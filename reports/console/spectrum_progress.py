"""How far a grid of runs is, and the time left, on standard error."""

from __future__ import annotations

import sys
import time
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager

Tell = Callable[[str, float], None]

# between two lines where there is no terminal to draw a bar in [s]
_PAUSE = 10.0


@contextmanager
def shown_fraction(stages: Sequence[str]) -> Iterator[Tell]:
    """Yield a callback for the stage at work and the fraction of it done; `stages` come in this order."""
    with _bar(stages) if sys.stderr.isatty() else _lines(stages) as tell:
        yield tell


@contextmanager
def _bar(stages: Sequence[str]) -> Iterator[Tell]:
    from rich.console import Console
    from rich.progress import BarColumn, Progress, TaskProgressColumn, TextColumn, TimeRemainingColumn

    columns = (
        TextColumn("{task.description}"),
        BarColumn(),
        TaskProgressColumn(),
        TimeRemainingColumn(),
        TextColumn("left"),
    )
    # sizes differ in cost: an average over many of them predicts the rest better than the last few
    with Progress(
        *columns, console=Console(stderr=True), transient=True, speed_estimate_period=600.0
    ) as bars:
        task = bars.add_task(stages[0], total=len(stages))

        def tell(stage: str, fraction: float) -> None:
            bars.update(task, description=stage, completed=stages.index(stage) + fraction)

        yield tell


@contextmanager
def _lines(stages: Sequence[str]) -> Iterator[Tell]:
    begun = last = time.monotonic()

    def tell(stage: str, fraction: float) -> None:
        nonlocal last
        now = time.monotonic()
        done = (stages.index(stage) + fraction) / len(stages)
        if now - last >= _PAUSE or done >= 1.0:
            last = now
            left = (now - begun) * (1.0 / done - 1.0)
            print(f"{stage}: {100.0 * done:.0f} % done, about {left:.0f} s left", file=sys.stderr, flush=True)

    yield tell
