"""Installed engines that fail to load: one line in every command, and defaults without them."""

from __future__ import annotations

import sys
from collections.abc import Iterator
from pathlib import Path

import pytest
from showing import call

from rockwobble.compare import default_runs
from rockwobble.compare.runs import execution
from rockwobble.models import Run
from rockwobble.multibody import available_engines
from rockwobble.multibody.engines import registry
from rockwobble.studies import study

REASON = "libmujoco.so.4: cannot open shared object file"
LINE = f"'mujoco' is installed and does not load: {REASON}"
RELEASE = ("--release-tilt-deg", "5", "--duration", "0.2")
COMMANDS = {
    "compare": RELEASE,
    "simulate": RELEASE,
    "view": RELEASE,
    "advise": (),
    "ensemble": (*RELEASE, "--copies", "2"),
    "fragility": ("--semidiagonal", "6", "--tan-alpha", "0.2", "--synthetic", "4"),
    "check": (),
    "certify": (),
}


def install(folder: Path, monkeypatch: pytest.MonkeyPatch, text: str) -> None:
    """Install a damaged MuJoCo ahead of the real one, as if nothing were loaded yet."""
    path = folder / "packages" / "mujoco" / "__init__.py"
    path.parent.mkdir(parents=True, exist_ok=True)
    path.write_text(text)
    for name in [each for each in sys.modules if each.partition(".")[0] == "mujoco"]:
        monkeypatch.delitem(sys.modules, name)
    monkeypatch.syspath_prepend(str(folder / "packages"))


@pytest.fixture
def fresh() -> Iterator[None]:
    """Unload engines before and after a test."""
    registry._load_failure.cache_clear()
    before = {name: module for name, module in sys.modules.items() if name.partition(".")[0] == "mujoco"}
    yield
    registry._load_failure.cache_clear()
    for name in [each for each in sys.modules if each.partition(".")[0] == "mujoco"]:
        del sys.modules[name]
    sys.modules.update(before)


@pytest.fixture
def damaged(fresh: None, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """Damaged MuJoCo in a temporary working folder."""
    text = "raise ImportError('libmujoco.so.4: cannot open\\nshared object file')"
    install(tmp_path, monkeypatch, text)
    monkeypatch.chdir(tmp_path)


@pytest.mark.parametrize("command", COMMANDS)
def test_damaged_engine_is_refused_in_one_line_before_any_run(damaged, monkeypatch, capsys, command):
    for module in (execution, study):
        monkeypatch.setattr(module, "run_tasks", lambda *_, **__: pytest.fail("it ran"))
    assert call(command, *COMMANDS[command], "--engine", "mujoco") == 2
    error = capsys.readouterr().err
    assert [line for line in error.splitlines() if "mujoco" in line] == [f"rockwobble: engine {LINE}"]
    assert "Traceback" not in error


def test_default_run_uses_engines_that_load(damaged):
    assert "mujoco" in available_engines()
    assert "mujoco" not in {run.engine for run in default_runs()}
    assert len(default_runs()) == 2 * len(registry.standard_engines()[1:])


@pytest.mark.slow
@pytest.mark.parametrize("command", ["compare", "ensemble", "view", "advise"])
def test_command_without_engine_option_reports_the_engine_that_does_not_load(
    damaged, in_this_process, six_records, capsys, command
):
    other = registry.standard_engines()[1]
    assert call(command, *(("--copies", "20") if command == "advise" else COMMANDS[command])) == 0
    captured = capsys.readouterr()
    said = [line for line in captured.err.splitlines() if "does not load" in line]
    instead = {"view": f"{other} runs in its place", "advise": "the prediction stays unverified"}
    line = f"rockwobble: mujoco is installed and does not load: {REASON}"
    assert said == [f"{line}; {instead.get(command, 'it is left out')}"]
    assert command not in ("compare", "ensemble") or f"{other} recess" in captured.out


@pytest.mark.parametrize("command", ["compare", "view", "simulate"])
def test_support_of_a_damaged_engine_alone_is_refused(damaged, monkeypatch, capsys, command):
    monkeypatch.setattr(execution, "run_tasks", lambda *_, **__: pytest.fail("it ran"))
    engine = ("--engine", "mujoco") if command == "simulate" else ()
    assert call(command, *RELEASE, "--support", "ring", *engine) == 2
    lines = capsys.readouterr().err.splitlines()
    assert [line for line in lines if "rockwobble: " in line] == [f"rockwobble: engine {LINE}"]


def test_check_states_why_an_engine_is_not_checked(damaged, capsys):
    call("check", "--only", "rest")
    assert REASON in " ".join(capsys.readouterr().out.split())


def test_leftover_folder_of_an_uninstalled_package_does_not_load(fresh, tmp_path, monkeypatch):
    # as `pip uninstall mujoco-core` leaves it: it can be imported, and holds nothing
    install(tmp_path, monkeypatch, "")
    assert "No module named" in registry.engine_fault("mujoco")
    with pytest.raises(ValueError, match="'mujoco' is installed and does not load: No module named"):
        registry.find_engine("mujoco")


def test_damaged_engine_does_not_affect_others(fresh, tmp_path, monkeypatch):
    install(tmp_path, monkeypatch, "raise RuntimeError")
    assert registry.engine_fault("mujoco").endswith(": RuntimeError")
    assert Run("mujoco", "recess") not in default_runs()
