"""What a check is doing, on standard error."""

from __future__ import annotations

import sys
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from rockwobble.compare import Progress


@contextmanager
def shown_progress(layer: str) -> Iterator[tuple[Callable[[Progress], None], Callable[[int], None]]]:
    """Yield callbacks for engine runs and for finished checks: a moving line, or one for each layer."""
    if not sys.stderr.isatty():
        print(f"checking {layer} ...", file=sys.stderr, flush=True)
        yield (lambda _: None), (lambda _: None)
        return
    from rich.console import Console

    with Console(stderr=True).status(f"{layer} ...") as status:
        checks = 0

        def tell(event: Progress) -> None:
            run = f"engine runs {event.done} of {event.total}: {event.label}"
            status.update(f"{layer} ... {checks} checks done, {run}")

        def count(done: int) -> None:
            nonlocal checks
            checks = done
            status.update(f"{layer} ... {done} checks done")

        yield tell, count
