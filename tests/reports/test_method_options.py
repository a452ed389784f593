"""Time step and settings from the command line, and the resulting statements of a run."""

from __future__ import annotations

import json
from pathlib import Path

import pytest
from showing import call
from typer.main import get_command

from rockwobble.compare.runs.choice import with_settings
from rockwobble.models import Case, Cylinder, InitialState, Run
from rockwobble.reports.cli.main import app
from rockwobble.reports.cli.options import settings
from rockwobble.reports.cli.problem import BODY

RELEASE = ["--release-tilt-deg", "5", "--rolling-rate", "0.5", "--duration", "0.2"]


@pytest.mark.parametrize("name", ["advise", "compare", "ensemble", "fragility", "simulate", "view"])
def test_cylinder_options_are_equal_in_all_commands(name: str) -> None:
    # type: ignore[attr-defined]
    assert {option.name for option in get_command(app).commands[name].params} >= BODY


def test_settings_are_whole_numbers_numbers_or_words() -> None:
    values = settings(["ring_facets=64", " ring_clearance = 1e-2", "cone=pyramidal"])
    assert values == {"ring_facets": 64, "ring_clearance": 0.01, "cone": "pyramidal"}
    assert [type(value) for value in values.values()] == [int, float, str]
    assert settings(None) == {}


@pytest.mark.slow
def test_auto_time_step_reports_the_remaining_error(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    method = ["--engine", "mujoco", "--time-step", "auto", "--set", "step_tolerance=1e-4"]
    assert call("simulate", *RELEASE, *method, "--out", str(tmp_path)) == 0
    assert "Until 0.2 s the tilt is within" in " ".join(capsys.readouterr().out.split())
    assert json.loads((tmp_path / "manifest.json").read_text())["about"]["result"]["error_estimate"] > 0.0


def test_settings_apply_only_to_engines_that_have_them() -> None:
    # the release leans into the walls that a ring has by default
    squat = Cylinder(semidiagonal=6.0, tan_alpha=1.0)
    case = Case(squat, initial=InitialState(0.3), duration=1.0, name="release")
    runs = [Run("mujoco", "ring", ring_facets=8), Run("mujoco", "flat", "auto")]
    given = {"ring_clearance": 3, "ring_facets": 16, "cone": "pyramidal", "step_tolerance": 1e-4}
    ring, free = with_settings(case, runs, given)
    assert dict(ring.settings) == {"ring_clearance": 3, "ring_facets": 16, "cone": "pyramidal"}
    assert dict(free.settings) == {"cone": "pyramidal", "step_tolerance": 1e-4}
    assert (ring.time_step, free.time_step) == (None, "auto")


@pytest.mark.slow
def test_flight_in_a_ring_is_reported(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    spin = ["--tan-alpha", "1", "--release-tilt-deg", "20", "--rolling-rate", "8", "--duration", "0.3"]
    given = ["--set", "ring_clearance=3", "--set", "ring_inclination=0.05", "--set", "ring_facets=16"]
    place = ["--engine", "mujoco", "--support", "ring", "--out", str(tmp_path)]
    assert call("simulate", *spin, *place, *given) == 0
    result = json.loads((tmp_path / "manifest.json").read_text())["about"]["result"]
    walls = (result["settings"][f"ring_{name}"] for name in ("clearance", "inclination", "facets"))
    assert tuple(walls) == (3, 0.05, 16)
    (flight,) = (fact for fact in result["facts"] if fact["code"] == "lift_off")
    said = f"The cylinder left the ground at {flight['time']:.4g} s"
    assert said in " ".join(capsys.readouterr().out.split())
    # from steps of 2e-5 to 1e-4 s and impedances of 0.99 to 0.9999 it is 0.2029 to 0.2063 s
    assert flight["time"] == pytest.approx(0.2046, abs=2e-3)
