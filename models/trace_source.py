"""Sources of the sampled quantities of a trace: at hand, or computed when they are first asked for."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass
from typing import TYPE_CHECKING, Protocol

import numpy as np
from numpy.typing import NDArray

from .diagnostic import Assumptions
from .shown import CompactRepr

if TYPE_CHECKING:
    import pandas as pd

Array = NDArray[np.float64]


class Source(Protocol):
    """Source of the lazily computed quantities of a trace."""

    def quantities(self) -> Mapping[str, Array]:
        """Return the sampled quantities beyond the fields of a trace, (n,) or (n, 3)."""
        ...

    def assumptions(self, until: float) -> Assumptions | None:
        """Return whether contact and friction held until a time [s]; None if it does not know."""
        ...


@dataclass(frozen=True, slots=True, eq=False, repr=False)
class EagerSource(CompactRepr):
    """A source that has everything at hand, such as an engine or a stored file."""

    values: Mapping[str, Array]
    held: Assumptions | None = None

    def quantities(self) -> Mapping[str, Array]:
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


def friction_of(force: Array) -> Array:
    """Return horizontal over normal force (n,) of `force` (n, 3); inf where N is not positive."""
    horizontal, normal = np.hypot(force[:, 0], force[:, 1]), force[:, 2]
    pressed = normal > 0.0
    needed = np.where(pressed, horizontal / np.where(pressed, normal, 1.0), math.inf)
    return np.where(np.isnan(normal), math.nan, needed)
