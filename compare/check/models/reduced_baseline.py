"""Layer baseline, first part: the reduced models give the numbers that they gave."""

from __future__ import annotations

import dataclasses
import math
from collections.abc import Iterator

import numpy as np

from rockwobble.models import Case, Cylinder, el_centro_1940

from ..baseline_file import read_baseline
from ..bench import Bench
from ..finding import Bound, Finding, worst_of
from ..problems import MODELS, PIER, released

FILE, GROUP = "reduced", "reduced models"
RTOL = 1e-12
# from 1e-11 the numbers move by 2e-10
SAME = Bound(1e-9, "rtol 1e-12, magnified by passes near upright", "alpha, s or rad")


def check(bench: Bench) -> Iterator[Finding]:
    """Yield the findings of this part, one for each run."""
    kept = read_baseline(FILE).values.get(GROUP, {})
    groups: dict[str, dict[str, float]] = {}
    for name, value in measure(bench).items():
        run, what = name.split(": ", 1)
        groups.setdefault(run, {})[what] = value
    for run, values in groups.items():
        apart = {what: value - kept.get(f"{run}: {what}", math.nan) for what, value in values.items()}
        part = f"the {run.split(',')[0]} model gives other numbers than it did"
        finding = worst_of(run, apart, SAME, part)
        if finding.failed:
            worst = finding.note.split(": ", 1)[1]
            was = f"; {values[worst]!r}, the baseline is {kept.get(f'{run}: {worst}')!r}"
            finding = dataclasses.replace(finding, note=finding.note + was)
        yield finding


def measure(bench: Bench) -> dict[str, float]:
    """Return the numbers that are kept: tilts at some instants, peaks, uplifts, passes."""
    found: dict[str, float] = {}
    for model, case, instants in _runs():
        trace = bench.solve(case, model, rtol=RTOL, sample_step=0.5)
        alpha = case.cylinder.alpha
        values = {"peak tilt [alpha]": trace.peak_tilt / alpha}
        for instant in instants:
            tilt = trace.tilt[int(np.argmin(np.abs(trace.time - instant)))]
            values[f"tilt at {instant:g} s [alpha]"] = tilt / alpha
        if case.motion is not None:
            values["uplift [s]"] = trace.uplift_time
            values["direction of uplift [rad]"] = trace.uplift_direction
        elif len(trace.passes):
            values["first pass [s]"] = trace.passes["time"].iloc[0]
            values["first angle of turn [rad]"] = trace.passes["angle_of_turn"].iloc[0]
        found |= {f"{model}, {case.name}: {what}": float(value) for what, value in values.items()}
    return found


def _runs() -> Iterator[tuple[str, Case, tuple[float, ...]]]:
    doubled, vertical = (el_centro_1940(vertical=each).scaled(2.0) for each in (False, True))
    for model in MODELS:
        yield model, Case(PIER, doubled, duration=8.0, name="El Centro doubled"), (3.0, 5.0, 7.0)
    name = "El Centro doubled with its vertical component"
    yield "recess", Case(PIER, vertical, duration=8.0, name=name), (3.0, 7.0)
    squat = Cylinder(semidiagonal=2.0, tan_alpha=1.0)
    for model in ("recess", "flat"):
        for name, body in (("slender", PIER), ("squat", squat)):
            yield model, released(0.5, 0.2, 6.0, body, f"released {name}"), (2.0, 4.0, 6.0)
