"""Right where nobody looks: each extreme with its exact or limiting answer."""

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
    """Simulate, and check that the run ended well and passed on no NaN."""
    response = solve(*arguments, **options)
    assert response.outcome in {"stands", "overturned"}, response.facts
    for name in FIELDS:
        assert np.isfinite(getattr(response, name)).all(), name
    assert np.array_equal(np.isnan(response.rolling_angle), response.tilt == 0.0) or response.run.settings
    assert (response.tilt >= 0.0).all()
    return response


def first_turn(response):
    return math.degrees(response.passes.angle_of_turn[0])


def test_zero_spin_turns_by_pi_and_tiny_spin_by_the_limit():
    still = simulate(PIER, initial=InitialState(0.5 * PIER.alpha), duration=10.0)
    assert abs(first_turn(still)) == pytest.approx(180.0, abs=1e-12)
    spun = simulate(PIER, initial=InitialState(0.5 * PIER.alpha, rolling_rate=1e-15), duration=10.0)
    limit = math.degrees(reduced.limiting_angle_of_turn(PIER))
    assert first_turn(spun) == pytest.approx(limit, abs=1e-5)  # 1e-8 relative at the default tolerance
    mirrored = simulate(PIER, initial=InitialState(0.5 * PIER.alpha, rolling_rate=-1e-15), duration=10.0)
    assert first_turn(mirrored) == -first_turn(spun)
    # the tilt of vanishing spin is that of no spin
    assert np.abs(spun.tilt - still.tilt).max() <= 1e-6 * PIER.alpha


@pytest.mark.parametrize("spin", [1e-90, 1e-110, 1e-300])
def test_spins_that_no_number_can_resolve_end_all_the_same(spin):
    response = simulate(PIER, initial=InitialState(0.5 * PIER.alpha, rolling_rate=spin), duration=10.0)
    assert abs(first_turn(response)) == pytest.approx(181.33, abs=1.34)  # pi or the limit


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
    # the tilt is a double: each rounding is 1e-7 of alpha - theta = 2e-10, and is time by 1/p
    assert through == pytest.approx(exact, abs=1e-5)


def test_release_above_alpha_falls_in_its_exact_time():
    tilt = 1.01 * PIER.alpha
    response = simulate(PIER, initial=InitialState(tilt), duration=60.0, rtol=1e-11)
    assert response.outcome == "overturned"
    # energy: theta'^2/2 = p^2 [cos(tilt - alpha) - cos(theta - alpha)], by quadrature
    from scipy.integrate import quad

    beyond = tilt - PIER.alpha
    p = math.sqrt(response.source.problem.body.p2)

    def slowness(u):  # theta - alpha = beyond cosh(u) takes out the root at the start
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


@pytest.mark.parametrize("semidiagonal", [1e-3, 1e3])
@pytest.mark.parametrize("gravity", [0.1, 30.0])
def test_extreme_size_and_gravity_follow_froude(semidiagonal, gravity):
    cylinder = Cylinder(semidiagonal=semidiagonal, tan_alpha=0.2)
    time = math.sqrt(semidiagonal / 6.0 * 9.81 / gravity)
    reference = simulate(PIER, initial=InitialState(0.1, rolling_rate=0.3), duration=10.0)
    scaled = simulate(
        cylinder,
        initial=InitialState(0.1, rolling_rate=0.3 / time),
        duration=10.0 * time,
        sample_step=0.01 * time,
        gravity=gravity,
    )
    assert np.abs(scaled.tilt - reference.tilt).max() <= 1e-10 * PIER.alpha


def plane_wave(peak, sample_count=1001, time_step=0.01):
    """Shaking of constant direction 0.3 rad that swells to `peak` and dies out."""
    shape = np.sin(np.linspace(0.0, math.pi, sample_count))
    return GroundMotion(peak * np.outer(shape, [math.cos(0.3), math.sin(0.3)]), time_step)


def turning_wave(peak, sample_count=1001, time_step=0.01):
    shape = np.sin(np.linspace(0.0, math.pi, sample_count))
    angle = np.linspace(0.0, 2.0, sample_count)
    return GroundMotion(peak * np.column_stack([shape * np.cos(angle), shape * np.sin(angle)]), time_step)


