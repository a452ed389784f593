"""Results of a recorder, for any division of the steps into chunks."""

from __future__ import annotations

import itertools
from typing import Any

import numpy as np
import pytest
from engine_samples import scene_of
from numpy.typing import NDArray

from rockwobble.models import Cylinder, GroundMotion, InitialState
from rockwobble.multibody.engines.mujoco import MujocoEngine
from rockwobble.multibody.excitation import StepMeans
from rockwobble.multibody.kinematics import axis_of
from rockwobble.multibody.passes import TurningPoint
from rockwobble.multibody.protocol import Steps
from rockwobble.multibody.recorder import COLUMNS, Recorder
from rockwobble.multibody.scene import Scene, Start, froude_scale, scaled_body, starting_state

STEP = 1e-4
PIER = Cylinder(semidiagonal=6.0, tan_alpha=0.2)
BODY = scaled_body(PIER, 1.0)
# rounding of sums that begin again with every chunk
ROUNDING = {"rtol": 1e-9, "atol": 1e-12}


def part(steps: Steps, rows: slice) -> Steps:
    return Steps(
        steps.position[rows], steps.quaternion[rows], steps.velocity[rows], steps.angular_velocity[rows]
    )


def record(
    scene: Scene,
    steps: Steps,
    acceleration: NDArray[np.float64],
    samples: NDArray[np.float64],
    chunks: list[int],
) -> Recorder:
    recorder = Recorder(scene, samples, 0.0, False)
    edges = [0, *np.cumsum(chunks), len(steps.position)]
    for first, last in itertools.pairwise(edges):
        if not recorder.ended:
            rows = slice(int(first), int(last))
            recorder.take(part(steps, rows), acceleration[rows])
    return recorder


def after_uplift(recorder: Recorder) -> list[TurningPoint]:
    """Turning points without the noise of standing."""
    assert recorder.uplift is not None
    return [point for point in recorder.points if point.time > recorder.uplift[0]]


def computed(initial: InitialState | None, motion: GroundMotion | None, count: int) -> Any:
    """Steps of MuJoCo, the scene, and the ground acceleration."""
    scene = scene_of(PIER, initial)
    engine = MujocoEngine()
    acceleration = StepMeans(motion, froude_scale(6.0, 9.81), STEP)(0, count)
    with engine.open(scene, engine.settings({}, scene)) as stepper:
        return scene, stepper.advance(acceleration), acceleration


@pytest.mark.parametrize("chunks", [[], [1, 1, 700, 5], [311] * 9])
def test_twist_is_continuous_over_turns_and_signs_of_the_quaternion(chunks: list[int]) -> None:
    # it spins about its axis at constant tilt: the twist is the rate times the time
    rate, count = -40.0, 3001
    leaning = starting_state(BODY, InitialState(0.1, rolling_angle=0.7), 1.0)
    spin = rate * axis_of(leaning.quaternion[None])
    start = Start(False, leaning.position, leaning.quaternion, np.zeros(3), spin[0])
    time = STEP * np.arange(1, count + 1)
    w, x, y, _ = leaning.quaternion
    cosine, sine = np.cos(0.5 * rate * time), np.sin(0.5 * rate * time)
    quaternion = np.stack([w * cosine, x * cosine + y * sine, y * cosine - x * sine, w * sine], axis=1)
    # Bullet returns either sign
    quaternion *= np.random.default_rng(0).choice([-1.0, 1.0], size=(count, 1))
    ones = np.ones((count, 1))
    steps = Steps(leaning.position * ones, quaternion, 0.0 * ones * leaning.position, spin * ones)
    samples = 0.01 * np.arange(31)
    motion = record(scene_of(PIER, start=start), steps, np.zeros((count, 3)), samples, chunks)
    assert not motion.ended, motion.failure
    twist = motion.table[:, 1 + COLUMNS.index("twist")]
    np.testing.assert_allclose(twist, rate * samples, atol=1e-9)
    assert abs(twist[-1]) > 3.0 * np.pi


