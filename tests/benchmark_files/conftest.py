"""Fixtures: the unpacked published folder, and its check.py.

`test_files` starts the programs as anybody would; the many judgements are made by the same `main` in this
process, since most of the time of a start goes into loading numpy.
"""

from __future__ import annotations

import contextlib
import importlib.util
import io
import json
import runpy
import shutil
import sys
from collections.abc import Callable, Iterator, Mapping
from pathlib import Path
from types import ModuleType
from typing import Any, NamedTuple

import pytest

from benchmark_files.submission import Table, submit
from benchmark_files.write import PUBLISHED

EXIT = {"exact": 0, "good": 0, "pass": 0, "fail": 1, "rejected": 2}
# case with one run out of three
SINGLE, SPIN = "turn-once", "spin-0.1"


class Judged(NamedTuple):
    verdict: str
    errors: dict[str, float]
    mistakes: dict[str, float | None]  # values by code
    result: dict[str, Any]
    text: str


Judge = Callable[..., Judged]


@pytest.fixture(scope="session")
def copied(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The published folder as its archive, away from the project."""
    place = tmp_path_factory.mktemp("copied")
    runpy.run_path(str(PUBLISHED.parent / "remake.py"))["archive"](place / "benchmark.zip")
    shutil.unpack_archive(place / "benchmark.zip", place)
    return place / "benchmark"


@pytest.fixture(scope="session")
def check(copied: Path, tmp_path_factory: pytest.TempPathFactory) -> Iterator[ModuleType]:
    """Module check.py of that folder, with its cases and a one-run case."""
    folder = tmp_path_factory.mktemp("judging")
    shutil.copy(copied / "check.py", folder)
    shutil.copytree(copied / "external", folder / "external")
    shutil.copytree(copied / "cases", folder / "cases")
    single = shutil.copytree(folder / "cases" / "turn-recess", folder / "cases" / SINGLE) / "case.json"
    given = json.loads(single.read_text())
    single.write_text(json.dumps(given | {"runs": [run for run in given["runs"] if run["name"] == SPIN]}))
    spec = importlib.util.spec_from_file_location("copied_check", folder / "check.py")
    assert spec is not None
    assert spec.loader is not None
    module = importlib.util.module_from_spec(spec)
    sys.modules[spec.name] = module  # lookup by its dataclasses
    sys.path.insert(0, str(folder))  # as where a program is run
    spec.loader.exec_module(module)
    yield module
    sys.path.remove(str(folder))


@pytest.fixture
def judge(check: ModuleType, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Judge:
    """Judgement of check.py on a trajectory, given as tables or as file text."""

    def run(case: str, given: Mapping[str, Table] | str, titles: Mapping[str, str] | None = None) -> Judged:
        path, out = tmp_path / "mine.csv", tmp_path / "result.json"
        if isinstance(given, str):
            path.write_text(given)
        else:
            submit(given, path, titles=titles)
        monkeypatch.setattr(sys, "argv", ["check.py", case, str(path), "--out", str(out)])
        said, complaints = io.StringIO(), io.StringIO()
        with contextlib.redirect_stdout(said), contextlib.redirect_stderr(complaints):
            ended = check.main()
        assert not complaints.getvalue()
        result = json.loads(out.read_text())
        assert ended == EXIT[result["verdict"]]
        errors = {one["name"]: one["error"] for one in result["criteria"]}
        mistakes = {one["code"]: one["value"] for one in result["mistakes"]}
        assert len(mistakes) == len(result["likely_mistakes"])
        return Judged(result["verdict"], errors, mistakes, result, said.getvalue())

    return run
