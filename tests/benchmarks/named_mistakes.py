"""Mistakes of a trajectory as `rockwobble compare --trajectory` and the benchmark's check.py name them.

Synthetic files of the case turn-recess, a release in a recess: the right one, and one for each mistake.
check.py is given all three runs; compare the fastest, released at the azimuth 0. Ends with 1 where one of
both does not name what was done to the file.
"""

from __future__ import annotations

import argparse
import dataclasses
import json
import math
import shlex
import subprocess
import sys
import tempfile
from collections.abc import Callable, Sequence
from pathlib import Path

import numpy as np
import pandas as pd
from benchmark_files.submission import Table, cases_of, positions, quaternions, submit, tilt_and_azimuth

from rockwobble import reduced
from rockwobble.models import Case, Cylinder, Trace

BENCHMARK = Path(__file__).resolve().parents[2] / "reports" / "published" / "benchmark"
CASE, FASTEST = "turn-recess", "spin-1"
LARGER = 1.01


def larger(case: Case) -> Case:
    """Return the case of a body that is 1 % larger."""
    return dataclasses.replace(
        case, cylinder=Cylinder.from_dimensions(base_radius=LARGER, height=4.0 * LARGER)
    )


def angles(trace: Trace) -> Table:
    """Return the columns of a file with tilt and azimuth."""
    return {name: tilt_and_azimuth(trace)[name] for name in ("time", "tilt", "azimuth")}


@dataclasses.dataclass(frozen=True, slots=True, kw_only=True)
class Mistaken:
    """What is done to a case, or to the columns of its file, and the code that names it."""

    code: str
    columns: Callable[[Trace], Table] = angles
    case: Callable[[Case], Case] = lambda case: case
    table: Callable[[Table], Table] = lambda table: table


FILES = {
    "right": Mistaken(code=""),
    "R 1 % larger": Mistaken(code="time_scale", case=larger),
    "g = 10": Mistaken(code="time_scale", case=lambda case: dataclasses.replace(case, gravity=10.0)),
    "mirrored": Mistaken(code="y_reversed", table=lambda t: t | {"azimuth": -t["azimuth"]}),
    "degrees for radians": Mistaken(
        code="angle_unit", table=lambda t: t | {name: np.degrees(t[name]) for name in ("tilt", "azimuth")}
    ),
    "y up, quaternions": Mistaken(
        code="y_up", columns=quaternions, table=lambda t: t | {"qy": t["qz"], "qz": -t["qy"]}
    ),
    "y up, positions": Mistaken(
        code="y_up", columns=positions, table=lambda t: t | {"y": t["z"], "z": -t["y"]}
    ),
    "0.05 s late": Mistaken(code="time_offset", table=lambda t: t | {"time": t["time"] + 0.05}),
    "azimuth 10 deg off": Mistaken(
        code="turned", table=lambda t: t | {"azimuth": t["azimuth"] + math.radians(10.0)}
    ),
}


def write(mistaken: Mistaken, folder: Path) -> tuple[Path, Path]:
    """Write the file of the three runs, and that of the fastest with the azimuth 0 at the start."""
    tables = {}
    for run, (case, support) in cases_of(BENCHMARK / "cases" / CASE).items():
        tables[run] = mistaken.table(
            mistaken.columns(reduced.simulate(mistaken.case(case), support=support, rtol=1e-10))
        )
    case, support = cases_of(BENCHMARK / "cases" / CASE)[FASTEST]
    assert case.initial is not None
    released = dataclasses.replace(case, initial=dataclasses.replace(case.initial, rolling_angle=0.0))
    trace = reduced.simulate(mistaken.case(released), support=support, rtol=1e-10)
    one = pd.DataFrame(mistaken.table(mistaken.columns(trace)))
    # a late clock has no samples before its start: there it stood at its release
    early = one.iloc[[0]].assign(time=0.0) if one["time"].iloc[0] > 0.0 else one.iloc[:0]
    steps = np.arange(0.0, float(one["time"].iloc[0]) - 1e-9, 0.01)
    early = pd.concat([early] * len(steps)).assign(time=steps) if len(early) else early
    titles = {"tilt": "tilt [rad]", "azimuth": "azimuth [rad]"}
    pd.concat([early, one]).rename(columns=titles).to_csv(folder / "one.csv", index=False)
    return submit(tables, folder / "all.csv"), folder / "one.csv"


def commands(all_runs: Path, one_run: Path, folder: Path) -> tuple[list[str], list[str]]:
    """Return the commands that judge both files."""
    case = cases_of(BENCHMARK / "cases" / CASE)[FASTEST][0]
    assert case.initial is not None
    check = [
        sys.executable,
        str(BENCHMARK / "check.py"),
        CASE,
        str(all_runs),
        "--out",
        str(folder / "result.json"),
    ]
    compare = [
        *(
            sys.executable,
            "-m",
            "rockwobble",
            "compare",
            "--engine",
            "none",
            "--diameter",
            "2",
            "--height",
            "4",
        ),
        *("--release-tilt-deg", repr(math.degrees(case.initial.tilt))),
        *("--rolling-rate", repr(case.initial.rolling_rate), "--duration", repr(case.duration)),
        *("--trajectory", str(one_run), "--out", str(folder / "comparison")),
    ]
    return check, compare


def named(name: str, folder: Path) -> tuple[str, str]:
    """Return the codes that check.py and compare give for a file, and print their commands."""
    folder.mkdir(parents=True, exist_ok=True)
    check, compare = commands(*write(FILES[name], folder), folder)
    print(f"\n{name}\n  {shlex.join(check)}\n  {shlex.join(compare)}")
    subprocess.run(check, check=False, capture_output=True)
    found = "; ".join(one["code"] for one in json.loads((folder / "result.json").read_text())["mistakes"])
    done = subprocess.run(compare, check=False, capture_output=True, text=True)
    if done.returncode:  # it cannot be read as it is, and says why
        return found, done.stderr.strip().rpartition("likely mistake: ")[-1]
    rows = pd.read_csv(folder / "comparison" / "summary.csv")
    own = rows[rows["support"] == "external"].iloc[0]
    return found, "" if pd.isna(own["likely_mistake"]) else str(own["likely_mistake"])


def main(arguments: Sequence[str] | None = None) -> int:
    """Print the table; return 1 if a mistake is not named."""
    parser = argparse.ArgumentParser(prog="python tests/benchmarks named_mistakes", description=__doc__)
    parser.add_argument("--only", action="append", choices=FILES, help="this file alone")
    parser.add_argument("--out", type=Path, help="folder that keeps the files; default: none is kept")
    given = parser.parse_args(arguments)
    with tempfile.TemporaryDirectory() as scratch:
        found = {
            name: named(name, (given.out or Path(scratch)) / str(number))
            for number, name in enumerate(FILES)
            if name in (given.only or FILES)
        }
    print(f"\n{'file':22s} {'to be named':14s} {'check.py':24s} compare --trajectory")
    for name, (by_check, by_compare) in found.items():
        print(f"{name:22s} {FILES[name].code or '-':14s} {by_check or '-':24s} {by_compare or '-'}")
    words = {"y_up": "y points up", "angle_unit": "its tilt and azimuth are in degrees, read as radians"}
    good = [
        by_check == FILES[name].code and by_compare in (by_check, words.get(by_check))
        for name, (by_check, by_compare) in found.items()
    ]
    return 0 if all(good) else 1