@pytest.mark.parametrize("chunks", [[2, 998, 1, 7, 1500], [400] * 10, "at its turns"])
def test_results_are_the_same_for_any_chunks(chunks: Any) -> None:
    # it stands, uplifts, rocks and wobbles, and passes upright twice
    motion = GroundMotion([[0.0, 0.0], [4.0, 0.3], [-3.0, 0.2], [0.5, 0.1], [0.0, 0.0]], 0.15)
    scene, steps, acceleration = computed(None, motion, 15001)
    samples = 0.0137 * np.arange(110)
    whole = record(scene, steps, acceleration, samples, [])
    if chunks == "at its turns":
        turns = [round(point.time / STEP) + off for point in after_uplift(whole) for off in (-1, 0, 1, 2)]
        chunks = np.diff(np.unique(turns), prepend=0).tolist()
    parts = record(scene, steps, acceleration, samples, chunks)
    np.testing.assert_allclose(parts.table, whole.table, **ROUNDING)
    np.testing.assert_allclose(parts.forces.at(samples), whole.forces.at(samples), **ROUNDING)
    assert parts.uplift == whole.uplift
    assert len(after_uplift(whole)) > 3
    for one, other in zip(after_uplift(parts), after_uplift(whole), strict=True):
        assert one.is_maximum == other.is_maximum
        np.testing.assert_allclose(
            [one.time, one.tilt, one.rolling_angle], [other.time, other.tilt, other.rolling_angle], **ROUNDING
        )
    assert parts.peak == whole.peak
    assert parts.rests.rests() == whole.rests.rests()
    assert parts.energy.largest == whole.energy.largest
    np.testing.assert_allclose([parts.slip_time, parts.flight_time], [whole.slip_time, whole.flight_time])


def test_motion_after_overturning_is_not_recorded() -> None:
    scene, steps, acceleration = computed(InitialState(1.2), None, 10000)
    tilt = np.arccos(axis_of(steps.quaternion)[:, 2])
    over = int(np.argmax(tilt > 0.5 * np.pi - 1e-3))
    assert 0 < over < 9000
    samples = 0.01 * np.arange(101)
    alone = record(scene, part(steps, slice(over + 2)), acceleration, samples, [])
    # thrown about by the engine
    position, velocity = steps.position.copy(), steps.velocity.copy()
    position[over + 2 :] += np.linspace([0.0, 0.0, 0.0], [3.0, 0.0, 5.0], len(position) - over - 2)
    velocity[over + 2 :] += [50.0, 0.0, 80.0]
    thrown = Steps(position, steps.quaternion, velocity, steps.angular_velocity)
    motion = record(scene, thrown, acceleration, samples, [])
    assert (motion.ended, motion.end_time) == (alone.ended, alone.end_time) == ("overturned", motion.end_time)
    np.testing.assert_array_equal(motion.table, alone.table)
    np.testing.assert_array_equal(motion.last_row, alone.last_row)
    np.testing.assert_array_equal(
        [motion.slip_time, motion.flight_time, motion.fastest],
        [alone.slip_time, alone.flight_time, alone.fastest],
    )
    assert motion.energy.remark(np.inf) == alone.energy.remark(np.inf)


def test_samples_between_steps_lie_on_the_straight_line_between_them() -> None:
    scene, steps, acceleration = computed(InitialState(0.12, rolling_rate=0.5), None, 2001)
    every = record(scene, steps, acceleration, STEP * np.arange(2001), []).table
    samples = 0.00137 * np.arange(1, 140)
    # the first two chunks end just before a sample, which lies between them
    table = record(scene, steps, acceleration, samples, [14, 14, 333]).table
    np.testing.assert_array_equal(table[:, 0], samples)
    for column in range(1, 1 + len(COLUMNS)):
        line = np.interp(samples, every[:, 0], every[:, column])
        np.testing.assert_allclose(table[:, column], line, rtol=1e-9, atol=1e-12)
