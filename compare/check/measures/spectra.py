"""Layer studies, fourth part: an overturning spectrum against single runs on a fine grid of intensities."""

from __future__ import annotations

import math
from collections.abc import Iterator
from typing import Any

import numpy as np

from rockwobble import reduced
from rockwobble.models import Case, Cylinder, Trace

from ...studies.spectrum.spectrum import SERIES, overturning_spectrum
from ..bench import Array, Bench
from ..finding import Bound, Finding, at_most, none_wrong
from ..problems import polyline

TAN_ALPHA, WEAKER = 0.25, 9.0  # [-], [m/s^2]
SIZES, LEVELS = (1.5, 3.0), (0.8, 2.0, 6.0)
RISING = 1.5  # intensity that uplifts and does not overturn
# of the series, in the order of `SERIES`: in space and in the planes of x and y
OPTIONS: tuple[dict[str, Any], ...] = ({"support": "recess"}, {"plane": 0.0}, {"plane": 0.5 * math.pi})
VALUES = (
    (0.0, 0.0, 0.0), (1.0, 0.3, 0.5), (-0.9, 0.7, -0.3), (-0.5, -0.8, 0.2), (0.6, -0.3, -0.1),
    (0.0, 0.0, 0.0), (0.0, 0.0, 0.0),
)  # fmt: skip
# the ground rests for as long as a fall takes
MOTION = polyline([0.0, 0.25, 0.5, 0.75, 1.0, 1.25, 12.0], np.array(VALUES), 0.125)
UNIT = WEAKER * TAN_ALPHA / math.hypot(0.9, 0.7)  # [-] the factor at which the peak is g tan(alpha)
CELLS = Bound(1e-6, "the same run, at a tolerance ten times as fine", "alpha")
THRESHOLD = Bound(1e-12, "closed form: |a| = (g + a_z) tan(alpha) at a sample", "")
STEP = 0.015  # of the search, the default
PART = "overturning spectrum (compare/studies/spectrum)"


def check(bench: Bench) -> Iterator[Finding]:
    """Yield the findings of this part; the spectrum runs the models that are installed."""
    del bench
    found = overturning_spectrum(
        TAN_ALPHA, MOTION, semidiagonals=SIZES, intensities=LEVELS, gravity=WEAKER, probes=0, workers=1
    )
    apart, off, on_grid = [], [], []
    wrong: list[str] = []
    for series, options in zip(SERIES, OPTIONS, strict=True):
        start = _uplift(options.get("plane"))
        off.append(abs(found.searched_from[series] / start - 1.0))
        for row, size in enumerate(SIZES):
            peaks = [_peak(size, level, options) for level in LEVELS]
            apart.append(np.abs(found.peak_tilt[series][row] - peaks).max() / math.atan(TAN_ALPHA))
            fell = (level for level, peak in zip(LEVELS, peaks, strict=True) if peak > 1.0)
            on_grid.append(next(fell, 0.0))
            lowest = float(found.lowest[series][row])
            wrong += [f"{series}, {size:g} m: {what}" for what in _wrong(size, lowest, start, options)]
    yield at_most("peaks of a spectrum against single runs", max(apart), CELLS, PART)
    yield at_most("intensity of uplift of a spectrum", max(off), THRESHOLD, PART)
    told = np.nan_to_num(found.lowest_frame()["on_grid"].to_numpy())
    unlike = [f"{a:g}, not {b:g}" for a, b in zip(told, on_grid, strict=True) if a != b]
    yield none_wrong(
        "lowest intensities on the grid that are not", unlike, "single runs, 0 where none overturns", PART
    )
    reason = f"single runs from the uplift up, at each {STEP:g}"
    yield none_wrong("lowest overturning intensities that are not the lowest", wrong, reason, PART)
    usual = overturning_spectrum(TAN_ALPHA, MOTION, semidiagonals=SIZES[:1], intensities=[RISING], probes=0)
    strong = MOTION.scaled(UNIT / WEAKER * 9.81 * RISING)
    single = reduced.simulate(Case(Cylinder(semidiagonal=SIZES[0], tan_alpha=TAN_ALPHA), strong), rtol=1e-9)
    default = abs(float(usual.peak_tilt[SERIES[0]][0, 0]) - single.peak_tilt) / math.atan(TAN_ALPHA)
    yield at_most("peak of a spectrum with the gravity of its default", default, CELLS, PART)


def _wrong(size: float, lowest: float, start: float, options: dict[str, Any]) -> Iterator[str]:
    """Yield objections of single runs to the lowest intensity that overturns."""
    # within a step of the search nobody says which is the lowest
    below = np.arange(start, lowest - STEP if math.isfinite(lowest) else LEVELS[-1], STEP)
    fell = [level for level in below if _peak(size, level, options) > 1.0]
    if fell:
        yield f"{fell[0]:.4g} overturns, below {lowest:.4g}"
    if math.isfinite(lowest) and not _peak(size, lowest, options) > 1.0:
        yield f"{lowest:.4g} does not overturn"


def _peak(size: float, level: float, options: dict[str, Any]) -> float:
    """Return the peak tilt of one run [rad]."""
    cylinder = Cylinder(semidiagonal=size, tan_alpha=TAN_ALPHA)
    case = Case(cylinder, MOTION.scaled(UNIT * level), gravity=WEAKER)
    trace: Trace = reduced.simulate(case, rtol=1e-9, **options)
    return trace.peak_tilt


def _uplift(plane: float | None) -> float:
    """Return the intensity at which a cylinder that stands uplifts: (25), with the vertical component."""
    x, y, z = np.array(VALUES).T
    across: Array = np.hypot(x, y) if plane is None else np.abs(x if plane == 0.0 else y)
    return WEAKER * TAN_ALPHA / float(np.max(across - TAN_ALPHA * z)) / UNIT
