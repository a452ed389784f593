"""The ratios of the peaks of each member, as the figures of an ensemble show them."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from rockwobble.compare.metrics.distributions import MARGIN
from rockwobble.compare.studies.ensemble.tables import pairs

if TYPE_CHECKING:
    from rockwobble.compare import Ensemble

# beyond the largest ratio, and at least beyond the margin
_ROOM = 1.25
_DECADES = tuple(digit * 10.0**power for power in range(-6, 7) for digit in (1.0, 2.0, 5.0))
_STEPS = (0.01, 0.02, 0.05, 0.1, 0.2, 0.5)
_MOST_TICKS = 7


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class RatioRow:
    """One line of the picture: a method against another.

    Attributes
    ----------
    method, against : str
    members : list of str
    ratios : ndarray, shape (n,)
        Of these members; 0 and infinity where one method alone overturns.
    median, ends, spread : float and pairs of float
        Median ratio, its interval, and the 5th and 95th percentile of the members.
    """

    method: str
    against: str
    members: list[str]
    ratios: NDArray[np.float64]
    median: float
    ends: tuple[float, float]
    spread: tuple[float, float]

    @property
    def label(self) -> tuple[str, str]:
        """What stands beside the line, in two lines: a phone has no room for one."""
        return self.method, f"/ {self.against}, n = {len(self.ratios)}"


def main_pairs(found: Ensemble) -> list[dict[Any, Any]]:
    """Return the rows of the contrasts that are asked for first: engines by their own model, then models."""
    rows = found.contrasts.to_dict("records")
    own = {row["method"]: row["own_model"] for row in found.methods.to_dict("records")}
    engines = [row for row in rows if own[row["method"]] and own[row["method"]] == row["against"]]
    models = [row for row in rows if not own[row["method"]] and not own[row["against"]]]
    return engines + models or rows


def ratio_rows(found: Ensemble) -> list[RatioRow]:
    """Return the pairs of methods that are asked for first and have a ratio."""
    rows = []
    for row in main_pairs(found):
        both = pairs(found.members, row["method"], row["against"])
        logarithms = both.log_ratios()
        has = ~np.isnan(logarithms)
        if has.any():
            rows.append(
                RatioRow(
                    method=row["method"],
                    against=row["against"],
                    members=list(map(str, both.members[has])),
                    ratios=np.exp(logarithms[has]),
                    median=row["ratio"],
                    ends=(row["ratio_low"], row["ratio_high"]),
                    spread=(row["ratio_05"], row["ratio_95"]),
                )
            )
    return rows


def ratio_span(rows: list[RatioRow]) -> tuple[float, float]:
    """Return the ends of the axis of ratios, as far from 1 on both sides; what is beyond is at its edges."""
    logarithms = np.log(np.concatenate([row.ratios[(row.ratios > 0.0)] for row in rows]))
    known = np.abs(logarithms[np.isfinite(logarithms)])
    reach = _ROOM * max(float(known.max()) if len(known) else 0.0, 2.0 * math.log1p(MARGIN))
    return math.exp(-reach), math.exp(reach)


def ratio_ticks(low: float, high: float) -> list[float]:
    """Return where an axis of ratios has its numbers."""
    if high / low > 4.0:
        found = [tick for tick in _DECADES if low <= tick <= high]
        return found if len(found) <= _MOST_TICKS else [t for t in found if math.log10(t).is_integer()]
    step = next((s for s in _STEPS if (high - low) / s <= _MOST_TICKS), _STEPS[-1])
    first = math.ceil(low / step)
    return [round(index * step, 6) for index in range(first, math.floor(high / step) + 1)]
