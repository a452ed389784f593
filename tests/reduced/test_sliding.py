"""The sliding model against closed forms, symmetries and explicit steps of another formulation."""

from __future__ import annotations

import math

import numpy as np
import pytest
from numpy.typing import NDArray
from reference.slides import TABLE, shaking
from scipy.integrate import solve_ivp

from rockwobble import reduced
from rockwobble.models import Case, Cylinder, GroundMotion, InitialState, Tendon, Trace, WobblingFrame

BODY = Cylinder(semidiagonal=3.0, tan_alpha=0.5)
G = 9.81
EXACT = 1e-11  # of the peak: thousands of steps of tolerance 1e-13

Samples = NDArray[np.float64]


def slide(samples: Samples, step: float, friction: float, duration: float | None = None) -> Trace:
    case = Case(BODY, GroundMotion(samples, step), friction=friction, duration=duration)
    return reduced.simulate(case, support="flat", sample_step=step)


def test_rectangular_pulse_slides_by_its_closed_form() -> None:
    size, length, friction = 7.0, 0.4, 0.3
    direction = np.array([0.6, -0.8])
    trace = slide(np.outer(np.ones(11), size * direction), length / 10, friction)
    expected = size * length**2 * (size - friction * G) / (2 * friction * G)
    assert trace.mode == "slides"
    assert trace.peak_displacement == pytest.approx(expected, rel=EXACT)
    np.testing.assert_allclose(trace.displacement[-1], -expected * direction, rtol=EXACT)
    assert trace.followed_until == pytest.approx(size * length / (friction * G), rel=EXACT)
    assert trace.rests
    np.testing.assert_allclose(trace.energy_lost, friction * G * trace.slip, rtol=EXACT, atol=1e-13)


def test_circling_ground_slides_at_constant_speed() -> None:
    size, rate, friction = 5.0, 4.0, 0.3
    time = np.arange(0.0, 20.0, 0.002)
    trace = slide(size * np.column_stack([np.cos(rate * time), np.sin(rate * time)]), 0.002, friction)
    steady = math.sqrt(size**2 - (friction * G) ** 2) / rate
    speed = np.sqrt(2.0 * trace.energy[(trace.time > 10.0) & (trace.time < 19.0)])
    np.testing.assert_allclose(speed, steady, rtol=1e-5)  # linear between samples: (rate step)^2/12


@pytest.mark.parametrize("seed", range(4))
def test_slide_is_rotated_mirrored_and_scaled_with_its_ground(seed: int) -> None:
    samples, friction = shaking(seed)
    trace = slide(samples, 0.02, friction)
    peak = trace.peak_displacement
    place, turn = trace.displacement[:25], np.array([[0.6, 0.8], [-0.8, 0.6]])
    turned, mirrored, harder = samples.copy(), samples * [-1.0, -1.0, 1.0], samples * [1.1, 1.1, 1.0]
    turned[:, :2] = samples[:, :2] @ turn
    finer = np.column_stack([np.interp(np.arange(49) / 2, np.arange(25), each) for each in samples.T])
    for other, expected, limit in (
        (slide(turned, 0.02, friction), place @ turn, 1e-9),
        (slide(mirrored, 0.02, friction), -place, EXACT),
        (slide(harder, 0.02, 1.1 * friction), 1.1 * place, 1e-9),
        (slide(samples, 0.06, friction), 9.0 * place, 1e-8),
    ):
        np.testing.assert_allclose(other.displacement[:25], expected, atol=limit * peak)
    np.testing.assert_allclose(slide(finer, 0.01, friction).displacement[:49:2], place, atol=1e-9 * peak)


def test_peak_displacement_may_lie_between_samples() -> None:
    for seed in range(8):
        samples, friction = shaking(seed)
        case = Case(BODY, GroundMotion(samples, 0.02), friction=friction)
        dense = reduced.simulate(case, support="flat", sample_step=1e-5)
        away = np.hypot(*dense.displacement.T).max()
        assert away * (1.0 - 1e-12) <= dense.peak_displacement <= away * (1.0 + 1e-6), seed


def test_random_slides_match_small_time_steps() -> None:
    for seed, *place in np.loadtxt(TABLE, delimiter=",", skiprows=1, usecols=(0, 1, 2)):
        samples, friction = shaking(int(seed))
        trace = slide(samples, 0.02, friction)
        off = np.abs(trace.displacement[24] - place).max()
        assert off < 1e-10 * trace.peak_displacement, f"{seed}"  # error of starts at a root


def start_in_polar(force: Samples, slope: Samples, n: Samples, times: Samples) -> Samples:
    """Speed, direction and path of a start from rest at t = 0, by steps in log t: (n, 3)."""
    size, cross = math.hypot(*force), force[0] * slope[1] - force[1] * slope[0]
    over, rate = size - n[0], force @ slope / size - n[1]
    begin = times[0] * (1e-6 if over else 1e-2)  # from a root of f the direction soon is that of the force
    speed = over * begin + 0.5 * rate * begin**2 + cross**2 / size**3 * begin**3 / 6.0

    def rates(log: float, y: Samples) -> list[float]:
        t = math.exp(log)
        f, along = force + slope * t, np.array([math.cos(y[1]), math.sin(y[1])])
        turn = (along[0] * f[1] - along[1] * f[0]) / y[0]
        return [t * (f @ along - n[0] - n[1] * t), t * turn, t * y[0]]

    way = (0.5 * over + rate * begin / 6.0) * begin**2
    state = [speed, math.atan2(*(force + slope * begin)[::-1]), way]
    bounds = [1e-13 * speed, 1e-14, 1e-13 * way]
    span = (math.log(begin), math.log(times[-1]))
    return solve_ivp(rates, span, state, "LSODA", np.log(times), rtol=1e-13, atol=bounds).y.T


