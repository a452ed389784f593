"""Sources of the sampled quantities of a trace: at hand, or computed when they are first asked for."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass
from typing import TYPE_CHECKING, Protocol, overload

import numpy as np
from numpy.typing import NDArray

from .diagnostic import Assumptions
from .shown import Brief

if TYPE_CHECKING:
    import pandas as pd

Array = NDArray[np.float64]


class Source(Protocol):
    """The maker of a trace: gives what costs something, when it is first asked for."""

    def sampled(self) -> Mapping[str, Array]:
        """Return the sampled quantities that it knows beyond those that are fields, (n,) or (n, 3)."""
        ...

    def assumptions(self, until: float) -> Assumptions | None:
        """Return whether contact and friction held until a time [s]; None if it does not know."""
        ...


@dataclass(frozen=True, slots=True, eq=False, repr=False)
class Known(Brief):
    """A source that has everything at hand, such as an engine or a stored file."""

    values: Mapping[str, Array]
    held: Assumptions | None = None

    def sampled(self) -> Mapping[str, Array]:
        """Return the quantities, each (n,) or (n, 3)."""
        return self.values

    def assumptions(self, until: float) -> Assumptions | None:
        """Return the assumptions of the whole motion, as far as they are known."""
        return self.held


def no_passes() -> pd.DataFrame:
    """Return an empty table of passes."""
    import pandas as pd

    table = pd.DataFrame({name: np.empty(0) for name in ("time", "minimum_tilt", "angle_of_turn")})
    return table.assign(resolved=np.empty(0, dtype=bool))


class HasLate(Protocol):
    """The part of a trace that its late quantities need."""

    @property
    def time(self) -> Array:
        """Samples (n,) [s]."""
        ...

    @property
    def late(self) -> Mapping[str, Array]:
        """The quantities that the source gave."""
        ...


class Late:
    """A sampled quantity that may cost something: the source computes it when it is first asked for."""

    def __init__(self, width: int) -> None:
        self._width = width

    def __set_name__(self, owner: type, name: str) -> None:
        self._name = name

    @overload
    def __get__(self, trace: None, owner: type) -> Late: ...
    @overload
    def __get__(self, trace: HasLate, owner: type) -> Array: ...
    def __get__(self, trace: HasLate | None, owner: type) -> Array | Late:
        if trace is None:
            return self
        found = trace.late.get(self._name)
        count = len(trace.time)
        return (
            np.full(count if self._width == 1 else (count, self._width), math.nan) if found is None else found
        )


def friction_of(force: Array) -> Array:
    """Return horizontal over normal force (n,) of `force` (n, 3); inf where N is not positive."""
    horizontal, normal = np.hypot(force[:, 0], force[:, 1]), force[:, 2]
    pressed = normal > 0.0
    needed = np.where(pressed, horizontal / np.where(pressed, normal, 1.0), math.inf)
    return np.where(np.isnan(normal), math.nan, needed)
