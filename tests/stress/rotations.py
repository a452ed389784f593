"""Print how many of 400 ground motions give another peak when they are rotated.

Half of them are planar at first: the second component begins later. Synthetic motions of the project (seed
4), sizes from 0.5 to 50 m, tan alpha from 0.1 to 1. One counts where perturbed copies (1e-9 and 1e-7 of the
record) give it alike.
"""

from __future__ import annotations

import numpy as np

from rockwobble.models import Case, Cylinder, GroundMotion, synthetic_motions
from rockwobble.reduced import simulate

COUNT = 400


def main() -> None:
    random = np.random.default_rng(4)
    firm, off, turned = np.zeros(2, int), np.zeros(2, int), np.zeros(2, int)
    for index, motion in enumerate(synthetic_motions(COUNT, peak=1.0, seed=4)):
        late = index % 2
        acceleration = np.array(motion.acceleration)
        if late:
            acceleration[: int(random.uniform(0.1, 0.5) * len(acceleration)), 1] = 0.0
        tan_alpha = 10.0 ** random.uniform(-1.0, 0.0)
        cylinder = Cylinder(semidiagonal=10.0 ** random.uniform(-0.3, 1.7), tan_alpha=tan_alpha)
        scale = 9.81 * tan_alpha * random.uniform(1.05, 3.0) / np.hypot(*acceleration.T).max()
        shaken = GroundMotion(acceleration, motion.time_step).scaled(scale)
        copies = [shaken.scaled(1.0 + size) for size in (1e-9, -1e-9, 1e-7, -1e-7)]
        runs = (shaken, shaken.rotated(random.uniform(-np.pi, np.pi)), *copies)
        plain, rotated, *perturbed = (simulate(Case(cylinder, run), rtol=1e-9).peak_tilt for run in runs)
        if not all(abs(peak - plain) <= 1e-3 * plain for peak in perturbed):
            continue
        firm[late] += 1
        if not abs(rotated - plain) <= 0.02 * plain:
            off[late] += 1
            turned[late] += (rotated == 0.5 * np.pi) != (plain == 0.5 * np.pi)
    for late, kind in enumerate(("two components from the start", "planar at first")):
        print(f"{kind}: {off[late]} of {firm[late]} off by more than 2 %, {turned[late]} in outcome")


if __name__ == "__main__":
    main()
