"""Many runs at once are the runs one by one."""

from __future__ import annotations

import threading

import mujoco
import numpy as np
import pytest

from rockwobble import multibody
from rockwobble.models import Case, Cylinder, GroundMotion, InitialState

PIER = Cylinder(semidiagonal=6.0, tan_alpha=0.2)
PULSE = GroundMotion([[0.0, 0.0], [4.0, 1.0], [-1.0, 2.0], [0.0, 0.0]], 0.2)


@pytest.fixture
def cases() -> list[Case]:
    """Released and standing, of several sizes, frictions and lengths, two that overturn."""
    found = [
        Case(
            PIER,
            initial=InitialState(0.05 + 0.02 * n, rolling_rate=0.4),
            duration=0.4 + 0.3 * n,
            name=f"start {n}",
        )
        for n in range(3)
    ]
    found.append(
        Case(Cylinder(semidiagonal=0.06, tan_alpha=0.2), PULSE.scaled(0.7), duration=0.15, name="small")
    )
    found.append(
        Case(
            PIER,
            initial=InitialState(0.1, rolling_rate=0.5),
            duration=1.0,
            gravity=9.81,
            friction=0.01,
            name="slips",
        )
    )
    found.append(Case(PIER, initial=InitialState(1.3 * PIER.alpha), duration=6.0, name="falls"))
    found.append(Case(PIER, PULSE, duration=0.5, gravity=1.62, name="moon"))
    return found


def test_each_run_is_that_of_its_own_bit_for_bit(cases: list[Case], engine: str) -> None:
    if engine != "mujoco":
        cases = cases[:2]
    support = "flat" if engine == "exudyn" else "recess"
    runs = multibody.simulate_many(cases, engine=engine, support=support, workers=3)
    assert len(runs) == len(cases)
    for case, run in zip(cases, runs, strict=True):
        alone = multibody.simulate(
            Case(
                case.cylinder,
                case.motion,
                initial=case.initial,
                duration=case.duration,
                friction=case.friction,
                gravity=case.gravity,
            ),
            engine=engine,
            support=support,
        )
        assert run.to_frame().equals(alone.to_frame()), case.name
        assert run.passes.equals(alone.passes), case.name
        assert (run.outcome, str(run.facts), run.time_step) == (
            alone.outcome,
            str(alone.facts),
            alone.time_step,
        )
        np.testing.assert_array_equal(run.peak_tilt, alone.peak_tilt)
    if engine == "mujoco":
        # the last one rises with the energy to pass its balance when its time is over
        assert [run.outcome for run in runs[5:]] == ["overturned", "overturned"]
        assert runs[6].time[-1] > 0.5
        assert "slip" in {fact.code for fact in runs[4].facts}


def test_a_failure_leaves_the_others_alone(cases: list[Case]) -> None:
    # a contact that 1e-4 s cannot follow: the released ones gain energy
    runs = multibody.simulate_many(cases[:2], contact_time_constant=2e-5, workers=2)
    good = multibody.simulate_many(cases[:2], workers=2)
    assert [run.outcome for run in runs] == ["failed", "failed"]
    assert [run.outcome for run in good] == ["stands", "stands"]


def test_progress_rises_to_one_in_this_thread(cases: list[Case]) -> None:
    seen: list[float] = []
    where: set[threading.Thread] = set()

    def told(done: float) -> None:
        seen.append(done)
        where.add(threading.current_thread())

    multibody.simulate_many(cases[:3], progress=told, workers=2)
    assert seen == sorted(seen)
    assert seen[-1] == pytest.approx(1.0)
    assert len(seen) > 3
    assert where == {threading.current_thread()}


@pytest.mark.parametrize("workers", [1, 2])
def test_an_interrupt_leaves_nothing_behind(cases: list[Case], workers: int) -> None:
    def told(done: float) -> None:
        raise KeyboardInterrupt

    reporter = mujoco.get_mju_user_warning()
    before = threading.active_count()
    long = [
        Case(PIER, initial=InitialState(0.1, rolling_rate=0.5), duration=1000.0, name=f"{n}")
        for n in range(4)
    ]
    with pytest.raises(KeyboardInterrupt):
        multibody.simulate_many(long, progress=told, workers=workers)
    assert threading.active_count() == before
    assert mujoco.get_mju_user_warning() == reporter


def test_bad_input_names_the_case(cases: list[Case]) -> None:
    with pytest.raises(ValueError, match=r"^small: time_step must be at most 0\.0001 s"):
        multibody.simulate_many([cases[3], cases[0]], time_step=5e-4, workers=2)
    with pytest.raises(ValueError, match=r"^start 0: 'stifness' is not a setting"):
        multibody.simulate_many(cases[:1], stifness=1.0)
    with pytest.raises(ValueError, match="workers must be a positive whole number, got 0"):
        multibody.simulate_many(cases, workers=0)
    assert multibody.simulate_many([]) == []
