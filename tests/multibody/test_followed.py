"""A run that ends in motion is followed to the maximum of its swing, or to the end of its fall."""

from __future__ import annotations

import dataclasses
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

from rockwobble import multibody, reduced
from rockwobble.models import Case, Cylinder, GroundMotion, InitialState
from rockwobble.multibody import stepping
from rockwobble.multibody.excitation import StepMeans
from rockwobble.multibody.passes import STEPS_OF_A_PASS, TurningPoint
from rockwobble.multibody.scene import froude_scale

PIER = Cylinder(semidiagonal=6.0, tan_alpha=0.2)
PERIOD = 1.2  # [s]
UPLIFT = 9.81 * PIER.tan_alpha  # [m/s^2]
STEP = 2.5e-4  # [s] the decision depends on whole chunks of steps, and holds at steps as large


def one_sine(times_uplift: float, still: float = 0.0) -> GroundMotion:
    """One period of a sine, and still ground for a time after it [s]."""
    time = 0.01 * np.arange(round((PERIOD + still) / 0.01) + 1)
    push = times_uplift * UPLIFT * np.sin(2.0 * np.pi * time / PERIOD) * (time < PERIOD - 1e-9)
    return GroundMotion(np.column_stack([push, 0.0 * push]), 0.01)


@pytest.mark.slow
def test_a_fall_that_the_record_cuts_off_overturns(engine: str) -> None:
    short, whole = (
        multibody.simulate(Case(PIER, one_sine(4.0, still)), engine=engine, time_step=STEP)
        for still in (0.0, 6.0)
    )
    for run in (short, whole):
        assert run.outcome == "overturned"
        assert run.peak_tilt == run.tilt[-1] == 0.5 * np.pi
    # the same ground, and the same run to the last sample: the record's own end is exact
    assert short.time[-1] > PERIOD + 1.0
    np.testing.assert_allclose(short.time, whole.time, rtol=1e-12)
    np.testing.assert_allclose(short.tilt, whole.tilt, atol=1e-9)
    np.testing.assert_allclose(short.contact_force, whole.contact_force, atol=1e-6)
    assert short.passes["time"].tolist() == pytest.approx(whole.passes["time"].tolist())
    # the speed at which the side comes down is no diagnostic of the passes before
    within = short.tilt < PIER.alpha
    fastest = float(np.abs(short.tilt_rate[within]).max())
    assert short.contact_resolution == pytest.approx(STEPS_OF_A_PASS * short.time_step * fastest, rel=0.05)
    assert np.abs(short.tilt_rate).max() > 2.0 * fastest


def test_a_fall_past_the_end_has_the_samples_of_the_reduced_model(engine: str) -> None:
    # pushed over; 0.8 s is no multiple of 0.06 s, and no end of this run
    case = Case(PIER, GroundMotion(np.full((2, 2), 2.0 * UPLIFT), 0.8), duration=0.8)
    run = multibody.simulate(case, engine=engine, support="flat", sample_step=0.06)
    model = reduced.simulate(case, support="flat", sample_step=0.06)
    assert run.outcome == model.outcome == "overturned"
    assert len(run.contact_force) == len(run.time)
    held = int((model.tilt < 1.0).sum())  # from 1.3 rad on contact is open
    np.testing.assert_allclose(run.time[:held], model.time[:held], rtol=1e-12)
    np.testing.assert_allclose(run.tilt[:held], model.tilt[:held], atol=3e-4)


@pytest.mark.parametrize("sample_step", [0.9, 100.0])
def test_a_fall_between_two_samples_has_its_start_and_its_end(sample_step: float) -> None:
    case = Case(PIER, GroundMotion(np.full((2, 2), 2.0 * UPLIFT), 0.8), duration=0.8)
    run, model = (each.simulate(case, sample_step=sample_step) for each in (multibody, reduced))
    np.testing.assert_allclose(run.time[:-1], model.time[:-1], rtol=1e-12)
    assert (run.outcome, len(run.contact_force)) == ("overturned", len(run.time))


@pytest.mark.parametrize("support", ["recess", "flat"])
@pytest.mark.parametrize("tilt_rate", [0.05, -0.05])  # one grows at its end, one passes upright before it
def test_a_free_response_that_is_cut_has_the_peak_of_its_swing(
    engine: str, support: str, tilt_rate: float
) -> None:
    start = InitialState(0.3 * PIER.alpha, tilt_rate=tilt_rate, rolling_rate=0.4)
    case = Case(PIER, initial=start, duration=0.2)
    run = multibody.simulate(case, engine=engine, support=support, time_step=STEP)
    model = reduced.simulate(case, support=support)
    assert np.sign(run.tilt_rate[-1]) == np.sign(tilt_rate)
    assert run.tilt.max() < 0.99 * run.peak_tilt
    # error of first order in the step, at 2.5 times the default
    assert run.peak_tilt == pytest.approx(model.peak_tilt, abs=1e-5 * PIER.alpha)
    assert run.followed_until == pytest.approx(model.followed_until, abs=1e-4)


