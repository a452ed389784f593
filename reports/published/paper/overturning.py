"""Figure 6: overturning spectra in three dimensions and of each component alone.

The paper draws each planar curve over the peak of its own component. On equal shaking, over the peak of the
resultant that both components make, a planar curve lies higher: a statement is judged on the axes of the
paper, and on equal shaking beside it.
"""

from __future__ import annotations

import math
from collections.abc import Mapping

import numpy as np
from numpy.typing import NDArray

import rockwobble as rw
from rockwobble.reports.published.paper.statements import Statement, verdict_of
from rockwobble.studies import OverturningSpectrum

Array = NDArray[np.float64]

TAN_ALPHA = 0.1
LARGE = 20.0  # [m] from which on a cylinder is "large": the upper third of the paper's sizes
_PROBES = 5  # random intensities below each lowest one, per intensity of the grid: few on a coarse one
_EVERY = 0.95  # share of the sizes that may pass for all of them: single ones are a matter of chance


def spectrum_of(grid: int) -> OverturningSpectrum:
    """Run `grid` sizes at as many intensities."""
    return rw.spectrum(
        TAN_ALPHA,
        rw.el_centro_1940(),
        semidiagonals=np.linspace(0.5, 30.0, grid).tolist(),
        intensities=np.linspace(1.0, 12.0, grid).tolist(),
        probes=_PROBES * grid,
    )


def lowest_on_axes(spectrum: OverturningSpectrum, *, own: bool) -> Mapping[str, Array]:
    """Lowest overturning intensities (n_R,) of each series, over its component's peak or the resultant's."""
    return {
        name: lowest * (spectrum.maps.component_share(name) if own else 1.0)
        for name, lowest in spectrum.maps.lowest.items()
    }


def statements(spectrum: OverturningSpectrum) -> list[Statement]:
    """Compare the paper's statements on the figure with the spectrum, on both pairs of axes."""
    large = spectrum.maps.semidiagonals >= LARGE
    every, upper = spectrum.contrast.iloc[-1], spectrum.contrast.iloc[-2]
    cells = {"from": unconservative_from(spectrum)}
    cells |= {name: float(every[name]) for name in ("unconservative", "conservative")}
    cells |= {
        f"upper_{name}": float(upper[name])
        for name in ("smallest", "largest", "unconservative", "conservative")
    }
    entries = []
    for axes, own in (("own", True), ("equal", False)):
        lowest = lowest_on_axes(spectrum, own=own)
        top, whole = _lower(lowest, large), _lower(lowest, np.full(len(large), True))
        beside = {} if own else cells
        of_large = verdict_of(top["share"] > 0.5, top["share"] > _EVERY)
        parts = [whole["share"] > 0.5, *([] if own else [bool(every.unconservative > every.conservative)])]
        entries += [
            (f"large_{axes}", {**top, "large": LARGE, **beside}, of_large),
            (f"general_{axes}", {**whole, **beside}, verdict_of(*parts)),
        ]
    return [Statement(figure=6, name=name, numbers=n, verdict=verdict) for name, n, verdict in entries]


def unconservative_from(spectrum: OverturningSpectrum) -> float:
    """Size [m] from which on 3D has the lower overturning intensity at every size; NaN if none."""
    maps = spectrum.maps
    space, x, y = (np.nan_to_num(each, nan=math.inf) for each in maps.lowest.values())
    higher = ~(space < np.minimum(x, y) - maps.plan.search_step)
    if higher[-1]:
        return math.nan
    return float(maps.semidiagonals[np.flatnonzero(higher)[-1] + 1 if higher.any() else 0])


def _lower(lowest: Mapping[str, Array], chosen: NDArray[np.bool_]) -> dict[str, float]:
    """Number of sizes at which the 3D boundary is lowest, and its median relative distance.

    The ratio is of the lower planar curve to that of 3D; above 1 planar analysis is unconservative.
    """
    space, x, y = (np.nan_to_num(each[chosen], nan=math.inf) for each in lowest.values())
    plane = np.minimum(x, y)
    known = np.isfinite(space) | np.isfinite(plane)
    lower = (space < plane)[known]
    with np.errstate(invalid="ignore"):
        ratio = (plane / space)[known]
    return {
        "sizes": int(known.sum()),
        "lower": int(lower.sum()),
        "share": float(lower.mean()) if known.any() else math.nan,
        "ratio": float(np.median(ratio)) if known.any() else math.nan,
    }
