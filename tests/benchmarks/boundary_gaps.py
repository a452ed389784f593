"""How often a fine scan undercuts the overturning boundary of a spectrum, with random probes and without.

`python tests/benchmarks boundary_gaps --seed 7` draws cylinders and supports at random, searches the lowest
intensity of the strongest 15 s of El Centro that overturns each, with and without the probes below it, and
runs every 0.002 g tan(alpha) from uplift up to the first that overturns. A boundary is undercut where that
is more than the step of the search below it. A gap narrower than the spacing of the probes may stay: what is
stated is a bound on the share of what lies below that overturns, and the scan says how often that holds.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from functools import partial
from time import perf_counter
from typing import TYPE_CHECKING, Any

import numpy as np

from rockwobble import reduced
from rockwobble.compare.metrics.pair import overturned
from rockwobble.compare.runs.progress import stages
from rockwobble.models import GroundMotion, el_centro_1940
from rockwobble.studies.plans import PROBES, STEP
from rockwobble.studies.spectrum.maps import intensity_unit, uplift_factor
from rockwobble.studies.spectrum.parts import RTOL
from rockwobble.studies.spectrum.search import (
    gap_bound,
    probe_below,
    run_searches,
    search_lowest,
)

from .console import options_of, show, tell

if TYPE_CHECKING:
    from numpy.typing import NDArray

    Array = NDArray[np.float64]

SCANS, FINE = 20, 2e-3  # [g tan(alpha)]
SECONDS = 15.0
SIZES, SLENDERNESS = (2.0, 16.0), (0.08, 0.4)
GRID = np.linspace(1.0, 12.0, 100)  # that of a spectrum
BLOCK = 50  # levels of a scan between two looks


def scan(size: float, tan_alpha: float, support: str, probes: int, seed: int) -> dict[str, float | str]:
    """Return the boundary without and with probes, that of the scan, the gaps and the cost of either."""
    record = el_centro_1940()
    motion = GroundMotion(record.acceleration[: round(SECONDS / record.time_step)], record.time_step)
    unit = intensity_unit(tan_alpha, motion, 9.81)
    start = uplift_factor(motion, tan_alpha, 9.81) / unit
    count = 0

    def peaks(levels: Array) -> Array:
        options: dict[str, Any] = {"support": support, "rtol": RTOL, "workers": 1}
        return reduced.peak_tilts([size], tan_alpha, motion, unit * levels, **options).ravel()

    def at(_: int, levels: Array) -> Array:
        nonlocal count
        count += len(levels)
        return peaks(levels)

    run = partial(run_searches, peak_tilts=at, workers=1)
    known = peaks(GRID)
    search = partial(search_lowest, GRID, known, start=start, step=STEP, alpha=math.atan(tan_alpha))
    begun, count = perf_counter(), 0
    (found,) = run([search()])
    searched, seconds = count, perf_counter() - begun
    probed = probe_below(start, float(GRID[-1]), found, probes=probes, seed=(seed,))
    ((lowest, _),) = run([probed])
    both, whole = count, perf_counter() - begun
    levels = np.arange(start, np.nan_to_num(found, nan=GRID[-1]), FINE)
    fell = np.concatenate([overturned(peaks(levels[i : i + BLOCK])) for i in range(0, len(levels), BLOCK)])
    least = float(levels[fell][0]) if fell.any() else found
    below = fell[levels < np.nan_to_num(lowest, nan=GRID[-1])]
    return {
        "support": support,
        "R [m]": size,
        "tan alpha": tan_alpha,
        "search": found,
        "probed": lowest,
        "scan": least,
        "gap before": _gap(found, least),
        "gap after": _gap(lowest, least),
        "share below": float(below.mean()) if len(below) else 0.0,
        "searched": searched,
        "runs": both,
        "cost": (whole / max(seconds, 1e-9)),
        "of a spectrum": (len(GRID) + both) / (len(GRID) + searched),
    }


def _gap(stated: float, least: float) -> float:
    return max(np.nan_to_num(stated, nan=GRID[-1]) - least, 0.0) if math.isfinite(least) else 0.0


def main(arguments: Sequence[str] | None = None) -> int:
    """Print the table and how many boundaries are undercut by more than a step."""
    import pandas as pd

    parser = options_of("boundary_gaps", "How often the overturning boundary is undercut by a fine scan.")
    parser.add_argument("--seed", type=int, default=1, help="of cylinders and probes (%(default)s)")
    parser.add_argument("--scans", type=int, default=SCANS, help="cylinders (%(default)s)")
    parser.add_argument("--probes", type=int, default=PROBES, help="below each boundary (%(default)s)")
    given = parser.parse_args(arguments)
    random, rows = np.random.default_rng(given.seed), []
    stage = stages(tell, [1.0] * given.scans)
    for place in range(given.scans):
        size, tan_alpha = (
            math.exp(random.uniform(math.log(ends[0]), math.log(ends[1]))) for ends in (SIZES, SLENDERNESS)
        )
        with stage(f"R = {size:.3g} m, tan alpha = {tan_alpha:.3g}"):
            support = ("recess", "flat")[place % 2]
            rows.append(scan(size, tan_alpha, support, given.probes, given.seed + place))
    table = pd.DataFrame(rows)
    formats = {str(name): "" if name == "support" else ".4g" for name in table}
    show(table, "Lowest overturning intensity [g tan alpha], and what lies below it", formats)
    for name in ("before", "after"):
        gaps = table[f"gap {name}"]
        print(
            f"undercut by more than {STEP:g} {name} the probes: {(gaps > STEP).sum()} of {len(gaps)}, "
            f"largest {gaps.max():.3g}"
        )
    most, shares = gap_bound(given.probes), table["share below"]
    print(
        f"of {given.probes} probes none overturns: at most {most:.2%} of what lies below does (95 %); "
        f"by the scan more does in {(shares > most).sum()} of {len(shares)}, at most {shares.max():.2%}"
    )
    cost = ("cost", "of a spectrum")
    print("median cost of search and probes over the search, in time and, with the grid, in runs: ", end="")
    print(", ".join(f"{table[name].median():.2g}" for name in cost))
    return 0