# time over |f|/|f'| = 1 s: terms of third order are left out, from a root of second order
@pytest.mark.parametrize(
    ("force", "slope", "off"),
    [
        ((4.0, 3.0), (0.0, 5.0), (3e-11, 1e-11)),
        ((1.8, 2.4), (3.0, 0.0), (1e-7, 5e-10)),
        ((2.4, 1.8), (1.8, 2.4), (1e-7, 5e-10)),
    ],
)
def test_slide_starts_by_its_equations_of_speed_and_direction(
    force: tuple[float, float], slope: tuple[float, float], off: tuple[float, float]
) -> None:
    f, g, n, friction = np.array(force), np.array(slope), np.array([3.0, -1.0]), 0.3
    samples = np.column_stack([[-f, -f - g], np.array([n[0], n.sum()]) / friction - G])
    case = Case(BODY, GroundMotion(samples, 1.0), friction=friction, duration=1.1e-3)
    trace = reduced.simulate(case, support="flat", sample_step=1e-4)
    at = np.array([2, 4, 5, 10])
    speed, direction, path = start_in_polar(f, g, n, trace.time[at]).T
    pushed = trace.contact_force[at]
    np.testing.assert_allclose(np.sqrt(2.0 * trace.energy[at]), speed, rtol=off[0])
    np.testing.assert_allclose(np.arctan2(-pushed[:, 1], -pushed[:, 0]), direction, rtol=0.0, atol=off[1])
    np.testing.assert_allclose(trace.slip[at], path, rtol=1e-6)


def test_without_friction_the_body_stays_while_the_ground_moves() -> None:
    samples, _ = shaking(7)
    samples[0] = 0.0
    trace = slide(samples[:, :2], 0.02, 0.0)
    speed = np.concatenate(
        [np.zeros((1, 2)), np.cumsum(0.5 * (samples[1:, :2] + samples[:-1, :2]), axis=0) * 0.02]
    )
    place = np.cumsum(speed[:-1] * 0.02 + (2 * samples[:-1, :2] + samples[1:, :2]) * 0.02**2 / 6, axis=0)
    np.testing.assert_allclose(trace.displacement[1:], -place, atol=1e-9 * trace.peak_displacement)
    assert trace.slip[1] == pytest.approx(np.hypot(*trace.displacement[1]), rel=1e-12)
    assert not trace.rests


def test_vertical_shaking_counts_as_gravity_until_it_lifts() -> None:
    samples, friction = shaking(3)
    samples[:, 2] = 0.0
    lighter = samples - np.array([0.0, 0.0, 0.5 * G])
    np.testing.assert_allclose(
        slide(lighter, 0.02, friction, 0.48).displacement[:25],
        slide(samples, 0.02, 0.5 * friction, 0.48).displacement[:25],
        rtol=1e-9,
    )
    samples[10, 2] = -1.5 * G
    lifted = slide(samples, 0.02, friction)
    assert (lifted.outcome, lifted.facts[0].code, lifted.mode) == ("failed", "weightless", "")
    assert lifted.facts[0].time == pytest.approx(0.18 + 0.02 / 1.5)
    assert math.isnan(lifted.peak_displacement)
    assert math.isnan(reduced.peak_displacements([friction], GroundMotion(samples, 0.02), [1.0])[0, 0])


def test_peaks_of_a_batch_are_those_of_single_slides() -> None:
    samples, _ = shaking(5)
    motion, frictions, scales = GroundMotion(samples, 0.02), [0.0, 0.1, 0.3, 2.0], [0.0, 0.7, 1.0]
    peaks = reduced.peak_displacements(frictions, motion, scales)
    squat = Cylinder(semidiagonal=1.0, tan_alpha=3.0)
    for i, friction in enumerate(frictions):
        for j, scale in enumerate(scales):
            trace = reduced.simulate(Case(squat, motion.scaled(scale), friction=friction), support="flat")
            assert peaks[i, j] == pytest.approx(trace.peak_displacement, rel=1e-6)
    assert (peaks[:, 0] == 0.0).all()
    with pytest.raises(ValueError, match="frictions must be"):
        reduced.peak_displacements([-0.1], motion, [1.0])


def test_only_slides_from_rest_are_accepted() -> None:
    motion = GroundMotion(shaking(5)[0] * 3.0, 0.02)
    for case, support in (
        (Case(BODY, motion, friction=0.51), "flat"),
        (Case(BODY, motion, friction=0.3), "recess"),
        (Case(BODY, motion, friction=0.3, initial=InitialState(0.1)), "flat"),
    ):
        assert "rocks" in reduced.simulate(case, support=support).mode
    with pytest.raises(ValueError, match="slab"):
        reduced.simulate(Case(WobblingFrame(BODY, 1.0), motion, friction=0.3), support="flat")
    with pytest.raises(ValueError, match="tendon"):
        reduced.simulate(Case(BODY, motion, friction=0.3, tendon=Tendon(prestress=1.0)), support="flat")
