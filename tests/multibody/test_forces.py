"""The contact force, step by step and as means about the samples."""

from __future__ import annotations

import mujoco
import numpy as np
import pytest
from engine_samples import scene_of

from rockwobble.models import Cylinder, InitialState
from rockwobble.models.support import FLAT, RECESS, Support
from rockwobble.multibody.engines.mujoco import MujocoEngine
from rockwobble.multibody.engines.mujoco_scene import MujocoSettings, compile_scene
from rockwobble.multibody.reaction import HALF_WINDOW, ForceSamples, force_of_steps
from rockwobble.multibody.recorder import Recorder

STEP = 1e-4


@pytest.mark.parametrize("support", [RECESS, FLAT])
def test_force_of_a_step_equals_the_engines_contact_force(support: Support) -> None:
    # pushed sideways like an inertia force, so that friction has work to do
    initial = InitialState(0.2, tilt_rate=0.1, rolling_angle=0.7, rolling_rate=0.5)
    scene = scene_of(Cylinder(semidiagonal=6.0, tan_alpha=0.5), initial, support=support)
    ground = np.tile([1.5, -0.8, 0.0], (41, 1))
    engine = MujocoEngine()
    settings = engine.settings({}, scene)
    recorder = Recorder(scene, np.array([0.0]), 0.7, False)
    with engine.open(scene, settings) as stepper:
        poses, after = recorder._pair(stepper.advance(ground))
    force = force_of_steps(poses, after, ground, STEP, 9.81)
    model = compile_scene(scene, MujocoSettings(**settings), standing=False)
    for index in (1, 20, 40):
        # the same step repeated, from its pose and velocity
        data = mujoco.MjData(model)
        data.qpos[:3], data.qpos[3:] = poses.position[index], poses.quaternion[index]
        data.qvel[:3] = poses.velocity[index]
        mujoco.mju_rotVecQuat(
            data.qvel[3:], poses.angular_velocity[index], poses.quaternion[index] * [1.0, -1.0, -1.0, -1.0]
        )
        data.ctrl[:2] = -ground[index, :2]
        mujoco.mj_forward(model, data)
        wrench = np.zeros(6)
        mujoco.mj_contactForce(model, data, 0, wrench)
        own = data.contact[0].frame.reshape(3, 3).T @ wrench[:3] / 9.81
        # the difference of two velocities of some m/s over 1e-4 s; contact multiplies rounding of the depth
        np.testing.assert_allclose(force[:, index], own, atol=1e-6)


def test_means_of_a_linear_force_are_that_force() -> None:
    # a straight line is its own mean under a symmetric window, whatever the chunks
    samples = 1e-3 * np.array([0.0, 4.03, 5.0, 9.999, 10.0, 24.96])
    number = np.arange(260)
    force = np.stack([1.0 + 0.01 * number, 2.0 - 0.02 * number, 3.0 + 0.0 * number])
    record = ForceSamples(samples, STEP)
    for first, last in ((0, 100), (100, 101), (101, 200), (200, 251)):
        record.add(force[:, first:last])
    forces = record.at(samples)
    at = samples / STEP
    inner = slice(1, 5)
    expected = np.stack([1.0 + 0.01 * at, 2.0 - 0.02 * at, 3.0 + 0.0 * at], axis=1)
    np.testing.assert_allclose(forces[inner], expected[inner], rtol=1e-12, atol=1e-14)
    # at both ends the window is cut: within a third of its half width
    slope = 0.02 * HALF_WINDOW / 3.0
    np.testing.assert_allclose(forces[[0, -1]], expected[[0, -1]], atol=slope)
    assert (forces[[0, -1], 0] != expected[[0, -1], 0]).all()


def test_load_is_averaged_over_an_empty_and_a_doubled_step() -> None:
    force = np.ones((3, 400))
    force[:, 203], force[:, 204] = 0.0, 2.0
    record = ForceSamples(np.array([0.02]), STEP)
    record.add(force)
    # weights of neighbours in the window differ by at most pi/2/33^2
    np.testing.assert_allclose(record.at(np.array([0.02])), np.ones((1, 3)), atol=1.5e-3)


def test_the_contact_force_of_the_first_step_is_ignored() -> None:
    force = np.ones((3, 400))
    force[:, 0] = 50.0
    record = ForceSamples(np.array([0.0]), STEP)
    record.add(force)
    np.testing.assert_allclose(record.at(np.array([0.0])), np.ones((1, 3)), rtol=1e-12)
