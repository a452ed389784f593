"""Runs of a spectrum: ground motion of each series, its uplift factor, and cached parts."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass, replace
from functools import partial
from typing import Any, TypedDict

import numpy as np
import pandas as pd
from numpy.typing import NDArray

from rockwobble import reduced
from rockwobble.compare.metrics.pair import beyond_yield
from rockwobble.compare.runs.choice import require_runnable
from rockwobble.compare.storage.provenance import reduced_makers, result_fingerprint
from rockwobble.models import Case, Cylinder, GroundMotion, Run, WobblingFrame
from rockwobble.models.cpus import usable_cpus
from rockwobble.models.number_checks import require_increasing
from rockwobble.models.support import support_named

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
    """Options of a reduced run for one series; `support`: support in 3D."""
    return {"support": support} if series == SPATIAL else {"plane": AZIMUTH[series]}


def intensity_unit(tan_alpha: float, motion: GroundMotion, gravity: float) -> float:
    """Factor that brings the peak horizontal resultant of `motion` to g tan(alpha).

    Raises
    ------
    ValueError
        If the motion has no horizontal component to scale.
    """
    if motion.peak == 0.0:
        raise ValueError("motion must have a horizontal acceleration to scale, got none")
    return gravity * tan_alpha / motion.peak


def uplift_factor(
    motion: GroundMotion,
    tan_alpha: float,
    gravity: float,
    *,
    plane: float | None = None,
    until: float = math.inf,
) -> float:
    """Factor on a ground motion at which a cylinder at rest uplifts [-]; inf if none does.

    Without rolling resistance, which holds it longer.

    Exact: f of equation (25) is convex between samples, and so is largest at one of them.

    Parameters
    ----------
    motion : GroundMotion
    tan_alpha : float
    gravity : float
        [m/s^2]
    plane : float, optional
        Azimuth of the plane of planar motion [rad]. Default: motion in space.
    until : float, optional
        End of the run [s].
    """
    samples = motion.until(until)
    x, y = samples[:, 0], samples[:, 1]
    drive = np.hypot(x, y) if plane is None else np.abs(x * math.cos(plane) + y * math.sin(plane))
    if motion.has_vertical:
        drive = drive - samples[:, 2] * tan_alpha
    largest = float(drive.max())
    return gravity * tan_alpha / largest if largest > 0.0 else math.inf


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class SpectrumRuns:
    """Cylinders of one slenderness under one record, over size and intensity, in three series.

    Attributes
    ----------
    tan_alpha : float
        Slenderness b/h [-].
    motion : GroundMotion
        The record at its own scale.
    plan : SpectrumPlan
        Support of the model in three dimensions, terms of the body, and search.
    semidiagonals : ndarray, shape (n_R,)
        Sizes R [m].
    intensities : ndarray, shape (n_I,)
        Peak of the horizontal resultant over g tan(alpha) [-]; 1 is the threshold of uplift in three
        dimensions without vertical motion.
    searched_from : mapping
        For each of `SERIES` the intensity at which it uplifts [-], from which the lowest is searched: up to
        where something overturns, or to the last of the grid. inf where it uplifts at none.
    """

    tan_alpha: float
    motion: GroundMotion
    plan: SpectrumPlan
    semidiagonals: Array
    intensities: Array
    searched_from: Mapping[str, float]

    @property
    def alpha(self) -> float:
        """Slenderness [rad]."""
        return math.atan(self.tan_alpha)

    @property
    def unit(self) -> float:
        """Factor on the record that makes an intensity of 1 [-]."""
        return intensity_unit(self.tan_alpha, self.motion, self.plan.gravity)

    @property
    def scales(self) -> Array:
        """Factor on the record for each intensity (n_I,) [-]."""
        return self.intensities * self.unit

    def case(self, size: float, scale: float) -> Case:
        """Case of one cylinder, with ample friction if the plan states none."""
        plan = self.plan
        return Case(
            WobblingFrame(Cylinder(semidiagonal=size, tan_alpha=self.tan_alpha), plan.slab_mass_ratio),
            self.motion.scaled(scale),
            gravity=plan.gravity,
            friction=1.0 if plan.friction is None else plan.friction,
            rolling_resistance=plan.rolling_resistance,
            tendon=plan.tendon,
        )


def runs_of(tan_alpha: float, motion: GroundMotion, plan: SpectrumPlan) -> SpectrumRuns:
    """Runs specified by the options of a spectrum.

    Raises
    ------
    ValueError
        If an axis is not increasing and positive, the motion is still, an option is out of range for the
        smallest of the sizes or for the largest, or all of them slide and nothing more.
    """
    sizes, levels = (
        np.linspace(*default) if given is None else require_increasing(name, given)
        for name, given, default in (
            ("semidiagonals", plan.semidiagonals, SpectrumPlan.SIZES),
            ("intensities", plan.intensities, SpectrumPlan.INTENSITIES),
        )
    )
    unit = intensity_unit(tan_alpha, motion, plan.gravity)
    uplifted = partial(uplift_factor, motion, tan_alpha, plan.gravity)
    column = WobblingFrame(Cylinder(semidiagonal=1.0, tan_alpha=tan_alpha), plan.slab_mass_ratio)
    held = 1.0 if plan.tendon is None else plan.tendon.uplift_factor(column)
    runs = SpectrumRuns(
        tan_alpha=tan_alpha,
        motion=motion,
        plan=plan,
        semidiagonals=sizes,
        intensities=levels,
        searched_from={name: held * uplifted(plane=AZIMUTH.get(name)) / unit for name in SERIES},
    )
    for size in (sizes[0], sizes[-1]):
        case = runs.case(float(size), 1.0)
        bound = case.friction_of_uplift
        if plan.friction is not None and plan.friction < bound and support_named(plan.support).lets_slide:
            raise ValueError(
                f"friction {plan.friction:g} is below b/h = {bound:g}: on flat ground every size slides "
                "alike and none uplifts; a fragility with a gap, or reduced.peak_displacements, says how far"
            )
        require_runnable(case, Run(None, plan.support))
    return runs


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class SpectrumPart:
    """Some sizes of a spectrum in one series.

    Attributes
    ----------
    series : str
        One of `SERIES`.
    places : range
        Places of its sizes among all of the spectrum.
    runs : SpectrumRuns
        Runs of the whole spectrum.
    threads : int, optional
        Number of threads; it does not influence the result.
    """

    series: str
    places: range
    runs: SpectrumRuns
    threads: int | None = None

    @property
    def semidiagonals(self) -> Array:
        """Sizes [m]."""
        return self.runs.semidiagonals[self.places.start : self.places.stop]

    @property
    def name(self) -> str:
        """Description of the part, for the progress callback."""
        first, last = self.semidiagonals[0], self.semidiagonals[-1]
        return f"{TITLES[self.series]}, R = {first:.3g} m" + (f" to {last:.3g} m" if last > first else "")

    def key(self) -> str:
        """Hash that identifies its result."""
        runs = self.runs
        plan = replace(runs.plan, semidiagonals=None, intensities=None, friction=None)  # not of its runs
        motion = runs.motion.acceleration, runs.motion.time_step
        start = runs.searched_from[self.series]
        inputs = [self.series, list(self.places), self.semidiagonals, runs.intensities, start]
        return result_fingerprint([*inputs, plan, runs.tan_alpha, motion, RTOL, _CALM], reduced_makers())


def run_part(part: SpectrumPart) -> pd.DataFrame:
    """One row per size: lowest, below, and by index the peak tilt at each level."""
    runs, plan, sizes, workers = part.runs, part.runs.plan, part.semidiagonals, part.threads
    elastic = partial(
        reduced.peak_tilts,
        tan_alpha=runs.tan_alpha,
        motion=runs.motion,
        rtol=RTOL,
        gravity=plan.gravity,
        slab_mass_ratio=plan.slab_mass_ratio,
        rolling_resistance=plan.rolling_resistance,
        tendon=plan.tendon,
        **series_options(part.series, plan.support),
    )
    case = runs.case(float(sizes[0]), 1.0)  # the yield tilt is equal for all sizes

    def run(semidiagonals: Array, intensities: Array, **given: Any) -> Array:
        tilts = elastic(semidiagonals, scales=runs.unit * intensities, **given)
        return np.where(beyond_yield(tilts, case), math.nan, tilts)

    def of_one(i: int, intensities: Array, **given: Any) -> Array:
        return run(sizes[i : i + 1], intensities, workers=1, **given).ravel()

    levels, start = runs.intensities, runs.searched_from[part.series]
    peaks = run(sizes, levels, workers=workers)
    searches = [
        search_lowest(levels, known, start=start, step=plan.search_step, alpha=runs.alpha) for known in peaks
    ]
    lowest = run_searches(searches, of_one, workers=workers)
    index = SERIES.index(part.series)
    probing = [
        probe_below(start, levels[-1], each, probes=plan.probes, seed=(index, place))
        for place, each in zip(part.places, lowest, strict=True)
    ]
    probed = run_searches(probing, partial(of_one, rest_tilt=_CALM), workers=workers)
    table = pd.DataFrame(probed, columns=["lowest", "below"], dtype=float)
    of_levels = pd.DataFrame(peaks, columns=[str(place) for place in range(len(levels))], dtype=float)
    return pd.concat([table, of_levels], axis=1)


def blocks_of_sizes(count: int) -> list[range]:
    """Indices of the sizes of each part: as many as there are threads, at least `_SIZES`."""
    step = max(_SIZES, usable_cpus())
    return [range(first, min(first + step, count)) for first in range(0, count, step)]
