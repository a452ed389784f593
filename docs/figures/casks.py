"""Draw how far casks slide: `python docs/figures/casks.py` writes casks.svg beside itself.

Prints what it draws: peak displacement under 22 pairs of FEMA P-695 (needs rockwobble[records]), each scaled
to a peak ground velocity, at three frictions.
"""

from __future__ import annotations

from pathlib import Path

import numpy as np

import rockwobble as rw
from rockwobble import reduced
from rockwobble.reports.figures.palette import run_styles
from rockwobble.reports.figures.picture import Axis, Line, Panel, Picture, Rule
from rockwobble.reports.figures.svg import svg

FRICTIONS = (0.2, 0.3, 0.4)
VELOCITIES = np.array([0.13, 0.25, 0.5, 0.75, 1.0])  # peak of the horizontal resultant [m/s]
FIELD = (0.025, 0.114)  # slid at North Anna [m]
PERCENTILES = (5, 50, 95)


def displacements() -> np.ndarray:
    """Percentiles of the peak displacement (percentile, velocity, friction) [m]."""
    moved = []
    for motion in rw.far_field_motions(peak=3.0):
        velocity = np.cumsum(motion.acceleration[:, :2], axis=0) * motion.time_step
        scales = VELOCITIES / np.hypot(*velocity.T).max()
        moved.append(reduced.peak_displacements(FRICTIONS, motion, scales).T)
    return np.percentile(moved, PERCENTILES, axis=0)


def main() -> None:
    """Print the table, and write the figure."""
    low, median, high = displacements()
    for velocity, *rows in zip(VELOCITIES, low, median, high, strict=True):
        cells = [f"{m:.0f} ({a:.0f} to {b:.0f})" for a, m, b in 1e3 * np.array(rows).T]
        print(f"| {velocity:g} | {' | '.join(cells)} |")
    named = [f"friction {friction:g}" for friction in FRICTIONS]
    styles = run_styles(named)
    lines = [
        Line(x=VELOCITIES, y=values[:, i], name=name * wide, style=styles[name], width=1.6 if wide else 0.7)
        for i, name in enumerate(named)
        for values, wide in ((median, 1), (low, 0), (high, 0))
    ]
    panel = Panel(
        x=Axis(label="peak ground velocity", unit="m/s", low=0.0, high=1.0),
        y=Axis(label="peak displacement", unit="m", low=0.0, high=0.35),
        layers=[
            Rule(at=FIELD[0], until=FIELD[1], axis="y", text="North Anna", colour="#dddddd"),
            Rule(at=0.13, axis="x", text="recorded"),
            *lines,
        ],
        height=3.4,
    )
    drawn = Picture(name="casks", title="How far casks slide", panels=[panel])
    (Path(__file__).parent / "casks.svg").write_bytes(svg(drawn))


if __name__ == "__main__":
    main()
