"""Layer studies: the batch kernel, each cell of a grid of peak tilts against a run of its own."""

from __future__ import annotations

import math
from collections.abc import Iterator
from typing import Any

import numpy as np

from rockwobble.models import Case, Cylinder, GroundMotion

from ..bench import Bench
from ..finding import Finding, at_most
from ..polyline import polyline

LAYER = "studies"
GRAVITY = 9.81
TAN_ALPHA = 0.25
SIZES = (1.5, 6.0, 20.0)
# no uplift, powers of two, which scale a record without rounding, and one that rounds
SCALES = (0.25, 1.0, 2.0, 4.0)
ROUNDED = (1.3, 2.9)
# the record scaled first rounds otherwise: magnified by the two passes; 1e-13 was measured
ROUNDING = 1e-10
PLANE = 0.4  # [rad] azimuth of planar runs
METHODS: dict[str, dict[str, Any]] = {
    "recess": {"support": "recess"},
    "flat": {"support": "flat"},
    "planar": {"plane": PLANE, "restitution": "momentum"},
}


def check(bench: Bench) -> Iterator[Finding]:
    """Yield the findings of this part."""
    motion = _motion()
    for model, options in METHODS.items():
        given = {"rtol": 1e-9, "rest_tilt": 1e-4, **options}
        grid = bench.reduced.peak_tilts(SIZES, TAN_ALPHA, motion, [*SCALES, *ROUNDED], **given)
        alone = np.array(
            [
                [_peak(bench, size, motion.scaled(scale), given) for scale in (*SCALES, *ROUNDED)]
                for size in SIZES
            ]
        )
        alpha = math.atan(TAN_ALPHA)
        # some stand, some rock and some overturn, or the grid would show little
        varied = bool(
            (alone == 0.0).any()
            and (alone == 0.5 * math.pi).any()
            and np.ptp(alone[alone < 1.5]) > 0.1 * alpha
        )
        apart = np.abs(grid - alone) / alpha
        name = f"peak_tilts against simulate, {model}"
        count = len(SCALES)
        yield at_most(
            LAYER,
            f"{name}, scales that do not round",
            apart[:, :count].max() if varied else math.nan,
            0.0,
            unit="alpha",
            reason="the same run, to the last bit",
            part="batch kernel (reduced/batch.py): cells of the grid, or its scale",
            note=f"{apart[:, :count].size} cells",
        )
        yield at_most(
            LAYER,
            f"{name}, scales that round",
            apart[:, count:].max(),
            ROUNDING,
            unit="alpha",
            reason="rounding of the scaled record",
            part="batch kernel (reduced/batch.py): cells of the grid, or its scale",
            note=f"{apart[:, count:].size} cells",
        )


def _peak(bench: Bench, size: float, motion: GroundMotion, options: dict[str, Any]) -> float:
    cylinder = Cylinder(semidiagonal=size, tan_alpha=TAN_ALPHA)
    return float(bench.reduced.simulate(Case(cylinder, motion), sample_step=1.0, **options).peak_tilt)


def _motion() -> GroundMotion:
    values = np.array(
        [
            [0.0, 0.0, 0.0],
            [1.0, 0.8, 0.2],
            [-0.9, 0.9, -0.3],
            [-0.7, -0.9, 0.2],
            [0.6, -0.3, -0.1],
            [0.0, 0.0, 0.0],
        ]
    )
    # the ground rests for as long as a fall takes
    times = [0.0, 0.3, 0.6, 0.9, 1.2, 1.5, 15.0]
    return polyline(times, np.vstack([values, np.zeros(3)]) * GRAVITY * TAN_ALPHA, 0.1)
