"""Who can rock: one can in every simulator, with its default settings and with the best that were found.

Default settings, and simulators that rockwobble does not drive, are in `rock_worlds`, each run in a process
of its own. The best settings of an engine are those of rockwobble. PhysX and Newton are packages of their
own: `--environment physx=/path/to/python`, or they are installed into a fresh one.
"""

from __future__ import annotations

import datetime
import json
import math
import subprocess
import sys
import tempfile
import time
from collections import Counter
from collections.abc import Mapping, Sequence
from pathlib import Path
from types import MappingProxyType
from typing import TYPE_CHECKING, Any

import numpy as np

from rockwobble import multibody
from rockwobble.models import Case, Cylinder, GroundMotion, InitialState
from rockwobble.multibody.engines.registry import find_engine, own_engines

from . import rock_worlds as worlds
from .console import options_of, show

if TYPE_CHECKING:
    import pandas as pd

_STEP = 1e-4  # [s] of the engines with the settings of rockwobble
_CAN = Cylinder(semidiagonal=math.hypot(worlds.B, worlds.H), tan_alpha=worlds.B / worlds.H)
_LONGEST = 600.0  # [s] of one simulator
_INSTALL = 300.0  # [s]
# formulation and precision
KNOWN: Mapping[str, tuple[str, str]] = MappingProxyType(
    {
        "mujoco": ("soft, convex optimisation", "double"),
        "pybullet": ("hard, iterated impulses", "double"),
        "dart": ("hard, complementarity", "double"),
        "drake": ("soft, regularised friction", "double"),
        "exudyn": ("ideal rolling joint", "double"),
        "rapier": ("soft constraints of substeps", "single"),
        "physx": ("temporal Gauss-Seidel", "single"),
        "physx-32": ("the same, a prism of 32 corners", "single"),
        "physx-64": ("the same, a prism of 64 corners", "single"),
        "newton-xpbd": ("position-based dynamics", "single"),
        "newton-mujoco": ("soft, convex optimisation", "single"),
    }
)
_EXTRA = ("physx", "physx-32", "physx-64", "newton-xpbd", "newton-mujoco")
_COLUMNS = ("simulator", "version", "formulation", "precision", "settings", "time_step", "turn", "tilt",
            "uplift", "microseconds", "remark")  # fmt: skip


def driven(engine: str) -> dict[str, Any]:
    """Return what an engine does with the settings of rockwobble, on flat ground."""
    release = InitialState(worlds.TILT, rolling_rate=worlds.SPIN)
    case = Case(_CAN, initial=release, duration=2.0)
    started = time.process_time()
    trace = multibody.simulate(case, engine=engine, support="flat", time_step=_STEP, sample_step=0.001)
    seconds = (time.process_time() - started) * _STEP / case.length
    upright = int(trace.tilt[:1200].argmin())
    top = upright + int(trace.tilt[upright:].argmax())
    found = {
        "version": trace.version,
        "time_step": _STEP,
        "turn": math.degrees(float(trace.passes["angle_of_turn"].iloc[0])),
        "tilt": trace.tilt[top] / worlds.TILT,
        "microseconds": 1e6 * seconds,
        "wrong": None,
    }
    if not find_engine(engine).uplifts:
        return found | {"remark": "cannot uplift"}
    wrong = found["wrong"] = []
    for azimuth in math.tau * np.arange(worlds.DIRECTIONS) / worlds.DIRECTIONS:
        for share in (0.49, 0.51):
            push = share * worlds.G * np.array([math.cos(azimuth), math.sin(azimuth)])
            motion = GroundMotion([0.0 * push, *[push] * 25], worlds.RAMP)
            case = Case(_CAN, motion, duration=worlds.LENGTH, gravity=worlds.G)
            trace = multibody.simulate(case, engine=engine, support="flat", time_step=_STEP)
            tilt, direction = float(trace.tilt[-1]), float(trace.rolling_angle[-1])
            wrong += worlds.misses(tilt, math.remainder(direction - azimuth - math.pi, math.tau), share)
    return found


def foreign(simulator: str, variant: str, python: str) -> dict[str, Any]:
    """Return what a simulator does in a process of its own."""
    command = [python, "-W", "ignore", str(Path(worlds.__file__)), simulator, variant]
    try:
        done = subprocess.run(command, capture_output=True, text=True, timeout=_LONGEST, check=False)
    except subprocess.TimeoutExpired:
        return {"remark": f"not done within {_LONGEST:.0f} s"}
    if done.returncode:
        said = done.stderr.strip().splitlines() or ["crashes without a word"]
        return {"remark": said[-1]}
    return dict(json.loads(done.stdout.splitlines()[-1]))


