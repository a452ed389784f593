"""Limit states, and from the runs of a study to samples: what each motion does at each level."""

from __future__ import annotations

import itertools
import math
from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass

import numpy as np
import pandas as pd
from numpy.typing import NDArray

from rockwobble.models.number_checks import require_one_of

from .fit import Sample
from .intensity import MEASURES

OVERTURNED, CONTACT_LOST = "overturned", "contact_lost"
# name: the tilt that is reached [alpha]; NaN where it is no tilt that decides
LIMITS: Mapping[str, float] = {
    "uplift": 0.0,
    "0.1 alpha": 0.1,
    "0.25 alpha": 0.25,
    "0.5 alpha": 0.5,
    "1 alpha": 1.0,
    OVERTURNED: math.nan,
    CONTACT_LOST: math.nan,
}
DEFAULT_LIMITS = tuple(name for name in LIMITS if name != CONTACT_LOST)


def require_limits(names: Iterable[str]) -> tuple[str, ...]:
    """Return the limit states, each once, in the order of `LIMITS`.

    Raises
    ------
    ValueError
        If one is unknown, or there is none.
    """
    given = list(names)
    for name in given:
        require_one_of("a limit", name, LIMITS)
    if not given:
        raise ValueError("a fragility needs at least one limit, got none")
    return tuple(name for name in LIMITS if name in given)


def exceeded(runs: pd.DataFrame, limit: str) -> NDArray[np.float64]:
    """Return 1 where a run exceeds a limit, 0 where it does not, NaN where that is not known.

    Overturned is what the run itself says: the side reaches the ground, or no later ground motion can stop
    it. Such a run exceeds every limit: when in its fall it leaves the ground depends on where a method ends
    the fall. A cylinder at rest has not uplifted; any tilt above zero is uplift.

    Parameters
    ----------
    runs : DataFrame
        Columns peak_tilt [alpha], outcome, contact_lost.
    limit : str
        One of `LIMITS`.
    """
    failed = (runs["outcome"] == "failed").to_numpy(bool)
    fell = (runs["outcome"] == "overturned").to_numpy(bool)
    if limit == CONTACT_LOST:
        lost = runs["contact_lost"].to_numpy(float)
        found = np.where(fell & ~np.isnan(lost), 1.0, lost)
    elif limit == OVERTURNED:
        found = fell.astype(float)
    else:
        peaks = runs["peak_tilt"].to_numpy(float)
        bound = LIMITS[limit]
        found = (fell | (peaks > 0.0 if bound == 0.0 else peaks >= bound)).astype(float)
    return np.where(failed, np.nan, found)


Array = NDArray[np.float64]
Key = tuple[str, str, str]  # cylinder, method, limit


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Blocks:
    """The runs as blocks of motions and levels.

    Attributes
    ----------
    cylinders, methods, motions : list of str
        In the order in which they were run.
    intensities : mapping of (str, str) to ndarray, shape (R, S)
        Logarithms by cylinder and measure; of a stripe the same for all motions.
    runs : mapping of (str, str) to DataFrame
        By cylinder and method, the S levels of each of R motions one after the other.
    limits : sequence of str
        That are asked about.
    measure : str
        Intensity of the levels.
    """

    cylinders: list[str]
    methods: list[str]
    motions: list[str]
    intensities: Mapping[tuple[str, str], Array]
    runs: Mapping[tuple[str, str], pd.DataFrame]
    limits: Sequence[str]
    measure: str

    def known_keys(self) -> Iterator[Key]:
        """Yield cylinder, method and limit where anything is known."""
        for key in itertools.product(self.cylinders, self.methods, self.limits):
            if not np.isnan(self.exceeded(*key)).all():
                yield key

    def sample(self, cylinder: str, method: str, limit: str, measure: str | None = None) -> Sample:
        """Return the sample of a method and a limit, by one intensity; default: that of the levels."""
        x = self.intensities[cylinder, measure or self.measure]
        return Sample(x=x, y=self.exceeded(cylinder, method, limit))

    def exceeded(self, cylinder: str, method: str, limit: str) -> Array:
        """Return 1, 0 or NaN for each motion and level (R, S)."""
        return exceeded(self.runs[cylinder, method], limit).reshape(len(self.motions), -1)

    def known(self, cylinder: str, measure: str) -> bool:
        """Whether every motion has an intensity of this measure."""
        return bool(np.isfinite(self.intensities[cylinder, measure]).all())


def blocks_of(runs: pd.DataFrame, points: pd.DataFrame, limits: Sequence[str], measure: str) -> Blocks:
    """Return the blocks of a table of runs and of the table of the points at which they were made."""
    cylinders, methods, motions = (
        list(dict.fromkeys(table[name]))
        for table, name in ((runs, "cylinder"), (runs, "method"), (points, "motion"))
    )
    place = {name: index for index, name in enumerate(motions)}

    def ordered(table: pd.DataFrame) -> pd.DataFrame:
        order = np.lexsort((table["step"].to_numpy(), table["motion"].map(place).to_numpy()))
        return table.iloc[order].reset_index(drop=True)

    own = {name: ordered(part) for name, part in points.groupby("cylinder", sort=False)}
    with np.errstate(divide="ignore"):
        intensities = {
            (str(name), measure): np.log(part[measure].to_numpy(float)).reshape(len(motions), -1)
            for name, part in own.items()
            for measure in MEASURES
        }
    grouped = runs.groupby(["cylinder", "method"], sort=False)
    return Blocks(
        cylinders=cylinders,
        methods=methods,
        motions=motions,
        intensities=intensities,
        runs={(str(key[0]), str(key[1])): ordered(part) for key, part in grouped},
        limits=limits,
        measure=measure,
    )
