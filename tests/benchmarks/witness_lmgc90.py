"""Prism in LMGC90 on a shaken slab: a process of `witnesses`.

It needs compas_lmgc90 and numpy alone. LMGC90 computes one simulation a process, and what it cannot do ends
the interpreter. Standard input has the problem, the last line of standard output the answer, as JSON.
"""

from __future__ import annotations

import json
import math
import sys
import time
from typing import Any

import numpy as np

B, H = 1.0, 2.0  # radius and half height [m]
FRICTION, DENSITY = 5.0, 2750.0
THETA = 0.5  # of the time integration: the midpoint
ALERT = 0.01  # distance at which contacts are looked for [m]
TABLE_STEP = 1e-3  # of the velocity of the slab, linear between its samples [s]


def prism(corners: int, tilt: float) -> dict[str, Any]:
    """Prism with these corners, axis leaning towards x, lowest corner on the plane z = 0."""
    angle = 2.0 * math.pi * np.arange(corners) / corners
    base = np.column_stack([B * np.cos(angle), B * np.sin(angle), np.full(corners, -H)])
    points = np.vstack([base, base * [1.0, 1.0, -1.0]])
    s, c = math.sin(tilt), math.cos(tilt)
    points = points @ np.array([[c, 0.0, s], [0.0, 1.0, 0.0], [-s, 0.0, c]]).T
    points[:, 2] -= points[:, 2].min()
    sides = [[i, (i + 1) % corners, corners + (i + 1) % corners, corners + i] for i in range(corners)]
    ends = [list(range(corners))[::-1], list(range(corners, 2 * corners))]
    return {"vertices": points.tolist(), "faces": sides + ends}


def slab() -> dict[str, Any]:
    """A slab whose upper face is the plane z = 0."""
    vertices = [[x, y, z] for x in (-6.0, 6.0) for y in (-6.0, 6.0) for z in (-1.0, 0.0)]
    faces = [[0, 1, 3, 2], [4, 6, 7, 5], [0, 4, 5, 1], [2, 3, 7, 6], [0, 2, 6, 4], [1, 5, 7, 3]]
    return {"vertices": vertices, "faces": faces}


def simulated(problem: dict[str, Any]) -> dict[str, Any]:
    """Time [s], tilt [rad] and height of the mass centre [m], and processor time [s]."""
    from compas_lmgc90.solver import Solver  # type: ignore[import-not-found]

    step, length = problem["step"], problem["length"]
    solver = Solver(dt=step, theta=THETA, density=DENSITY)
    solver.geometry_from_v_f([slab(), prism(problem["corners"], problem["tilt"])])
    solver.contact_law("IQS_CLB", FRICTION, ALERT)
    times = np.arange(0.0, length + 1.0, TABLE_STEP)
    known = np.array(problem["acceleration"])  # linear between its samples, zero after the last
    for name, column in zip(("Vx", "Vy"), known.T, strict=True):
        samples = problem["sample_step"] * np.arange(len(known))
        push = np.interp(times, samples, column, right=0.0)
        speed = np.append(0.0, np.cumsum(0.5 * (push[1:] + push[:-1])) * TABLE_STEP)
        solver.apply_velocity(0, name, np.array([times, speed]))
    for name in ("Vz", "Rx", "Ry", "Rz"):
        solver.apply_velocity(0, name, np.zeros((1, 6)))
    solver.preprocess()
    initial, lean = (
        solver.init_frame[1],
        np.array([math.sin(problem["tilt"]), 0.0, math.cos(problem["tilt"])]),
    )
    began, rows = time.process_time(), []
    for number in range(1, round(length / step) + 1):
        result = solver.lmgc90.compute_one_step()
        axis = np.array(result.body_frames[1]).reshape(3, 3).T @ initial @ lean
        rows.append([number * step, math.atan2(math.hypot(axis[0], axis[1]), axis[2]), result.bodies[1][2]])
    columns = dict(zip(("time", "tilt", "height"), np.array(rows).T.tolist(), strict=True))
    return columns | {"seconds": time.process_time() - began}


if __name__ == "__main__":
    print("\n" + json.dumps(simulated(json.load(sys.stdin))))
