"""The wobbling frame in the reduced models: closed forms, limits, and the slab on top."""

from __future__ import annotations

import math

import numpy as np
import pytest

from rockwobble import reduced
from rockwobble.models import Case, Cylinder, InitialState, WobblingFrame, el_centro_1940
from rockwobble.models.trace_file import friction_of
from rockwobble.reduced.body import body_of

PIER = Cylinder(semidiagonal=6.0, tan_alpha=0.2)
SQUAT = Cylinder(semidiagonal=2.0, tan_alpha=0.8, transverse_inertia=1.1, axial_inertia=0.7)
THREE_DECIMALS = 0.5e-3  # of the published limits [deg]
ROUNDING = 1e-14  # relative, of some ten operations
TIGHT = {"rtol": 1e-11}
INTEGRATED = 1e-8  # relative error of a tolerance of 1e-11 over a swing


@pytest.mark.parametrize(
    ("ratio", "turn"), [(0.0, 182.660), (0.5, 183.202), (1.0, 183.338), (2.0, 183.435), (20.0, 183.550)]
)
def test_a_frame_of_vanishing_spin_turns_by_its_closed_form(ratio: float, turn: float) -> None:
    frame = WobblingFrame(PIER, ratio)
    assert math.degrees(reduced.limiting_angle_of_turn(frame)) == pytest.approx(turn, abs=THREE_DECIMALS)
    release = InitialState(0.5 * frame.alpha, rolling_rate=1e-15)
    assert math.degrees(reduced.angle_of_turn(frame, release)) == pytest.approx(turn, abs=THREE_DECIMALS)


@pytest.mark.parametrize("tan_alpha", [0.1, 0.2, 0.5])
@pytest.mark.parametrize("ratio", [0.0, 0.5, 3.0, 100.0])
def test_a_frame_of_boxes_is_the_planar_rocking_frame(ratio: float, tan_alpha: float) -> None:
    """p^2 = (3 g/4 R)(1 + 2 gamma)/(1 + 3 gamma), and its restitution by moment of momentum."""
    R, alpha = 3.0, math.atan(tan_alpha)
    box = Cylinder(semidiagonal=R, tan_alpha=tan_alpha, transverse_inertia=R * R / 3.0, axial_inertia=0.1)
    frame = WobblingFrame(box, ratio)
    p2 = 0.75 * 9.81 / R * (1.0 + 2.0 * ratio) / (1.0 + 3.0 * ratio)
    assert body_of(frame, 9.81).p2 == pytest.approx(p2, rel=ROUNDING)
    r = (1.0 - 1.5 * math.sin(alpha) ** 2 + 3.0 * ratio * math.cos(2.0 * alpha)) / (1.0 + 3.0 * ratio)
    assert reduced.restitution_from_momentum(frame) == pytest.approx(r, rel=ROUNDING)


@pytest.mark.parametrize("ratio", [0.0, 0.7, 20.0])
@pytest.mark.parametrize("column", [PIER, SQUAT, Cylinder(semidiagonal=2.0, tan_alpha=2.0)])
def test_restitution_balances_the_impulses_on_column_and_slab(column: Cylinder, ratio: float) -> None:
    """Impulse balance of both bodies; unknown are the rate after and the impulses at the new contacts."""
    b, h = column.base_radius, column.mass_centre_height
    inertia = body_of(column, 1.0).I1
    # column: momentum along and up, moment about its mass centre; slab: momentum along and up, velocity twice
    # that of the mass centre: (h, b) at a tilt rate of 1 before, (h, -b) after
    columns = [
        [-h, b, -inertia, -2.0 * ratio * h, 2.0 * ratio * b],  # the rate after
        [1.0, 0.0, -h, 0.0, 0.0],  # impulses at the base, on the column
        [0.0, 1.0, b, 0.0, 0.0],
        [1.0, 0.0, h, -1.0, 0.0],  # at the top, on the column
        [0.0, 1.0, -b, 0.0, -1.0],
    ]
    before = np.array([-h, -b, -inertia, -2.0 * ratio * h, -2.0 * ratio * b])
    after = float(np.linalg.solve(np.transpose(columns), before)[0])
    assert reduced.restitution_from_momentum(WobblingFrame(column, ratio)) == pytest.approx(
        max(after, 0.0), rel=1e-12, abs=1e-15
    )


@pytest.mark.parametrize("options", [{}, {"support": "flat"}, {"plane": 0.3, "restitution": "momentum"}])
def test_without_a_slab_a_frame_is_the_cylinder_to_the_bit(options: dict[str, object]) -> None:
    runs = [
        reduced.simulate(Case(body, el_centro_1940(), duration=12.0), **options)  # type: ignore[arg-type]
        for body in (PIER, WobblingFrame(PIER, 0.0))
    ]
    for name in ("tilt", "rolling_angle", "energy", "contact_force", "restraining_moment"):
        assert np.array_equal(*(getattr(run, name) for run in runs), equal_nan=True), name
    assert runs[0].assumptions == runs[1].assumptions
    assert np.isnan(runs[0].top_contact_force).all()
    assert np.isnan(runs[0].slab_displacement).all()


@pytest.mark.parametrize("ratio", [0.3, 1.0, 10.0])
@pytest.mark.parametrize("column", [PIER, SQUAT])
def test_free_response_of_a_frame_is_the_quadrature(column: Cylinder, ratio: float) -> None:
    frame = WobblingFrame(column, ratio)
    release = InitialState(0.5 * frame.alpha, rolling_rate=0.2)
    exact = reduced.free_response(frame, release)
    trace = reduced.simulate(Case(frame, initial=release, duration=1.2 * exact.period), **TIGHT)
    assert trace.extrema[2, 0] == pytest.approx(exact.period, rel=INTEGRATED)
    assert trace.passes.angle_of_turn[0] == pytest.approx(exact.angle_of_turn, rel=INTEGRATED)
    assert trace.passes.minimum_tilt[0] == pytest.approx(exact.minimum_tilt, rel=1e-6)  # magnified
    assert trace.energy[0] == pytest.approx(exact.energy, rel=1e-12)


def test_a_slab_moves_twice_as_far_and_the_larger_friction_demand_counts() -> None:
    case = Case(WobblingFrame(PIER, 0.05), el_centro_1940(vertical=True), duration=8.0)
    trace = reduced.simulate(case, sample_step=1e-3)
    b, h, theta = PIER.base_radius, PIER.mass_centre_height, trace.tilt
    lean = 2.0 * (h * np.sin(theta) + b * (1.0 - np.cos(theta)))
    assert np.hypot(*trace.slab_displacement[:, :2].T) == pytest.approx(lean, rel=1e-12)
    rise = 2.0 * (b * np.sin(theta) - h * (1.0 - np.cos(theta)))
    assert trace.slab_displacement[:, 2] == pytest.approx(rise, abs=1e-14 * h)
    held = trace.assumptions
    assert held is not None
    moving = trace.tilt > 0.0
    base, top = trace.friction_needed[moving].max(), trace.top_friction_needed[moving].max()
    assert top > 1.05 * base  # a light slab slides before the base
    assert held.largest_friction_needed == pytest.approx(top, rel=1e-2)  # samples miss the maximum itself
    least = min(trace.contact_force[moving, 2].min(), trace.top_contact_force[moving, 2].min())
    assert held.least_normal_force == pytest.approx(least, abs=1e-2)
    assert np.array_equal(trace.top_friction_needed, friction_of(trace.top_contact_force))
