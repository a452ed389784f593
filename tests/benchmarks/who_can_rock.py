"""Who can rock: one can in every simulator, with default and with the best known settings.

Default settings, and simulators that rockwobble does not drive, are in `rock_worlds`, each run in a process
of its own. The best settings of an engine are those of rockwobble. PhysX and Newton need a Python with
`pip install numpy sapien` or `pip install numpy 'newton[sim]'`: `--environment physx=/path/to/python`.
The times of a step are medians over rounds, each of which times them all.
"""

from __future__ import annotations

import datetime
import json
import math
import statistics
import subprocess
import sys
import time
from collections import Counter
from collections.abc import Callable, Mapping, Sequence
from pathlib import Path
from types import MappingProxyType
from typing import TYPE_CHECKING, Any

import numpy as np

from rockwobble import multibody
from rockwobble.models import Case, Cylinder, GroundMotion, InitialState, Trace
from rockwobble.multibody.engines.registry import engine_packages, find_engine, own_engines

from . import rock_worlds as worlds
from .console import options_of, show

if TYPE_CHECKING:
    import pandas as pd

_STEP = 1e-4  # [s] of the engines with the settings of rockwobble
_CAN = Cylinder(semidiagonal=math.hypot(worlds.B, worlds.H), tan_alpha=worlds.B / worlds.H)
_LONGEST = 1200.0  # [s] of one simulator
_ROUNDS = 3  # rounds in which every simulator's step is timed
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
        "prism-32": ("exact, a prism of 32 corners", "double"),
        "prism-64": ("exact, a prism of 64 corners", "double"),
        "prism-128": ("exact, a prism of 128 corners", "double"),
        "newton-xpbd": ("position-based dynamics", "single"),
        "newton-mujoco": ("soft, convex optimisation", "single"),
        "newton-semi-implicit": ("springs, semi-implicit Euler", "single"),
        "newton-featherstone": ("springs, generalised coordinates", "single"),
        "newton-vbd": ("augmented vertex block descent", "single"),
        "newton-steel": ("projected Gauss-Seidel", "single"),
        "newton-kamino": ("complementarity by proximal ADMM", "single"),
        "newton-style3d": ("projective dynamics of cloth", "single"),
        "newton-mpm": ("material points", "single"),
    }
)
_COLUMNS = ("simulator", "version", "formulation", "precision", "settings", "time_step", "turn", "tilt",
            "uplift", "microseconds", "remark")  # fmt: skip


def _released(engine: str) -> Trace:
    release = InitialState(worlds.TILT, rolling_rate=worlds.SPIN)
    case = Case(_CAN, initial=release, duration=2.0)
    return multibody.simulate(case, engine=engine, support="flat", time_step=_STEP, sample_step=0.001)


def driven(engine: str) -> dict[str, Any]:
    """Result of an engine with the settings of rockwobble, on flat ground."""
    trace = _released(engine)
    upright = int(trace.tilt[:1200].argmin())
    top = upright + int(trace.tilt[upright:].argmax())
    answer = {
        "version": trace.version,
        "time_step": _STEP,
        "turn": math.degrees(float(trace.passes["angle_of_turn"].iloc[0])),
        "tilt": trace.tilt[top] / worlds.TILT,
        "wrong": None,
    }
    if not find_engine(engine).uplifts:
        return answer | {"remark": "cannot uplift"}
    wrong = answer["wrong"] = []
    for azimuth in math.tau * np.arange(worlds.DIRECTIONS) / worlds.DIRECTIONS:
        for share in (0.49, 0.51):
            push = share * worlds.G * np.array([math.cos(azimuth), math.sin(azimuth)])
            motion = GroundMotion([0.0 * push, *[push] * 25], worlds.RAMP)
            case = Case(_CAN, motion, duration=worlds.LENGTH, gravity=worlds.G)
            trace = multibody.simulate(case, engine=engine, support="flat", time_step=_STEP)
            tilt, direction = float(trace.tilt[-1]), float(trace.rolling_angle[-1])
            wrong += worlds.misses(tilt, math.remainder(direction - azimuth - math.pi, math.tau), share)
    return answer


def foreign(simulator: str, variant: str, python: str) -> dict[str, Any]:
    """Result of a simulator in a separate process."""
    try:
        return dict(_answer(python, simulator, variant))
    except subprocess.TimeoutExpired:
        return {"remark": f"not done within {_LONGEST:.0f} s"}
    except subprocess.CalledProcessError as error:
        said = error.stderr.strip().splitlines() or ["crashes without a word"]
        return {"remark": said[-1]}


def cost(simulator: str, settings: str, python_of: Callable[[str], str]) -> float:
    """Return microseconds of the processor that a step takes."""
    if settings != "rockwobble":
        return float(_answer(python_of(simulator), simulator, settings, "cost"))
    started = time.process_time()
    trace = _released(simulator)
    return 1e6 * (time.process_time() - started) * _STEP / trace.case.length


