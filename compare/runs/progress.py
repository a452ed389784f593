"""Events and progress of tasks, wherever they run: the share that is done, and the time to go."""

from __future__ import annotations

import math
import time
from collections.abc import Callable, Generator, Iterator, Sequence
from contextlib import AbstractContextManager, contextmanager
from dataclasses import dataclass
from typing import Generic, Literal, TypeAlias, TypeVar

from rockwobble.models.shown import Brief

R = TypeVar("R")


@dataclass(frozen=True, slots=True)
class Lost:
    """A task whose process died, with its last words; it stands in the place of the result."""

    why: str


class IncompleteError(RuntimeError):
    """Some tasks are not finished: their processes died again and again, or the Dask cluster is gone."""


@dataclass(frozen=True, slots=True)
class Started:
    """A task, by its place among all, has begun."""

    place: int


@dataclass(frozen=True, slots=True)
class Finished(Generic[R]):
    """A task, by its place among all, has ended."""

    place: int
    result: R | Lost


Events: TypeAlias = Generator[Started | Finished[R], None, None]


@dataclass(frozen=True, slots=True, kw_only=True, repr=False)
class Progress(Brief):
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
        Of the computing time of those that run, from 0 to 1, as far as it is known beforehand.
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
    """Tells a callback how far it is, from the costs of the tasks.

    Parameters
    ----------
    tell : callable or None
    costs : sequence of float
        Of the tasks that run, in any unit.
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
        self._damaged = tuple(damaged)
        self._costs = costs
        self._whole = sum(costs)
        self._found = self._done = found
        self._spent = 0.0
        self._begun = time.monotonic()

    def __call__(self, state: Literal["started", "finished"], label: str, index: int = -1) -> None:
        """Tell of the start or the end of the task of this index."""
        if state == "finished":
            self._done += 1
            self._spent += self._costs[index]
        share = self._spent / self._whole if self._whole > 0.0 else 0.0
        left = (time.monotonic() - self._begun) * (1.0 / share - 1.0) if share > 0.0 else math.nan
        if self._tell is not None:
            self._tell(
                Progress(
                    label=label,
                    state=state,
                    done=self._done,
                    total=self._found + len(self._costs),
                    found=self._found,
                    share=share,
                    left=left,
                    damaged=self._damaged,
                )
            )


class Stages:
    """Tells a callback of one stage after the other, each a with block.

    Parameters
    ----------
    tell : callable or None
    costs : sequence of float
        Of the stages in their order, in any unit.
    """

    def __init__(self, tell: ProgressCallback | None, costs: Sequence[float]) -> None:
        self._clock = Clock(tell, costs)
        self._done = 0

    @contextmanager
    def stage(self, label: str) -> Iterator[None]:
        """Tell of the start and the end of what is in the block."""
        self._clock("started", label)
        yield
        self._clock("finished", label, self._done)
        self._done += 1
