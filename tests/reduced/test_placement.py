"""Positions and contact forces: azimuths, residual displacement, rests, the end of a record.

Each is computed from other columns of the trace, by the mechanics alone.
"""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import pytest

from rockwobble import reduced
from rockwobble.models import Case, Cylinder, GroundMotion, InitialState, Trace
from rockwobble.reduced.equations import energy

G = 9.81
PIER = Cylinder(semidiagonal=6.0, tan_alpha=0.2)
SQUAT = Cylinder(semidiagonal=2.0, tan_alpha=0.8)
UPLIFT = G * PIER.tan_alpha
EVERY_WAY = np.radians([-179.0, -135.0, -90.0, -30.0, 0.0, 60.0, 90.0, 120.0, 180.0])
ROUNDING = 1e-9  # relative: the same problem rotated
PATH = 1e-6  # relative: midpoints of steps in which the azimuth turns by up to a hundredth
DIFFERENCES = 2e-4  # weights; second differences over 2e-3 s of a force whose rate is some weights a second


def turned(columns: np.ndarray, angle: float) -> np.ndarray:
    """Two columns in axes turned by an angle [rad]."""
    cosine, sine = math.cos(angle), math.sin(angle)
    return columns @ np.array([[cosine, sine], [-sine, cosine]])


def push(time_step: float = 0.01) -> GroundMotion:
    """Push towards the east and a weaker one back, so that a tilt to the west is another problem."""
    time = np.arange(0.0, 1.2, time_step)
    east = UPLIFT * np.where(
        time < 0.4, 1.3 * np.sin(math.pi * time / 0.4), -0.6 * np.sin(math.pi * time / 0.8)
    )
    return GroundMotion(np.column_stack([east, 0.0 * east]), time_step)


@pytest.mark.parametrize("options", [{}, {"support": "flat"}, {"plane": 0.0}, {"plane": math.pi}], ids=str)
@pytest.mark.parametrize("lean", [0.0, math.pi])  # azimuths along the plane of shaking, in both senses
@pytest.mark.parametrize("shaken", [True, False])
def test_a_release_without_spin_is_planar(options: dict[str, Any], lean: float, shaken: bool) -> None:
    def released(azimuth: float) -> Trace:
        given = options | ({"plane": options["plane"] + azimuth} if "plane" in options else {})
        start = InitialState(0.3 * PIER.alpha, tilt_rate=0.01, rolling_angle=azimuth + lean)
        case = Case(PIER, push().rotated(azimuth) if shaken else None, initial=start, duration=2.0)
        return reduced.simulate(case, rtol=1e-10, sample_step=0.02, **given)

    first = released(0.0)
    assert math.remainder(first.rolling_angle[0] - lean, math.tau) == pytest.approx(0.0, abs=ROUNDING)
    assert len(first.passes) > 0
    for azimuth in EVERY_WAY:
        trace = released(float(azimuth))
        np.testing.assert_allclose(trace.tilt, first.tilt, atol=ROUNDING)
        off = np.exp(1j * (trace.rolling_angle - azimuth)) - np.exp(1j * first.rolling_angle)
        np.testing.assert_allclose(np.abs(off), 0.0, atol=ROUNDING)
        assert np.abs(np.diff(trace.rolling_angle)).max() < math.pi + ROUNDING
        for name in ("contact_point", "centre_of_mass", "contact_force"):
            expected = turned(getattr(first, name)[:, :2], azimuth)
            np.testing.assert_allclose(getattr(trace, name)[:, :2], expected, atol=1e-8)
        off = math.remainder(trace.uplift_direction - azimuth - lean, math.tau)
        assert off == pytest.approx(0.0, abs=ROUNDING)


@pytest.mark.parametrize("cylinder", [PIER, SQUAT], ids=["slender", "squat"])
@pytest.mark.parametrize("support", ["recess", "flat"])
def test_the_residual_displacement_is_the_end_of_the_path(cylinder: Cylinder, support: str) -> None:
    start = InitialState(0.4 * cylinder.alpha, rolling_angle=0.7, rolling_rate=0.9)
    trace = reduced.simulate(
        Case(cylinder, initial=start, duration=3.3), support=support, rtol=1e-11, sample_step=1e-4
    )
    # the rim rolls without slip: the contact point moves with b psi', across its own azimuth
    b, phi = cylinder.base_radius, trace.rolling_angle
    middle, spin = 0.5 * (phi[1:] + phi[:-1]), np.diff(trace.twist - phi)
    path = b * (outward(phi[0]) + np.sum(spin * np.array([np.sin(middle), -np.cos(middle)]), axis=1))
    base = path - b * math.cos(trace.tilt[-1]) * outward(phi[-1])
    assert trace.residual_displacement == pytest.approx(math.hypot(*base), rel=PATH, abs=PATH * 1e-2 * b)
    assert trace.residual_displacement > 1e-3 * b


def outward(phi: float) -> np.ndarray:
    return np.array([math.cos(phi), math.sin(phi)])


