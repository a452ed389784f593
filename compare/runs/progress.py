"""Progress of tasks: the finished share, and the remaining time."""

from __future__ import annotations

import math
import time
from collections.abc import Callable, Iterator, Sequence
from contextlib import AbstractContextManager, contextmanager
from dataclasses import dataclass
from functools import partial
from typing import Literal

from rockwobble.models.shown import CompactRepr


@dataclass(frozen=True, slots=True)
class FailedTask:
    """Placeholder for the result of a task whose process died, with its last words."""

    why: str


class IncompleteError(RuntimeError):
    """Error of unfinished tasks: their processes died repeatedly, or the Dask cluster is gone."""


@dataclass(frozen=True, slots=True, kw_only=True, repr=False)
class Progress(CompactRepr):
    """Progress of tasks.

    Parameters
    ----------
    label : str
        The task that has begun or ended.
    state : {"started", "finished"}
    done, total : int
        Tasks finished, those found finished included, and in all.
    found : int
        Tasks found finished: they did not run.
    share : float
        Share of the computing time of those that run, from 0 to 1, as far as it is known beforehand.
    left : float
        Seconds to go if the rest is as fast as what ran so far; NaN before anything has.
    damaged : sequence of str
        Files of finished tasks that are not what was written: these tasks run again.
    """

    label: str
    state: Literal["started", "finished"]
    done: int
    total: int
    found: int = 0
    share: float = 0.0
    left: float = math.nan
    damaged: tuple[str, ...] = ()


ProgressCallback = Callable[[Progress], None]
Stage = Callable[[str], AbstractContextManager[object]]


class Clock:
    """Calls a callback with the finished share, by the costs of the tasks.

    Parameters
    ----------
    tell : callable or None
    costs : sequence of float
        Costs of the tasks that run, in any unit.
    found : int
        Tasks found finished.
    damaged : sequence of str
        See `Progress`.
    """

    def __init__(
        self,
        tell: ProgressCallback | None,
        costs: Sequence[float],
        found: int = 0,
        damaged: Sequence[str] = (),
    ) -> None:
        self._tell = tell
        self._stated = partial(Progress, total=found + len(costs), found=found, damaged=tuple(damaged))
        self._done, self._whole, self._spent = found, sum(costs), 0.0
        self._begun = time.monotonic()

    def __call__(self, state: Literal["started", "finished"], label: str, cost: float = 0.0) -> None:
        """Report the start of a task, or the end of one of this cost."""
        self._done += state == "finished"
        self._spent += cost
        share = self._spent / self._whole if self._whole > 0.0 else 0.0
        left = (time.monotonic() - self._begun) * (1.0 / share - 1.0) if share > 0.0 else math.nan
        if self._tell is not None:
            self._tell(self._stated(label=label, state=state, done=self._done, share=share, left=left))


def stages(tell: ProgressCallback | None, costs: Sequence[float]) -> Stage:
    """Context manager that reports successive stages to a callback, by label.

    Parameters
    ----------
    tell : callable or None
    costs : sequence of float
        Costs of the stages in their order, in any unit.
    """
    clock, following = Clock(tell, costs), iter(costs)

    @contextmanager
    def stage(label: str) -> Iterator[None]:
        clock("started", label)
        yield
        clock("finished", label, next(following))

    return stage
