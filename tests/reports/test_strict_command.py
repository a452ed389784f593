"""What was typed wrongly is refused in a line that says it, by every command in the same way."""

from __future__ import annotations

from pathlib import Path

import pytest

from rockwobble.reports.cli.main import main


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


def test_what_may_be_repeated_stays_so(capsys: pytest.CaptureFixture[str]) -> None:
    said = refused(capsys, "compare", "--engine", "mujoco", "--engine", "all")
    assert "all stands alone, got mujoco and all" in said
