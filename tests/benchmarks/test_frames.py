"""Frame solvers compared with the reduced model, and detection of columns out of step."""

from __future__ import annotations

import math

import pytest

from benchmarks.frame_solvers import Frame, by_bullet, by_mujoco, by_springs
from benchmarks.frames import measured

SHORT = 0.5  # [s]
SPRINGS = 6e-5  # of alpha, what a give of 1e-4 b leaves; 5.3e-5 in 3 s
MUJOCO = 1e-4  # of alpha, what a step of 2e-4 s leaves; 6.9e-5 in 3 s
TURNS = 4e-4  # of alpha, by which a free slab on a circle of 3 b turns its columns; 2.5e-4 in 3 s


@pytest.mark.parametrize("support", ["recess", "flat"])
def test_one_column_is_the_reduced_model(support: str) -> None:
    frame = Frame(columns=1, support=support, duration=SHORT)
    assert measured(frame, by_springs)[1] < SPRINGS
    assert measured(frame, lambda frame: by_mujoco(frame, impedance=0.995, contact_steps=2.0))[1] < MUJOCO


@pytest.mark.parametrize("solve", [by_springs, by_mujoco, by_bullet])
def test_three_columns_stay_in_step(solve: object) -> None:
    until, off, *_ = measured(Frame(columns=3, duration=SHORT), solve)  # type: ignore[arg-type]
    assert math.isinf(until)
    assert off < TURNS


def test_four_unequal_columns_diverge() -> None:
    until, _, apart, _, load = measured(Frame(columns=4, longer=30.0, duration=SHORT), by_springs)
    assert until < SHORT
    assert apart > 0.01
    assert load == 0.0
