"""A part of the report: what it measures, cut into tasks that can be kept and repeated singly."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from typing import Any

from .extent import Extent

Inputs = Mapping[str, Any]
Row = dict[str, Any]


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
        Returns the inputs of each task of an extent: numbers and text by name.
    measure : callable
        Returns the rows of one task; depends on nothing but its inputs.
    cost : callable
        Rough computing time of a task [s].
    module : str
        Where `measure` stands: its code is one of the things that its results depend on.
    engine : str
        The engine that it runs; empty where it runs the reduced models alone.
    """

    name: str
    title: str
    tasks: Callable[[Extent], Sequence[Inputs]]
    measure: Callable[[Inputs], list[Row]]
    cost: Callable[[Inputs], float]
    module: str
    engine: str = ""