def _answer(python: str, *words: str) -> Any:
    command = [python, "-W", "ignore", str(Path(worlds.__file__)), *words]
    done = subprocess.run(command, capture_output=True, text=True, timeout=_LONGEST, check=True)
    return json.loads(done.stdout.splitlines()[-1])


def _row(simulator: str, settings: str, answer: Mapping[str, Any]) -> dict[str, Any]:
    formulation, precision = KNOWN[simulator]
    row: dict[str, Any] = dict.fromkeys(_COLUMNS, math.nan) | {"version": "", "remark": ""}
    row |= {"simulator": simulator, "formulation": formulation, "precision": precision, "settings": settings}
    row |= {name: value for name, value in answer.items() if name in _COLUMNS}
    wrong = answer.get("wrong")
    counted = Counter(wrong or ())
    row["uplift"] = (
        "–" if wrong is None else "; ".join(f"{n} × {what}" for what, n in counted.items()) or "holds"
    )
    return row


def page(table: pd.DataFrame, when: str, command: str) -> str:
    """Table as Markdown."""
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
    import pandas as pd

    parser = options_of("who_can_rock", "What each simulator makes of a can: its turn, its tilt, its uplift.")
    parser.add_argument("--simulator", action="append", choices=tuple(KNOWN), help="default: all")
    parser.add_argument("--environment", action="append", default=[], metavar="NAME=PYTHON",
                        help="Python that has physx or newton; default: this one")  # fmt: skip
    parser.add_argument("--out", type=Path, help="folder for the table; rows of other simulators stay")
    given = parser.parse_args(arguments)
    pythons: dict[str, str] = dict(each.split("=", 1) for each in given.environment)

    def python_of(simulator: str) -> str:
        return pythons.get(simulator.partition("-")[0], sys.executable)

    rows = [row for simulator in given.simulator or KNOWN for row in _measured(simulator, python_of)]
    _time(rows, python_of)
    table = pd.DataFrame(rows, columns=list(_COLUMNS))
    show(table, "Who can rock", {"simulator": "", "settings": "", "turn": ".3f", "tilt": ".5f", "uplift": "",
                                 "microseconds": ".0f", "remark": ""})  # fmt: skip
    if given.out is not None:
        _write(table, given.out)
    return 0


def _measured(simulator: str, python_of: Callable[[str], str]) -> list[dict[str, Any]]:
    """Row for each of the settings of a simulator; none of an engine that is not installed here."""
    if simulator in engine_packages() and simulator not in own_engines():
        return []
    print(f"{simulator} ...", file=sys.stderr, flush=True)
    rows = []
    if simulator in worlds.WORLDS:
        python = python_of(simulator)
        steps = dict(zip(("default", "best"), worlds.WORLDS[simulator][1:3], strict=True))
        variants = [name for name, step in steps.items() if math.isfinite(step)]
        rows = [_row(simulator, each, foreign(simulator, each, python)) for each in variants]
    if simulator in own_engines():
        rows.append(_row(simulator, "rockwobble", driven(simulator)))
    return rows


def _time(rows: Sequence[dict[str, Any]], python_of: Callable[[str], str]) -> None:
    """Time a step of each row, in rounds that share other load equally."""
    ran = [row for row in rows if math.isfinite(row["turn"])]
    rounds = []
    for number in range(_ROUNDS):
        print(f"times, round {number + 1} of {_ROUNDS} ...", file=sys.stderr, flush=True)
        rounds.append([cost(row["simulator"], row["settings"], python_of) for row in ran])
    for row, times in zip(ran, zip(*rounds, strict=True), strict=True):
        row["microseconds"] = statistics.median(times)


def known(out: Path) -> pd.DataFrame:
    """Stored table of a folder."""
    import pandas as pd

    return pd.read_csv(out / "simulators.csv", dtype={"version": str}).fillna({"version": "", "remark": ""})


def _write(table: pd.DataFrame, out: Path) -> None:
    import pandas as pd

    out.mkdir(parents=True, exist_ok=True)
    if (out / "simulators.csv").exists():
        kept = known(out)
        table = pd.concat([kept[~kept["simulator"].isin(table["simulator"])], table])
    order = {name: place for place, name in enumerate(KNOWN)}
    table = table.sort_values("simulator", key=lambda names: names.map(order), kind="stable")
    table.to_csv(out / "simulators.csv", index=False)
    when = datetime.datetime.now(tz=datetime.UTC).date().isoformat()
    command = "python tests/benchmarks who_can_rock --out reports/published/simulators"
    (out / "simulators.md").write_text(page(table, when, command), encoding="utf-8")
