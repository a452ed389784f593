"""Print how many cells of a grid change where the same ground motion is sampled more finely.

Synthetic motions of the project (seed 3), interpolated by their own straight lines: 20 motions, 30 sizes,
30 intensities. A cell counts where a perturbed copy (1e-7 of the record) and a tighter tolerance give it
alike. The finest sampling is the reference. ``resampling.py --keep other.npy`` keeps the peaks of another
version, and ``resampling.py other.npy`` compares these with it too.
"""

from __future__ import annotations

import sys

import numpy as np

from rockwobble.models import GroundMotion, synthetic_motions
from rockwobble.reduced import peak_tilts

TAN_ALPHA = 0.2
PARTS = (1, 2, 5)  # of a sample of 0.01 s
SIZES = np.geomspace(0.5, 50.0, 30)
SCALES = np.linspace(1.02, 3.5, 30)
DIFFERENT = 0.02


def divided(motion: GroundMotion, parts: int) -> GroundMotion:
    """Return the same function of time with `parts` times as many samples."""
    whole = np.arange(len(motion.acceleration))
    at = np.arange((len(whole) - 1) * parts + 1) / parts
    columns = [np.interp(at, whole, column) for column in motion.acceleration.T]
    return GroundMotion(np.column_stack(columns), motion.time_step / parts)


def peaks(motions: list[GroundMotion], parts: int, rtol: float = 1e-8) -> np.ndarray:
    """Return the peaks (motions, sizes, scales) [rad] at one sampling."""
    return np.array(
        [
            peak_tilts(SIZES, TAN_ALPHA, divided(motion, parts), SCALES, rtol=rtol, rest_tilt=1e-8)
            for motion in motions
        ]
    )


def main() -> None:
    motions = synthetic_motions(20, peak=9.81 * TAN_ALPHA, seed=3)
    found = {str(parts): peaks(motions, parts) for parts in PARTS}
    if "--keep" in sys.argv:
        np.save(sys.argv[-1], np.stack([found[str(parts)] for parts in PARTS]))
        return
    copies = [peaks([motion.scaled(1.0 + 1e-7) for motion in motions], 1), peaks(motions, 1, rtol=1e-10)]
    tables = {"now": found}
    if len(sys.argv) > 1:
        tables["kept"] = dict(zip(map(str, PARTS), np.load(sys.argv[1]), strict=True))
    reference = found[str(PARTS[-1])]
    firm = np.isfinite(reference) & np.isfinite(found["1"])
    for copy in copies:
        firm &= np.abs(copy - found["1"]) <= 1e-3 * found["1"]
    print(f"{firm.size} cells, {firm.sum()} of them not sensitive")
    for name, cells in tables.items():
        for parts in PARTS:
            peak = np.nan_to_num(cells[str(parts)], nan=np.inf)
            off = firm & (np.abs(peak - reference) > DIFFERENT * reference)
            turned = off & ((peak == 0.5 * np.pi) != (reference == 0.5 * np.pi))
            share = 100.0 * off.sum() / firm.sum()
            print(
                f"{name}: {0.01 / parts:.3f} s: {share:.2f} % off by more than 2 %, {turned.sum()} in outcome"
            )


if __name__ == "__main__":
    main()
