"""Whether a planar analysis of each component would be on the safe side for one case."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from ...metrics.tilt import overturned
from ..spectrum.series import PLANAR_X, PLANAR_Y, SPATIAL
from .scales import ScaleScan

# scales next to the case: a designer knows the intensity of shaking no better than to a factor of two
NEIGHBOURS = 2.0
# ratio of peak tilts from which one is larger: below it is rounding and the step of the solution
LARGER = 1.01


@dataclass(frozen=True, slots=True, kw_only=True)
class PlanarView:
    """Planar analysis of each component against three dimensions.

    Attributes
    ----------
    spatial, planar_x, planar_y : float
        Peak tilts at the scale of the case [rad].
    neighbours : int
        Scales from half to twice that of the case at which anything uplifts and both could be solved.
    larger : float
        Share of them at which 3D tilts more than both planar runs [-]; NaN without any.
    missed : float
        Share at which 3D overturns and no planar run does.
    lowest_spatial, lowest_planar : float
        Lowest factor on the ground motion found to overturn, in 3D and in the worse plane [-]; NaN if none.
    """

    spatial: float
    planar_x: float
    planar_y: float
    neighbours: int
    larger: float
    missed: float
    lowest_spatial: float
    lowest_planar: float

    @property
    def planar(self) -> float:
        """Peak tilt of the worse plane [rad]."""
        return max(self.planar_x, self.planar_y)

    @property
    def ratio(self) -> float:
        """3D over the worse plane at this scale [-]: inf where only 3D uplifts, NaN where nothing does."""
        if self.planar > 0.0:
            return self.spatial / self.planar
        return math.inf if self.spatial > 0.0 else math.nan

    @property
    def kind(self) -> str:
        """What planar analysis is at this scale: unconservative, conservative, equal or unknown."""
        ratio = self.ratio
        if math.isnan(ratio):
            return "unknown"
        if ratio > LARGER:
            return "unconservative"
        return "conservative" if ratio < 1.0 / LARGER else "equal"


def planar_view(scan: ScaleScan | None) -> PlanarView | None:
    """Return what a scan says of planar analysis; None where there are no planar runs."""
    if scan is None or PLANAR_X not in scan.peaks:
        return None
    spatial, x, y = (scan.peaks[name] for name in (SPATIAL, PLANAR_X, PLANAR_Y))
    near = (scan.factors >= 1.0 / NEIGHBOURS * (1.0 - 1e-9)) & (scan.factors <= NEIGHBOURS * (1.0 + 1e-9))
    planar = np.maximum(x, y)
    counts = near & np.isfinite(spatial) & np.isfinite(planar) & ((spatial > 0.0) | (planar > 0.0))
    lowest = [scan.lowest[name] for name in (PLANAR_X, PLANAR_Y)]
    known = [value for value in lowest if math.isfinite(value)]
    here = scan.here
    return PlanarView(
        spatial=float(spatial[here]),
        planar_x=float(x[here]),
        planar_y=float(y[here]),
        neighbours=int(counts.sum()),
        larger=_share(spatial[counts] > LARGER * planar[counts]),
        missed=_share(overturned(spatial[counts]) & ~overturned(planar[counts])),
        lowest_spatial=scan.lowest[SPATIAL],
        lowest_planar=min(known) if known else math.nan,
    )


def _share(which: np.ndarray) -> float:
    return float(which.mean()) if len(which) else math.nan
