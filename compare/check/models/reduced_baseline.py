"""Layer baseline, first part: the reduced models give the numbers that they gave."""

from __future__ import annotations

import math
from collections.abc import Iterator
from typing import Any

import numpy as np

from rockwobble.models import Case, Cylinder, InitialState, el_centro_1940

from ..baseline_file import read_baseline
from ..bench import Bench
from ..finding import FAILED, Finding, at_most

LAYER = "baseline"
FILE, GROUP = "reduced", "reduced models"
# rtol 1e-12, magnified by the passes: from 1e-11 the numbers move by 2e-10
RTOL, TOLERANCE = 1e-12, 1e-9


def check(bench: Bench) -> Iterator[Finding]:
    """Yield the findings of this part, one for each run."""
    kept = read_baseline(FILE).values.get(GROUP, {})
    groups: dict[str, dict[str, float]] = {}
    for name, value in measure(bench).items():
        groups.setdefault(name.split(":")[0], {})[name] = value
    for run, values in groups.items():
        apart = {name: abs(value - kept.get(name, math.nan)) for name, value in values.items()}
        worst = max(apart, key=lambda name: apart[name] if math.isfinite(apart[name]) else math.inf)
        finding = at_most(
            LAYER,
            run,
            apart[worst],
            TOLERANCE,
            unit="alpha, s or rad",
            reason=f"rtol {RTOL:g}, magnified by passes near upright",
            part=f"the {run.split(',')[0]} model gives other numbers than it did",
        )
        note = f"{len(values)} numbers, worst{worst.removeprefix(run)}"
        if finding.outcome == FAILED:
            note += f": {values[worst]!r}, the baseline is {kept.get(worst)!r}"
        yield at_most(
            LAYER,
            finding.name,
            finding.value,
            finding.bound,
            unit=finding.unit,
            reason=finding.reason,
            part=finding.part,
            note=note,
        )


def measure(bench: Bench) -> dict[str, float]:
    """Return the numbers that are kept: tilts at some instants, peaks, uplifts, passes."""
    found: dict[str, float] = {}
    for model, case, instants in _runs():
        response = bench.response(case, model, rtol=RTOL, sample_step=0.5)
        alpha = case.cylinder.alpha
        name = f"{model}, {case.name}"
        found[f"{name}: peak tilt [alpha]"] = _number(response.peak_tilt / alpha)
        for instant in instants:
            index = int(np.argmin(np.abs(response.time - instant)))
            found[f"{name}: tilt at {instant:g} s [alpha]"] = _number(response.tilt[index] / alpha)
        if case.motion is not None:
            found[f"{name}: uplift [s]"] = _number(response.uplift_time)
            found[f"{name}: direction of uplift [rad]"] = _number(response.uplift_direction)
        else:
            passes = response.passes
            if len(passes):
                found[f"{name}: first pass [s]"] = _number(passes["time"].iloc[0])
                found[f"{name}: first angle of turn [rad]"] = _number(passes["angle_of_turn"].iloc[0])
    return found


def _runs() -> Iterator[tuple[str, Case, tuple[float, ...]]]:
    pier, squat = Cylinder(semidiagonal=6.0, tan_alpha=0.2), Cylinder(semidiagonal=2.0, tan_alpha=1.0)
    doubled = el_centro_1940().scaled(2.0)
    vertical = el_centro_1940(vertical=True).scaled(2.0)
    for model in ("recess", "flat", "planar"):
        yield model, Case(pier, doubled, duration=8.0, name="El Centro doubled"), (3.0, 5.0, 7.0)
    yield (
        "recess",
        Case(pier, vertical, duration=8.0, name="El Centro doubled with its vertical component"),
        (3.0, 7.0),
    )
    for model in ("recess", "flat"):
        for name, body in (("slender", pier), ("squat", squat)):
            release = InitialState(tilt=0.5 * body.alpha, rolling_rate=0.2)
            yield model, Case(body, initial=release, duration=6.0, name=f"released {name}"), (2.0, 4.0, 6.0)


def _number(value: Any) -> float:
    return float(value)
