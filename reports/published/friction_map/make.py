"""Mode of motion of a cylinder on flat ground, over friction and intensity; see script.py beside its folder.

A cell is answered by the sliding model below b/h, where it is exact, and above by the flat-ground model where
the friction that it needs is there. Elsewhere by MuJoCo and PyBullet, over fewer copies.
"""

from __future__ import annotations

import argparse
import math
import sys
from collections import Counter
from collections.abc import Iterator, Sequence
from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd

from rockwobble import multibody, reduced
from rockwobble.compare import Results
from rockwobble.models import Case, Cylinder, Trace, el_centro_1940, perturbed_copies
from rockwobble.reports.figures.heat import Gap, Heat, Shades, names
from rockwobble.reports.figures.picture import Axis, Panel, Picture
from rockwobble.reports.pages.page import Page
from rockwobble.reports.published.script import run

BODIES = {0.5: 3.0, 0.2: 6.0}  # R [m] of each b/h
FRICTIONS = tuple(round(0.1 * n, 1) for n in range(1, 11))
INTENSITIES = (0.45, 0.85, 1.3, 2.0, 3.0, 4.0)  # peak of the horizontal resultant [g b/h]
COPIES, ENGINE_COPIES = 20, 10
DURATION = 10.0  # of El Centro, whose strong part has ended [s]
BORDER, SLIPS = 1.1, 0.05  # engines answer up to so many b/h, and beyond a share of time that lacks friction
STEP = 1.6e-4  # engine time step times sqrt(R/1 m) [s]: four times the default
ENGINES = ("mujoco", "pybullet")
OVERTURNS, DIFFER = "overturns", "engines differ"
COLOURS = {
    "rest": "#ffffff",
    "slides": "#56B4E9",
    "rocks and slides": "#F0E442",
    "rocks": "#009E73",
    OVERTURNS: "#D55E00",
    DIFFER: "#9a9a9a",
}


class FrictionMap(Results, kind="friction map"):
    """Modes over friction and intensity: the table `cells`, a row for each."""

    def headline(self) -> dict[str, int]:
        """Numbers of cells and runs, of cells of engines, and of those whose engines have different modes."""
        cells = self.cells
        return {
            "cells": len(cells),
            "runs": int(cells["runs"].sum()),
            "cells of engines": int((cells["by"] == "engines").sum()),
            "cells whose engines differ": int((cells["mode"] == DIFFER).sum()),
        }


def mode_of(traces: Sequence[Trace]) -> str:
    """Most frequent mode of some runs."""
    modes = [OVERTURNS if each.outcome == "overturned" else each.mode for each in traces]
    return Counter(modes).most_common(1)[0][0]


def lacks_friction(traces: Sequence[Trace], friction: float) -> bool:
    """Whether half of the runs need more friction for longer than `SLIPS` of their time in motion."""
    needed = [each.friction_needed[each.open_base] for each in traces]
    return float(np.median([(each > friction).mean() if len(each) else 0.0 for each in needed])) > SLIPS


def by_engine(name: str, cases: Sequence[Case]) -> list[Trace]:
    """Runs of an engine on flat ground."""
    step = STEP * math.sqrt(cases[0].cylinder.semidiagonal)
    return [multibody.simulate(each, engine=name, support="flat", time_step=step) for each in cases]


def rows_of(tan_alpha: float, intensity: float) -> Iterator[dict[str, Any]]:
    """A row for each friction under one intensity."""
    record = el_centro_1940()
    shaking = record.scaled(intensity * 9.81 * tan_alpha / record.peak)
    body = Cylinder(semidiagonal=BODIES[tan_alpha], tan_alpha=tan_alpha)
    rolled: list[Trace] = []  # flat-ground model traces, equal for every friction
    for friction in FRICTIONS:
        case = Case(body, shaking, duration=DURATION, friction=friction)
        copies = perturbed_copies(case, COPIES, perturbation=0.01, seed=1)
        traces = rolled or [reduced.simulate(each, support="flat") for each in copies]
        rolled = traces if friction >= tan_alpha else []
        mode, by = mode_of(traces), "sliding model" if friction < tan_alpha else "flat-ground model"
        row: dict[str, Any] = {"tan_alpha": tan_alpha, "intensity": intensity, "friction": friction}
        if rolled and mode != "rest" and (friction < BORDER * tan_alpha or lacks_friction(traces, friction)):
            runs = {name: by_engine(name, copies[:ENGINE_COPIES]) for name in ENGINES}
            modes = {f"mode_{name}": mode_of(each) for name, each in runs.items()}
            mode, by = (DIFFER if len({*modes.values()}) > 1 else modes["mode_mujoco"]), "engines"
            row, traces = row | modes, [each for every in runs.values() for each in every]
        moved = math.nan if mode == OVERTURNS else np.median([each.peak_displacement for each in traces])
        yield row | {"mode": mode, "by": by, "runs": len(traces), "displacement": float(moved)}


def measure(_: argparse.Namespace) -> FrictionMap:
    """Modes of all cells."""
    rows = [row for tan_alpha in BODIES for each in INTENSITIES for row in rows_of(tan_alpha, each)]
    return FrictionMap(tables={"cells": pd.DataFrame(rows)}, facts={})


def panel(cells: pd.DataFrame, tan_alpha: float) -> Panel:
    """Map of the bodies of one b/h."""
    own = cells[cells["tan_alpha"] == tan_alpha]
    shape = len(INTENSITIES), len(FRICTIONS)
    modes, runs = (own[name].to_numpy().reshape(shape) for name in ("mode", "runs"))
    (x, columns), (y, lines) = names(FRICTIONS), names(INTENSITIES)
    gaps = [Gap(name=name, colour=COLOURS[name], cells=modes == name) for name in COLOURS]
    return Panel(
        x=Axis(label="friction", unit="-", ticks=columns),
        y=Axis(label="peak resultant / (g b/h)", unit="-", ticks=lines),
        title=f"b/h = {tan_alpha:g}, R = {BODIES[tan_alpha]:g} m",
        layers=[Heat(x=x, y=y, values=runs.astype(float), gaps=gaps, written=".0f")],
    )


def page_of(results: FrictionMap) -> Page:
    """Page with the map."""
    cells = results.cells
    picture = Picture(
        name="friction-map",
        title="Mode of motion on flat ground, El Centro 1940",
        caption="The number in a cell is that of its runs, and the colour their most frequent mode: "
        f"{COPIES} copies by a model, {ENGINE_COPIES} by each of two engines where no model answers.",
        panels=[panel(cells, each) for each in BODIES],
        columns=2,
        shades=Shades(label="runs", unit="-", low=0.0, high=4.0 * COPIES),
    )
    sizes = {"least": ("displacement", "min"), "most": ("displacement", "max")}
    groups = cells.groupby(["tan_alpha", "mode", "by"], sort=False)
    counts = groups.agg(cells=("runs", "size"), runs=("runs", "sum"), **sizes)
    values = {
        "counts": counts.reset_index().to_dict("records"),
        "headline": results.headline(),
        "about": results.manifest,
    }
    template = Path(__file__).with_name("page.md.j2")
    return Page(name="friction_map", template=template, values=values, pictures=[picture])


if __name__ == "__main__":
    sys.exit(run(__file__, FrictionMap, measure, page_of))
