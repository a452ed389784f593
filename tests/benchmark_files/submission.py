"""Trajectory file of any of our models, from case.json alone."""

from __future__ import annotations

import json
import math
from collections.abc import Callable, Mapping
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from rockwobble.models import Case, Cylinder, GroundMotion, InitialState, Tendon, Trace

Array = NDArray[np.float64]
Simulate = Callable[[Case, str], Trace]  # of a case, on "recess" or "flat"
Table = dict[str, Array]


def cases_of(folder: Path) -> dict[str, tuple[Case, str]]:
    """Case and support of each run of a folder; "flat" if both supports give one motion."""
    given = json.loads((folder / "case.json").read_text())
    cases = {}
    for run in given["runs"]:
        start = run["start"]
        body = Cylinder.from_dimensions(
            base_radius=run["base_radius"],
            height=run["height"],
            mass_centre_height=run["mass_centre_height"],
            transverse_inertia=run["transverse_inertia"],
            axial_inertia=run["axial_inertia"],
        )
        initial = None
        if start["tilt"]:
            initial = InitialState(start["tilt"], start["tilt_rate"], start["azimuth"], start["azimuth_rate"])
        held = run.get("tendon")
        case = Case(
            body,
            motion_of(run["motion"], folder),
            initial=initial,
            duration=run["duration"],
            gravity=given["gravity"],
            friction=run["friction"],
            tendon=Tendon(**held["dimensionless"]) if held else None,
            name=run["name"],
        )
        cases[run["name"]] = case, "recess" if run["support"] == "recess" else "flat"
    return cases


def motion_of(given: Mapping[str, Any], folder: Path) -> GroundMotion | None:
    """Ground motion of a run."""
    if given["kind"] == "still":
        return None
    if given["kind"] == "samples":
        return GroundMotion(given["acceleration"], given["time"][1] - given["time"][0])
    lines = (folder / given["file"]).read_text().splitlines()
    titles = lines[0].split(",")
    table = np.loadtxt(lines[1:], delimiter=",")
    time = table[:, titles.index("time")]
    columns = [table[:, titles.index(name)] for name in given["columns"]]
    return GroundMotion(np.column_stack(columns), (time[-1] - time[0]) / (len(time) - 1))


def tilt_and_azimuth(trace: Trace) -> Table:
    """File columns with tilt and azimuth, and the position."""
    place = dict(zip("xyz", trace.centre_of_mass.T, strict=True))
    return {"time": trace.time, "tilt": trace.tilt, "azimuth": np.nan_to_num(trace.rolling_angle), **place}


def quaternions(trace: Trace) -> Table:
    """File columns with quaternions: a turn by the tilt, after one by the twist."""
    half, azimuth, twist = 0.5 * trace.tilt, np.nan_to_num(trace.rolling_angle), 0.5 * trace.twist
    lean = -np.sin(azimuth), np.cos(azimuth)
    s, c = np.sin(half), np.cos(half)
    return {
        "time": trace.time,
        "qw": c * np.cos(twist),
        "qx": s * (lean[0] * np.cos(twist) + lean[1] * np.sin(twist)),
        "qy": s * (lean[1] * np.cos(twist) - lean[0] * np.sin(twist)),
        "qz": c * np.sin(twist),
    }


def positions(trace: Trace) -> Table:
    """File columns with the mass centre only."""
    return {"time": trace.time, **dict(zip("xyz", trace.centre_of_mass.T, strict=True))}


def submit(tables: Mapping[str, Table], path: Path, *, titles: Mapping[str, str] | None = None) -> Path:
    """Write one file from several tables, with a column `run` and custom titles."""
    lines: list[str] = []
    for run, table in tables.items():
        if not lines:
            lines.append(",".join(["run", *((titles or {}).get(name, name) for name in table)]))
        # of Python's own numbers, a row at a time: numpy's take several times as long to print
        form = ",".join(["{}", *["{:.13g}"] * len(table)])
        columns = [values.tolist() for values in table.values()]
        lines += [form.format(run, *row) for row in zip(*columns, strict=True)]
    path.write_text("\n".join(lines) + "\n")
    return path


def spacing(case: Case, samples: int = 2000) -> float:
    """Sample step that suits the size of the body and the length of its run [s]."""
    return min(0.01 * math.sqrt(case.cylinder.semidiagonal), case.length / samples)
