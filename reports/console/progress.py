"""What is running, on standard error."""

from __future__ import annotations

import sys
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from rich.progress import TaskID

    from rockwobble.compare import Progress

Tell = Callable[["Progress"], None]

_COMPILES = ("recess model", "flat-ground model", "planar model")


@contextmanager
def shown_progress(*, many: bool = False) -> Iterator[Tell]:
    """Yield a callback that shows the runs: as moving lines in a terminal, as plain lines elsewhere.

    Of `many` cases the runs are named with their case, and one bar says how far they are.
    """
    if sys.stderr.isatty():
        with _one_bar() if many else _moving() as tell:
            yield tell
    else:
        with _plain(many=many) as tell:
            yield tell


def _name(label: str) -> str:
    return f"{label} (compiled on its first run)" if label in _COMPILES else label


@contextmanager
def _moving() -> Iterator[Tell]:
    from rich.console import Console
    from rich.progress import Progress as Bars
    from rich.progress import SpinnerColumn, TextColumn, TimeElapsedColumn

    columns = (SpinnerColumn(finished_text="[green]✓"), TextColumn("{task.description}"), TimeElapsedColumn())
    with Bars(*columns, console=Console(stderr=True), transient=True) as bars:
        tasks: dict[tuple[str, str], TaskID] = {}

        def tell(event: Progress) -> None:
            run = (event.case, event.label)
            if event.state == "started":
                tasks[run] = bars.add_task(_name(event.label), total=1)
            else:
                bars.update(
                    tasks[run], completed=1, description=f"{_name(event.label)}  {event.done}/{event.total}"
                )

        yield tell


@contextmanager
def _one_bar() -> Iterator[Tell]:
    from rich.console import Console
    from rich.progress import (
        BarColumn,
        MofNCompleteColumn,
        TextColumn,
        TimeElapsedColumn,
        TimeRemainingColumn,
    )
    from rich.progress import Progress as Bars

    columns = (
        BarColumn(),
        MofNCompleteColumn(),
        TimeElapsedColumn(),
        TextColumn("left"),
        TimeRemainingColumn(),
        # a name may have brackets, which would be markup
        TextColumn("{task.description}", markup=False),
    )
    with Bars(*columns, console=Console(stderr=True), transient=True) as bars:
        running: dict[tuple[str, str], str] = {}
        task = bars.add_task("", total=None)

        def tell(event: Progress) -> None:
            run = (event.case, event.label)
            if event.state == "started":
                running[run] = f"{event.case}, {event.label}"
            else:
                running.pop(run, None)
            last = next(reversed(running.values()), "")
            bars.update(task, completed=event.done, total=event.total, description=last)

        yield tell


@contextmanager
def _plain(*, many: bool) -> Iterator[Tell]:
    begun: dict[tuple[str, str], float] = {}

    def tell(event: Progress) -> None:
        run = (event.case, event.label)
        place = f"{event.case}, " if many else ""
        if event.state == "started":
            begun[run] = time.monotonic()
            print(f"running {place}{_name(event.label)} ...", file=sys.stderr, flush=True)
        else:
            took = time.monotonic() - begun[run]
            print(
                f"  done {place}{event.label} in {took:.1f} s ({event.done} of {event.total})",
                file=sys.stderr,
                flush=True,
            )

    yield tell
