"""Benchmark command: finds its scripts, each has help, and the README lists them."""

from __future__ import annotations

import re
import subprocess
import sys
from pathlib import Path

import pytest

from benchmarks.__main__ import SCRIPTS, main

FOLDER = Path(__file__).parent


@pytest.mark.parametrize("name", SCRIPTS)
def test_benchmark_scripts_print_help(name: str, capsys: pytest.CaptureFixture[str]) -> None:
    with pytest.raises(SystemExit, match="0"):
        main([name, "--help"])
    assert f"usage: python tests/benchmarks {name}" in capsys.readouterr().out


def test_the_command_runs_from_anywhere(tmp_path: Path) -> None:
    command = [sys.executable, str(FOLDER), "decks", "--none"]
    answer = subprocess.run(command, capture_output=True, text=True, cwd=tmp_path)
    assert answer.returncode == 2
    assert "unrecognized arguments: --none" in answer.stderr


def test_every_script_is_a_command_and_in_the_readme() -> None:
    scripts = [path.stem for path in sorted(FOLDER.glob("*.py")) if "\ndef main(" in path.read_text()]
    assert tuple(name for name in scripts if name != "__main__") == SCRIPTS
    listed = re.findall(r"^\| `(\w+)[ `]", (FOLDER / "README.md").read_text(), re.MULTILINE)
    assert tuple(listed) == SCRIPTS
