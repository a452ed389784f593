"""Extremes of each input, each with its exact or limiting answer."""

import math

import numpy as np
import pytest
from stating import solve

from rockwobble import reduced
from rockwobble.models import Case, Cylinder, GroundMotion, InitialState, el_centro_1940

PIER = Cylinder(semidiagonal=6.0, tan_alpha=0.2)
THRESHOLD = 9.81 * 0.2
FIELDS = ["tilt", "tilt_rate", "rolling_rate", "twist", "centre_of_mass", "energy", "contact_force"]


def simulate(*arguments, **options):
    """Run that ended well, without a NaN."""
    response = solve(*arguments, **options)
    assert response.outcome in {"stands", "overturned"}, response.facts
    for name in FIELDS:
        assert np.isfinite(getattr(response, name)).all(), name
    assert np.array_equal(np.isnan(response.rolling_angle), response.tilt == 0.0) or response.run.settings
    assert (response.tilt >= 0.0).all()
    return response


def test_zero_spin_turns_by_pi_and_tilts_as_tiny_spin_does():
    still, spun = (
        simulate(PIER, initial=InitialState(0.5 * PIER.alpha, rolling_rate=spin), duration=10.0)
        for spin in (0.0, 1e-15)
    )
    assert abs(still.passes.angle_of_turn[0]) == pytest.approx(math.pi, abs=1e-14)
    assert np.abs(spun.tilt - still.tilt).max() <= 1e-6 * PIER.alpha


def test_rocking_period_at_tiny_tilt_scales_with_its_square_root():
    tilt = 1e-12 * PIER.alpha
    initial = InitialState(tilt, rolling_rate=1e-3)
    quarter = reduced.free_response(PIER, initial).half_period
    response = simulate(PIER, initial=initial, duration=20.0 * quarter, sample_step=quarter, rest_tilt=0.0)
    # the restoring moment is constant at such tilts: theta = tilt - p^2 sin(alpha) t^2/2
    p2 = response.source.problem.body.p2
    assert quarter == pytest.approx(math.sqrt(2.0 * tilt / (p2 * math.sin(PIER.alpha))), rel=1e-6)
    assert response.passes.time[0] == pytest.approx(quarter, rel=1e-7)
    at_rest = simulate(PIER, initial=initial, duration=1.0)
    assert at_rest.rests


def test_release_a_hair_below_alpha_takes_its_exact_time():
    tilt = PIER.alpha * (1.0 - 1e-9)
    exact = reduced.rocking_period(PIER, tilt) / 4.0
    response = simulate(PIER, initial=InitialState(tilt), duration=1.2 * exact)
    through = response.extrema[response.extrema[:, 3] < 0.0][0, 0]
    # the tilt is a double: one rounding is 1e-7 of alpha - theta = 2e-10, and changes the time by 1e-7/p
    assert through == pytest.approx(exact, abs=1e-5)


def test_release_above_alpha_falls_in_its_exact_time():
    tilt = 1.01 * PIER.alpha
    response = simulate(PIER, initial=InitialState(tilt), duration=60.0, rtol=1e-11)
    assert response.outcome == "overturned"
    # energy: theta'^2/2 = p^2 [cos(tilt - alpha) - cos(theta - alpha)], by quadrature
    from scipy.integrate import quad

    beyond = tilt - PIER.alpha
    p = math.sqrt(response.source.problem.body.p2)

    def slowness(u):  # theta - alpha = beyond cosh(u), which removes the root singularity at the start
        x = beyond * math.cosh(u)
        drop = 2.0 * math.sin(0.5 * (x + beyond)) * math.sin(0.5 * (x - beyond))
        return beyond * math.sinh(u) / math.sqrt(2.0 * drop) if u else 1.0

    end = math.acosh((0.5 * math.pi - PIER.alpha) / beyond)
    exact = quad(slowness, 0.0, end, epsabs=1e-12)[0] / p
    assert response.time[-1] == pytest.approx(exact, rel=1e-8)


@pytest.mark.parametrize("tan_alpha", [1e-3, 1e3])
def test_extreme_slenderness_keeps_the_exact_turn_and_period(tan_alpha):
    cylinder = Cylinder(semidiagonal=6.0, tan_alpha=tan_alpha)
    initial = InitialState(0.5 * cylinder.alpha, rolling_rate=0.3)
    exact = reduced.free_response(cylinder, initial)
    response = simulate(cylinder, initial=initial, duration=2.5 * exact.period, rtol=1e-11)
    assert response.passes.angle_of_turn[0] == pytest.approx(exact.angle_of_turn, rel=1e-8)
    assert response.passes.time[0] == pytest.approx(exact.half_period, rel=1e-8)


