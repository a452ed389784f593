"""Column on no-tension contacts in OpenSees, planar and spatial: a process of `witnesses`.

It needs openseespy and numpy alone. Standard input has the problem, the last line of standard output the
answer, as JSON.

In a plane: a stiff column on a stiff base with a no-tension spring under each edge; damping in proportion to
the present stiffness acts in closed springs alone, and stands for the impact. In space: six point masses with
the mass and the inertias of the cylinder, tied to a ring of contacts by stiff corotational trusses. There are
no rotations, so that no transformation of rotations takes part.
"""

from __future__ import annotations

import json
import math
import sys
import time
from typing import Any

import numpy as np

B, H, G = 1.0, 2.0, 9.81  # radius and half height [m], gravity [m/s^2]
MASS = 1000.0  # [kg]
TRANSVERSE, AXIAL = B**2 / 4.0 + H**2 / 3.0, B**2 / 2.0  # inertias over the mass [m^2]
FRICTION = 5.0
RIGID = 1e12  # EA and EI of bars and beams [N, N m^2]
SAMPLES = 0.005  # [s]
HALVINGS = (10, 100)  # parts of a step that does not converge


def plane(o: Any, problem: dict[str, Any]) -> tuple[int, int]:
    """Build the planar column; return the end nodes of its axis."""
    o.model("basic", "-ndm", 2, "-ndf", 3)
    o.node(1, 0.0, H, "-mass", MASS, MASS, MASS * TRANSVERSE)
    o.node(2, 0.0, 0.0)
    o.fix(2, 1, 0, 0)
    o.geomTransf("Corotational", 1)
    o.element("elasticBeamColumn", 1, 2, 1, 1.0, RIGID, 1.0, 1)
    o.uniaxialMaterial("ENT", 1, problem["stiffness"] / problem["contacts"])
    springs = []
    for i, x in enumerate(np.linspace(-B, B, problem["contacts"])):
        foot, ground = 100 + i, 1000 + i
        o.node(foot, float(x), 0.0)
        o.node(ground, float(x), 0.0)
        o.fix(ground, 1, 1, 1)
        o.element("elasticBeamColumn", foot, 2, foot, 1.0, RIGID, 1.0, 1)
        o.element("zeroLength", ground, ground, foot, "-mat", 1, "-dir", 2, "-doRayleigh", 1)
        springs.append(ground)
    o.region(1, "-ele", *springs, "-rayleigh", 0.0, problem["damping"], 0.0, 0.0)
    o.timeSeries("Constant", 1)
    o.pattern("Plain", 1, 1)
    o.load(1, 0.0, -MASS * G, 0.0)
    return 2, 1


def space(o: Any, problem: dict[str, Any]) -> tuple[int, int]:
    """Build the spatial column; return the end nodes of its axis."""
    o.model("basic", "-ndm", 3, "-ndf", 3)
    across = math.sqrt(1.5 * AXIAL)
    along = math.sqrt(3.0 * TRANSVERSE - across**2)
    masses = [(across, 0.0, H), (-across, 0.0, H), (0.0, across, H), (0.0, -across, H),
              (0.0, 0.0, H - along), (0.0, 0.0, H + along)]  # fmt: skip
    o.uniaxialMaterial("Elastic", 1, RIGID)
    bars = 0
    for i, place in enumerate(masses, start=1):
        o.node(i, *place, "-mass", *[MASS / 6.0] * 3)
        for other in range(1, i):
            o.element("corotTruss", bars := bars + 1, other, i, 1.0, 1)
    count = problem["contacts"]
    for i in range(count):
        angle = 2.0 * math.pi * (i + 0.5) / count
        foot, ground = 100 + i, 1000 + i
        for node in (foot, ground):
            o.node(node, B * math.cos(angle), B * math.sin(angle), 0.0)
        o.fix(ground, 1, 1, 1)
        for mass in range(1, 7):
            o.element("corotTruss", bars := bars + 1, mass, foot, 1.0, 1)
        share = problem["stiffness"] / count
        contact = ("zeroLengthContactASDimplex", 10000 + i, ground, foot, share, share, FRICTION)
        o.element(*contact, "-orient", 0.0, 0.0, 1.0)
    o.timeSeries("Constant", 1)
    o.pattern("Plain", 1, 1)
    for i in range(1, 7):
        o.load(i, 0.0, 0.0, -MASS * G / 6.0)
    return 5, 6


def _solve(o: Any, tolerance: float) -> None:
    o.constraints("Plain")
    o.numberer("RCM")
    o.system("UmfPack")
    o.test("NormDispIncr", tolerance, 60)
    o.algorithm("Newton")


def simulated(problem: dict[str, Any]) -> dict[str, Any]:
    """Time [s], tilt [rad], processor time [s], and the time a step failed to converge [s] or None."""
    import openseespy.opensees as o  # type: ignore[import-not-found]

    dimensions = problem["dimensions"]
    foot, head = (plane if dimensions == 2 else space)(o, problem)
    _solve(o, problem["tolerance"])
    o.integrator("LoadControl", 0.1)
    o.analysis("Static")
    o.analyze(10)
    o.loadConst("-time", 0.0)
    o.wipeAnalysis()
    for axis, column in enumerate(np.array(problem["acceleration"]).T[: dimensions - 1], start=1):
        o.timeSeries("Path", 1 + axis, "-dt", problem["sample_step"], "-values", *column.tolist(), 0.0)
        o.pattern("UniformExcitation", 1 + axis, axis, "-accel", 1 + axis)
    _solve(o, problem["tolerance"])
    o.integrator("HHT", 0.9)
    o.analysis("Transient")
    began, rows, stopped = time.process_time(), [], None
    original = np.array(o.nodeCoord(head)) - np.array(o.nodeCoord(foot))
    each = max(1, round(SAMPLES / problem["step"]))
    for number in range(round(problem["length"] / problem["step"])):
        if o.analyze(1, problem["step"]) and all(o.analyze(n, problem["step"] / n) for n in HALVINGS):
            stopped = o.getTime()
            break
        if number % each == 0:
            moved = [o.nodeDisp(head, i) - o.nodeDisp(foot, i) for i in range(1, dimensions + 1)]
            axis = original + moved
            rows.append([o.getTime(), math.atan2(math.hypot(*axis[:-1]), axis[-1])])
    columns = dict(zip(("time", "tilt"), np.array(rows).T.tolist(), strict=True))
    return columns | {"seconds": time.process_time() - began, "stopped": stopped}


if __name__ == "__main__":
    print("\n" + json.dumps(simulated(json.load(sys.stdin))))
