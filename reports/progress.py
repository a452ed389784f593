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

_COMPILES = ("recess", "rolling", "planar")


@contextmanager
def shown_progress() -> Iterator[Tell]:
    """Yield a callback that shows the runs: as moving lines in a terminal, as plain lines elsewhere."""
    with _moving() if sys.stderr.isatty() else _plain() as tell:
        yield tell


def _name(label: str) -> str:
    return f"{label} model (compiled on its first run)" if label in _COMPILES else label


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
def _plain() -> Iterator[Tell]:
    begun: dict[tuple[str, str], float] = {}

    def tell(event: Progress) -> None:
        run = (event.case, event.label)
        if event.state == "started":
            begun[run] = time.monotonic()
            print(f"running {_name(event.label)} ...", file=sys.stderr, flush=True)
        else:
            took = time.monotonic() - begun[run]
            print(
                f"  done {event.label} in {took:.1f} s ({event.done} of {event.total})",
                file=sys.stderr,
                flush=True,
            )

    yield tell
