"""Maps: coloured cells, colour scale, and contours."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]
NOTHING = "#d9d9d9"  # behind cells without a value


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Gap:
    """Reason for empty cells of a map, with colour and legend entry."""

    name: str
    colour: str
    cells: NDArray[np.bool_]


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Heat:
    """Coloured cells.

    Attributes
    ----------
    x, y : ndarray
        Centres of the cells; for cells at even distances 0, 1, 2 and ticks on the axes, see `names`.
    values : ndarray, shape (len(y), len(x))
        NaN where there is none.
    gaps : sequence of Gap
        Why: the kinds of missing values.
    written : str
        Format of the number in each cell; empty: none. Left out where cells are too many to be read.
    """

    x: Array
    y: Array
    values: Array
    gaps: Sequence[Gap] = ()
    written: str = ""

    @property
    def shaded(self) -> bool:
        """Whether a cell has a coloured value and is no gap."""
        covered = np.any([np.isnan(self.values), *(gap.cells for gap in self.gaps)], axis=0)
        return not covered.all()

    def edges(self, *, log_x: bool = False, log_y: bool = False) -> tuple[Array, Array]:
        """Cell edges, (len(x) + 1,) and (len(y) + 1,)."""
        return _edges(self.x, log_x), _edges(self.y, log_y)


@dataclass(frozen=True, slots=True, kw_only=True)
class Shades:
    """Colour scale of all maps of a picture.

    Attributes
    ----------
    label, unit : str
    low, high : float
        What is beyond is drawn as these.
    log : bool
    centre : float, optional
        Centre of a scale with two sides, for signed values: low and high as far from it.
    steps : int
        Number of colours; 0: a continuous scale.
    reverse : bool
        Whether low values are the red ones of a scale with two sides, because they are those to fear.
    """

    label: str
    unit: str
    low: float
    high: float
    log: bool = False
    centre: float | None = None
    steps: int = 0
    reverse: bool = False

    @property
    def title(self) -> str:
        """Label and unit."""
        return f"{self.label} [{self.unit}]"

    @property
    def colours(self) -> str:
        """Name of the colour map, shared by both renderers."""
        return "Blues" if self.centre is None else "RdBu" if self.reverse else "RdBu_r"

    def place(self, values: Array) -> Array:
        """Positions of values on the scale, from 0 to 1; NaN stays."""
        low, high = self.low, self.high
        if self.log:
            with np.errstate(divide="ignore", invalid="ignore"):
                values, low, high = np.log10(np.maximum(values, low)), np.log10(low), np.log10(high)
        elif self.centre is not None:
            reach = max(high - self.centre, self.centre - low)
            low, high = self.centre - reach, self.centre + reach
        return np.asarray(np.clip((values - low) / (high - low), 0.0, 1.0))

    def ticks(self) -> list[tuple[float, str]]:
        """Ticks as positions on the scale and values."""
        if self.log:
            ends = np.log10(self.low), np.log10(self.high)
            values = 10.0 ** np.arange(np.ceil(ends[0] - 1e-9), np.floor(ends[1] + 1e-9) + 1.0)
            if len(values) < 2:
                values = np.array([self.low, self.high])
        else:
            values = np.linspace(self.low, self.high, 5)
        return [(float(at), f"{value:.3g}") for at, value in zip(self.place(values), values, strict=True)]


PEAKS = Shades(label="peak tilt / α", unit="-", low=0.0, high=1.0, steps=10)
_OVERTURNED, _NO_UPLIFT, _FAILED = "#D55E00", "#ffffff", "#9a9a9a"


def peak_map(x: Array, y: Array, tilt: Array, fell: NDArray[np.bool_]) -> Heat:
    """Map of peak tilts over alpha (len(y), len(x)), in `PEAKS`; NaN was not solved."""
    return Heat(
        x=x,
        y=y,
        values=np.where(fell | (tilt == 0.0), np.nan, tilt),
        gaps=[
            Gap(name="overturned", colour=_OVERTURNED, cells=fell),
            Gap(name="no uplift", colour=_NO_UPLIFT, cells=tilt == 0.0),
            Gap(name="not solved", colour=_FAILED, cells=np.isnan(tilt)),
        ],
    )


def names(values: Sequence[object]) -> tuple[Array, list[tuple[float, str]]]:
    """Positions 0, 1, 2, ... for values, and tick labels with enough digits to differ."""
    numbers = {value for value in values if isinstance(value, float)}
    digits = next(n for n in range(4, 18) if len({f"{value:.{n}g}" for value in numbers}) == len(numbers))
    said = [f"{value:.{digits}g}" if isinstance(value, float) else str(value) for value in values]
    places = np.arange(len(said), dtype=np.float64)
    return places, [(float(place), name) for place, name in zip(places, said, strict=True)]


def contour(x: Array, y: Array, values: Array, level: float) -> tuple[Array, Array]:
    """Contour (n,), (n,) of values (len(y), len(x)) at `level`; NaN separates its pieces."""
    from contourpy import contour_generator

    if min(values.shape) < 2:  # a single row of cells has no contour
        return np.empty(0), np.empty(0)
    pieces = contour_generator(x, y, np.ma.masked_invalid(values)).lines(level)
    separated = [part for piece in pieces for part in (np.asarray(piece), np.full((1, 2), np.nan))]
    whole = np.concatenate(separated[:-1]) if separated else np.empty((0, 2))
    return whole[:, 0], whole[:, 1]


def _edges(centres: Array, log: bool) -> Array:
    if log:
        return np.asarray(10.0 ** _edges(np.log10(centres), log=False))
    if len(centres) == 1:
        return np.array([centres[0] - 0.5, centres[0] + 0.5])
    between = 0.5 * (centres[1:] + centres[:-1])
    ends = [2.0 * centres[0] - between[0]], [2.0 * centres[-1] - between[-1]]
    return np.concatenate([ends[0], between, ends[1]])
