"""Tilts by the set-valued law of rolling resistance, of which the models take a regularised form.

The law in which the couple of a body at rest is any of at most delta N was a solver of its own until commit
8810d40c. The table beside this file was written there: `git worktree add old 8810d40c`, then

    PYTHONPATH=old/src python tests/reference/rolling_resistance.py > tests/reference/rolling_resistance.csv
"""

from __future__ import annotations

import csv
import math
import sys
from collections.abc import Iterator

import numpy as np

import rockwobble as rw

COLUMNS = ("semidiagonal", "tan_alpha", "share", "support", "release", "rolling_rate", "scale")
TIMES = np.arange(1, 9) * 0.5


def case_of(row: dict[str, str]) -> rw.Case:
    """The case of a row: a release in shares of alpha, or from rest under a multiple of El Centro."""
    cylinder = rw.Cylinder(semidiagonal=float(row["semidiagonal"]), tan_alpha=float(row["tan_alpha"]))
    scale, release = float(row["scale"]), float(row["release"])
    start = rw.InitialState(release * cylinder.alpha, rolling_rate=float(row["rolling_rate"]))
    return rw.Case(
        cylinder,
        rw.el_centro_1940().scaled(scale) if scale else None,
        initial=None if scale else start,
        duration=float(TIMES[-1]),
        rolling_resistance=float(row["share"]) * cylinder.base_radius,
        friction=50.0,
    )


def rows() -> Iterator[dict[str, str]]:
    """Bodies, lengths and starts by a fixed seed."""
    random = np.random.default_rng(28)
    for number in range(24):
        size, slenderness = math.exp(random.uniform(0.5, 2.5)), random.uniform(0.08, 0.6)
        spin = math.sqrt(9.81 / size) * 10.0 ** random.uniform(-2.0, 0.2)
        scale = 3.0 * slenderness * random.uniform(1.2, 2.5) / 0.35 if number % 4 == 0 else 0.0
        values = (size, slenderness, (0.004, 0.02, 0.1)[number % 3], ("recess", "flat")[number // 3 % 2])
        start = (random.uniform(0.2, 0.8), spin, scale)
        yield dict(zip(COLUMNS, map(str, (*values, *start)), strict=True))


if __name__ == "__main__":
    from rockwobble import reduced

    table = csv.writer(sys.stdout, lineterminator="\n")
    table.writerow([*COLUMNS, *TIMES])
    for row in rows():
        trace = reduced.simulate(case_of(row), support=row["support"], rtol=1e-11, sample_step=0.5)
        tilts = [f"{tilt:.12g}" for tilt in trace.tilt[1 : len(TIMES) + 1]]
        table.writerow([*row.values(), *(tilts + [""] * (len(TIMES) - len(tilts)))])
