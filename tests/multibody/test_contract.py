"""Contract of an engine beyond the checks of `rw.check`: interruption, closing, refusals."""

from __future__ import annotations

import pickle
from pathlib import Path
from typing import Any

import mujoco
import numpy as np
import pytest

from rockwobble import multibody
from rockwobble.models import Case, Cylinder, InitialState
from rockwobble.models.support import SUPPORTS

PIER = Cylinder(semidiagonal=6.0, tan_alpha=0.2)
RELEASE = InitialState(PIER.alpha / 2, rolling_rate=0.5)


def test_a_trace_of_an_engine_is_complete_and_travels(engine: str) -> None:
    case = Case(PIER, initial=RELEASE, duration=0.5037)
    run = multibody.simulate(case, sample_step=0.02, engine=engine, support="flat")
    assert (run.run.engine, run.run.support, run.outcome) == (engine, "flat", "stands")
    assert run.version[0].isdigit()
    assert run.time_step == pytest.approx(1e-4)
    assert run.wall_time > 0.0
    assert len(run.settings) > 3
    assert (run.uplift_time, run.uplift_direction) == (0.0, 0.0)
    assert list(run.passes.columns) == ["time", "minimum_tilt", "angle_of_turn", "resolved"]
    assert run.passes["resolved"].dtype == bool
    np.testing.assert_array_equal(run.to_frame()["contact_x"], run.contact_point[:, 0])
    copy = pickle.loads(pickle.dumps(run))
    np.testing.assert_array_equal(copy.energy, run.energy)
    assert copy.settings == run.settings


@pytest.mark.slow
def test_progress_rises_to_one_and_interrupts(engine: str) -> None:
    seen: list[float] = []
    # one call after each second of the run
    case = Case(PIER, initial=RELEASE, duration=2.1)
    multibody.simulate(case, engine=engine, progress=seen.append)
    assert seen == sorted(seen)
    assert seen[-1] == 1.0
    assert len(seen) > 2

    def interrupt(fraction: float) -> None:
        raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt):
        multibody.simulate(case, engine=engine, progress=interrupt)


def test_clients_are_closed_and_a_divergence_writes_nothing(
    engine: str, capfd: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch, tmp_path: Path
) -> None:
    monkeypatch.chdir(tmp_path)
    case = Case(PIER, initial=RELEASE, duration=0.1)

    def fail(fraction: float) -> None:
        raise RuntimeError

    before = mujoco.get_mju_user_warning(), mujoco.get_mjcb_time()
    with pytest.raises(RuntimeError):
        multibody.simulate(case, engine=engine, progress=fail)
    assert (mujoco.get_mju_user_warning(), mujoco.get_mjcb_time()) == before
    # a diverging run, in which MuJoCo would write a file
    multibody.simulate(case, engine=engine, guide_stiffness=1000000000000.0)
    if engine == "pybullet":
        import pybullet

        assert not pybullet.getConnectionInfo(0)["isConnected"]
    assert capfd.readouterr() == ("", "")
    assert list(tmp_path.iterdir()) == []


@pytest.mark.parametrize(
    ("change", "message"),
    [
        ({"support": "glued"}, f"support must be one of {', '.join(SUPPORTS)}, got 'glued'"),
        ({"time_step": -1.0}, "time_step must be positive [s], got -1.0"),
        ({"sample_step": 0.0}, "sample_step must be positive [s], got 0.0"),
        ({"sample_step": 1e-12}, "sample_step must be at least "),
        ({"stifness": 1.0}, "'stifness' is not a setting of mujoco; allowed are contact_time_constant, "),
        ({"integrator": "leapfrog"}, "integrator must be one of Euler, implicitfast, implicit, RK4, disc"),
        ({"impedance": 1.0}, "impedance must be above 0 and at most 0.9999, got 1.0"),
        ({"friction_damping": float("nan")}, "friction_damping must be above 0 and at most 2, got nan"),
        ({"iterations": 0}, "iterations must be a whole number, at least 1, got 0"),
        ({"standing_corners": 7}, "standing_corners must be one of 0, 4, 8, "),
        ({"engine": "pybullet", "contact_slop": -1.0}, "contact_slop must be from 0 to 0.1, got -1"),
    ],
)
def test_bad_input_is_refused_in_one_line(change: dict[str, Any], message: str) -> None:
    if change.get("engine") == "pybullet" and "pybullet" not in multibody.available_engines():
        pytest.skip("no wheel of pybullet here")
    stated: dict[str, Any] = {"initial": RELEASE, "duration": 1.0}
    stated |= {name: change[name] for name in ("duration", "gravity", "friction") if name in change}
    with pytest.raises(ValueError, match=r"must|setting") as caught:
        multibody.simulate(
            Case(PIER, **stated), **{name: change[name] for name in change if name not in stated}
        )
    assert str(caught.value).startswith(message)
    assert "\n" not in str(caught.value)


@pytest.mark.slow
def test_a_squat_cylinder_falls_flat_and_rests(engine: str, time_step: float | None) -> None:
    # planar rocking loses almost everything in each impact at tan alpha 1.2
    squat = Cylinder(semidiagonal=6.0, tan_alpha=1.2)
    case = Case(squat, initial=InitialState(0.2 * squat.alpha), duration=4.0)
    run = multibody.simulate(case, engine=engine, time_step=time_step)
    assert run.rests
    # it stands: MuJoCo does not resolve a tilt below 1e-8 rad
    assert run.tilt[-1] < 1e-7
    assert np.isnan(run.rolling_angle[-1])
    assert run.energy[-1] == pytest.approx(0.0, abs=1e-8)
    assert run.peak_tilt == pytest.approx(0.2 * squat.alpha)


# six times 0.05 s rounds beyond 3000 steps of 1e-4 s, and so do others
@pytest.mark.parametrize(("count", "sample_step"), [(6, 0.05), (3, 0.1), (7, 0.01), (14, 0.025), (3, 0.07)])
def test_the_end_of_a_run_is_its_last_sample(count: int, sample_step: float) -> None:
    case = Case(PIER, initial=RELEASE, duration=round(count * sample_step, 12))
    trace = multibody.simulate(case, sample_step=sample_step)
    assert trace.time == pytest.approx(sample_step * np.arange(count + 1), abs=1e-12)
    assert trace.tilt[-1] < trace.tilt[-2] < trace.tilt[0]
