"""Figure 6: overturning spectra in three dimensions and of each component alone."""

from __future__ import annotations

import math
from typing import Any

import numpy as np

from rockwobble.compare.studies.spectrum.planar_contrast import (
    edge_difference,
    planar_contrast,
    unconservative_from,
)
from rockwobble.compare.studies.spectrum.result import OverturningSpectrum
from rockwobble.compare.studies.spectrum.series import PLANAR_X, PLANAR_Y, SPATIAL
from rockwobble.models import el_centro_1940

from .claim import Claim, verdict_of

TAN_ALPHA = 0.1
SIZES = (0.5, 30.0)  # [m]
INTENSITIES = (1.0, 12.0)  # [g tan alpha]
GRID = 100
# "large": what begins above the upper fifth of the sizes is no statement on large cylinders
_LARGE = 0.2


def problem(grid: int = GRID) -> dict[str, Any]:
    """Return what `overturning_spectrum` is asked: `grid` sizes and as many intensities."""
    return {
        "tan_alpha": TAN_ALPHA,
        "motion": el_centro_1940(),
        "semidiagonals": np.linspace(*SIZES, grid),
        "intensities": np.linspace(*INTENSITIES, grid),
    }


def overturning_claims(spectrum: OverturningSpectrum) -> list[Claim]:
    """Return the claims on figure 6."""
    return [_large_claim(spectrum), _general_claim(spectrum)]


def _large_claim(spectrum: OverturningSpectrum) -> Claim:
    sizes = spectrum.semidiagonals
    start = unconservative_from(spectrum)
    contrast = planar_contrast(spectrum)
    band = contrast.iloc[-2]
    found = (
        f"at R = {band.smallest:.3g} to {band.largest:.3g} m the 3D model overturns and neither planar run "
        f"does in {_percent(band.missed)} of the cells, the reverse in {_percent(band.overcalled)}. "
    )
    if math.isnan(start):
        found += "At the largest size the lowest intensity found to overturn is not lower in 3D. "
        large = False
    else:
        large = bool((sizes >= start).mean() >= _LARGE)
        found += (
            f"From R = {start:.3g} m up the lowest found to overturn is lower in 3D than in both planes "
            f"at every size, by {_percent(_margin(spectrum, start))} in the median. "
        )
    found += _own_scale(spectrum)
    return Claim(
        says="for large blocks planar analysis is unconservative.",
        found=found,
        verdict=verdict_of(large, bool(band.missed > band.overcalled)),
    )


def _margin(spectrum: OverturningSpectrum, start: float) -> float:
    """Median share by which the planar minimum lies above that in 3D, over the sizes from `start`."""
    chosen = spectrum.semidiagonals >= start
    share = -edge_difference(spectrum)[chosen] / spectrum.lowest[SPATIAL][chosen]
    # where no planar run overturns on the grid the share is unbounded, and so may be the median
    return float(np.median(share))


def _own_scale(spectrum: OverturningSpectrum) -> str:
    own = {name: spectrum.lowest[name] * spectrum.component_share(name) for name in (PLANAR_X, PLANAR_Y)}
    planar = np.fmin(own[PLANAR_X], own[PLANAR_Y])
    lower = np.nan_to_num(spectrum.lowest[SPATIAL], nan=math.inf) < np.nan_to_num(planar, nan=math.inf)
    return (
        "Here the three curves are drawn over the same shaking; over the peak of its own component a planar "
        f"curve lies lower, and the 3D curve is then the lowest at {_percent(float(lower.mean()))} of all "
        "sizes."
    )


def _general_claim(spectrum: OverturningSpectrum) -> Claim:
    contrast = planar_contrast(spectrum)
    every, bands = contrast.iloc[-1], contrast.iloc[:-1]
    opposite = bands[bands["overcalled"] > bands["missed"]]
    where = ", ".join(f"{row.smallest:.3g} to {row.largest:.3g} m" for _, row in opposite.iterrows())
    return Claim(
        says="the 2D model generally gives unconservative estimates of the overturning intensity.",
        found=f"the lowest intensity found to overturn is lower in 3D than in both planes at "
        f"{_percent(every.lower_edge)} of the sizes and higher than in one at {_percent(every.higher_edge)}; "
        f"over all cells planar analysis misses {_percent(every.missed)} and overcalls "
        f"{_percent(every.overcalled)}"
        + (
            f", more than it misses at R = {where}."
            if where
            else ", in no band of sizes more than it misses."
        ),
        verdict=verdict_of(bool(every.lower_edge > 0.5), bool(every.missed > every.overcalled)),
    )


def _percent(share: float) -> str:
    return f"{100.0 * share:.1f} %"