def test_motion_after_the_end_changes_only_the_peak(engine: str, monkeypatch: pytest.MonkeyPatch) -> None:
    # a wobble with more energy than that of its balance, which turns back after the end
    start = InitialState(0.55 * PIER.alpha, tilt_rate=0.02, rolling_rate=0.95)
    case = Case(PIER, initial=start, duration=0.51303)
    followed = multibody.simulate(case, engine=engine, time_step=STEP)
    later = multibody.simulate(dataclasses.replace(case, duration=3.0), engine=engine, time_step=STEP)
    monkeypatch.setattr(stepping, "_follow", lambda _, scene, recorder, *rest: recorder)
    alone = multibody.simulate(case, engine=engine, time_step=STEP)
    assert followed.energy[-1] > 9.81 * (PIER.semidiagonal - PIER.mass_centre_height)
    for field in dataclasses.fields(followed):
        one, other = getattr(followed, field.name), getattr(alone, field.name)
        if field.name == "passes":
            assert one.equals(other)
        elif field.name == "source":
            np.testing.assert_equal(dict(one.quantities()), dict(other.quantities()))
        elif field.name not in ("wall_time", "peak_tilt", "followed_until"):
            np.testing.assert_equal(one, other)
    assert followed.outcome == later.outcome == "stands"
    assert alone.peak_tilt == alone.tilt[-1] < followed.peak_tilt
    assert followed.peak_tilt == pytest.approx(later.peak_tilt, abs=1e-9)


@pytest.mark.parametrize("centre", [0.0, 0.5, 1.0])
def test_the_step_after_a_cut_corrects_the_ground_velocity(centre: float) -> None:
    motion = GroundMotion([[0.0, 1.0], [2.0, -1.0], [1.0, 3.0], [4.0, 1.0]], 0.02)
    step, end = 1e-3, 0.0314
    means = StepMeans(motion, froude_scale(6.0, 9.81), step)
    taken = 33  # one more than the index of the first pose at the end or after it
    total = step * (means(0, taken, centre).sum(axis=0) + means.stop(end, taken, centre))
    # integral of the straight lines between samples, from the start of the first step (still ground before)
    time = np.linspace(0.0, end, 20001)
    exact = [
        np.trapezoid(np.interp(time, 0.02 * np.arange(4), component), time)
        for component in motion.acceleration.T
    ]
    before = step * means(0, 1, 0.0)[0, :2] if centre == 1.0 else 0.0
    lost = means.ground_velocity(np.array([(centre - 0.5) * step]))[0, :2]
    assert np.abs(before).max() < 1.0
    np.testing.assert_allclose(total[:2], np.array(exact) - lost, atol=1e-7)
    assert total[2] == 0.0


def test_an_undecided_run_is_reported(monkeypatch: pytest.MonkeyPatch) -> None:
    assert "undecided" not in {fact.code for fact in multibody.simulate(Case(PIER, one_sine(2.0))).facts}
    monkeypatch.setattr(stepping, "LONGEST", 0.5)
    run = multibody.simulate(Case(PIER, one_sine(4.0)))
    assert (run.outcome, run.time[-1]) == ("undecided", PERIOD)
    assert [fact.code for fact in run.facts] == ["undecided"]


def test_noise_of_a_slow_rise_is_no_turn() -> None:
    start = TurningPoint(1.0, 0.1, 0.0, False)
    noise = [TurningPoint(1.1, 0.1 + 3e-7, 0.0, True), TurningPoint(1.2, 0.1 + 2e-7, 0.0, False)]
    top = [TurningPoint(1.3, 0.12, 0.0, True)]

    def turned(points: list[TurningPoint], tilt: float) -> bool:
        seen: Any = SimpleNamespace(points=points, last_value=lambda name: tilt)
        return stepping._maximum(start, seen) is not None

    assert not turned(noise, 0.1 + 4e-7)
    assert not turned(noise[:1], 0.1)
    assert not turned(noise + top, 0.12)
    assert turned(noise + top, 0.119)
    # a maximum before the end does not count, and a descent has yet to rise again
    assert not turned([TurningPoint(0.9, 0.2, 0.0, True)], 0.11)