@pytest.mark.parametrize("model", ["recess", "flat", "planar"])
@pytest.mark.parametrize("cut", [False, True], ids=["the record ends", "the run ends, and it falls"])
def test_forces_after_the_end_are_those_of_still_ground(model: str, cut: bool) -> None:
    """Newton's law: mass times the acceleration of the mass centre, by second differences, and the weight."""
    strong = np.array([[0.0, 0.0], [2.6, 1.1], [2.2, 1.6]]) * UPLIFT * (1.0 if cut else 0.5)
    end, h, count = 0.8, 1e-3, 7 if cut else 3
    motion = GroundMotion(np.vstack([strong, np.full((4, 2), 3.0 * UPLIFT)])[:count], 0.5 * end)
    options = {"plane": 0.4} if model == "planar" else reduced.MODELS[model]
    case = Case(PIER, motion, duration=end if cut else end + 0.6)
    trace = reduced.simulate(case, rtol=1e-12, sample_step=h, **options)
    assert trace.time[-1] > end + 0.5
    at = np.flatnonzero((trace.tilt > 0.01 * PIER.alpha) & (trace.tilt < 1.0))[1:-1]
    at = at[np.abs(trace.time[at] - end) > 1.5 * h]
    late, samples = trace.time[at] > end, motion.time_step * np.arange(count)
    columns = [np.interp(trace.time[at], samples, column) for column in motion.acceleration.T]
    ground = np.where(late, 0.0, [*columns, 0.0 * columns[0]]).T
    if model == "planar":
        ground[:, :2] = (ground[:, :2] @ outward(0.4))[:, None] * outward(0.4)
    place = trace.centre_of_mass
    motion_of_mass = (place[at + 1] - 2.0 * place[at] + place[at - 1]) / h**2
    force = (motion_of_mass + ground + [0.0, 0.0, G]) / G
    assert min(late.sum(), (~late).sum()) > 50
    np.testing.assert_allclose(trace.contact_force[at], force, atol=DIFFERENCES)


REST = {"rest_tilt": 0.05, "rtol": 1e-10}


def shock(count: int, strength: float, azimuth: float, turning: float) -> np.ndarray:
    """Half a sine whose azimuth turns (count, 3), samples of 0.01 s; the ground falls meanwhile."""
    share = np.linspace(0.0, 1.0, count)
    size, angle = np.sin(math.pi * share), azimuth + turning * share
    return np.column_stack(
        [strength * UPLIFT * size * np.cos(angle), strength * UPLIFT * size * np.sin(angle), -0.1 * G * size]
    )


def shocks(strength: float, turning: float) -> tuple[np.ndarray, np.ndarray]:
    """Two motions: after the first it comes to rest, and the second uplifts it again."""
    tail = np.vstack([shock(100, 0.3, 1.0, 5.0), np.zeros((50, 3))])
    return np.vstack([shock(60, strength, 0.4, turning), tail]), np.vstack(
        [shock(80, 1.6, -2.0, 1.5), np.zeros((60, 3))]
    )


@pytest.mark.parametrize(("strength", "turning"), [(1.2, 2.0), (1.5, 4.0)])
def test_place_and_twist_on_flat_ground_are_kept_over_a_rest(strength: float, turning: float) -> None:
    first, second = shocks(strength, turning)
    both, alone = (
        reduced.simulate(Case(PIER, GroundMotion(each, 0.01)), support="flat", **REST)
        for each in (np.vstack([first, second]), second)
    )
    ((begin, end),) = both.rest_intervals
    b = PIER.base_radius
    stands = (both.time > begin) & (both.time < end)
    place, twist = both.centre_of_mass[stands][0], both.twist[stands][0]
    assert stands.sum() > 50
    assert np.isnan(both.contact_point[stands]).all()
    np.testing.assert_array_equal(both.centre_of_mass[stands] - place, 0.0)
    np.testing.assert_array_equal(both.twist[stands], twist)
    # displacement when the rest begins: the centre of the circle on which the rim rolls moves with b tau'
    last = int(np.flatnonzero(both.time < begin)[-1])
    rolled = both.contact_point[last] - b * outward(both.rolling_angle[last]) - place[:2]
    assert abs(both.twist[last] - twist) < 0.5 * abs(twist)
    assert math.hypot(*rolled) < 1.01 * b * abs(both.twist[last] - twist) + 1e-12
    assert math.hypot(*place[:2]) > 1e-6 * b
    # after the second uplift it moves as in the second shock alone, from its new place
    count = len(second)
    later = both.centre_of_mass[-count:] - [*place[:2], 0.0]
    np.testing.assert_allclose(later, alone.centre_of_mass, atol=1e-8)
    np.testing.assert_allclose(both.contact_point[-count:] - place[:2], alone.contact_point, atol=1e-8)
    np.testing.assert_allclose(both.twist[-count:] - twist, alone.twist, atol=1e-9)


@pytest.mark.parametrize("options", [{}, {"support": "flat"}, {"plane": 1.0}], ids=str)
@pytest.mark.parametrize(("strength", "turning"), [(1.2, 2.0), (1.5, 4.0)])
def test_a_rest_begins_at_the_first_step_with_too_little_energy(
    options: dict[str, Any], strength: float, turning: float
) -> None:
    first, _ = shocks(strength, turning)
    trace = reduced.simulate(Case(PIER, GroundMotion(first, 0.01)), **REST, **options)
    begin = trace.rest_intervals[0, 0]
    result, _ = trace.source.problem.solve(np.empty(0), record_steps=True)
    b, h, limit = PIER.base_radius, PIER.mass_centre_height, REST["rest_tilt"] * PIER.alpha
    ends = []
    for time, theta, omega, _, *momenta in result.steps:
        a = [np.interp(time, 0.01 * np.arange(len(first)), column) for column in first.T]
        size = abs(a[:2] @ outward(1.0)) if "plane" in options else math.hypot(*a[:2])
        spin, twist = (momenta[0], momenta[2]) if "support" in options else (sum(momenta), 0.0)
        left = energy(trace.source.problem.body, theta, omega, spin, twist)
        standstill = G * (b * math.sin(limit) - 2.0 * h * math.sin(0.5 * limit) ** 2)
        if size < (G + a[2]) * PIER.tan_alpha and left < standstill * (1.0 + a[2] / G - size / UPLIFT):
            ends.append(time)
    assert ends[0] == begin
    assert np.count_nonzero(result.steps[:, 0] < begin) > 10
