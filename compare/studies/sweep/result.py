"""The result of a sweep: a table of its runs, and what it was made of."""

from __future__ import annotations

import math
from dataclasses import dataclass

import pandas as pd

from ...metrics.order_statistics import stated
from ...storage.manifest import Number
from ...storage.results import Results

KIND = "sweep"
_OUTCOMES = ("stands", "overturned", "failed")


@dataclass(frozen=True, kw_only=True, eq=False, repr=False)
class Sweep(Results, kind=KIND):
    """What became of each run.

    Attributes
    ----------
    sweep : DataFrame
        One row for each run, in the order of the plan; `table`, too.
    motions : DataFrame
        Of a grid the samples of its ground motions.

    Its facts are the plan: its kind, the number of runs, and the axes of a grid or its cases and methods.
    """

    @property
    def table(self) -> pd.DataFrame:
        """One row for each run, in the order of the plan."""
        return self.tables[KIND]

    def headline(self) -> dict[str, Number]:
        """Return the number of runs, and of those that ended in each way."""
        outcome = self.table["outcome"]
        return {"runs": len(outcome), **{name: int((outcome == name).sum()) for name in self.outcomes}}

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
