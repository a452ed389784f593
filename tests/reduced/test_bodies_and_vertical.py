"""Bodies other than the homogeneous cylinder, and the vertical component of the ground motion."""

import numpy as np
import pytest

from rockwobble import reduced
from rockwobble.models import Case, Cylinder, GroundMotion, InitialState, el_centro_1940

PIER = Cylinder(semidiagonal=6.0, tan_alpha=0.2)


def test_the_default_inertias_by_name_are_the_same_body():
    b, h = PIER.base_radius, PIER.half_height
    named = Cylinder(
        semidiagonal=6.0,
        tan_alpha=0.2,
        height=2.0 * h,
        transverse_inertia=(3.0 * b * b + 4.0 * h * h) / 12.0,
        axial_inertia=0.5 * b * b,
    )
    plain, other = (reduced.simulate(Case(c, el_centro_1940(), duration=10.0)) for c in (PIER, named))
    assert np.array_equal(plain.tilt, other.tilt)


def test_a_point_mass_on_a_light_column_is_a_pendulum():
    """Without inertia of its own p^2 = g/R: Housner's equation of the inverted pendulum."""
    bob = Cylinder(semidiagonal=4.0, tan_alpha=0.2, transverse_inertia=1e-12, axial_inertia=1e-12)
    initial = InitialState(0.3 * bob.alpha)
    period = reduced.rocking_period(bob, initial.tilt)
    response = reduced.simulate(Case(bob, initial=initial, duration=1.1 * period), rtol=1e-11)
    assert response.source.problem.body.p2 == pytest.approx(9.81 / 4.0, rel=1e-12)
    # two passes in a full cycle
    assert response.extrema[4, 0] == pytest.approx(period, rel=1e-9)


def test_a_deck_mass_raises_the_centre_and_rocks_more_slowly():
    plain = Cylinder.from_dimensions(base_radius=1.0, height=8.0)
    decked = Cylinder.from_dimensions(base_radius=1.0, height=8.0, mass_centre_height=6.0)
    assert decked.tan_alpha == pytest.approx(1.0 / 6.0)
    assert decked.half_height == pytest.approx(4.0)
    # the threshold of uplift is g b/h of the mass centre
    for cylinder in (plain, decked):
        threshold = 9.81 / cylinder.mass_centre_height
        wave = np.column_stack([np.linspace(0.0, 2.0 * threshold, 101), np.zeros(101)])
        response = reduced.simulate(Case(cylinder, GroundMotion(wave, 0.01)))
        assert response.uplift_time == pytest.approx(0.5, abs=1e-12)


def with_vertical(motion, vertical):
    return GroundMotion(np.column_stack([motion.acceleration, vertical]), motion.time_step)


@pytest.mark.parametrize("model", ["recess", "flat"])
def test_a_steady_vertical_acceleration_is_gravity(model):
    motion = el_centro_1940()
    lifted = with_vertical(motion, np.full(len(motion.acceleration), 2.0))
    response = reduced.simulate(Case(PIER, lifted, duration=12.0), **reduced.MODELS[model])
    heavier = reduced.simulate(Case(PIER, motion, duration=12.0, gravity=11.81), **reduced.MODELS[model])
    assert response.uplift_time == pytest.approx(heavier.uplift_time, abs=1e-12)
    # the same equations, summed in another order; passes multiply the rounding
    assert np.abs(response.tilt - heavier.tilt).max() <= 1e-7 * PIER.alpha
    # force in weights of the given gravity
    moving = heavier.tilt > 1e-3 * PIER.alpha
    expected = heavier.contact_force[moving] * 11.81 / 9.81
    assert response.contact_force[moving] == pytest.approx(expected, abs=1e-4)


def test_the_vertical_component_decides_the_uplift():
    horizontal = np.full(201, 0.98 * 9.81 * PIER.tan_alpha)
    vertical = np.linspace(0.0, -9.81 * 0.04, 201)
    motion = GroundMotion(np.column_stack([horizontal, np.zeros(201), vertical]), 0.01)
    response = reduced.simulate(Case(PIER, motion))
    # |a| = (g + az) tan(alpha) where az = -0.02 g, halfway
    assert response.uplift_time == pytest.approx(1.0, abs=1e-12)
    assert reduced.simulate(Case(PIER, with_vertical(motion_without_z(motion), 0.0 * vertical))).rests


def motion_without_z(motion):
    return GroundMotion(motion.acceleration[:, :2], motion.time_step)
