"""Parts of a spectrum: some sizes in one series, each kept as it is finished."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import partial
from typing import Any, TypedDict

import numpy as np
import pandas as pd
from numpy.typing import NDArray

from rockwobble import reduced
from rockwobble.compare.metrics.pair import beyond_yield
from rockwobble.compare.storage.provenance import reduced_makers, result_fingerprint
from rockwobble.models import Case, Cylinder, GroundMotion, WobblingFrame
from rockwobble.models.case import TERMS
from rockwobble.models.cpus import usable_cpus

from ..plans import SpectrumPlan
from .search import probe_below, run_searches, search_lowest

Array = NDArray[np.float64]
SPATIAL, PLANAR_X, PLANAR_Y = "3d", "planar_x", "planar_y"
SERIES = (SPATIAL, PLANAR_X, PLANAR_Y)
TITLES = {
    SPATIAL: "3D, both components",
    PLANAR_X: "planar x (east-west)",
    PLANAR_Y: "planar y (north-south)",
}
AZIMUTH = {PLANAR_X: 0.0, PLANAR_Y: 0.5 * math.pi}  # azimuth of the plane [rad]
# Steps end at each sample of the record, so a tenth of the tolerance of `reduced.peak_tilts` costs only
# 4 % of the time, and the cells that it moves by 2 % of their tilt fall from 2 in 1000 to none.
RTOL = 1e-8
# Rest tilt (over alpha) of the random runs below a boundary: just above uplift a cylinder chatters below it
# through millions of steps. A rest may change what follows (`reduced.REST_TILT`), but not the share that
# overturns; the lowest that is found so is confirmed.
_CALM = 1e-5
# sizes of a part on a small machine: some seconds of work, with the default probes
_SIZES = 4


class Options(TypedDict, total=False):
    """Options of a reduced run."""

    support: str
    plane: float


def series_options(series: str, support: str) -> Options:
    """Return the options of a reduced run that make it one of a series; `support` is that in 3D."""
    return {"support": support} if series == SPATIAL else {"plane": AZIMUTH[series]}


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class SpectrumPart:
    """Some sizes of a spectrum in one series.

    Attributes
    ----------
    series : str
        One of `SERIES`.
    places : sequence of int
        Places of its sizes among all of the spectrum.
    semidiagonals : ndarray, shape (n,)
        [m]
    levels : ndarray, shape (n_I,)
        Intensities [g tan alpha].
    unit : float
        Factor on the motion that makes an intensity of 1.
    start : float
        Intensity at which the series uplifts.
    tan_alpha : float
    motion : GroundMotion
    plan : SpectrumPlan
    threads : int, optional
        Number of threads; it does not influence the result.
    """

    series: str
    places: Sequence[int]
    semidiagonals: Array
    levels: Array
    unit: float
    start: float
    tan_alpha: float
    motion: GroundMotion
    plan: SpectrumPlan
    threads: int | None = None

    @property
    def name(self) -> str:
        """Name, for people."""
        first, last = self.semidiagonals[0], self.semidiagonals[-1]
        return f"{TITLES[self.series]}, R = {first:.3g} m" + (f" to {last:.3g} m" if last > first else "")

    def key(self) -> str:
        """Hash that identifies its result."""
        plan, motion = self.plan, self.motion
        terms = (name for name in TERMS if hasattr(plan, name))
        named = ("gravity", "slab_mass_ratio", *terms, "support", "search_step", "probes")
        return result_fingerprint(
            {name: getattr(plan, name) for name in named}
            | {name: getattr(self, name) for name in ("series", "semidiagonals", "levels", "unit", "start")}
            | {"places": list(self.places), "tan_alpha": self.tan_alpha, "rtol": [RTOL, _CALM]}
            | {"motion": (motion.acceleration, motion.time_step)},
            reduced_makers(),
        )


def run_part(part: SpectrumPart) -> pd.DataFrame:
    """Return one row for each size: lowest, below and the peak tilt at each level, by its place."""
    workers, sizes, levels, plan = part.threads, part.semidiagonals, part.levels, part.plan
    elastic = partial(
        reduced.peak_tilts,
        tan_alpha=part.tan_alpha,
        motion=part.motion,
        rtol=RTOL,
        gravity=plan.gravity,
        slab_mass_ratio=plan.slab_mass_ratio,
        rolling_resistance=plan.rolling_resistance,
        tendon=plan.tendon,
        **series_options(part.series, plan.support),
    )
    body = WobblingFrame(Cylinder(semidiagonal=1.0, tan_alpha=part.tan_alpha), plan.slab_mass_ratio)
    case = Case(body, part.motion, tendon=plan.tendon)

    def run(semidiagonals: Array, **given: Any) -> Array:
        tilts = elastic(semidiagonals, **given)
        return np.where(beyond_yield(tilts, case), math.nan, tilts)

    peaks = run(sizes, scales=part.unit * levels, workers=workers)
    searches = [
        search_lowest(levels, known, start=part.start, step=plan.search_step, alpha=math.atan(part.tan_alpha))
        for known in peaks
    ]
    found = run_searches(searches, partial(_at_levels, run, sizes, part.unit), workers=workers)
    index = SERIES.index(part.series)
    probing = [
        probe_below(part.start, levels[-1], each, probes=plan.probes, seed=(index, place))
        for place, each in zip(part.places, found, strict=True)
    ]
    calm = partial(_at_levels, partial(run, rest_tilt=_CALM), sizes, part.unit)
    lowest, below = np.array(run_searches(probing, calm, workers=workers)).T
    return pd.DataFrame(
        {"lowest": lowest, "below": below} | {str(place): column for place, column in enumerate(peaks.T)}
    )


def blocks_of_sizes(count: int) -> list[range]:
    """Return the places of the sizes of each part: as many as there are threads, and some on few."""
    step = max(_SIZES, usable_cpus())
    return [range(first, min(first + step, count)) for first in range(0, count, step)]


def _at_levels(run: Callable[..., Array], sizes: Array, unit: float, i: int, levels: Array) -> Array:
    return run(sizes[i : i + 1], scales=unit * levels, workers=1).ravel()
