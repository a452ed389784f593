"""Engines at default settings in cases with exact answers: impacts in one plane, slides."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from rockwobble import multibody, reduced
from rockwobble.models import Case, Cylinder, GroundMotion, InitialState, Trace, el_centro_1940
from rockwobble.multibody.engines.registry import engine_named, own_engines
from rockwobble.multibody.modes import mode_facts, path_of_slide


def one_sine(tan_alpha: float) -> Case:
    """Sine in one component, 1.3 times the uplift threshold, for 0.8 s."""
    time = np.arange(0.0, 1.0, 0.005)
    push = 1.3 * tan_alpha * 9.81 * np.sin(2.0 * np.pi * time / 0.8) * (time <= 0.8)
    body = Cylinder(semidiagonal=np.hypot(1.0, 2.0), tan_alpha=tan_alpha)
    return Case(body, GroundMotion(np.column_stack([push, 0.0 * push]), 0.005), friction=5.0)


@pytest.mark.slow
@pytest.mark.parametrize(
    # step of the release at which closing points as hard as the rim would stop the heel
    ("tan_alpha", "grazes"),
    [(0.1, 1e-4), (0.2, 3.30240449149053e-4), (0.5, 4.852738114354453e-5), (1.0, 3.8826684786683367e-4)],
)
def test_an_impact_in_one_plane_is_of_momentum_at_any_step(tan_alpha: float, grazes: float) -> None:
    shaken = one_sine(tan_alpha)
    released = Case(
        shaken.cylinder, initial=InitialState(0.3 * shaken.cylinder.alpha), friction=5.0, duration=1.2
    )
    steps = [*np.exp(np.random.default_rng(2).uniform(*np.log([2e-5, 5e-4]), 19)), grazes]
    for number, case in enumerate((shaken, released)):
        exact = reduced.simulate(case, plane=0.0, restitution="momentum")
        closing = exact.extrema[exact.extrema[:, 3] < 0.0][0, 0]

        def largest_after(run: Trace, closing: float = closing) -> float:
            return float(run.extrema[run.extrema[:, 0] > closing + 0.01, 1].max())

        for step, support in zip(steps[10 * number :][:10], 5 * ["flat", "recess"], strict=True):
            run = multibody.simulate(case, support=support, time_step=float(step))
            assert largest_after(run) == pytest.approx(largest_after(exact), rel=0.01), (support, step)


@pytest.mark.slow
def test_only_an_impact_that_breaks_momentum_is_reported() -> None:
    case = one_sine(0.5)
    assert multibody.simulate(case, support="flat").facts == ()
    (settled,) = multibody.simulate(case, support="flat", time_step="auto").facts
    assert settled.code == "settled"
    hops = multibody.simulate(case, support="flat", time_step=1e-4, contact_damping_ratio=1.0)
    assert hops.first("impact_loss") == pytest.approx(0.48, abs=0.01)


@pytest.mark.slow
@pytest.mark.parametrize("sliding", [name for name in own_engines() if engine_named(name).uplifts])
def test_a_slide_below_the_border_neither_tilts_nor_turns(sliding: str) -> None:
    case = Case(
        Cylinder(semidiagonal=3.0, tan_alpha=0.5),
        el_centro_1940().scaled(2.5),
        friction=0.48,
        duration=4.0,
    )
    exact = reduced.simulate(case, support="flat")
    np.testing.assert_allclose(
        path_of_slide(case, exact.time), exact.displacement, atol=2e-3 * exact.peak_displacement
    )
    run = multibody.simulate(case, engine=sliding, support="flat")
    assert (run.mode, run.facts) == ("slides", ())
    away = run.displacement - exact.displacement[: len(run.time)]
    assert np.abs(away).max() < 0.03 * exact.peak_displacement
    assert run.peak_tilt < 1e-4 * case.cylinder.alpha
    assert np.abs(run.twist).max() < 1e-3


def test_an_engine_that_tilts_a_sliding_body_reports_it() -> None:
    motion = el_centro_1940().scaled(2.5)
    case = Case(Cylinder(semidiagonal=3.0, tan_alpha=0.5), motion, friction=0.48, duration=3.0)
    hops = {"follow_load": True, "friction_damping": 1.8, "points": 0, "noslip_iterations": 0}
    run = multibody.simulate(case, support="flat", **hops)
    assert {"mode", "unresolved_slide"} <= {fact.code for fact in run.facts}
    slid = multibody.simulate(case, support="flat")
    turned = replace(slid, twist=slid.twist + 0.02 * (slid.time > 2.0))
    assert [(fact.code, fact.time > 2.0) for fact in mode_facts(turned)] == [("turning_slide", True)]
