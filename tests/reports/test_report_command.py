"""`rockwobble report` and `show` on stored studies: they say what they said, whatever is installed."""

from __future__ import annotations

import shutil
from collections.abc import Callable
from pathlib import Path

import pytest

from rockwobble.compare import read_ensemble
from rockwobble.compare.describe import folder as describe_store
from rockwobble.compare.storage import origin, provenance
from rockwobble.compare.studies.extremes import read_extremes
from rockwobble.compare.studies.tradeoff import read_tradeoff
from rockwobble.compare.studies.validity import motions, read_validity
from rockwobble.models.plain_json import dumps, loads
from rockwobble.reports.cli.main import main
from rockwobble.reports.pages.ensemble.document import ensemble_document
from rockwobble.reports.pages.extremes.page import extremes_markdown
from rockwobble.reports.pages.tradeoff.page import tradeoff_markdown
from rockwobble.reports.pages.validity.page import validity_document
from rockwobble.reports.pages.validity.sections import sections_of

PUBLISHED = Path(__file__).parents[2] / "reports" / "published"


def call(*arguments: str) -> int:
    with pytest.raises(SystemExit) as ended:
        main(list(arguments))
    assert isinstance(ended.value.code, int)
    return ended.value.code


@pytest.fixture
def nothing_here(monkeypatch: pytest.MonkeyPatch) -> None:
    """Let nothing run, and no engine and no record be installed."""

    def refuse(*_, **__):
        raise AssertionError("something ran, or looked at what is installed")

    for name in ("rockwobble.reduced.simulate", "rockwobble.multibody.simulate"):
        monkeypatch.setattr(name, refuse)
    for module in (provenance, origin):
        monkeypatch.setattr(module, "package_versions", refuse)
    monkeypatch.setattr(motions, "have_records", refuse)


def validity_text(folder: Path) -> str:
    found = read_validity(folder)
    return validity_document(sections_of(dict(found.tables)), found)


@pytest.mark.parametrize(
    ("study", "text"),
    [
        ("validity", validity_text),
        ("tradeoff", lambda folder: tradeoff_markdown(read_tradeoff(folder))),
        ("extremes", lambda folder: extremes_markdown(read_extremes(folder))),
        ("ensemble/starts", lambda folder: ensemble_document(read_ensemble(folder))),
        ("ensemble/p695-2", lambda folder: ensemble_document(read_ensemble(folder))),
    ],
)
@pytest.mark.usefixtures("nothing_here")
def test_what_is_published_is_what_its_stored_results_say_anywhere(study: str, text: Callable[[Path], str]):
    document = PUBLISHED / study / f"{study.split('/')[0]}.md"
    assert text(PUBLISHED / study) == document.read_text()


@pytest.mark.usefixtures("nothing_here")
def test_pages_go_into_the_folder_of_the_results_or_elsewhere(tmp_path: Path, capsys):
    stored, elsewhere = tmp_path / "stored", tmp_path / "elsewhere"
    stored.mkdir()
    for name in ("extremes.json", "extremes.parquet"):
        shutil.copy(PUBLISHED / "extremes" / name, stored)
    results = {path.name: path.read_bytes() for path in stored.iterdir()}
    pages = {"extremes.html", "extremes.md", "extremes.svg"}
    assert call("report", str(stored), "--out", str(elsewhere)) == 0
    assert {path.name for path in elsewhere.iterdir()} == pages
    assert call("report", str(stored)) == 0
    assert {path.name for path in stored.iterdir()} == pages | set(results)
    assert all((stored / name).read_bytes() == content for name, content in results.items())
    assert (stored / "extremes.md").read_text() == (PUBLISHED / "extremes" / "extremes.md").read_text()


def test_a_table_of_another_kind_is_no_ensemble(tmp_path: Path, capsys):
    shutil.copy(PUBLISHED / "ensemble" / "starts" / "ensemble.json", tmp_path)
    shutil.copy(PUBLISHED / "extremes" / "extremes.parquet", tmp_path / "members.parquet")
    assert call("report", str(tmp_path)) == 2
    assert "members.parquet does not hold the members of an ensemble" in capsys.readouterr().err
    assert not (tmp_path / "ensemble.html").exists()


@pytest.mark.parametrize(
    ("study", "inputs", "figures"),
    [
        ("validity", {"extent": "full", "ensemble": "22 FEMA P-695 far-field records"}, 8),
        ("tradeoff", {"rounds": 3}, 6),
        ("extremes", {}, 9),
    ],
)
@pytest.mark.usefixtures("nothing_here")
def test_show_tells_what_a_study_was_made_with(study: str, inputs: dict[str, object], figures: int, capsys):
    assert call("show", str(PUBLISHED / study), "--json") == 0
    (result,) = loads(capsys.readouterr().out)["results"]
    stored = loads((PUBLISHED / study / f"{study}.json").read_bytes())["origin"]
    assert result["inputs"].items() >= inputs.items()
    assert result["inputs"]["command"] == stored["command"]
    assert result["versions"] == stored["versions"]
    assert len(result["figures"]) == figures
    assert call("show", str(PUBLISHED / study)) == 0
    assert stored["processor"] in " ".join(capsys.readouterr().out.split())


def test_show_tells_how_far_limits_are_measured(tmp_path: Path):
    (tmp_path / "measured").mkdir()
    (tmp_path / "measured" / "a.json").write_text("{}")
    (found,) = describe_store.describe_store(tmp_path)
    assert (found["complete"], found["runs_finished"]) == (False, 1)


@pytest.mark.parametrize(
    ("break_it", "words"),
    [
        (lambda folder: (folder / "extremes.json").unlink(), "with one of comparison.json (compare)"),
        (lambda folder: (folder / "extremes.json").write_text("{"), "extremes.json cannot be read"),
        (lambda folder: (folder / "extremes.json").write_text("[]"), "extremes.json cannot be read"),
        (lambda folder: _replace(folder, "kind", "x"), "is of `x`, not of `rockwobble extremes`"),
        (lambda folder: _replace(folder, "origin", {}), "extremes.json cannot be read"),
        (
            lambda folder: (folder / "extremes.parquet").unlink(),
            "is not complete: extremes.parquet is missing",
        ),
        (
            lambda folder: (folder / "extremes.parquet").write_bytes(b"torn"),
            "extremes.parquet cannot be read",
        ),
    ],
)
def test_what_cannot_be_read_is_one_line(break_it, words, tmp_path: Path, capsys):
    for name in ("extremes.json", "extremes.parquet"):
        shutil.copy(PUBLISHED / "extremes" / name, tmp_path)
    break_it(tmp_path)
    assert call("report", str(tmp_path)) == 2
    said = capsys.readouterr().err
    assert words in said
    assert said.count("\n") == 1
    assert not (tmp_path / "extremes.html").exists()


def _replace(folder: Path, name: str, value: object) -> None:
    file = folder / "extremes.json"
    file.write_text(dumps(loads(file.read_bytes()) | {name: value}))
