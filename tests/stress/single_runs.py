"""Print how many cells of grids differ from single runs, and what the default rest threshold changes.

First 2880 cells of `peak_tilts` (El Centro and three synthetic motions, tan alpha 0.1 to 0.4) against
`simulate` at the same tolerance. Then 520 cells of single runs, with the default rest threshold against one
a hundred times smaller; one counts where two tolerances agree with both.
"""

from __future__ import annotations

import numpy as np

from rockwobble.models import Case, Cylinder, GroundMotion, el_centro_1940, synthetic_motions
from rockwobble.reduced import peak_tilts, simulate
from rockwobble.reduced.problem import REST_TILT


def grid_against_single_runs(motions: list[GroundMotion]) -> None:
    sizes, scales = np.geomspace(0.3, 40.0, 10), np.linspace(1.003, 3.0, 18)
    cells, other, off, turned = 0, 0, 0, 0
    for motion in motions:
        for tan_alpha in (0.1, 0.15, 0.25, 0.4):
            factors = scales * (9.81 * tan_alpha / motion.peak)
            peaks = peak_tilts(sizes, tan_alpha, motion, factors)
            for i, j in np.ndindex(peaks.shape):
                cylinder = Cylinder(semidiagonal=float(sizes[i]), tan_alpha=tan_alpha)
                single = simulate(Case(cylinder, motion.scaled(float(factors[j]))), rtol=1e-7).peak_tilt
                cells += 1
                other += not np.array_equal(peaks[i, j], single, equal_nan=True)
                off += not abs(peaks[i, j] - single) <= 0.02 * single
                turned += (peaks[i, j] == 0.5 * np.pi) != (single == 0.5 * np.pi)
    print(f"{cells} cells: {other} not simulate's to the bit, {off} by more than 2 %, {turned} in outcome")


def rest_threshold(motions: list[GroundMotion]) -> None:
    tan_alpha, cells = 0.2, 0
    limits = (0.02, 0.2)
    off = np.zeros(len(limits), int)
    turned = 0
    for motion in motions:
        for size in np.geomspace(0.5, 50.0, 13):
            cylinder = Cylinder(semidiagonal=float(size), tan_alpha=tan_alpha)
            for scale in np.linspace(1.01, 2.5, 10):
                shaken = motion.scaled(9.81 * tan_alpha * scale / motion.peak)
                (with_it, tight_with), (without, tight_without) = (
                    [
                        simulate(Case(cylinder, shaken), rest_tilt=rest_tilt, rtol=rtol).peak_tilt
                        for rtol in (1e-9, 1e-11)
                    ]
                    for rest_tilt in (REST_TILT, 0.01 * REST_TILT)
                )
                converged = (
                    abs(with_it - tight_with) <= 1e-3 * with_it
                    and abs(without - tight_without) <= 1e-3 * without
                )
                if converged:
                    cells += 1
                    off += [abs(with_it - without) > limit * without for limit in limits]
                    turned += (with_it == 0.5 * np.pi) != (without == 0.5 * np.pi)
    print(
        f"{cells} converged cells: {off[0]} by more than 2 %, {off[1]} by more than 20 %, {turned} in outcome"
    )


def main() -> None:
    motions = [el_centro_1940(), *synthetic_motions(3, peak=1.0, seed=3)]
    grid_against_single_runs(motions)
    rest_threshold(motions)


if __name__ == "__main__":
    main()
