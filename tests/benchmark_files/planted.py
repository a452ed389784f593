"""Planted mistakes by case: the second formulation with one error each."""

from __future__ import annotations

import dataclasses
import importlib
import math
import sys
from collections.abc import Callable, Mapping
from functools import cache
from types import ModuleType
from typing import Any

import numpy as np

from rockwobble.models import Cylinder, GroundMotion, Tendon
from rockwobble.reduced.body import body_of

from .definitions import BenchmarkRun, Definition, G, definitions
from .second import Array, sampled
from .slide import integrated
from .write import PUBLISHED

RTOL = 1e-10
Change = Callable[[BenchmarkRun], BenchmarkRun]


def _of_body(
    *, radius: float = 1.0, height: float = 1.0, transverse: float = 1.0, axial: float = 1.0
) -> Change:
    """Change of base radius, mass centre height and inertias by factors."""

    def changed(run: BenchmarkRun) -> BenchmarkRun:
        body = body_of(run.cylinder, G)
        b, h = radius * body.b, height * body.h
        other = Cylinder(
            semidiagonal=math.hypot(b, h),
            tan_alpha=b / h,
            transverse_inertia=transverse * body.I1,
            axial_inertia=axial * body.I2,
        )
        return dataclasses.replace(run, cylinder=other)

    return changed


def _with_motion(factors: tuple[float, float, float]) -> Change:
    def changed(run: BenchmarkRun) -> BenchmarkRun:
        if run.motion is None:
            return run
        samples = np.array(run.motion.acceleration)
        scaled = samples * factors[: samples.shape[1]]
        if np.array_equal(scaled, samples):
            return run
        return dataclasses.replace(run, motion=GroundMotion(scaled, run.motion.time_step))

    return changed


def _with_tendon(run: BenchmarkRun) -> BenchmarkRun:
    held = run.tendon
    if held is None:
        return run
    other = Tendon(prestress=1.02 * held.prestress, stiffness=1.02 * held.stiffness)
    return dataclasses.replace(run, tendon=other)


WITHOUT_GYROSCOPIC_TERM = "gyroscopic term left out"
MISTAKES: Mapping[str, Change] = {
    "size 1 % too large": _of_body(radius=1.01, height=1.01, transverse=1.01**2, axial=1.01**2),
    "base radius 1 % too large": _of_body(radius=1.01),
    "mass centre 1 % too high": _of_body(height=1.01),
    "transverse inertia 2 % too large": _of_body(transverse=1.02),
    "axial inertia 10 % too large": _of_body(axial=1.1),
    WITHOUT_GYROSCOPIC_TERM: lambda run: run,
    "ground acceleration 1 % too large": _with_motion((1.01, 1.01, 1.01)),
    "vertical acceleration left out": _with_motion((1.0, 1.0, 0.0)),
    "tendon 2 % too strong": _with_tendon,
}


@cache
def check() -> ModuleType:
    """The published check.py."""
    sys.path.append(str(PUBLISHED))
    return importlib.import_module("check")


def slid(run: BenchmarkRun, spacing: float) -> dict[str, Array]:
    """Columns of a sliding cylinder."""
    time = spacing * np.arange(round(run.duration / spacing) + 1)
    x, y = integrated(run, time).T
    still, height = np.zeros_like(time), np.full_like(time, run.cylinder.mass_centre_height)
    return {"time": time, "tilt": still, "azimuth": still, "x": x, "y": y, "z": height}


def judged(definition: Definition, mistake: str) -> tuple[str, float] | None:
    """Verdict, and largest error over its pass bound; None if the mistake changes no run."""
    changed = {run.name: MISTAKES[mistake](run) for run in definition.runs}
    gyroscopic = 0.0 if mistake == WITHOUT_GYROSCOPIC_TERM else 1.0
    if gyroscopic and all(changed[run.name] == run for run in definition.runs):
        return None
    case: Any = check().Case(PUBLISHED / "cases" / definition.name)
    motions = {}
    for name, run in changed.items():
        spacing = definition.step * run.time_unit
        if run.slides:  # sliding is outside of this formulation
            motions[name] = check().read_motion(case.runs[name], slid(run, spacing))
            continue
        end = spacing * round(run.duration / spacing)
        samples = sampled(run, spacing, end, rtol=RTOL, gyroscopic=gyroscopic)
        values = {"time": samples.time, "tilt": samples.tilt, "azimuth": samples.azimuth}
        motions[name] = check().read_motion(case.runs[name], values)
    judgement = check().Judgement(case.judge(motions), (), ())
    return judgement.verdict, case.score(motions)


def table() -> str:
    """Page: case by mistake."""
    titles = ["case", *MISTAKES]
    lines = [" | ".join(titles), " | ".join("---" for _ in titles)]
    for definition in definitions():
        cells = [definition.name]
        for mistake in MISTAKES:
            grade = judged(definition, mistake)
            cells.append(
                "" if grade is None else f"{grade[0]}, {grade[1]:.2g}" if grade[1] < math.inf else grade[0]
            )
        lines.append(" | ".join(cells))
    return "\n".join(f"| {line} |" for line in lines)
