"""Contact force of the engines against that of the reduced models, and friction demands."""

from __future__ import annotations

import math

import numpy as np
import pytest

from rockwobble import multibody, reduced
from rockwobble.models import Case, Cylinder, InitialState, Trace, el_centro_1940

pytestmark = pytest.mark.slow

# Of the force: the goal. Measured: 0.4 % in free response, 0.5 % under El Centro.
FORCE = 0.01
# Between passes: the model's tilt is above this share of alpha, and the uplift is 0.1 s past. Below it the
# force changes by weights within the ten milliseconds between two samples.
BETWEEN = 0.1
# Of b in each turn: the goal. Measured: 2e-6 in MuJoCo, 2e-5 in PyBullet.
SLIP = 1e-3

ENGINES = [name for name in ("mujoco", "pybullet") if name in multibody.available_engines()]  # with contact


def _agree(run: multibody.Trajectory, model: Trace, alpha: float, start: float) -> None:
    np.testing.assert_allclose(run.time, model.time, rtol=1e-14)  # rounding
    between = (model.tilt > BETWEEN * alpha) & (model.time >= start)
    assert between.sum() > 200
    forces, expected = run.contact_force[between], model.contact_force[between]
    difference = forces - expected
    size = np.linalg.norm(expected, axis=1)
    assert (np.abs(difference[:, 2]) < FORCE * expected[:, 2]).all()
    # the horizontal force passes through zero, so it is compared with the whole force
    assert (np.hypot(difference[:, 0], difference[:, 1]) < FORCE * size).all()


@pytest.mark.parametrize("engine", ENGINES)
@pytest.mark.parametrize("support", ["recess", "flat"])
@pytest.mark.parametrize("tan_alpha", [0.2, 1.0])
def test_force_of_a_free_response_is_that_of_the_model(engine: str, support: str, tan_alpha: float) -> None:
    cylinder = Cylinder(semidiagonal=6.0, tan_alpha=tan_alpha)
    initial = InitialState(cylinder.alpha / 2, rolling_rate=0.5)
    run = multibody.simulate(Case(cylinder, initial=initial, duration=2.5), engine=engine, support=support)
    model = reduced.simulate(Case(cylinder, initial=initial, duration=2.5), support=support)
    _agree(run, model, cylinder.alpha, 0.0)


@pytest.mark.parametrize("support", ["recess", "flat"])
def test_force_under_el_centro_is_that_of_the_model(support: str) -> None:
    # rest, uplift and two passes; the record has a kink at every sample
    cylinder, motion = Cylinder(semidiagonal=10.0, tan_alpha=0.1), el_centro_1940()
    run = multibody.simulate(Case(cylinder, motion, duration=6.0), support=support)
    model = reduced.simulate(Case(cylinder, motion, duration=6.0), support=support)
    _agree(run, model, cylinder.alpha, model.uplift_time + 0.1)
    standing = model.time < model.uplift_time - 0.1
    # the window of the mean, 8 ms, rounds the kinks of the record
    np.testing.assert_allclose(run.contact_force[standing], model.contact_force[standing], atol=1e-3)


@pytest.mark.parametrize("engine", ENGINES)
@pytest.mark.parametrize("support", ["recess", "flat"])
def test_a_steady_wobble_reports_insufficient_friction(engine: str, support: str) -> None:
    cylinder = Cylinder(semidiagonal=6.0, tan_alpha=0.5)
    tilt = 0.3 * cylinder.alpha
    period = reduced.wobbling_period(cylinder, tilt)
    initial = InitialState(tilt, rolling_rate=2.0 * math.pi / period)
    needed = float(
        reduced.simulate(Case(cylinder, initial=initial, duration=period), support=support)
        .friction_needed.max()
    )  # fmt: skip

    def wobble(friction: float, duration: float) -> Trace:
        return multibody.simulate(
            Case(cylinder, initial=initial, duration=duration, friction=friction),
            engine=engine,
            support=support,
        )

    held = wobble(1.2 * needed, period)
    assert (held.outcome, held.facts) == ("stands", ())
    assert np.ptp(held.rolling_angle) == pytest.approx(2.0 * math.pi, rel=1e-3)
    assert held.slip[-1] < SLIP * cylinder.base_radius
    assert np.abs(held.contact_offset).max() < SLIP * cylinder.base_radius
    # it slides, which is a diagnostic and no failure
    lost = wobble(0.8 * needed, period / 4.0)
    assert lost.outcome == "stands"
    assert lost.first("slip") < period / 4.0
    assert lost.slip[-1] > 0.01 * cylinder.base_radius
    assert np.abs(lost.contact_offset).max() > SLIP * cylinder.base_radius
