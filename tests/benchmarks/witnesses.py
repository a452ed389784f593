"""LMGC90 and OpenSees compared with the reduced models: impact law, and finite elements.

Each runs with a Python that has it (`pip install compas_lmgc90`, `pip install openseespy`), each row in a
process of its own; one that ends without an answer is a row, too. Body: radius 1 m, height 4 m.
"""

from __future__ import annotations

import json
import subprocess
import sys
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from rockwobble import reduced
from rockwobble.models import Case, Cylinder, GroundMotion

from .console import options_of
from .rock_worlds import SWINGS

Array = NDArray[np.float64]
G = 9.81
BODY = Cylinder.from_dimensions(base_radius=1.0, height=4.0)
LONGEST = 500.0  # [s] of one process
# times of comparison of spatial motion [s]
MOMENTS = (0.48, 0.72, 0.96, 1.20, 1.44, 1.68, 1.92, 2.16, 2.40)
LMGC90: Sequence[tuple[str, dict[str, Any]]] = (
    ("plane", {"corners": 16, "step": 2e-4}),
    ("space", {"corners": 16, "step": 2e-4}),
    ("space", {"corners": 20, "step": 2e-4}),
    ("plane", {"corners": 21, "step": 2e-4}),
    ("tilted", {"corners": 4, "step": 1e-3, "tilt": 0.035}),
)
_TRUSS = {"contacts": 16, "stiffness": 1e11, "step": 1e-3, "tolerance": 1e-8}
_EDGES = {"contacts": 2, "stiffness": 1e10, "damping": 3e-4, "step": 1e-4, "tolerance": 1e-9}
OPENSEES: Sequence[tuple[str, dict[str, Any]]] = (
    ("plane", _EDGES),
    ("plane", _EDGES | {"stiffness": 1e9, "damping": 1e-3, "step": 1e-3}),
    ("plane", _EDGES | {"damping": 0.0}),
    ("plane", _EDGES | {"contacts": 20}),
    ("space", _TRUSS | {"stiffness": 1e9}),
    ("space", _TRUSS),
    ("space", _TRUSS | {"step": 1e-4, "tolerance": 1e-10}),
    ("space", _TRUSS | {"contacts": 40, "step": 2e-4, "tolerance": 1e-9}),
)


def motion(kind: str) -> GroundMotion:
    """One sine of 0.65 g in x; half sine of 0.7 g in x with sine of 0.28 g in y; or still ground."""
    length = {"plane": 0.8, "space": 1.0, "tilted": 1.0}[kind]
    phase = 2.0 * np.pi * np.linspace(0.0, 1.0, 161)
    sines = {
        "plane": (0.65 * np.sin(phase), 0.0 * phase),
        "space": (0.7 * np.sin(0.5 * phase), 0.28 * np.sin(phase)),
        "tilted": (0.0 * phase, 0.0 * phase),
    }
    return GroundMotion(G * np.column_stack(sines[kind]), length / 160.0)


def asked(python: str, child: str, kind: str, settings: Mapping[str, Any]) -> dict[str, Any]:
    """Answer of a witness; without one, the reason."""
    ground = motion(kind)
    problem = {
        "acceleration": ground.acceleration.tolist(),
        "sample_step": ground.time_step,
        "length": {"plane": 2.0, "space": 2.45, "tilted": 0.5}[kind],
        "dimensions": 3 if kind == "space" else 2,
        "tilt": 0.0,
        **settings,
    }
    command = [python, str(Path(__file__).with_name(f"witness_{child}.py"))]
    text = json.dumps(problem)
    try:
        done = subprocess.run(command, input=text.encode(), capture_output=True, timeout=LONGEST, check=False)
    except subprocess.TimeoutExpired:
        return {"ends": f"not done within {LONGEST:.0f} s"}
    said = (done.stdout + done.stderr).decode(errors="replace").strip().splitlines() or ["without a word"]
    answer = next((line for line in reversed(said) if line.startswith('{"time"')), None)
    if done.returncode or answer is None:
        words = next((line for line in said if line.startswith("ERROR [")), said[-1])
        return {"ends": f"its process ends: {' '.join(words.split())}"}
    return dict(json.loads(answer))


def told(kind: str, time: Array, tilt: Array) -> list[float]:
    """Tilts of a motion [alpha]: maxima between impacts, or values at the compared times."""
    tilt = tilt / BODY.alpha
    if kind == "plane":
        inside = [(time > low) & (time < high) for low, high in SWINGS]
        return [float(tilt[one].max(initial=0.0)) for one in inside]
    return np.interp(MOMENTS, time, tilt, right=np.nan).tolist()


def of_model(kind: str) -> list[float]:
    """Tilts of the reduced model: planar by the moment of momentum, or on flat ground."""
    case = Case(BODY, motion(kind), duration=2.5, friction=5.0, gravity=G)
    more: dict[str, Any] = {"plane": 0.0, "restitution": "momentum"} if kind == "plane" else {}
    trace = reduced.simulate(case, support="flat", sample_step=0.001, **more)
    return told(kind, trace.time, trace.tilt)


def row(kind: str, name: str, answer: Mapping[str, Any]) -> str:
    """A line of the table."""
    if "ends" in answer:
        return f"| {kind} | {name} | {answer['ends']} | |"
    time, tilt = np.array(answer["time"]), np.array(answer["tilt"])
    if kind == "tilted":
        fallen = answer["height"][0] - answer["height"][-1]
        return (
            f"| {kind} | {name} | sinks by {fallen:.3f} m, in free fall {0.5 * G * time[-1] ** 2:.3f} m | |"
        )
    numbers = " ".join("-" if np.isnan(x) else f"{x:.4f}" for x in told(kind, time, tilt))
    stopped = answer.get("stopped")
    end = f", no convergence at {stopped:.3f} s" if stopped else ""
    return f"| {kind} | {name} | {numbers}{end} | {answer['seconds']:.1f} |"


def main(arguments: Sequence[str]) -> int:
    """Print the tables of the witnesses whose Python is given."""
    parser = options_of("witnesses", __doc__ or "")
    parser.add_argument("--lmgc90", metavar="PYTHON", help="that has compas_lmgc90")
    parser.add_argument("--opensees", metavar="PYTHON", help="that has openseespy")
    given = parser.parse_args(arguments)
    for child, python, rows in (("lmgc90", given.lmgc90, LMGC90), ("opensees", given.opensees, OPENSEES)):
        if python is None:
            continue
        print(f"| motion | {child} | tilts [alpha] | s of the processor |\n| --- | --- | --- | ---: |")
        for kind in ("plane", "space"):
            numbers = " ".join(f"{x:.4f}" for x in of_model(kind))
            print(f"| {kind} | reduced model | {numbers} | |")
        for kind, settings in rows:
            name = ", ".join(f"{key} {value:g}" for key, value in settings.items())
            print(row(kind, name, asked(python, child, kind, settings)), flush=True)
        print()
    if given.lmgc90 is None and given.opensees is None:
        print("give --lmgc90 PYTHON or --opensees PYTHON", file=sys.stderr)
        return 2
    return 0
