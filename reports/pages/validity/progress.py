"""How far the measurements are, and the time left, on standard error."""

from __future__ import annotations

import sys
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from rockwobble.compare.studies.validity import CampaignProgress

Tell = Callable[["CampaignProgress"], None]

# between two lines where there is no terminal to draw a bar in [s]
_PAUSE = 10.0


@contextmanager
def shown_campaign() -> Iterator[Tell]:
    """Yield a callback that shows a campaign: a bar in a terminal, a line now and then elsewhere."""
    with _bar() if sys.stderr.isatty() else _lines() as tell:
        yield tell


@contextmanager
def _bar() -> Iterator[Tell]:
    from rich.console import Console
    from rich.progress import BarColumn, Progress, TaskProgressColumn, TextColumn, TimeRemainingColumn

    columns = (
        BarColumn(),
        TaskProgressColumn(),
        TimeRemainingColumn(),
        TextColumn("left  {task.description}"),
    )
    with Progress(
        *columns, console=Console(stderr=True), transient=True, speed_estimate_period=600.0
    ) as bars:
        task = bars.add_task("", total=1.0)

        def tell(event: CampaignProgress) -> None:
            bars.update(task, completed=event.share, description=event.title)

        yield tell


@contextmanager
def _lines() -> Iterator[Tell]:
    begun = last = time.monotonic()

    def tell(event: CampaignProgress) -> None:
        nonlocal last
        now = time.monotonic()
        if event.done == event.found and event.found and event.total:
            print(f"{event.found} of {event.total} tasks found, measured before", file=sys.stderr, flush=True)
        if 0.0 < event.share < 1.0 and now - last >= _PAUSE:
            last = now
            left = (now - begun) * (1.0 / event.share - 1.0)
            print(
                f"{event.title}: {100.0 * event.share:.0f} % done, about {left:.0f} s left",
                file=sys.stderr,
                flush=True,
            )

    yield tell
