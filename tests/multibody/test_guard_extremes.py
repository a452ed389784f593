"""At the extremes of the engines a run agrees with its model, says what limits it, or fails in words."""

from __future__ import annotations

from typing import Any

import pytest
from benchmarks.engine_extremes import AGREES, run
from benchmarks.engine_trials import Trial, trials

from rockwobble import multibody
from rockwobble.models import Case, Cylinder, InitialState


def at(engine: str, support: str, **given: Any) -> dict[str, Any]:
    """Run a trial that has no name."""
    return run(Trial(extreme="", value="", engine=engine, support=support, **given))


@pytest.mark.slow
@pytest.mark.parametrize("support", ["recess", "flat"])
@pytest.mark.parametrize(
    "given",
    [
        # the truncation of the step is far below AGREES in all of these, and nothing limits them
        {"arguments": {"time_step": 1e-6}, "length": 0.01},
        {"arguments": {"time_step": 1e-3}, "length": 2.0},
        {"tan_alpha": 0.05, "length": 0.5},
        {"tan_alpha": 10.0, "length": 0.5},
        {"rate": 3.0, "length": 0.5},
        {"arguments": {"friction": 10.0}, "tan_alpha": 3.0, "length": 0.5},
    ],
)
def test_sound_extremes_agree_and_say_nothing(engine: str, support: str, given: dict[str, Any]) -> None:
    row = at(engine, support, **given)
    assert (row["verdict"], row["diagnostics"]) == ("agrees", "")
    assert row["error"] < AGREES


@pytest.mark.parametrize(
    ("engine", "given", "code"),
    [
        ("mujoco", {"arguments": {"contact_time_constant": 1e-5}}, "energy_gain"),
        ("mujoco", {"arguments": {"contact_time_constant": 1.0}}, "penetration"),
        ("mujoco", {"arguments": {"guide_stiffness": (3.0 / 1e-4) ** 2}, "tan_alpha": 3.0}, "energy_gain"),
        ("mujoco", {"arguments": {"guide_stiffness": 1.0}, "tan_alpha": 3.0}, "guide"),
        ("pybullet", {"arguments": {"guide_stiffness": (1e3 / 1e-4) ** 2}}, "energy_gain"),
        ("pybullet", {"arguments": {"guide_stiffness": 1.0}, "tan_alpha": 3.0}, "guide"),
    ],
)
def test_what_diverges_fails(engine: str, given: dict[str, Any], code: str) -> None:
    if engine not in multibody.available_engines():
        pytest.skip(f"no wheel of {engine} here")
    row = at(engine, "recess", **given)
    assert row["verdict"] == "failed"
    assert code in row["diagnostics"]


@pytest.mark.parametrize(
    ("engine", "arguments", "code"),
    [
        ("mujoco", {"contact_time_constant": 0.1}, "energy"),
        ("mujoco", {"iterations": 1}, "solver"),
        ("pybullet", {"contact_slop": 0.01}, "energy"),
        ("pybullet", {"iterations": 1}, "solver"),
    ],
)
def test_what_is_doubtful_is_said(engine: str, arguments: dict[str, Any], code: str) -> None:
    if engine not in multibody.available_engines():
        pytest.skip(f"no wheel of {engine} here")
    row = at(engine, "flat", arguments=arguments, length=1.5)
    assert row["verdict"] in ("agrees", "said")
    assert code in row["diagnostics"]


def test_a_step_that_contact_cannot_follow_or_is_lost_in_rounding_is_refused(engine: str) -> None:
    row = at(engine, "recess", arguments={"time_step": 1e-2})
    assert row["verdict"] == "refused"
    assert "\n" not in row["diagnostics"]
    assert "time_step must be at most 0.001 s" in row["diagnostics"]
    row = at(engine, "recess", arguments={"time_step": 1e-300})
    assert row["verdict"] == "refused"
    assert "time_step must be at least 1e-09 s" in row["diagnostics"]


def test_friction_that_does_not_suffice_is_said(engine: str) -> None:
    row = at(engine, "recess", arguments={"friction": 0.05}, length=0.5)
    assert {"slip", "energy"} <= set(row["diagnostics"].split(", "))


def test_a_run_that_disagrees_in_silence_is_called_wrong(monkeypatch: pytest.MonkeyPatch) -> None:
    import benchmarks.engine_extremes as module

    pier = Cylinder(semidiagonal=6.0, tan_alpha=0.2)
    # the run of another release
    other = multibody.simulate(
        Case(pier, initial=InitialState(0.45 * pier.alpha, rolling_rate=0.5), duration=0.5), time_step=0.0005
    )
    monkeypatch.setattr(module.multibody, "simulate", lambda *_, **__: other)
    row = at("mujoco", "recess", length=0.5)
    assert row["verdict"] == "wrong"
    assert row["error"] == pytest.approx(0.05, rel=0.5)


def test_every_extreme_of_the_design_is_in_the_scan() -> None:
    found = {trial.extreme for trial in trials(["mujoco", "pybullet"])}
    for extreme in (
        "time step [s]",
        "friction",
        "tan alpha",
        "spin [rad/s]",
        "shaking [g]",
        "guide, h sqrt(k)",
    ):
        assert extreme in found
    assert {"contact time constant [h]", "contact damping ratio"} <= found
