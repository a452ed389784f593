"""Outputs of commands: results of another plan or command are never replaced silently."""

from __future__ import annotations

import json
from pathlib import Path

import pytest
from showing import call
from typer.main import get_command

from rockwobble.reports.cli.main import app

SHORT = ("--release-tilt-deg", "5", "--duration", "1")


def contents(folder: Path) -> dict[str, bytes]:
    return {str(path.relative_to(folder)): path.read_bytes() for path in folder.rglob("*") if path.is_file()}


def test_every_writing_command_has_an_overwrite_option() -> None:
    commands = get_command(app).commands  # type: ignore[attr-defined]
    options = {name: {each.name for each in command.params} for name, command in commands.items()}
    writing = {name for name, known in options.items() if known & {"out", "json", "junit"}}
    assert {"compare", "advise", "simulate", "spectrum", "sweep", "ensemble", "fragility"} < writing
    assert [name for name in writing if "overwrite" not in options[name]] == []


GRID = ("sweep", "--semidiagonal", "1,2", "--scale", "1", "--workers", "1")
SIMULATE = ("simulate", *SHORT)
# options of another plan
PLANS = {each[0]: (each, (*each, "--tan-alpha", "0.3")) for each in (GRID, SIMULATE)}


@pytest.mark.slow
@pytest.mark.usefixtures("in_this_process")
@pytest.mark.parametrize("command", PLANS)
def test_a_folder_of_another_plan_or_command_is_refused(
    command: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    first, other = PLANS[command]
    out = ("--out", str(tmp_path))
    assert call(*first, *out) == 0
    before = contents(tmp_path)
    strange = PLANS["sweep" if command == "simulate" else "simulate"][0]
    for refused in (other, strange):
        capsys.readouterr()
        assert call(*refused, *out) == 2
        error = capsys.readouterr().err
        assert error.count("\n") == 1
        assert f"rockwobble {command} " in error or f"`{command}" in error or "holds" in error
        assert "--overwrite" in error
        assert contents(tmp_path) == before
    assert call(*first, *out) == 0
    assert contents(tmp_path).keys() == before.keys()
    assert call(*other, *out, "--overwrite") == 0
    assert call(*other, *out) == 0
    assert call(*first, *out) == 2


@pytest.mark.slow
def test_changed_record_content_changes_the_plan_hash(tmp_path: Path) -> None:
    record, out = tmp_path / "x.csv", ("--out", str(tmp_path / "out"))
    given = ("simulate", "--record-x", str(record), "--record-y", "zero", "--units", "g", *out)
    for level, code in (("0.3", 0), ("0.3", 0), ("0.31", 2)):
        record.write_text(
            "time,a\n" + "".join(f"{0.01 * i:.2f},{level if i == 50 else 0}\n" for i in range(100))
        )
        assert call(*given) == code


@pytest.mark.slow
def test_file_not_written_by_the_command_is_not_replaced(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    check = ("check", "--only", "trace")
    for option, content in (("--json", "{}"), ("--junit", "<a/>")):
        path = tmp_path / f"mine{option}"
        path.write_text(content)
        assert call(*check, option, str(path)) == 2
        assert "--overwrite" in capsys.readouterr().err
        assert path.read_text() == content
        assert call(*check, option, str(path), "--overwrite") == 0
        assert call(*check, option, str(path)) == 0
        assert call("check", "--only", "equations", option, str(path)) == 2
    assert json.loads((tmp_path / "mine--json").read_text())["plan"]
    assert call("certify", "--out", str(tmp_path / "mine--json")) == 2
