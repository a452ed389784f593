"""From the runs of a study to samples: what each motion does at each level, by cylinder, method and limit."""

from __future__ import annotations

import itertools
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass

import numpy as np
import pandas as pd
from numpy.typing import NDArray

from .intensity import MEASURES
from .limits import exceeded
from .resampling import Sample

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
