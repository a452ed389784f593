"""Layer baseline, first part: the reduced models give the numbers that they gave."""

from __future__ import annotations

import dataclasses
import math
from collections.abc import Iterator

import numpy as np

from rockwobble.models import Case, Cylinder, el_centro_1940

from ..baseline_file import read_baseline
from ..bench import Bench
from ..finding import Bound, Finding, worst_of, worst_place
from ..problems import MODELS, PIER, released

FILE, GROUP = "reduced", "reduced models"
RTOL = 1e-12
# from 1e-11 the numbers move by 2e-10
SAME = Bound(1e-9, "rtol 1e-12, magnified by passes near upright", "alpha, s or rad")


def check(bench: Bench) -> Iterator[Finding]:
    """Yield the findings of this part, one for each run."""
    kept = read_baseline(FILE).values.get(GROUP, {})
    for model, run, values in _measured(bench):
        before = {what: kept.get(_key(run, what), math.nan) for what in values}
        apart = {what: value - before[what] for what, value in values.items()}
        finding = worst_of(run, apart, SAME, f"the {model} model gives other numbers than it did")
        if finding.failed:
            worst = worst_place(apart)
            was = f"; {values[worst]!r}, the baseline is {before[worst]!r}"
            finding = dataclasses.replace(finding, note=finding.note + was)
        yield finding


def measure(bench: Bench) -> dict[str, float]:
    """Return the numbers that are kept: tilts at some instants, peaks, uplifts, passes."""
    return {_key(run, what): value for _, run, values in _measured(bench) for what, value in values.items()}


def _key(run: str, what: str) -> str:
    return f"{run}: {what}"


def _measured(bench: Bench) -> Iterator[tuple[str, str, dict[str, float]]]:
    """Yield model, run and numbers of each run."""
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
        yield model, f"{model}, {case.name}", {what: float(value) for what, value in values.items()}


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
