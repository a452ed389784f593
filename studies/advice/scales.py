"""One case over scales of its ground motion, and planar analysis over scales of other records."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from functools import partial

import numpy as np
import pandas as pd

from rockwobble import reduced
from rockwobble.compare.metrics.pair import beyond_yield, overturned
from rockwobble.compare.metrics.statistics import share_interval
from rockwobble.models import Case
from rockwobble.models.support import RECESS

from ..plans import STEP
from ..spectrum.parts import (
    AZIMUTH,
    RTOL,
    SERIES,
    SPATIAL,
    intensity_unit,
    series_options,
    uplift_factor,
)
from ..spectrum.search import Array, lowest_on_grid, run_searches, search_lowest
from ..spectrum.verification import CHECK_RTOL, CONFIRMING
from .members import tendon_uplift_factor

# twelve scales for each factor of two, from a quarter to sixteen times the record as it is given
FACTORS: Array = 2.0 ** (np.arange(-24, 49) / 12.0)
# [-] least and largest scale of shaking that is as strong as that given: 12 % either way. A peak acceleration
# says no more: between the geometric mean of both components of a record and their resultant lies a factor
# of 1.09 to 1.28 (5 to 95 % of the 22 far-field pairs of FEMA P-695), between these scales one of 1.26
AS_STRONG = (2.0 ** (-1.0 / 6.0), 2.0 ** (1.0 / 6.0))
# scales that are run between them, evenly in the logarithm, before those about the extrema
AS_STRONG_COUNT = 385
# how often scales between are run about so many of the largest, and of the least, tilts
REFINEMENTS, EXTREMA = 3, 8
# scales of the records at which planar analysis is compared with 3D
PLANAR_SCALES = (0.5, 2.0**-0.5, 1.0, 2.0**0.5, 2.0)
# ratio of peak tilts from which one is larger: below it is rounding and the step of the solution
LARGER = 1.01
_SCALES = ["series", "factor", "peak_tilt", "yields"]
_LOWEST = ["series", "factor", "confirmed", "start"]


def scan_scales(case: Case, support: str = RECESS) -> tuple[pd.DataFrame, pd.DataFrame]:
    """Run a case over scales of its ground motion; empty without shaking.

    Returns
    -------
    scales : DataFrame
        series, factor [-], peak_tilt [rad], yields, see `beyond_yield`: "3d", and "planar_x" and "planar_y"
        unless the case is a release, of which a planar analysis knows nothing.
    lowest : DataFrame
        Lowest factor found to overturn, by series, NaN where none does; confirmed,
        whether
        it does so to a tighter tolerance and under a record that differs by `NUDGE`, too; and start, the
        factor at which it uplifts and from which was searched: 0 for a release, inf where it never uplifts.
    """
    motion = case.motion
    if motion is None or motion.peak == 0.0:
        return pd.DataFrame(columns=_SCALES), pd.DataFrame(columns=_LOWEST)
    tan_alpha, gravity = case.cylinder.tan_alpha, case.gravity
    step = STEP * intensity_unit(tan_alpha, motion, gravity)
    tables, lowest = [], []
    for name in (SPATIAL,) if case.is_release else SERIES:
        run = partial(_peaks, case, series=name, support=support)

        def at(_: int, factors: Array, run: Callable[[Array], Array] = run) -> Array:
            return run(factors)

        peaks = run(FACTORS)
        start, alpha, stands = 0.0, case.cylinder.alpha, not case.is_release
        if stands:
            plane = AZIMUTH.get(name)
            start = uplift_factor(motion, tan_alpha, gravity, plane=plane, until=case.length)
            start *= tendon_uplift_factor(case)
        search = search_lowest(FACTORS, peaks, start=start, step=step, alpha=alpha, stands=stands)
        searched = run_searches([search], at)[0]
        factor = float(np.fmin(searched, lowest_on_grid(FACTORS, peaks[None])[0]))
        again = run(factor * np.array(CONFIRMING), rtol=CHECK_RTOL)
        lowest.append((name, factor, bool(overturned(again).all()), start))
        columns = {"series": name, "factor": FACTORS, "peak_tilt": peaks, "yields": beyond_yield(peaks, case)}
        tables.append(pd.DataFrame(columns))
    return pd.concat(tables, ignore_index=True), pd.DataFrame(lowest, columns=_LOWEST)


def scan_as_strong(case: Case, support: str, peak_tilt: float) -> pd.DataFrame:
    """Run a case over equally strong shaking: factor [-], increasing, peak_tilt [rad] and yields.

    Scales evenly in the logarithm over `AS_STRONG`, then, `REFINEMENTS` times, between the largest of the
    tilts and their neighbours and between the least and theirs: tilts change fastest there. No row without
    shaking, or where the case as given, of this peak tilt [rad], overturns.
    """
    motion = case.motion
    if motion is None or motion.peak == 0.0 or overturned(np.array([peak_tilt]))[0]:
        return pd.DataFrame(columns=["factor", "peak_tilt", "yields"], dtype=float)
    run = partial(_peaks, case, series=SPATIAL, support=support)
    factors = np.unique([*np.geomspace(*AS_STRONG, AS_STRONG_COUNT), 1.0])
    peaks = run(factors)
    for _ in range(REFINEMENTS):
        order = np.argsort(peaks)
        extreme = np.concatenate([order[:EXTREMA], order[-EXTREMA:]])
        left = np.unique(np.concatenate([extreme - 1, extreme]))
        left = left[(left >= 0) & (left < len(factors) - 1)]
        between = np.sqrt(factors[left] * factors[left + 1])
        factors = np.concatenate([factors, between])
        peaks = np.concatenate([peaks, run(between)])
        order = np.argsort(factors)
        factors, peaks = factors[order], peaks[order]
    return pd.DataFrame({"factor": factors, "peak_tilt": peaks, "yields": beyond_yield(peaks, case)})


def planar_runs(cases: Sequence[Case], support: str = RECESS) -> pd.DataFrame:
    """Run cases from rest at each of `PLANAR_SCALES` in 3D and in the planes of both components.

    Columns: member, scale, and the peak tilts 3d, planar_x, planar_y [rad].
    """
    scales = np.array(PLANAR_SCALES)
    tables = []
    for case in cases:
        peaks = {name: _peaks(case, scales, series=name, support=support) for name in SERIES}
        tables.append(pd.DataFrame({"member": case.name, "scale": scales, **peaks}))
    return pd.concat(tables, ignore_index=True)


def planar_shares(runs: pd.DataFrame) -> list[dict[str, float]]:
    """Share of records at each scale where 3D tilts more than both planes, and overturns where neither does.

    Keys: scale; moving, records that uplift in any; larger and unconservative, counts of these, with
    the shares NAME_share and the ends of their intervals, NAME_low and NAME_high.
    """
    rows = []
    for scale, group in runs.groupby("scale"):
        space, x, y = (group[name].to_numpy(float) for name in SERIES)
        planar = np.fmax(x, y)
        counts = np.isfinite(space) & np.isfinite(planar) & ((space > 0.0) | (planar > 0.0))
        shares = {
            "larger": (space > LARGER * planar)[counts],
            "unconservative": (overturned(space) & ~overturned(planar))[counts],
        }
        row: dict[str, float] = {"scale": float(str(scale)), "moving": int(counts.sum())}
        for name, which in shares.items():
            share = share_interval(int(which.sum()), len(which))
            row |= share.columns(name) | {name: int(which.sum()), f"{name}_share": share.value}
        rows.append(row)
    return rows


def _peaks(case: Case, factors: Array, *, series: str, support: str, rtol: float = RTOL) -> Array:
    """Peak tilts of a case at factors on its motion (n,) [rad]; NaN stays NaN."""
    peaks = np.full(len(factors), math.nan)
    known = np.isfinite(factors)
    options = series_options(series, support)
    peaks[known] = reduced.peak_tilts_of_case(case, factors[known], rtol=rtol, **options)
    return peaks
