"""What was typed wrongly is refused in a line that says it, by every command in the same way."""

from __future__ import annotations

from pathlib import Path

import pytest
import typer

from rockwobble.reports.cli.main import app, main

COMMANDS = typer.main.get_command(app).commands  # type: ignore[attr-defined]
WITH_OUT = sorted(name for name, each in COMMANDS.items() if "out" in {option.name for option in each.params})


def refused(capsys: pytest.CaptureFixture[str], *arguments: str) -> str:
    """Run a command that must refuse; return the one line that it prints."""
    with pytest.raises(SystemExit) as ended:
        main(list(arguments))
    assert ended.value.code == 2
    printed = capsys.readouterr()
    assert printed.out == ""
    assert printed.err.count("\n") == 1
    return printed.err


@pytest.fixture(autouse=True)
def _elsewhere(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """What is not refused, though it must be, writes here and not where the tests are run."""
    monkeypatch.chdir(tmp_path)


@pytest.mark.parametrize("command", WITH_OUT)
def test_an_empty_folder_name_is_not_the_current_folder(
    tmp_path: Path, capsys: pytest.CaptureFixture[str], command: str
) -> None:
    needed = ["somewhere"] if command == "report" else []
    assert "--out must not be empty, got ''" in refused(capsys, command, *needed, "--out", "")
    assert list(tmp_path.iterdir()) == []


def test_an_empty_argument_is_refused(capsys: pytest.CaptureFixture[str]) -> None:
    assert "STORE must not be empty, got ''" in refused(capsys, "show", "")


@pytest.mark.parametrize(
    ("arguments", "text"),
    [
        (["compare", "--scale", "abc"], "abc"),
        (["simulate", "--plane", "north"], "north"),
        (["simulate", "--engine", "mujoco", "--time-step", "short"], "short"),
        (["ensemble", "--copies", "2.5"], "2.5"),
        (["spectrum", "--probes", "many"], "many"),
        (["fragility", "--seed", "1e3"], "1e3"),
        (["certify", "--time-step", "1e"], "1e"),
    ],
)
def test_what_is_no_number_is_said(
    capsys: pytest.CaptureFixture[str], arguments: list[str], text: str
) -> None:
    said = refused(capsys, *arguments)
    assert f"'{arguments[-2]}'" in said
    assert said.endswith(f", got {text!r}\n")


@pytest.mark.parametrize(
    ("arguments", "name"),
    [
        (["simulate", "--engine", "mujoco", "--engine", "dart"], "--engine"),
        (["compare", "--scale", "1", "--scale=2"], "--scale"),
        (["certify", "--out", "a", "--out", "b"], "--out"),
        (["validity", "--quick", "--quick"], "--quick"),
    ],
)
def test_an_option_that_comes_twice_is_refused(
    capsys: pytest.CaptureFixture[str], arguments: list[str], name: str
) -> None:
    assert refused(capsys, *arguments) == f"rockwobble: {name} is given twice\n"


def test_what_may_be_repeated_stays_so(capsys: pytest.CaptureFixture[str]) -> None:
    said = refused(capsys, "compare", "--engine", "mujoco", "--engine", "all")
    assert "all stands alone, got mujoco and all" in said
