"""The files of a case: case.json, accept.json, reference.json and reference.csv, and its ground motions."""

from __future__ import annotations

import json
import math
from collections.abc import Mapping
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from rockwobble.reduced.body import body_of

from .definitions import BenchmarkRun, Definition, G
from .references import FIRST, INTEGRATED, MODEL, SECOND, Reference

PUBLISHED = Path(__file__).resolve().parents[2] / "reports" / "published" / "benchmark"
_MANY = 100  # samples of a ground motion that has a file of its own


def write(definition: Definition, computed: Reference, folder: Path) -> None:
    """Write the four files of a case, and that of its ground motions."""
    folder.mkdir(parents=True, exist_ok=True)
    _write_json(folder / "case.json", case_file(definition))
    accept = {
        "schema": "accept/1",
        "case": definition.name,
        "runs": definition.needs,
        "needed": list(definition.needed),
        "criteria": list(definition.criteria),
    }
    _write_json(folder / "accept.json", accept)
    reference = {
        "schema": "reference/1",
        "case": definition.name,
        "traces": {
            name: {
                "bound": bound,
                "unit": "m" if name in "xy" else "rad",
                "certified_by": [MODEL, INTEGRATED] if name in "xy" else [FIRST, SECOND],
            }
            for name, bound in computed.bounds.items()
        },
        "quantities": computed.quantities,
    }
    _write_json(folder / "reference.json", reference)
    _write_table(folder / "reference.csv", computed.columns, digits=12)
    columns: dict[str, NDArray[np.float64]] = {}
    for run in definition.runs:
        if run.motion is not None and len(run.motion.acceleration) >= _MANY:
            columns["time"] = run.motion.time_step * np.arange(len(run.motion.acceleration))
            for axis, column in zip("xyz", run.motion.acceleration.T, strict=False):
                columns[f"a{axis}{_label(definition, run)}"] = column
    if columns:
        _write_table(folder / "motion.csv", columns, digits=7)


def case_file(definition: Definition) -> dict[str, Any]:
    """Return what case.json says."""
    supports = {run.support for run in definition.runs}
    return {
        "schema": "case/1",
        "name": definition.name,
        "title": definition.title,
        "support": supports.pop() if len(supports) == 1 else "by run",
        "gravity": G,
        "runs": [_run(definition, run) for run in definition.runs],
    }


def _label(definition: Definition, run: BenchmarkRun) -> str:
    motions = {id(other.motion) for other in definition.runs}
    return "" if len(motions) == 1 else f":{run.name}"


def _run(definition: Definition, run: BenchmarkRun) -> dict[str, Any]:
    body, cylinder = body_of(run.cylinder, G), run.cylinder
    unit = math.sqrt(cylinder.semidiagonal / G)
    start = run.initial
    tilt, rate = (start.tilt, start.tilt_rate) if start else (0.0, 0.0)
    azimuth, spin = (start.rolling_angle, start.rolling_rate) if start else (0.0, 0.0)
    entry: dict[str, Any] = {
        "name": run.name,
        "support": run.support,
        "friction": run.friction,
        "duration": run.duration,
        "base_radius": body.b,
        "mass_centre_height": body.h,
        "height": 2.0 * cylinder.half_height,
        "alpha": body.alpha,
        "transverse_inertia": body.I1,
        "axial_inertia": body.I2,
        "start": {"tilt": tilt, "tilt_rate": rate, "azimuth": azimuth, "azimuth_rate": spin} | pose(run),
        "motion": _motion(definition, run),
        "dimensionless": {
            "tan_alpha": cylinder.tan_alpha,
            "unit_of_length": cylinder.semidiagonal,
            "unit_of_time": unit,
            "tilt_over_alpha": tilt / body.alpha,
            "azimuth_rate": spin * unit,
            "duration": run.duration / unit,
            "transverse_inertia": body.I1 / cylinder.semidiagonal**2,
            "axial_inertia": body.I2 / cylinder.semidiagonal**2,
        },
        **run.levels,
    }
    if run.tendon is not None:
        prestress, stiffness = run.tendon.prestress, run.tendon.stiffness
        entry["tendon"] = {
            "prestress": prestress * G,
            "stiffness": stiffness * G / body.b,
            "dimensionless": {"prestress": prestress, "stiffness": stiffness},
        }
    if run.turned:
        entry["turned"] = run.turned
    if run.time_unit != 1.0:
        entry["time_unit"] = run.time_unit
    return entry


def pose(run: BenchmarkRun) -> dict[str, list[float]]:
    """Start in rigid body terms: mass centre relative to the ground, in world axes.

    The axis leans by the tilt towards the azimuth without a twist, the base touches the ground on its
    original circle, equations (8) and (10), and there is no twist rate: psi' = -phi'.
    """
    start, body = run.initial, body_of(run.cylinder, G)
    if start is None:
        upright = {"position": [0.0, 0.0, body.h], "quaternion": [1.0, 0.0, 0.0, 0.0]}
        return {**upright, "velocity": [0.0] * 3, "angular_velocity": [0.0] * 3}
    s, c = math.sin(start.tilt), math.cos(start.tilt)
    outward = np.array([math.cos(start.rolling_angle), math.sin(start.rolling_angle), 0.0])
    across, up = np.array([-outward[1], outward[0], 0.0]), np.array([0.0, 0.0, 1.0])
    axis = s * outward + c * up
    contact = body.b * outward
    centre = contact - body.b * (c * outward - s * up) + body.h * axis
    spin = start.tilt_rate * across - start.rolling_rate * s * outward + start.rolling_rate * (1.0 - c) * up
    half = 0.5 * start.tilt
    return {
        "position": centre.tolist(),
        "quaternion": [math.cos(half), *(math.sin(half) * across).tolist()],
        "velocity": np.cross(spin, centre - contact).tolist(),
        "angular_velocity": spin.tolist(),
    }


def _motion(definition: Definition, run: BenchmarkRun) -> dict[str, Any]:
    if run.motion is None:
        return {"kind": "still"}
    if len(run.motion.acceleration) < _MANY:
        samples = run.motion.acceleration
        times = (run.motion.time_step * np.arange(len(samples))).tolist()
        padded = np.pad(samples, ((0, 0), (0, 3 - samples.shape[1])))
        return {"kind": "samples", "time": times, "acceleration": padded.tolist()}
    label = _label(definition, run)
    return {"kind": "file", "file": "motion.csv", "columns": [f"a{axis}{label}" for axis in "xy"]}


def _write_json(path: Path, content: Mapping[str, Any]) -> None:
    path.write_text(json.dumps(content, indent=1, default=float) + "\n", encoding="utf-8")


def _write_table(path: Path, columns: Mapping[str, NDArray[np.float64]], *, digits: int) -> None:
    table = np.column_stack([*columns.values()]) + 0.0
    rows = [",".join(columns), *(",".join(f"{value:.{digits}g}" for value in row) for row in table)]
    path.write_text("\n".join(rows) + "\n", encoding="utf-8")
