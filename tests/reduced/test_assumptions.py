"""A response says in words where contact or friction would not have sufficed."""

import math

import numpy as np
import pytest

from rockwobble import reduced
from rockwobble.models import CLOSED_TILT, Case, Cylinder, GroundMotion, InitialState

PIER = Cylinder(semidiagonal=6.0, tan_alpha=0.2)


def test_steady_wobble_needs_the_friction_of_its_centripetal_force():
    tilt = 0.5 * PIER.alpha
    rate = reduced.steady_wobble_rate(PIER, tilt)
    response = reduced.simulate(Case(PIER, initial=InitialState(tilt, rolling_rate=rate), duration=2.0))
    radius = math.hypot(*response.centre_of_mass[0, :2])
    review = response.assumptions
    # the mass centre circles at constant height: N is the weight
    assert review.least_normal_force == pytest.approx(1.0, abs=1e-9)
    assert review.largest_friction_needed == pytest.approx(rate**2 * radius / 9.81, rel=1e-8)
    assert review.all_hold
    assert review.breaches == ()


def test_a_cylinder_that_stands_demands_nothing_of_the_model():
    still = reduced.simulate(Case(PIER, GroundMotion(np.zeros((10, 2)), 0.1)))
    assert still.assumptions.all_hold
    assert still.assumptions.largest_friction_needed == 0.0


@pytest.mark.parametrize("rtol", [1e-6, 1e-8, 1e-10, 1e-12])
def test_contact_loss_shorter_than_a_step_is_reported(rtol):
    initial = InitialState(1.5 * PIER.alpha, rolling_angle=0.3, rolling_rate=0.1)
    review = reduced.simulate(Case(PIER, initial=initial, duration=5.0, friction=0.6), rtol=rtol).assumptions
    assert review.least_normal_force < 0.0
    assert [breach.code for breach in review.breaches] == ["tension", "friction_needed"]
    assert (review.breaches[0].size, review.breaches[0].bound) == (review.least_normal_force, 0.0)
    assert not review.all_hold
    assert math.isinf(review.largest_friction_needed)


@pytest.mark.parametrize("length", [0.0, 0.05])
@pytest.mark.parametrize("support", ["recess", "flat"])
def test_demands_are_extrema_over_samples_with_an_open_base(support, length):
    """The sampled extrema with an open base, however near upright the motion passes."""
    release = InitialState(0.3 * PIER.alpha, rolling_rate=1e-4)
    case = Case(PIER, initial=release, duration=5.0, rolling_resistance=length)
    response = reduced.simulate(case, support=support, sample_step=2e-4)
    review, opens = response.assumptions, response.open_base
    assert (response.tilt[opens] >= CLOSED_TILT * PIER.alpha).all()
    assert np.count_nonzero(~opens & (response.tilt > 0.0)) > 0
    force = response.contact_force
    # samples of 0.2 ms miss the demand of a closing base by some percent
    for largest, sampled in (
        (review.largest_normal_force, force[opens, 2].max()),
        (review.largest_friction_needed, response.friction_needed[opens].max()),
        (1.0 - review.least_normal_force, 1.0 - force[opens, 2].min()),
    ):
        assert sampled <= largest * (1.0 + 1e-9)
        assert largest == pytest.approx(sampled, rel=0.1)
