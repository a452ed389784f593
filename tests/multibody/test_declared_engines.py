"""Engines that other packages declare: discovery, runs, and isolation from our engines."""

from __future__ import annotations

import tomllib
from importlib import metadata
from pathlib import Path

import pytest
from declared_engines import Install, installer

from rockwobble import multibody
from rockwobble.compare import default_runs
from rockwobble.compare.runs.choice import require_runnable, reserved_engines
from rockwobble.models import Case, Cylinder, InitialState, Run
from rockwobble.multibody import engine_names
from rockwobble.multibody.engines.registry import GROUP, engine_named, engine_packages, find_engine

PIER = Cylinder(semidiagonal=6.0, tan_alpha=0.2)


@pytest.fixture
def install(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Install:
    return installer(tmp_path, monkeypatch)


def test_an_engine_of_another_package_is_found_and_runs(install: Install) -> None:
    install(sound="external_engine:Sound")
    assert multibody.engine_names() == (*engine_packages(), "sound")
    assert multibody.available_engines()[-1] == "sound"
    release = InitialState(PIER.alpha / 2, rolling_rate=0.5)
    run = multibody.simulate(Case(PIER, initial=release, duration=0.5), engine="sound", support="flat")
    assert run.run.engine == "sound"
    assert run.outcome != "failed"


def test_our_engines_are_known_without_an_entry_point(monkeypatch: pytest.MonkeyPatch) -> None:
    # a checkout on the path, which is not installed, has no metadata at all
    monkeypatch.setattr(metadata, "entry_points", lambda **_: ())
    assert engine_names() == tuple(engine_packages())
    for name in engine_names():
        assert type(engine_named(name)).__module__ == f"rockwobble.multibody.engines.{name}"
    project = tomllib.loads((Path(__file__).parents[2] / "pyproject.toml").read_text())["project"]
    assert GROUP not in project["entry-points"]


@pytest.mark.parametrize(
    ("factory", "words"),
    [
        ("external_engine:Missing", "does not load: AttributeError: "),
        ("no_such_module:Engine", "does not load: ModuleNotFoundError: No module named 'no_such_module'"),
        ("external_engine:fails", "does not load: RuntimeError: no licence"),
        ("external_engine:Half", "is no engine: it has no uplifts, facts, settings, open"),
        ("not an object reference", "does not load: "),
    ],
)
def test_a_broken_engine_is_named_and_breaks_no_other(install: Install, factory: str, words: str) -> None:
    ours = default_runs()
    install(broken=factory)
    with pytest.raises(multibody.BrokenEngineError) as caught:
        find_engine("broken")
    assert str(caught.value).startswith(f"engine 'broken' of the package external {words}")
    assert "\n" not in str(caught.value)
    assert default_runs() == ours
    assert reserved_engines()["broken"] == str(caught.value)
    with pytest.raises(ValueError, match=r"engine must be one of mujoco, .*broken, got 'chrono'"):
        find_engine("chrono")
    still = Case(PIER, duration=1.0, name="still")
    require_runnable(still, Run("mujoco", "recess"))


def test_a_name_that_two_packages_claim_is_refused(install: Install) -> None:
    install("one", shared="external_engine:Sound")
    install("two", shared="external_engine:Loud")
    assert multibody.engine_names().count("shared") == 1
    with pytest.raises(multibody.BrokenEngineError, match="declared more than once, by one, two: uninstall"):
        find_engine("shared")


def test_another_package_cannot_replace_our_engine(install: Install) -> None:
    install(mujoco="external_engine:fails")
    assert multibody.engine_names() == tuple(engine_packages())
    assert type(find_engine("mujoco")).__module__ == "rockwobble.multibody.engines.mujoco"