@pytest.mark.parametrize("wave", [plane_wave, turning_wave])
def test_a_hair_under_the_threshold_stands_and_a_hair_over_uplifts(wave):
    under = simulate(PIER, wave(THRESHOLD * (1.0 - 1e-12)))
    assert under.rests
    assert under.peak_tilt == 0.0
    assert math.isnan(under.uplift_time)
    assert math.isnan(under.uplift_time)
    over = simulate(PIER, wave(THRESHOLD * (1.0 + 1e-9)))
    assert over.uplift_time == pytest.approx(5.0, abs=0.01)
    # f is at most 1e-9 g tan(alpha) for some 1e-4 s: next to nothing
    assert 0.0 < over.peak_tilt < 1e-9 * PIER.alpha


def test_zero_motion_stands():
    response = simulate(PIER, GroundMotion(np.zeros((100, 2)), 0.01))
    assert response.rests
    assert not response.energy.any()
    assert np.array_equal(response.contact_force[:, 2], np.ones(100))


def test_a_hundred_g_overturns():
    motion = el_centro_1940().scaled(100.0 * 9.81 / el_centro_1940().peak)
    response = simulate(PIER, motion)
    assert response.outcome == "overturned"


def test_samples_of_1e_5_s_act_as_a_velocity_jump():
    """A pulse much shorter than 1/p is a jump of velocity: theta' = p^2 cos(alpha) dv/g."""
    acceleration = np.zeros((201, 2))
    acceleration[50:150, 0] = -2.0e3
    response = simulate(PIER, GroundMotion(acceleration, 1e-5), duration=1.0, sample_step=1e-3)
    kick = response.source.problem.body.p2 * math.cos(PIER.alpha) * 2.0e3 * 1e-3 / 9.81
    at_end = response.tilt_rate[2]
    # the restoring moment takes off its part in 1 ms: tan(alpha)/200 of it
    assert at_end == pytest.approx(kick, rel=2e-3)


def test_interpolating_half_second_samples_does_not_change_the_motion():
    coarse = GroundMotion(el_centro_1940().acceleration[::50] * 1.2, 0.5)
    fine_time = np.arange(round(coarse.duration / 0.005) + 1) * 0.005
    at = np.arange(len(coarse.acceleration)) * 0.5
    fine = GroundMotion(np.column_stack([np.interp(fine_time, at, c) for c in coarse.acceleration.T]), 0.005)
    few = simulate(PIER, coarse, rtol=1e-10, duration=20.0)
    many = simulate(PIER, fine, rtol=1e-10, duration=20.0)
    assert few.peak_tilt > 0.1 * PIER.alpha
    assert few.peak_tilt == pytest.approx(many.peak_tilt, rel=1e-6)


def test_a_record_of_a_million_samples_has_an_outcome():
    rng = np.random.default_rng(1)
    slow = np.cumsum(rng.normal(size=(1_000_000, 2)), axis=0)
    slow -= np.linspace(slow[0], slow[-1], len(slow))
    motion = GroundMotion(slow * 1.05 * THRESHOLD / np.hypot(*slow.T).max(), 0.01)
    response = simulate(PIER, motion, sample_step=1.0)
    assert response.outcome in {"stands", "overturned"}


@pytest.mark.slow
def test_chatter_without_a_seating_rule_ends_as_failed_with_words():
    weak = turning_wave(THRESHOLD * (1.0 + 1e-6))
    response = reduced.simulate(Case(PIER, weak), rest_tilt=0.0)
    assert response.outcome == "failed"
    assert math.isnan(response.peak_tilt)
    assert [fact.code for fact in response.facts] == ["step_budget"]
    assert np.isfinite(response.tilt).all()
    assert len(response.time) == len(response.tilt)
    seated = simulate(PIER, weak)
    assert seated.peak_tilt < 1e-6 * PIER.alpha


@pytest.mark.parametrize(
    ("options", "words"),
    [
        ({"rtol": 0.0}, "rtol"),
        ({"rtol": math.nan}, "rtol"),
        ({"rest_tilt": -1.0}, "rest_tilt"),
        ({"gravity": -9.81}, "gravity"),
        ({"sample_step": 0.0}, "sample_step"),
        ({"sample_step": 1e-12}, "sample_step must be at least"),
        ({"duration": -1.0}, "duration"),
        ({"support": "sliding"}, "recess"),
        ({"restitution": 0.9}, "planar"),
        ({"model": "planar", "restitution": 1.1}, "restitution"),
    ],
)
def test_bad_options_are_named(options, words):
    with pytest.raises(ValueError, match=words):
        solve(PIER, el_centro_1940(), **options)
