"""What must not change the response: mirrors, scales, rotations, mass centre frames, sampling."""

import math

import numpy as np
import pytest

from rockwobble import reduced
from rockwobble.models import Case, Cylinder, GroundMotion, InitialState, el_centro_1940

PIER = Cylinder(semidiagonal=6.0, tan_alpha=0.2)
EL_CENTRO = el_centro_1940()
MODELS = ["recess", "flat"]


def copy_difference(model, until):
    """Largest difference that one rounding of the record makes, in alpha: what sensitivity does."""
    plain = reduced.simulate(Case(PIER, EL_CENTRO, duration=until), **reduced.MODELS[model])
    copy = reduced.simulate(
        Case(PIER, EL_CENTRO.scaled(1.0 + 2e-16), duration=until), **reduced.MODELS[model]
    )
    return np.abs(plain.tilt - copy.tilt).max() / PIER.alpha


@pytest.mark.parametrize("model", MODELS)
@pytest.mark.parametrize("change", ["size", "gravity", "rotation", "shift"])
def test_other_changes_of_scale_and_frame_cost_no_more_than_rounding(model, change):
    until = 15.0
    plain = reduced.simulate(Case(PIER, EL_CENTRO, duration=until), **reduced.MODELS[model])
    acceleration, step, cylinder, gravity, delay = EL_CENTRO.acceleration, 0.01, PIER, 9.81, 0.0
    if change == "size":
        cylinder, step = Cylinder(semidiagonal=6.0 * 3.0, tan_alpha=0.2), 0.01 * math.sqrt(3.0)
    elif change == "gravity":
        acceleration, gravity, step = acceleration * 0.7, 9.81 * 0.7, 0.01 / math.sqrt(0.7)
    elif change == "rotation":
        acceleration = EL_CENTRO.rotated(2.0).acceleration
    else:
        delay = 0.64
        acceleration = np.vstack([np.zeros((64, 2)), acceleration])
    other = reduced.simulate(
        Case(
            cylinder, GroundMotion(acceleration, step), gravity=gravity, duration=until * step / 0.01 + delay
        ),
        **reduced.MODELS[model],
        sample_step=step,
    )
    skip = round(delay / 0.01)
    tilt = other.tilt[skip : skip + len(plain.tilt) - 1]
    # Rounding enters at every step; ten times what one rounding of the record makes, or one part in
    # 1e10 where that is less. (The step control amplifies nothing: it decides alike.)
    allowed = max(10.0 * copy_difference(model, until), 1e-8)
    assert np.abs(tilt - plain.tilt[:-1]).max() <= allowed * PIER.alpha


@pytest.mark.parametrize("model", MODELS)
def test_ground_that_falls_all_the_time_is_less_gravity(model):
    options = {**reduced.MODELS[model], "rtol": 1e-10}
    plain = reduced.simulate(Case(PIER, EL_CENTRO, duration=15.0), **options)
    gravity = 9.81 / 0.7
    fall = np.full(len(EL_CENTRO.acceleration), 9.81 - gravity)
    motion = GroundMotion(np.column_stack([EL_CENTRO.acceleration, fall]), EL_CENTRO.time_step)
    falling = reduced.simulate(Case(PIER, motion, gravity=gravity, duration=15.0), **options)
    # the steps are others, and passes magnify what each leaves: 3e-10 was measured
    assert falling.tilt[:-1] == pytest.approx(plain.tilt[:-1], abs=3e-9 * PIER.alpha)


@pytest.mark.parametrize("azimuth", [0.0, 0.3, 1.0, 2.2, math.pi / 2, -3.0])
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
    # the component along the plane is rounded at every sample, ten times what one rounding makes
    rounding = np.abs(copy.tilt - planar.tilt).max()
    assert np.abs(turned.tilt - planar.tilt).max() <= max(10.0 * rounding, 1e-10 * PIER.alpha)


def test_tilt_after_a_release_does_not_depend_on_the_azimuth():
    for azimuth in (0.4, 3.0, -2.0):
        plain = reduced.simulate(Case(PIER, initial=InitialState(0.1, 0.0, 0.0, 0.01), duration=10.0))
        turned = reduced.simulate(Case(PIER, initial=InitialState(0.1, 0.0, azimuth, 0.01), duration=10.0))
        assert np.array_equal(plain.tilt, turned.tilt)
        assert np.abs(turned.rolling_angle - plain.rolling_angle - azimuth).max() <= 1e-13
