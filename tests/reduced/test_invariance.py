"""Invariances of the response: mirrors, scales, rotations, mass centre frames, sampling."""

import math

import numpy as np
import pytest

from rockwobble import reduced
from rockwobble.models import Case, Cylinder, GroundMotion, el_centro_1940

PIER = Cylinder(semidiagonal=6.0, tan_alpha=0.2)
EL_CENTRO = el_centro_1940()
MODELS = ["recess", "flat"]


@pytest.mark.parametrize("model", MODELS)
@pytest.mark.parametrize("delay", [0, 64])
def test_rotating_or_delaying_a_record_changes_only_rounding(model, delay):
    until, options = 15.0, reduced.MODELS[model]
    plain = reduced.simulate(Case(PIER, EL_CENTRO, duration=until), **options)
    turned = EL_CENTRO if delay else EL_CENTRO.rotated(2.0)
    motion = GroundMotion(np.vstack([np.zeros((delay, 2)), turned.acceleration]), 0.01)
    other = reduced.simulate(Case(PIER, motion, duration=until + 0.01 * delay), **options)
    tilt = other.tilt[delay : delay + len(plain.tilt) - 1]
    # Rounding enters at every step; ten times the effect of one rounding of the record, or one part in 1e10
    # where that is less. (The step control amplifies nothing: its decisions are the same.)
    copy = reduced.simulate(Case(PIER, EL_CENTRO.scaled(1.0 + 2e-16), duration=until), **options)
    allowed = max(10.0 * np.abs(plain.tilt - copy.tilt).max(), 1e-8 * PIER.alpha)
    assert np.abs(tilt - plain.tilt[:-1]).max() <= allowed


@pytest.mark.parametrize("model", MODELS)
@pytest.mark.parametrize("vertical", [2.0, -4.2])
def test_a_steady_vertical_acceleration_is_gravity(model, vertical):
    options, gravity = {**reduced.MODELS[model], "rtol": 1e-10}, 9.81 + vertical
    along = np.full(len(EL_CENTRO.acceleration), vertical)
    lifted = GroundMotion(np.column_stack([EL_CENTRO.acceleration, along]), EL_CENTRO.time_step)
    moved = reduced.simulate(Case(PIER, lifted, duration=15.0), **options)
    plain = reduced.simulate(Case(PIER, EL_CENTRO, duration=15.0, gravity=gravity), **options)
    assert moved.uplift_time == pytest.approx(plain.uplift_time, abs=1e-12)
    # the same equations in another order of summation, and other steps; passes magnify the differences
    assert moved.tilt[:-1] == pytest.approx(plain.tilt[:-1], abs=3e-9 * PIER.alpha)
    # force in weights of the given gravity
    moving = plain.tilt[:-1] > 1e-3 * PIER.alpha
    expected = plain.contact_force[:-1][moving] * gravity / 9.81
    assert moved.contact_force[:-1][moving] == pytest.approx(expected, abs=1e-4)


def test_explicit_default_inertias_give_the_same_body():
    b, h = PIER.base_radius, PIER.half_height
    transverse, axial = (3.0 * b * b + 4.0 * h * h) / 12.0, 0.5 * b * b
    inertias = {"transverse_inertia": transverse, "axial_inertia": axial}
    named = Cylinder(semidiagonal=6.0, tan_alpha=0.2, height=2.0 * h, **inertias)
    plain, other = (reduced.simulate(Case(body, EL_CENTRO, duration=10.0)) for body in (PIER, named))
    assert np.array_equal(plain.tilt, other.tilt)


@pytest.mark.parametrize("azimuth", [0.0, 1.0, math.pi / 2, -3.0])
@pytest.mark.parametrize("model", MODELS)
def test_motion_of_one_component_stays_planar_at_any_azimuth(model, azimuth):
    one = GroundMotion(EL_CENTRO.acceleration * [1.5, 0.0], EL_CENTRO.time_step)
    planar = reduced.simulate(Case(PIER, one), plane=0.0)
    copy = reduced.simulate(Case(PIER, one.scaled(1.0 + 2.0 ** (-52))), plane=0.0)
    turned = reduced.simulate(Case(PIER, one.rotated(azimuth)), **reduced.MODELS[model])
    moving = turned.tilt > 0.0
    off = np.sin(turned.rolling_angle[moving] - azimuth)
    assert np.abs(off).max() <= 1e-14
    assert not turned.twist.any()
    # the component along the plane is rounded at every sample: ten times the effect of one rounding
    rounding = np.abs(copy.tilt - planar.tilt).max()
    assert np.abs(turned.tilt - planar.tilt).max() <= max(10.0 * rounding, 1e-10 * PIER.alpha)