def environment(simulator: str, folder: Path) -> str:
    """Install the package of a simulator into a fresh environment, and return its Python.

    Raises
    ------
    RuntimeError
        If it does not install.
    """
    package = worlds.WORLDS[simulator][0]
    place = folder / package
    python = str(place / "bin" / "python")
    if not place.exists():
        subprocess.run([sys.executable, "-m", "venv", str(place)], check=True)
        install = [python, "-m", "pip", "install", "--quiet", "numpy", package]
        try:
            subprocess.run(install, capture_output=True, text=True, timeout=_INSTALL, check=True)
        except subprocess.CalledProcessError as error:
            raise RuntimeError(f"does not install: {error.stderr.strip().splitlines()[-1]}") from error
        except subprocess.TimeoutExpired as error:
            raise RuntimeError(f"is not installed within {_INSTALL:.0f} s") from error
    return python


def _row(simulator: str, settings: str, found: Mapping[str, Any]) -> dict[str, Any]:
    formulation, precision = KNOWN[simulator]
    row: dict[str, Any] = dict.fromkeys(_COLUMNS, math.nan) | {"version": "", "remark": ""}
    row |= {"simulator": simulator, "formulation": formulation, "precision": precision, "settings": settings}
    row |= {name: value for name, value in found.items() if name in _COLUMNS}
    wrong = found.get("wrong")
    counted = Counter(wrong or ())
    row["uplift"] = (
        "–" if wrong is None else "; ".join(f"{n} × {what}" for what, n in counted.items()) or "holds"
    )
    return row


def page(table: pd.DataFrame, when: str, command: str) -> str:
    """Return the table as Markdown."""
    lines = [
        "| simulator | formulation | precision | settings | step [s] | turn [deg] | tilt regained | uplift "
        "| µs a step | remark |",
        "| --- | --- | --- | --- | ---: | ---: | ---: | --- | ---: | --- |",
    ]
    rows: Any = table.itertuples()
    for row in rows:
        numbers = [
            f"{value:{form}}" if math.isfinite(value) else "–"
            for value, form in (
                (row.time_step, ".2g"), (row.turn, ".3f"), (row.tilt, ".5f"), (row.microseconds, ".0f")
            )
        ]  # fmt: skip
        step, turn, tilt, cost = numbers
        lines.append(
            f"| {row.simulator} {row.version} | {row.formulation} | {row.precision} | {row.settings} "
            f"| {step} | {turn} | {tilt} | {row.uplift} | {cost} | {row.remark} |"
        )
    return "\n".join([*lines, "", f"Made by `{command}` on {when}.", ""])


def main(arguments: Sequence[str] | None = None) -> int:
    """Measure each simulator, print the table and write it."""
    parser = options_of("who_can_rock", "What each simulator makes of a can: its turn, its tilt, its uplift.")
    parser.add_argument("--simulator", action="append", choices=tuple(KNOWN), help="default: all")
    parser.add_argument("--environment", action="append", default=[], metavar="NAME=PYTHON",
                        help="Python that has it; default: it is installed into a fresh one")  # fmt: skip
    parser.add_argument("--out", type=Path, help="folder for the table; rows of other simulators stay")
    given = parser.parse_args(arguments)
    pythons = dict(each.split("=", 1) for each in given.environment)
    rows: list[dict[str, Any]] = []
    with tempfile.TemporaryDirectory() as scratch:
        for simulator in given.simulator or KNOWN:
            print(f"{simulator} ...", file=sys.stderr, flush=True)
            if simulator in _EXTRA:
                try:
                    python = pythons.get(simulator) or environment(simulator, Path(scratch))
                except RuntimeError as error:
                    rows.append(_row(simulator, "default", {"remark": str(error)}))
                    continue
                rows += [
                    _row(simulator, each, foreign(simulator, each, python)) for each in ("default", "best")
                ]
            elif simulator in own_engines():
                if simulator in worlds.WORLDS:
                    rows.append(_row(simulator, "default", foreign(simulator, "default", sys.executable)))
                rows.append(_row(simulator, "rockwobble", driven(simulator)))
    table = _table(rows)
    show(table, "Who can rock", {"simulator": "", "settings": "", "turn": ".3f", "tilt": ".5f", "uplift": "",
                                 "microseconds": ".0f", "remark": ""})  # fmt: skip
    if given.out is not None:
        _write(table, given.out)
    return 0


def _table(rows: Sequence[Mapping[str, Any]]) -> pd.DataFrame:
    import pandas as pd

    return pd.DataFrame(rows, columns=list(_COLUMNS))


def _write(table: pd.DataFrame, out: Path) -> None:
    import pandas as pd

    out.mkdir(parents=True, exist_ok=True)
    file = out / "simulators.csv"
    if file.exists():
        known = pd.read_csv(file, dtype={"version": str}).fillna({"version": "", "remark": ""})
        table = pd.concat([known[~known["simulator"].isin(table["simulator"])], table])
    order = {name: place for place, name in enumerate(KNOWN)}
    table = table.sort_values("simulator", key=lambda names: names.map(order), kind="stable")
    table.to_csv(file, index=False)
    when = datetime.datetime.now(tz=datetime.UTC).date().isoformat()
    command = "python tests/benchmarks who_can_rock --out reports/published/simulators"
    (out / "simulators.md").write_text(page(table, when, command), encoding="utf-8")
