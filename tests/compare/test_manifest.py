"""A folder of results says what it holds and what made it; a damaged file is found before it is believed."""

from __future__ import annotations

import json
import re

import pandas as pd
import pytest

from rockwobble.compare.storage import provenance
from rockwobble.compare.storage.manifest import (
    MANIFEST,
    Manifest,
    file_state,
    read_manifests,
    read_results,
    with_provenance,
    write_pages,
    write_results,
)
from rockwobble.models.parquet_file import read_about

TABLE = pd.DataFrame({"peak": [0.1, float("nan")], "run": ["a", "b"]})


def write(folder, kind="study", tables=("points",), **options):
    made = Manifest(
        kind=kind,
        inputs="0" * 32,
        command="rockwobble study",
        seeds={"members": 3},
        headline={"largest": 0.1},
        about={"extent": [1.0, 2.0]},
    )
    return write_results(folder, with_provenance(made), dict.fromkeys(tables, TABLE), **options)


def test_a_written_manifest_is_read_back(tmp_path):
    write(tmp_path, files={"raw.csv": b"1,2\n"}, pages={"study.md": b"# Study"})
    found = read_results(tmp_path, "study")
    pd.testing.assert_frame_equal(found.table("points"), TABLE, check_exact=True)
    assert found.content("raw.csv") == b"1,2\n"
    made = found.manifest
    assert (made.command, made.seeds, made.headline) == ("rockwobble study", {"members": 3}, {"largest": 0.1})
    assert (made.about, made.pages) == ({"extent": [1.0, 2.0]}, ("study.md",))
    assert {"python", "numpy", "rockwobble"} <= set(made.versions)
    assert set(made.code) == {"models", "reduced", "multibody", "compare", "studies"}
    assert re.fullmatch(r"([0-9a-f]{40}\+?)?", made.commit)
    assert read_about(tmp_path / "points.parquet")["inputs"] == "0" * 32


def test_the_file_is_plain_json_with_the_names_of_the_contract(tmp_path):
    write(tmp_path)
    content = json.loads((tmp_path / MANIFEST).read_text())
    assert {"kind", "inputs", "command", "versions", "commit", "seeds", "headline", "files"} <= set(content)
    assert set(content["files"]) == {"points.parquet"}


@pytest.mark.parametrize(("damage", "state"), [(lambda p: p.unlink(), "missing"), (None, "damaged")])
def test_a_damaged_file_is_named_and_not_read(tmp_path, damage, state):
    write(tmp_path, tables=("points", "scenes"))
    path = tmp_path / "scenes.parquet"
    if damage is None:
        content = bytearray(path.read_bytes())
        content[len(content) // 2] ^= 1  # a single bit
        path.write_bytes(content)
    else:
        damage(path)
    (made,) = read_manifests(tmp_path)
    assert {name: file_state(tmp_path, made, name) for name in made.files} == {
        "points.parquet": "whole",
        "scenes.parquet": state,
    }
    with pytest.raises(ValueError, match=rf"scenes.parquet is {state}"):
        read_results(tmp_path, "study")


def test_a_second_run_replaces_its_own_files_and_touches_nothing_else(tmp_path):
    (tmp_path / "mine.txt").write_text("mine")
    write(tmp_path, tables=("points", "budget"), pages={"old.svg": b""})
    write(tmp_path, kind="other", tables=("rows",))
    write(tmp_path, tables=("points",))
    assert {path.name for path in tmp_path.iterdir()} == {
        "mine.txt",
        "points.parquet",
        "rows.parquet",
        MANIFEST,
    }
    assert [made.kind for made in read_manifests(tmp_path)] == ["study", "other"]
    assert read_results(tmp_path, "other").table("rows")["run"].tolist() == ["a", "b"]


def test_results_that_lost_a_file_to_others_are_no_longer_named(tmp_path):
    write(tmp_path, kind="first", tables=("points", "rest"))
    write(tmp_path, kind="second")
    assert [made.kind for made in read_manifests(tmp_path)] == ["second"]


def test_pages_drawn_again_leave_the_results_as_they_are(tmp_path):
    write(tmp_path, pages={"study.md": b"# Study"})
    before = (tmp_path / "points.parquet").read_bytes()
    write_pages(tmp_path, "study", {"study.md": b"# Again", "study.html": b""})
    assert (tmp_path / "points.parquet").read_bytes() == before
    assert read_results(tmp_path, "study").manifest.pages == ("study.md", "study.html")
    write_pages(tmp_path / "elsewhere", "study", {"study.md": b"# Again"})
    assert {path.name for path in (tmp_path / "elsewhere").iterdir()} == {"study.md"}


@pytest.mark.parametrize(
    ("content", "says"),
    [
        (None, "has no manifest.json"),
        ("{", "cannot be read"),
        ("[]", "cannot be read"),
        ('{"kind": "study"}', "cannot be read"),
    ],
)
def test_a_file_that_is_no_manifest_is_refused(tmp_path, content, says):
    if content is not None:
        (tmp_path / MANIFEST).write_text(content)
    with pytest.raises(ValueError, match=says):
        read_results(tmp_path, "study")


def test_results_of_another_kind_are_named(tmp_path):
    write(tmp_path, kind="other")
    with pytest.raises(ValueError, match="not hold results of kind 'study', but of other"):
        read_results(tmp_path, "study")


def test_an_installed_package_reports_no_commit_of_the_surrounding_repository(monkeypatch):
    refused = provenance.subprocess.CalledProcessError(1, "git")

    def run(command, **_):
        raise refused

    monkeypatch.setattr(provenance.subprocess, "run", run)
    assert provenance.commit.__wrapped__() == ""