def wave(peak, turn):
    """Shaking that swells to `peak` and dies out, while its direction turns from 0.3 rad."""
    shape, angle = np.sin(np.linspace(0.0, math.pi, 1001)), 0.3 + np.linspace(0.0, turn, 1001)
    return GroundMotion(peak * np.column_stack([shape * np.cos(angle), shape * np.sin(angle)]), 0.01)


@pytest.mark.parametrize("turn", [0.0, 2.0])
def test_it_stands_just_under_the_threshold_and_uplifts_just_over_it(turn):
    under = simulate(PIER, wave(THRESHOLD * (1.0 - 1e-12), turn))
    assert under.rests
    assert under.peak_tilt == 0.0
    assert math.isnan(under.uplift_time)
    over = simulate(PIER, wave(THRESHOLD * (1.0 + 1e-9), turn))
    assert over.uplift_time == pytest.approx(5.0, abs=0.01)
    # f is at most 1e-9 g tan(alpha) for some 1e-4 s: a negligible impulse
    assert 0.0 < over.peak_tilt < 1e-9 * PIER.alpha


# with samples shorter than 1e-6/p the uplift may be one sample late, which takes half a percent of the pulse
@pytest.mark.parametrize(("size", "time_step", "late"), [(6.0, 1e-5, 0.0), (1000.0, 2e-6, 0.005)])
def test_a_pulse_far_shorter_than_the_motion_is_a_velocity_jump(size, time_step, late):
    """A pulse much shorter than 1/p is a jump of velocity: theta' = p^2 cos(alpha) dv/g."""
    body, acceleration = Cylinder(semidiagonal=size, tan_alpha=0.2), np.zeros((201, 2))
    acceleration[50:150, 0] = -2.0e3
    response = simulate(body, GroundMotion(acceleration, time_step), duration=1.0, sample_step=1e-3)
    p2, jump = response.source.problem.body.p2, 2.0e3 * 100 * time_step
    # the restoring moment reduces it up to the sample at 2 ms
    slowed = p2 * math.sin(body.alpha) * (2e-3 - 50 * time_step)
    kick = p2 * math.cos(body.alpha) * jump / 9.81
    assert response.tilt_rate[2] == pytest.approx(kick * (1.0 - late) - slowed, rel=5e-4)


def test_a_record_of_a_million_samples_has_an_outcome():
    rng = np.random.default_rng(1)
    slow = np.cumsum(rng.normal(size=(1_000_000, 2)), axis=0)
    slow -= np.linspace(slow[0], slow[-1], len(slow))
    motion = GroundMotion(slow * 1.05 * THRESHOLD / np.hypot(*slow.T).max(), 0.01)
    response = simulate(PIER, motion, sample_step=1.0)
    assert response.outcome in {"stands", "overturned"}


@pytest.mark.slow
def test_chatter_without_a_rest_threshold_fails_and_is_masked_in_grids():
    weak = wave(THRESHOLD * (1.0 + 1e-6), 2.0)
    response = reduced.simulate(Case(PIER, weak), rest_tilt=0.0)
    assert response.outcome == "failed"
    assert math.isnan(response.peak_tilt)
    assert [fact.code for fact in response.facts] == ["step_budget"]
    assert np.isfinite(response.tilt).all()
    assert len(response.time) == len(response.tilt)
    assert simulate(PIER, weak).peak_tilt < 1e-6 * PIER.alpha
    (peaks,) = reduced.peak_tilts([6.0], 0.2, weak, [0.9, 1.0], rest_tilt=0.0)
    assert peaks[0] == 0.0
    assert math.isnan(peaks[1])


@pytest.mark.parametrize(
    ("options", "words"),
    [
        ({"rtol": 0.0}, "rtol"),
        ({"rest_tilt": -1.0}, "rest_tilt"),
        ({"sample_step": 0.0}, "sample_step"),
        ({"sample_step": 1e-12}, "sample_step must be at least"),
        ({"support": "sliding"}, "recess"),
        ({"restitution": 0.9}, "planar"),
        ({"model": "planar", "restitution": 1.1}, "restitution"),
    ],
)
def test_bad_options_are_refused_by_name(options, words):
    with pytest.raises(ValueError, match=words):
        solve(PIER, el_centro_1940(), **options)
