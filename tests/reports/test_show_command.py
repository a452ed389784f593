"""`rockwobble show` and `report`: contents of a folder, and redrawn pages."""

from __future__ import annotations

import shlex
from pathlib import Path

import pytest
from showing import call

from rockwobble import comparison
from rockwobble.compare import Comparison
from rockwobble.compare.storage.manifest import MANIFEST, read_manifests
from rockwobble.models import Case, Cylinder, InitialState, Run, plain_json

pytestmark = pytest.mark.checkout

PIER = Cylinder(semidiagonal=6.0, tan_alpha=0.2)
CASE = Case(PIER, initial=InitialState(0.5 * PIER.alpha, rolling_rate=0.5), duration=0.5, name="release")
PUBLISHED = Path(__file__).parents[2] / "reports" / "published"
RUNS = [Run("mujoco", "recess", 1e-3)]


@pytest.fixture(scope="module")
def stored(tmp_path_factory) -> Path:
    folder = tmp_path_factory.mktemp("stored")
    comparison(CASE, runs=RUNS, workers=1, out=folder)
    return folder


@pytest.fixture
def nothing_runs(monkeypatch):
    """Forbid runs and engine loading."""

    def refuse(*_, **__):
        raise AssertionError("something ran, or looked at what is installed")

    for name in ("rockwobble.reduced.simulate", "rockwobble.multibody.simulate"):
        monkeypatch.setattr(name, refuse)
    monkeypatch.setattr("rockwobble.multibody.available_engines", refuse)


def described(folder: Path, capsys, code: int = 0) -> list[dict]:
    capsys.readouterr()
    assert call("show", str(folder), "--json") == code
    return plain_json.loads(capsys.readouterr().out)["results"]


@pytest.mark.usefixtures("nothing_runs")
def test_show_lists_results_with_command_and_versions(stored, capsys):
    (result,) = described(stored, capsys)
    assert (result["kind"], result["complete"]) == ("comparison", True)
    assert result["headline"]["rows"] == len(Comparison.load(stored).summary)
    assert {"python", "numpy", "mujoco", "rockwobble"} <= set(result["versions"])
    assert set(result["states"].values()) == {"whole"}
    assert call("show", str(stored)) == 0
    said = " ".join(capsys.readouterr().out.split())
    for words in ("comparison", "median agreement time [s]", "commit", "traces.parquet", result["inputs"]):
        assert words in said


@pytest.mark.usefixtures("nothing_runs")
@pytest.mark.parametrize("folder", ["validity", "risk/p695", "ensemble/copies"])
def test_show_output_fits_80_columns(folder, capsys, monkeypatch):
    monkeypatch.setenv("COLUMNS", "80")
    store = PUBLISHED / folder
    assert call("show", str(store)) == 0
    printed = capsys.readouterr().out
    made = read_manifests(store)[0]
    _, *lines = printed.splitlines()  # the first names the folder
    assert max(map(len, lines)) <= 80
    command = printed.partition("\nmade by:\n")[2]
    assert shlex.split(command.replace("\\\n", "")) == shlex.split(made.command)


def test_show_names_a_damaged_file_and_fails(tmp_path, capsys):
    comparison(CASE, runs=RUNS, workers=1, out=tmp_path)
    (tmp_path / "passes.parquet").write_bytes(b"torn")
    (result,) = described(tmp_path, capsys, code=1)
    assert result["states"]["passes.parquet"] == "damaged"
    assert call("report", str(tmp_path)) == 2
    error = capsys.readouterr().err
    assert "passes.parquet is damaged" in error
    assert error.count("\n") == 1


def test_show_states_progress_of_unfinished_results_only(tmp_path, capsys):
    def interrupt(event):
        if event.state == "finished":
            raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt):
        comparison(CASE, runs=RUNS, workers=1, resume=tmp_path, progress=interrupt)
    (going,) = described(tmp_path, capsys)
    assert going == {"kind": "comparison", "done": 1, "total": 2, "complete": False}
    assert call("show", str(tmp_path)) == 0
    assert "comparison, not finished: 1 of 2 tasks" in capsys.readouterr().out
    comparison(CASE, runs=RUNS, workers=1, resume=tmp_path, out=tmp_path)
    assert [each["complete"] for each in described(tmp_path, capsys)] == [True]


@pytest.mark.slow
def test_report_redraws_in_any_folder_and_keeps_the_results(stored, tmp_path, capsys):
    before = {path.name: path.read_bytes() for path in stored.iterdir()}
    assert call("report", str(stored), "--out", str(tmp_path)) == 0
    pages = {path.name: path.read_bytes() for path in tmp_path.iterdir()}
    assert "figure.svg" in pages
    assert {path.name for path in stored.iterdir()} == set(before)
    assert call("report", str(stored)) == 0
    assert {name: (stored / name).read_bytes() for name in pages} == pages
    results = {name: (stored / name).read_bytes() for name in before if name != MANIFEST}
    assert results == {name: content for name, content in before.items() if name != MANIFEST}
    (made,) = described(stored, capsys)
    assert set(made["pages"]) == set(pages)


def test_folders_of_an_older_release_say_which_release_draws_them(capsys):
    folder = str(PUBLISHED / "tradeoff")
    assert call("report", folder) == 2
    assert "rockwobble 0.3.0" in capsys.readouterr().err
    assert call("show", folder) == 0
    assert "drawn by" in capsys.readouterr().out
