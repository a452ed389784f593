"""Events of a task, wherever it runs: started, finished, or its process lost."""

from __future__ import annotations

from collections.abc import Generator
from dataclasses import dataclass
from typing import Generic, TypeAlias, TypeVar

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
