"""A part of the report: what it measures, cut into tasks that can be kept and repeated singly."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass

from .extent import Extent

Inputs = Mapping[str, object]  # arguments of `Part.measure` by name: numbers, text and tuples of them
Row = dict[str, float | str | bool]


@dataclass(frozen=True, slots=True, kw_only=True)
class Part:
    """One set of measurements.

    Attributes
    ----------
    name : str
        Of its table.
    title : str
        For whoever watches it run.
    tasks : callable
        Returns the inputs of each task of an extent.
    measure : callable
        Returns the rows of one task; depends on nothing but its inputs.
    keys : tuple of str
        Inputs that are the first columns of every row.
    cost : callable
        Rough computing time of a task [s], of the same inputs.
    engine : str
        The engine that it runs; empty where it runs the reduced models alone.
    """

    name: str
    title: str
    tasks: Callable[[Extent], Iterable[Inputs]]
    measure: Callable[..., list[Row]]
    keys: tuple[str, ...]
    cost: Callable[..., float]
    engine: str = ""
