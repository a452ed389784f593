"""The planar model: Housner's block, its exact periods, impacts, and the one-sine pulse."""

import math

import numpy as np
import pytest
from stating import table

from rockwobble import reduced
from rockwobble.models import Case, Cylinder, GroundMotion, InitialState, el_centro_1940

PIER = Cylinder(semidiagonal=6.0, tan_alpha=0.2)


@pytest.mark.parametrize(
    ("restitution", "share"),
    [(0.9, (0.02, 0.0, 0.25)), (1.0, (0.01, 0.0, -0.25))],
    ids=["heavier", "lighter"],
)
def test_each_impact_loses_its_share_on_evenly_accelerating_ground(restitution, share):
    ground = 9.81 * np.array(share)
    case = Case(
        PIER, GroundMotion([ground, ground], 10.0), initial=InitialState(0.25 * PIER.alpha), duration=8.0
    )
    response = reduced.simulate(case, plane=0.0, restitution=restitution, rest_tilt=0.0, rtol=1e-11)
    _, tilt, angle, _ = response.extrema[response.extrema[:, 3] > 0.0].T
    # at a maximum all energy is potential, with the inertia force of the ground
    b, h = PIER.base_radius, PIER.mass_centre_height
    out, rise = b * (1.0 - np.cos(tilt)) + h * np.sin(tilt), b * np.sin(tilt) - h * (1.0 - np.cos(tilt))
    potential = ground[0] * np.cos(angle) * out + (9.81 + ground[2]) * rise
    assert len(tilt) > 3
    assert potential[1:] / potential[:-1] == pytest.approx(restitution**2, rel=1e-8)


def test_a_hop_shorter_than_a_step_lands_at_its_exact_time():
    """Release at 1e-4 alpha, where a hop takes the time of a step and less."""
    initial = InitialState(1e-4 * PIER.alpha)
    quarter = reduced.planar_quarter_period(PIER, initial.tilt)
    response = reduced.simulate(
        Case(PIER, initial=initial, duration=2001.0 * quarter), plane=0.0, rest_tilt=0.0
    )
    impacts = response.extrema[response.extrema[:, 1] == 0.0]
    assert len(response.passes) == 1000
    assert impacts[:, 0] == pytest.approx(quarter * (2.0 * np.arange(len(impacts)) + 1.0), rel=1e-6)
    highest = response.extrema[response.extrema[:, 3] > 0.0][:, 1]
    assert highest == pytest.approx(initial.tilt, rel=1e-5)


@pytest.mark.parametrize("intensity", [5.444444, 6.111111])
def test_chatter_that_grows_into_planar_rocking_ends(intensity):
    motion = el_centro_1940().scaled(intensity * 0.1 * 9.81 / el_centro_1940().peak)
    for plane in (0.0, 0.5 * math.pi):
        response = reduced.simulate(Case(Cylinder(semidiagonal=0.5, tan_alpha=0.1), motion), plane=plane)
        assert response.outcome == "overturned", response.message


def one_sine(amplitude, omega, cylinder, p):
    """A one-sine pulse of peak `amplitude` alpha g at `omega` p, sampled finely."""
    count = 100_000  # straight lines between samples take (2 pi/count)^2/12 off a sine, 3e-10
    time = np.linspace(0.0, 2.0 * math.pi / (omega * p), count + 1)
    pulse = amplitude * cylinder.alpha * 9.81 * np.sin(omega * p * time)
    return GroundMotion(np.column_stack([pulse, np.zeros_like(pulse)]), time[1])


@pytest.mark.parametrize("row", table("one_sine_overturning.csv"), ids=lambda r: r["w_over_p"])
def test_overturning_by_a_one_sine_pulse_without_impact(row):
    """Slender limit at alpha = 1e-4, with an error of the order alpha^2 = 1e-8."""
    cylinder = Cylinder(semidiagonal=6.0, tan_alpha=math.tan(1e-4))
    amplitude, rate = float(row["a"]), float(row["w_over_p"])
    p = reduced.simulate(Case(cylinder, duration=1.0), plane=0.0).source.problem.body.p
    verdicts = []
    for factor in (1.0 - 2e-8, 1.0 + 2e-8):
        motion = one_sine(factor * amplitude, rate, cylinder, p)
        # a difference of 1e-8 takes log(1e8)/p to grow to one of alpha, and log(1e4)/p to fall
        response = reduced.simulate(
            Case(cylinder, motion, duration=motion.duration + 50.0 / p),
            plane=0.0,
            rtol=1e-12,
            sample_step=1.0,
        )
        impacts = response.extrema[:, 1] == 0.0
        verdicts.append(response.outcome == "overturned" and not impacts.any())
    assert verdicts == [False, True]


def test_planar_forces_ignore_motion_across_the_plane():
    azimuth, record = 0.3, el_centro_1940()
    along = record.acceleration[:, :2] @ [math.cos(azimuth), math.sin(azimuth)]
    inside = GroundMotion(np.outer(along, [math.cos(azimuth), math.sin(azimuth)]), record.time_step)
    cylinder = Cylinder(semidiagonal=6.0, tan_alpha=0.2)
    given, alone = (
        reduced.simulate(Case(cylinder, motion, duration=15.0, friction=0.3), plane=azimuth)
        for motion in (record, inside)
    )
    np.testing.assert_allclose(given.contact_force, alone.contact_force, atol=1e-9)
    across = given.contact_force[:, :2] @ [-math.sin(azimuth), math.cos(azimuth)]
    assert np.abs(across).max() < 1e-12
    assert np.abs(given.restraining_moment).max() < 1e-12
    needs = [each.assumptions.largest_friction_needed for each in (given, alone)]
    assert needs[0] == pytest.approx(needs[1], rel=1e-9)


def test_decaying_swings_match_momentum_and_quadrature():
    """Each swing rises to r^2 of the height before; each half takes the exact quarter period of its tilt."""
    ratio = (16.0 - 25.0 * math.sin(PIER.alpha) ** 2) / (16.0 - math.sin(PIER.alpha) ** 2)
    case = Case(PIER, initial=InitialState(0.5 * PIER.alpha), duration=16.0)
    trace = reduced.simulate(case, plane=0.0, rtol=1e-12, rest_tilt=0.0, restitution="momentum")
    tops = trace.extrema[trace.extrema[:, 3] > 0.0]
    assert len(tops) > 8
    b, h = PIER.base_radius, PIER.mass_centre_height
    heights = b * np.sin(tops[:, 1]) - 2.0 * h * np.sin(0.5 * tops[:, 1]) ** 2
    # tilts and times of swings that shrink to a hundredth; 5e-10 was measured
    assert heights == pytest.approx(heights[0] * ratio ** (2.0 * np.arange(len(tops))), rel=2e-8)
    quarters = np.array([reduced.planar_quarter_period(PIER, float(tilt)) for tilt in tops[:, 1]])
    times = np.concatenate([[0.0], np.cumsum(quarters[:-1] + quarters[1:])])
    assert tops[:, 0] == pytest.approx(times, abs=2e-8 * times[-1])
