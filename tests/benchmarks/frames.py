"""Columns of a frame as separate bodies: whether they stay in step and match the reduced model.

Columns of R = 6 m and tan(alpha) = 0.5 under a slab of their own mass, released at alpha/2 with 0.5 rad/s, in
three formulations of contact (`frame_solvers`). ``python tests/benchmarks frames`` prints the tables,
``--only`` one of them.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import replace
from functools import partial

import numpy as np

from rockwobble.models import el_centro_1940
from rockwobble.multibody.engines.registry import find_engine, own_engines

from .console import options_of
from .frame_solvers import SAMPLE, Frame, Motion, by_bullet, by_engine, by_mujoco, by_springs

APART = 0.01  # share of alpha by which columns differ out of step
Row = tuple[str, Frame, Callable[[Frame], Motion]]


def _mujoco(step: float, impedance: float = 0.99, contact_steps: float = 10.0) -> Callable[[Frame], Motion]:
    return lambda frame: by_mujoco(frame, step, impedance=impedance, contact_steps=contact_steps)


def one_column() -> Iterator[Row]:
    """Rows of a slab that only translates, the assumption of the reduced model."""
    for support in ("recess", "flat"):
        frame = Frame(columns=1, support=support)
        for step in (1e-3, 5e-4, 2e-4):
            yield f"{support}, MuJoCo, step {step:g} s", frame, _mujoco(step, 0.995, 2.0)
        for give in (1e-3, 1e-4, 1e-5):
            yield f"{support}, springs, give {give:g} b", replace(frame, give=give), by_springs


def engines() -> Iterator[Row]:
    """Rows of the package's engines, at four times the default step and at the default."""
    for name in own_engines():
        for support in find_engine(name).supports[:2]:
            for step in (4e-4, 1e-4):
                solve = partial(by_engine, name=name, step=step)
                yield f"{support}, {name}, step {step:g} s", Frame(columns=1, support=support), solve


def equal_columns() -> Iterator[Row]:
    """Rows of a free slab on equal columns."""
    for columns in (3, 4, 5, 6):
        frame = Frame(columns=columns)
        yield f"{columns}, springs, give 1e-4 b", frame, by_springs
        yield f"{columns}, springs, give 1e-5 b", replace(frame, give=1e-5), by_springs
        yield f"{columns}, MuJoCo, sinks in by 1e-7 b", frame, _mujoco(2e-4)
        yield f"{columns}, MuJoCo, sinks in by 6e-11 b", frame, _mujoco(2e-4, 0.9999, 2.0)
        yield f"{columns}, PyBullet, does not give", frame, by_bullet


def imperfect() -> Iterator[Row]:
    """Rows of three and four columns with imperfections of a column, of their places, slab or friction."""
    kinds: Mapping[str, Mapping[str, float]] = {
        "ideal": {},
        "one longer by 1 give": {"longer": 1.0},
        "one longer by 3 gives": {"longer": 3.0},
        "one longer by 30 gives": {"longer": 30.0},
        "one 1 % longer (400 gives)": {"longer": 400.0},
        "give 1e-2 b, one longer by 1 give": {"longer": 1.0, "give": 1e-2},
        "one leans 0.1 % more": {"lean": 1e-3},
        "one leans 1 % more": {"lean": 1e-2},
        "mass centre 0.2 m off": {"offset": 0.2},
        "mass centre 1 m off": {"offset": 1.0},
        "circle of 2.2 b": {"circle": 2.2},
        "circle of 6 b": {"circle": 6.0},
        "slab 3 m thick": {"thickness": 3.0},
        "slab inertia x 4": {"inertia": 4.0},
        "friction 0.55": {"friction": 0.55},
    }
    for kind, changes in kinds.items():
        for columns in (3, 4):
            yield f"{columns}, {kind}", replace(Frame(columns=columns), **changes), by_springs  # type: ignore[arg-type]
    for columns in (3, 4):
        for kind in ("one leans 1 % more", "mass centre 1 m off", "one longer by 30 gives"):
            frame = replace(Frame(columns=columns), **kinds[kind])  # type: ignore[arg-type]
            yield f"{columns}, {kind}, MuJoCo", frame, _mujoco(2e-4)


def shaken() -> Iterator[Row]:
    """Rows of slender columns (tan alpha 0.2), released at 0.3 alpha and 0.2 rad/s under El Centro."""
    slender = Frame(
        columns=1, tan_alpha=0.2, circle=5.0, tilt=0.3, spin=0.2, motion=el_centro_1940(), duration=8.0
    )
    yield "1, springs", slender, by_springs
    yield "1, MuJoCo", slender, _mujoco(2e-4, 0.995, 2.0)
    for columns in (3, 4, 6):
        for circle in (5.0, 20.0):
            frame = replace(slender, columns=columns, circle=circle)
            yield f"{columns} on a circle of {circle:g} b, springs", frame, by_springs
        yield f"{columns} on a circle of 20 b, ratio 4, springs", replace(frame, ratio=4.0), by_springs
        yield f"{columns} on a circle of 20 b, MuJoCo", frame, _mujoco(2e-4)


TABLES = {
    "one": one_column,
    "engines": engines,
    "equal": equal_columns,
    "imperfect": imperfect,
    "shaken": shaken,
}


def measured(frame: Frame, solve: Callable[[Frame], Motion]) -> tuple[float, float, float, float, float]:
    """Time until which columns stay in step [s], and largest differences up to it.

    From the reduced model and between columns in alpha, turn of the slab in rad, and the least load of a
    column over its share of the slab, in the whole run.
    """
    motion, alpha = solve(frame), frame.cylinder.alpha
    reference = frame.reference().tilt[:, None]
    count = min(len(reference), len(motion.tilt))
    off = np.abs(motion.tilt[:count] - reference[:count]).max(axis=1) / alpha
    apart = np.ptp(motion.tilt[:count], axis=1) / alpha
    parted = np.flatnonzero(apart > APART)
    until = int(parted[0]) if len(parted) else count
    kept = slice(0, max(until, 1))
    time = math.inf if until == count else SAMPLE * until
    turned = float(motion.turned[kept].max())
    return time, float(off[kept].max()), float(apart.max()), turned, float(motion.load.min())


def main(arguments: Sequence[str] | None = None) -> int:
    """Print the tables."""
    parser = options_of("frames", __doc__.partition("\n")[0])
    parser.add_argument("--only", choices=tuple(TABLES), help="one table")
    only = parser.parse_args(arguments).only
    for name, rows in TABLES.items():
        if only not in (None, name):
            continue
        print(f"\n{(rows.__doc__ or '').strip()}\n")
        print(f"{'':40} {'in step':>9} {'off model':>10} {'apart':>9} {'turned':>9} {'least load':>11}")
        for title, frame, solve in rows():
            until, off, apart, turned, load = measured(frame, solve)
            step = "all" if math.isinf(until) else f"{until:.2f} s"
            print(f"{title:40} {step:>9} {off:10.1e} {apart:9.1e} {turned:9.1e} {load:11.2f}", flush=True)
    return 0
