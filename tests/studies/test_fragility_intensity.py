"""Intensity measures compared with closed forms and an independent integration."""

from __future__ import annotations

import math

import numpy as np
import pytest
from scipy.integrate import solve_ivp

from rockwobble import reduced
from rockwobble.models import Cylinder, GroundMotion, el_centro_1940
from rockwobble.studies.fragility.intensity import MEASURES, Array, intensity, measures_of, velocity
from rockwobble.studies.fragility.runs import RunPlan, default_levels, methods_of
from rockwobble.studies.plans import FragilityPlan

PIER = Cylinder(semidiagonal=6.0, tan_alpha=0.2)


def sine(x: float = 3.0, y: float = 4.0, *, step: float = 0.01, cycles: int = 4) -> GroundMotion:
    """Sine motion with both components in phase and a period of 1 s."""
    time = np.arange(round(cycles / step) + 1) * step
    wave = np.sin(2.0 * math.pi * time)
    return GroundMotion(np.column_stack([x * wave, y * wave]), step, "sine")


def test_peaks_of_a_sine_in_closed_form():
    motion = sine()
    # the largest velocity of a sine from rest is twice its amplitude over its frequency; trapezoids of
    # hundredths of a period are 3e-4 off
    swing = 2.0 / (2.0 * math.pi)
    assert intensity("peak_acceleration", motion, PIER) == pytest.approx(5.0 / (9.81 * 0.2))
    assert intensity("peak_over_friction", motion, PIER, friction=0.1) == pytest.approx(5.0 / (9.81 * 0.1))
    assert intensity("pga", motion, PIER) == pytest.approx(math.sqrt(12.0) / 9.81)
    assert intensity("pgv", motion, PIER) == pytest.approx(math.sqrt(12.0) * swing, rel=4e-4)
    # the slender rod: p^2 = 3 g/(4 R), and 15 + cos^2(alpha) in the place of 16
    p = math.sqrt(12.0 * 9.81 / (6.0 * (15.0 + math.cos(PIER.alpha) ** 2)))
    assert intensity("peak_velocity", motion, PIER) == pytest.approx(p * 5.0 * swing / (9.81 * 0.2), rel=4e-4)


@pytest.mark.slow
def test_response_spectrum_matches_integrated_oscillator():
    motion, period = el_centro_1940(), 0.7
    omega = 2.0 * math.pi / period
    times = np.arange(len(motion.acceleration)) * motion.time_step

    def rate(t: float, state: Array) -> Array:
        ground = np.array([np.interp(t, times, motion.acceleration[:, i]) for i in (0, 1)])
        return np.concatenate([state[2:], -ground - 0.1 * omega * state[2:] - omega**2 * state[:2]])

    end = 14.0  # the peak is at 12 s
    fine = np.linspace(0.0, end, 14001)
    solved = solve_ivp(rate, (0.0, end), np.zeros(4), t_eval=fine, max_step=0.01, rtol=1e-7, atol=1e-10)
    largest = omega**2 * np.hypot(solved.y[0], solved.y[1]).max() / 9.81
    # the samples are 1/32 of a period apart, so up to 0.5 % below the peak
    value = intensity("sa", motion, PIER, period=period)
    assert value == pytest.approx(largest, rel=5e-3)
    assert value <= largest * (1.0 + 1e-4)


def test_spectrum_tends_to_ground_displacement_and_acceleration_at_its_ends():
    motion = sine()
    stiff = intensity("sa", motion, PIER, period=0.02)
    assert stiff == pytest.approx(intensity("peak_acceleration", motion, PIER) * 0.2, rel=0.02)
    assert intensity("sa", motion, PIER, period=100.0) < 0.05 * stiff


@pytest.mark.parametrize("name", list(MEASURES))
def test_measures_scale_with_the_motion_and_are_independent_of_sampling(name):
    motion = sine(x=3.0, y=1.0)
    whole = intensity(name, motion, PIER)
    assert intensity(name, motion.scaled(2.5), PIER) == pytest.approx(2.5 * whole, rel=1e-12)
    places = np.arange(2 * len(motion.acceleration) - 1) / 2.0
    halves = [
        np.interp(places, np.arange(len(motion.acceleration)), motion.acceleration[:, i]) for i in (0, 1)
    ]
    finer = GroundMotion(np.column_stack(halves), 0.5 * motion.time_step, "finer")
    # response peak between two samples
    assert intensity(name, finer, PIER) == pytest.approx(whole, rel=5e-3)


