"""Layer studies: the batch kernel, each cell of a grid of peak tilts against a run of its own."""

from __future__ import annotations

import math
from collections.abc import Iterator

import numpy as np

from rockwobble.models import Case, Cylinder

from ..bench import Bench
from ..finding import Bound, Finding, at_most
from ..problems import GRAVITY, polyline

TAN_ALPHA = 0.25
SIZES = (1.5, 6.0, 20.0)
# no uplift, powers of two, which scale a record without rounding, and one that rounds
SCALES = (0.25, 1.0, 2.0, 4.0)
ROUNDED = (1.3, 2.9)
MODELS: dict[str, dict[str, object]] = {
    "recess": {"support": "recess"},
    "flat": {"support": "flat"},
    "planar": {"plane": 0.4, "restitution": "momentum"},
}
WEAKER = 0.8 * GRAVITY  # [m/s^2] not the default, which would stand in for one that is lost on its way
EXACT = Bound(0.0, "the same run, to the last bit", "alpha")
# the record scaled first rounds otherwise: magnified by the two passes; 1e-13 was measured
ROUNDING = Bound(1e-10, "rounding of the scaled record", "alpha")
PART = "batch kernel (reduced/batch.py): cells of the grid, or its scale"
VALUES = (
    (0.0, 0.0, 0.0), (1.0, 0.8, 0.2), (-0.9, 0.9, -0.3), (-0.7, -0.9, 0.2), (0.6, -0.3, -0.1),
    (0.0, 0.0, 0.0), (0.0, 0.0, 0.0),
)  # fmt: skip
# the ground rests for as long as a fall takes
MOTION = polyline([0.0, 0.3, 0.6, 0.9, 1.2, 1.5, 15.0], np.array(VALUES) * GRAVITY * TAN_ALPHA, 0.1)


def check(bench: Bench) -> Iterator[Finding]:
    """Yield the findings of this part."""
    scales, alpha = (*SCALES, *ROUNDED), math.atan(TAN_ALPHA)
    cylinders = [Cylinder(semidiagonal=size, tan_alpha=TAN_ALPHA) for size in SIZES]
    for model, options in MODELS.items():
        given = {"rtol": 1e-9, "rest_tilt": 1e-4, **options}
        grid = bench.reduced.peak_tilts(SIZES, TAN_ALPHA, MOTION, scales, gravity=WEAKER, **given)
        cases = (
            [Case(cylinder, MOTION.scaled(scale), gravity=WEAKER) for scale in scales]
            for cylinder in cylinders
        )
        alone = np.array(
            [[bench.reduced.simulate(c, sample_step=1.0, **given).peak_tilt for c in row] for row in cases]
        )
        # some stand, some rock and some overturn, or the grid would show little
        stands, falls = (alone == 0.0).any(), (alone == 0.5 * math.pi).any()
        varied = bool(stands and falls and np.ptp(alone[alone < 1.5]) > 0.1 * alpha)
        apart = np.abs(grid - alone) / alpha
        exact, rounded = apart[:, : len(SCALES)], apart[:, len(SCALES) :]
        name, value = f"peak_tilts against simulate, {model}", exact.max() if varied else math.nan
        yield at_most(f"{name}, scales that do not round", value, EXACT, PART, f"{exact.size} cells")
        yield at_most(f"{name}, scales that round", rounded.max(), ROUNDING, PART, f"{rounded.size} cells")
