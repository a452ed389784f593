"""One case over scales of its ground motion, and planar analysis over scales of other records."""

from __future__ import annotations

import dataclasses
import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import partial

import numpy as np
import pandas as pd

from rockwobble import reduced
from rockwobble.models import Case
from rockwobble.models.cpus import in_threads

from ...metrics.order_statistics import share_interval
from ...metrics.pair import is_release
from ...metrics.tilt import overturned
from ..spectrum.search import STEP, Array, lowest_on_grid, run_searches, search_lowest
from ..spectrum.spectrum import RTOL, SERIES, SPATIAL, intensity_unit, series_options, uplift_of_series
from ..spectrum.tables import CHECK_RTOL, NUDGE

# twelve scales for each factor of two, from a quarter to sixteen times the record as it is given
FACTORS: Array = 2.0 ** (np.arange(-24, 49) / 12.0)
# nobody knows the intensity of shaking to better than this: two steps of the scales either way
BESIDE = 2
# scales of the records at which planar analysis is held against 3D
PLANAR_SCALES = (0.5, 2.0**-0.5, 1.0, 2.0**0.5, 2.0)
# ratio of peak tilts from which one is larger: below it is rounding and the step of the solution
LARGER = 1.01


@dataclass(frozen=True, slots=True, kw_only=True)
class Lowest:
    """The lowest factor on the ground motion found to overturn, of one series.

    Attributes
    ----------
    factor : float
        NaN where none is.
    confirmed : bool
        Whether it overturns to a tighter tolerance and under a record that differs by a hair, too.
    start : float
        Factor at which it uplifts, from which was searched; 0 for a release, inf where it uplifts at none.
    """

    factor: float
    confirmed: bool
    start: float


def scan_scales(case: Case, support: str = "recess") -> tuple[pd.DataFrame, dict[str, Lowest]]:
    """Run a case over scales of its ground motion; nothing where there is none to scale.

    Returns
    -------
    DataFrame
        series, factor [-], peak_tilt [rad]: "3d", and "planar_x" and "planar_y" unless the case is a release,
        of which a planar analysis knows nothing.
    dict
        The lowest that overturns, of each series.
    """
    motion = case.motion
    if motion is None or motion.peak == 0.0:
        return pd.DataFrame(columns=["series", "factor", "peak_tilt"]), {}
    tan_alpha, gravity = case.cylinder.tan_alpha, case.gravity
    step = STEP * intensity_unit(tan_alpha, motion, gravity)
    tables, lowest = [], {}
    for name in (SPATIAL,) if is_release(case) else SERIES:
        run = partial(_peak, case, name, support)

        def at(_: list[int], factor: float, run: Callable[[float], float] = run) -> Array:
            return np.array([run(factor)])

        run(FACTORS[0])  # compiles, where that is due, once and not in each thread
        peaks = np.array(list(in_threads(run, FACTORS)))
        start = 0.0
        if not is_release(case):
            start = uplift_of_series(name, motion, tan_alpha, gravity, until=case.length)
        search = search_lowest(FACTORS, peaks, start=start, step=step, alpha=case.cylinder.alpha)
        found = run_searches([search], at)[0]
        factor = float(np.fmin(found, lowest_on_grid(FACTORS, peaks[None])[0]))
        again = [run(factor * nudge, rtol=CHECK_RTOL) for nudge in (1.0, 1.0 - NUDGE, 1.0 + NUDGE)]
        lowest[name] = Lowest(factor=factor, confirmed=bool(overturned(again).all()), start=start)
        tables.append(pd.DataFrame({"series": name, "factor": FACTORS, "peak_tilt": peaks}))
    return pd.concat(tables, ignore_index=True), lowest


def planar_runs(cases: Sequence[Case], support: str = "recess") -> pd.DataFrame:
    """Run cases from rest at each of `PLANAR_SCALES` in 3D and in the planes of both components.

    Columns: member, scale, and the peak tilts 3d, planar_x, planar_y [rad].
    """
    tables = []
    for case in cases:
        assert case.motion is not None
        peaks = {
            name: reduced.peak_tilts(
                [case.cylinder.semidiagonal],
                case.cylinder.tan_alpha,
                case.motion,
                PLANAR_SCALES,
                gravity=case.gravity,
                rtol=RTOL,
                **series_options(name, support),
            )[0]
            for name in SERIES
        }
        tables.append(pd.DataFrame({"member": case.name, "scale": PLANAR_SCALES, **peaks}))
    return pd.concat(tables, ignore_index=True)


def planar_chances(runs: pd.DataFrame) -> list[dict[str, float]]:
    """Return for each scale how often 3D tilts more than both planes, and overturns where neither does.

    Keys: scale; moving, records that uplift in any; larger and missed, counts of these, with the shares
    larger_share, missed_share and the ends of their intervals (_low, _high).
    """
    rows = []
    for scale, group in runs.groupby("scale"):
        space, x, y = (group[name].to_numpy(float) for name in SERIES)
        planar = np.fmax(x, y)
        counts = np.isfinite(space) & np.isfinite(planar) & ((space > 0.0) | (planar > 0.0))
        found = {
            "larger": (space > LARGER * planar)[counts],
            "missed": (overturned(space) & ~overturned(planar))[counts],
        }
        row: dict[str, float] = {"scale": float(str(scale)), "moving": int(counts.sum())}
        for name, which in found.items():
            share = share_interval(int(which.sum()), len(which))
            ends = {"share": share.value, "low": share.low, "high": share.high}
            row |= {name: int(which.sum()), **{f"{name}_{end}": value for end, value in ends.items()}}
        rows.append(row)
    return rows


def _peak(case: Case, series: str, support: str, factor: float, rtol: float = RTOL) -> float:
    assert case.motion is not None
    if math.isnan(factor):
        return math.nan
    scaled = dataclasses.replace(case, motion=case.motion.scaled(factor))
    return reduced.simulate(
        scaled, rtol=rtol, sample_step=case.length, **series_options(series, support)
    ).peak_tilt
