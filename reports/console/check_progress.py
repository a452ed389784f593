"""What a check is doing, on standard error."""

from __future__ import annotations

import sys
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from rockwobble.compare import Progress

Tell = Callable[["Progress"], None]
Count = Callable[[int], None]


@contextmanager
def shown_progress(layer: str) -> Iterator[tuple[Tell, Count]]:
    """Yield callbacks for engine runs and for finished checks: a moving line, or one for each layer."""
    if not sys.stderr.isatty():
        print(f"checking {layer} ...", file=sys.stderr, flush=True)
        yield (lambda _: None), (lambda _: None)
        return
    from rich.console import Console

    with Console(stderr=True).status(f"{layer} ...") as status:
        state = {"runs": "", "checks": ""}

        def show() -> None:
            status.update(f"{layer} ...{state['checks']}{state['runs']}")

        def tell(event: Progress) -> None:
            state["runs"] = f" engine runs {event.done} of {event.total}: {event.case}, {event.label}"
            show()

        def count(done: int) -> None:
            state["checks"], state["runs"] = f" {done} checks done", ""
            show()

        yield tell, count
