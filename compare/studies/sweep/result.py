"""The result of a sweep: a table of its runs, and what it was made of."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass

import pandas as pd

from rockwobble.models.shown import Shown

from ...metrics.order_statistics import stated
from ...storage.manifest import Results

KIND = "sweep"
_OUTCOMES = ("stands", "overturned", "failed")


@dataclass(frozen=True, slots=True, kw_only=True, eq=False, repr=False)
class Sweep(Shown):
    """What became of each run.

    Attributes
    ----------
    table : DataFrame
        One row for each run, in the order of the plan.
    about : mapping
        The plan: its kind, the number of runs, and the axes of a grid or its cases and methods.
    """

    table: pd.DataFrame
    about: Mapping[str, object]

    @property
    def keys(self) -> list[str]:
        """Columns whose values tell the parts of the sweep apart, as `summary` and figures have them."""
        return ["motion", "model", "tan_alpha"] if "model" in self.table else ["run"]

    @property
    def outcomes(self) -> list[str]:
        """The outcomes that there are."""
        found = set(self.table["outcome"])
        return [name for name in _OUTCOMES if name in found]

    def summary(self) -> pd.DataFrame:
        """Return one row for each part: how many runs ended how, and their peak tilts.

        Columns: `keys`, runs, a count for each outcome that there is, no_uplift (how many of them stood still
        throughout), and in alpha median, in which an overturned run is infinite, NaN of fewer than six, and
        largest, of those that do not overturn.
        """
        rows, outcomes = [], self.outcomes
        for key, own in self.table.groupby(self.keys, sort=False):
            fell, peaks = own["outcome"] == "overturned", own["peak_tilt_over_alpha"]
            rows.append(
                {
                    **dict(zip(self.keys, key, strict=True)),
                    "runs": len(own),
                    **{name: int((own["outcome"] == name).sum()) for name in outcomes},
                    "no_uplift": int((peaks == 0.0).sum()),
                    "median": stated(peaks.mask(fell, math.inf).median(), int(peaks.notna().sum())),
                    "largest": peaks[~fell].max(),
                }
            )
        return pd.DataFrame(rows)

    def _said(self) -> dict[str, str]:
        outcome = self.table["outcome"]
        counts = {name: str((outcome == name).sum()) for name in self.outcomes}
        return {"runs": str(len(self.table)), **counts}


def stored_sweep(results: Results) -> Sweep:
    """Return the sweep that is stored."""
    return Sweep(table=results.table(KIND), about=results.manifest.about)