@pytest.mark.parametrize("name", ["peak_acceleration", "peak_velocity", "sa"])
def test_resultant_measures_are_invariant_under_rotation(name):
    motion = el_centro_1940()
    turned = motion.rotated(0.7)
    assert intensity(name, turned, PIER) == pytest.approx(intensity(name, motion, PIER), rel=1e-9)
    assert intensity("pga", turned, PIER) != pytest.approx(intensity("pga", motion, PIER), rel=1e-3)


def test_the_velocity_of_a_constant_acceleration_is_a_ramp():
    motion = GroundMotion(np.tile([1.0, -2.0], (5, 1)), 0.5)
    np.testing.assert_allclose(velocity(motion), np.arange(5)[:, None] * 0.5 * np.array([1.0, -2.0]))


def test_uplift_and_slide_begin_at_an_intensity_of_one():
    motion = sine()
    scale = 1.0 / intensity("peak_acceleration", motion, PIER)
    below, above = reduced.peak_tilts([6.0], 0.2, motion, [0.999 * scale, 1.001 * scale])[0]
    assert below == 0.0 < above
    scale = 1.0 / intensity("peak_over_friction", motion, PIER, friction=0.1)
    below, above = reduced.peak_displacements([0.1], motion, [0.999 * scale, 1.001 * scale])[0]
    assert below == 0.0 < above


def test_bad_input_of_intensity_measures_is_refused():
    with pytest.raises(ValueError, match=r"an intensity must be one of peak_acceleration, .* got 'pgd'"):
        intensity("pgd", sine(), PIER)
    with pytest.raises(ValueError, match="period must be positive"):
        intensity("sa", sine(), PIER, period=0.0)
    with pytest.raises(ValueError, match="friction of peak_over_friction must be positive"):
        intensity("peak_over_friction", sine(), PIER, friction=0.0)
    with pytest.raises(ValueError, match="has no pga: a component is zero throughout"):
        intensity("pga", sine(y=0.0), PIER)
    known = measures_of([sine(y=0.0)], PIER)
    assert [name for name, values in known.items() if math.isnan(values[0])] == ["pga", "pgv", "sa_mean"]


@pytest.mark.parametrize("period", [0.3, 1.0, 2.7])
@pytest.mark.parametrize("measure", MEASURES)
def test_motion_scaled_to_a_level_reaches_that_intensity_at_any_period(measure: str, period: float) -> None:
    motions = [el_centro_1940(), sine(3.0, 1.0)]
    asked = FragilityPlan(measure=measure, levels=[0.7, 1.9], period=period, friction=0.3)
    plan = RunPlan(cylinders={"pier": PIER}, motions=motions, methods=methods_of(["recess"]), options=asked)
    for motion in motions:
        for level, factor in zip((0.7, 1.9), plan.factors(PIER, motion).values(), strict=True):
            own = intensity(measure, motion.scaled(factor), PIER, period=period, friction=0.3)
            assert own == pytest.approx(level, rel=1e-12)  # rounding
    for name, over in measures_of(motions, PIER, period=period).items():
        scaled = plan.points["scale"].to_numpy() * np.repeat(over, 2)
        assert plan.points[name].to_numpy() == pytest.approx(scaled, rel=1e-12)
    assert ("peak_over_friction" in plan.points) == (measure == "peak_over_friction")
    alone = default_levels({"pier": PIER}, motions[:1], asked)
    first = intensity(measure, motions[0], PIER, period=period, friction=0.3) / intensity(
        "peak_acceleration", motions[0], PIER
    )
    assert alone[0] == pytest.approx(1.25 * first, rel=5e-3)  # of three digits


def test_default_levels_are_equivalent_in_every_measure():
    motions = [sine(3.0, 4.0), sine(3.0, 1.0)]
    bodies = {"pier": PIER}
    own = default_levels(bodies, motions, FragilityPlan())
    assert (own[0], own[-1], len(own)) == (1.25, 12.0, 20)
    over = [intensity("pgv", m, PIER) / intensity("peak_acceleration", m, PIER) for m in motions]
    other = default_levels(bodies, motions, FragilityPlan(measure="pgv"))
    assert other[0] == pytest.approx(1.25 * sum(over) / 2.0, rel=5e-3)  # of three digits
