"""The published folder, copied away from the project, and its check run as anybody would."""

from __future__ import annotations

import json
import shutil
import subprocess
import sys
from collections.abc import Callable, Mapping
from pathlib import Path
from typing import Any, NamedTuple

import pytest

from benchmark_files.submission import Table, submit
from benchmark_files.write import PUBLISHED

EXIT = {"exact": 0, "good": 0, "pass": 0, "fail": 1, "rejected": 2}


class Judged(NamedTuple):
    verdict: str
    errors: dict[str, float]
    mistakes: list[str]
    result: dict[str, Any]
    text: str


Judge = Callable[..., Judged]


@pytest.fixture(scope="session")
def copied(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The folder, away from everything else."""
    folder = tmp_path_factory.mktemp("copied") / "benchmark"
    shutil.copytree(PUBLISHED, folder)
    return folder


@pytest.fixture
def judge(copied: Path, tmp_path: Path) -> Judge:
    """Return what check.py says of a trajectory, given as tables or as the text of a file."""

    def run(case: str, given: Mapping[str, Table] | str, titles: Mapping[str, str] | None = None) -> Judged:
        path, out = tmp_path / "mine.csv", tmp_path / "result.json"
        if isinstance(given, str):
            path.write_text(given)
        else:
            submit(given, path, titles=titles)
        command = [sys.executable, "-I", str(copied / "check.py"), case, str(path), "--out", str(out)]
        done = subprocess.run(command, capture_output=True, text=True, check=False)
        assert not done.stderr, done.stderr
        result = json.loads(out.read_text())
        assert done.returncode == EXIT[result["verdict"]]
        errors = {one["name"]: one["error"] for one in result["criteria"]}
        return Judged(result["verdict"], errors, result["likely_mistakes"], result, done.stdout)

    return run
