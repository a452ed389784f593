"""Folders of results: files whole or not at all, a manifest that names damage, and one plan a folder."""

from __future__ import annotations

import json
import os
import re
import subprocess
import sys
from contextlib import suppress
from pathlib import Path

import pandas as pd
import pytest

from rockwobble.compare.storage import provenance
from rockwobble.compare.storage.claim import CACHE, claim_folder, claim_on
from rockwobble.compare.storage.files import replace_files
from rockwobble.compare.storage.manifest import (
    MANIFEST,
    Manifest,
    file_state,
    read_manifests,
    read_results,
    require_writable,
    with_provenance,
    write_pages,
    write_results,
)
from rockwobble.models.trace_file import read_about

TABLE = pd.DataFrame({"peak": [0.1, float("nan")], "run": ["a", "b"]})
MADE = {"command": "rockwobble study", "seeds": {"members": 3}, "headline": {"largest": 0.1}}


def names(folder: Path) -> set[str]:
    return {path.relative_to(folder).as_posix() for path in folder.rglob("*")}


def contents(folder: Path) -> dict[str, bytes]:
    return {path.name: path.read_bytes() for path in folder.iterdir()}


def write(folder, kind="study", tables=("points",), **options):
    manifest = Manifest(kind=kind, inputs="0" * 32, about={"extent": [1.0, 2.0]}, **MADE)
    return write_results(folder, with_provenance(manifest), dict.fromkeys(tables, TABLE), **options)


def test_files_are_written_all_or_none(tmp_path):
    replace_files(tmp_path / "a" / "b", {"c.csv": b"1"})  # folders are created
    assert (tmp_path / "a" / "b" / "c.csv").read_bytes() == b"1"
    (tmp_path / "b.csv").mkdir()
    with pytest.raises(ValueError, match=r"must not be a folder, got .*b\.csv"):
        replace_files(tmp_path, {"a.csv": b"1", "b.csv": b"2"})
    assert names(tmp_path) == {"a", "a/b", "a/b/c.csv", "b.csv"}


def test_a_failure_while_writing_preserves_the_old_files(tmp_path, monkeypatch):
    replace_files(tmp_path, {"a.csv": b"old", "b.csv": b"old"})
    write_bytes = Path.write_bytes

    def disk_full(self, data):
        if ".b.csv" in self.name:
            write_bytes(self, data[:1])
            raise OSError(28, "No space left on device")
        return write_bytes(self, data)

    monkeypatch.setattr(Path, "write_bytes", disk_full)
    with pytest.raises(ValueError, match=r"cannot be written: No space left on device"):
        replace_files(tmp_path, {"a.csv": b"new", "b.csv": b"new"})
    assert contents(tmp_path) == {"a.csv": b"old", "b.csv": b"old"}


def test_files_and_their_names_survive_a_loss_of_power(tmp_path, monkeypatch):
    forced = []
    monkeypatch.setattr(os, "fsync", lambda descriptor: forced.append(os.fstat(descriptor).st_ino))
    replace_files(tmp_path, {"a.csv": b"1"})
    assert forced == [(tmp_path / "a.csv").stat().st_ino, tmp_path.stat().st_ino]


def test_pipes_and_links_are_not_replaced(tmp_path):
    pipe, link = tmp_path / "pipe", tmp_path / "link.csv"
    os.mkfifo(pipe)
    (tmp_path / "real.csv").write_bytes(b"old")
    link.symlink_to(tmp_path / "real.csv")
    reader = os.open(pipe, os.O_RDONLY | os.O_NONBLOCK)
    replace_files(tmp_path, {"pipe": b"1", "link.csv": b"new"})
    assert os.read(reader, 10) == b"1"
    os.close(reader)
    assert pipe.is_fifo()
    assert link.is_symlink()
    assert (tmp_path / "real.csv").read_bytes() == b"new"
    assert names(tmp_path) == {"link.csv", "pipe", "real.csv"}


def test_testing_whether_a_folder_is_writable_leaves_no_trace(tmp_path):
    assert require_writable(tmp_path / "x" / "y") == tmp_path / "x" / "y"
    assert names(tmp_path) == set()
    (tmp_path / "taken").write_text("")
    for folder in (tmp_path / "taken", tmp_path / "taken" / "below", "/proc/1/none"):
        with pytest.raises(ValueError, match="output folder"):
            require_writable(folder)


def test_a_written_manifest_is_read_back(tmp_path):
    write(tmp_path, files={"raw.csv": b"1,2\n"}, pages={"study.md": b"# Study"})
    stored = read_results(tmp_path, "study")
    pd.testing.assert_frame_equal(stored.table("points"), TABLE, check_exact=True)
    assert stored.content("raw.csv") == b"1,2\n"
    manifest = stored.manifest
    assert {name: getattr(manifest, name) for name in MADE} == MADE
    assert (manifest.about, manifest.pages) == ({"extent": [1.0, 2.0]}, ("study.md",))
    assert {"python", "numpy", "rockwobble"} <= set(manifest.versions)
    assert set(manifest.code) == {"models", "reduced", "multibody", "compare", "studies"}
    assert re.fullmatch(r"([0-9a-f]{40}\+?)?", manifest.commit)
    assert read_about(tmp_path / "points.parquet")["inputs"] == "0" * 32
    content = json.loads((tmp_path / MANIFEST).read_text())
    assert {"kind", "inputs", "commit", "versions", "files", *MADE} <= set(content)
    assert set(content["files"]) == {"points.parquet", "raw.csv"}


@pytest.mark.parametrize("state", ["missing", "damaged"])
def test_a_damaged_file_is_named_and_not_read(tmp_path, state):
    write(tmp_path, tables=("points", "scenes"))
    path = tmp_path / "scenes.parquet"
    content = bytearray(path.read_bytes())
    content[len(content) // 2] ^= 1  # a single bit
    path.unlink() if state == "missing" else path.write_bytes(content)
    (manifest,) = read_manifests(tmp_path)
    assert [file_state(tmp_path, manifest, f"{name}.parquet") for name in ("points", "scenes")] == [
        "whole",
        state,
    ]
    with pytest.raises(ValueError, match=rf"scenes.parquet is {state}"):
        read_results(tmp_path, "study")


def test_a_second_run_replaces_only_its_own_files(tmp_path):
    (tmp_path / "mine.txt").write_text("mine")
    write(tmp_path, tables=("points", "budget"), pages={"old.svg": b""})
    write(tmp_path, kind="other", tables=("rows",))
    write(tmp_path, tables=("points",))
    assert names(tmp_path) == {"mine.txt", "points.parquet", "rows.parquet", MANIFEST}
    assert [manifest.kind for manifest in read_manifests(tmp_path)] == ["study", "other"]
    assert read_results(tmp_path, "other").table("rows")["run"].tolist() == ["a", "b"]
    write(tmp_path, kind="second")  # overwrites a file of the study, which is damaged by that
    assert [manifest.kind for manifest in read_manifests(tmp_path)] == ["second", "other"]


def test_new_pages_leave_the_results_unchanged(tmp_path):
    write(tmp_path, pages={"study.md": b"# Study"})
    before = (tmp_path / "points.parquet").read_bytes()
    write_pages(tmp_path, "study", {"study.md": b"# Again", "study.html": b""})
    assert (tmp_path / "points.parquet").read_bytes() == before
    assert read_results(tmp_path, "study").manifest.pages == ("study.md", "study.html")
    write_pages(tmp_path / "elsewhere", "study", {"study.md": b"# Again"})
    assert names(tmp_path / "elsewhere") == {"study.md"}


def test_a_foreign_manifest_is_refused(tmp_path):
    with pytest.raises(ValueError, match=r"has no manifest\.json"):
        read_results(tmp_path, "study")
    for content in ("{", "[]", '{"kind": "study"}'):
        (tmp_path / MANIFEST).write_text(content)
        with pytest.raises(ValueError, match="cannot be read"):
            read_results(tmp_path, "study")
    write(tmp_path / "other", kind="other")
    with pytest.raises(ValueError, match="not hold results of kind 'study', but of other"):
        read_results(tmp_path / "other", "study")


def test_an_installed_package_reports_no_commit_of_the_surrounding_repository(monkeypatch):
    def run(command, **_):
        raise subprocess.CalledProcessError(1, "git")

    monkeypatch.setattr(provenance.subprocess, "run", run)
    assert provenance.commit.__wrapped__() == ""


def write_claimed(folder: Path, kind: str, name: str) -> None:
    """Write results of a table under the plan for which this process has claimed the folder."""
    claim = claim_on(folder)
    manifest = Manifest(kind=kind, command=claim.command if claim else "", plan=claim.plan if claim else "")
    write_results(folder, manifest, {name: TABLE})


def finish(folder: Path, kind: str, name: str) -> Path:
    path = folder / CACHE / kind / f"{name}.parquet"
    path.parent.mkdir(parents=True, exist_ok=True)
    path.write_bytes(b"")
    return path


def require_refused(folder: Path, words: str, **claim) -> None:
    with pytest.raises(ValueError, match=words), claim_folder(folder, **claim):
        pass


def test_the_same_plan_resumes_and_another_is_refused(tmp_path):
    with claim_folder(tmp_path, plan="a", command="sweep --a"):
        write_claimed(tmp_path, "sweep", "one")
    before = contents(tmp_path)
    words = r"holds sweep of `sweep --a`: choose another by --out, or replace that by --overwrite"
    require_refused(tmp_path, words, plan="b", command="sweep --b")
    assert contents(tmp_path) == before
    with claim_folder(tmp_path, plan="a", command="sweep  --a"):
        pass
    assert contents(tmp_path) == before


def test_finished_tasks_belong_to_the_interrupted_plan(tmp_path):
    with suppress(KeyboardInterrupt), claim_folder(tmp_path, plan="a", command="sweep --a"):
        path = finish(tmp_path, "sweep", "x")
        raise KeyboardInterrupt
    require_refused(tmp_path, "1 finished tasks of `sweep --a`", plan="b", command="sweep --b")
    with claim_folder(tmp_path, plan="a", command="sweep --a"):
        assert path.exists()


def test_an_overwritten_plan_is_removed_once_the_new_one_is_complete(tmp_path):
    with claim_folder(tmp_path, plan="a", command="sweep --a"):
        write_claimed(tmp_path, "sweep", "one")
    (tmp_path / "notes.txt").write_text("mine")
    finish(tmp_path, "sweep", "x")
    other = {"plan": "b", "command": "other --b", "overwrite": True}
    with pytest.raises(KeyboardInterrupt), claim_folder(tmp_path, **other):
        raise KeyboardInterrupt
    assert "one.parquet" in names(tmp_path)
    with claim_folder(tmp_path, **other):
        write_claimed(tmp_path, "other", "two")
    assert [each.kind for each in read_manifests(tmp_path)] == ["other"]
    assert names(tmp_path) == {"two.parquet", MANIFEST, "notes.txt", CACHE}


def test_a_plan_without_finished_tasks_leaves_nothing(tmp_path):
    place = tmp_path / "x" / "y"
    with suppress(KeyboardInterrupt), claim_folder(place, plan="a", command="sweep"):
        assert claim_on(place)
        raise KeyboardInterrupt
    assert names(tmp_path) == set()
    assert claim_on(place) is None


def test_results_of_other_programs_or_versions_are_not_reused(tmp_path):
    write_claimed(tmp_path, "sweep", "one")
    require_refused(tmp_path, "another program", plan="a", command="sweep")
    write_results(tmp_path, Manifest(kind="sweep", command="sweep --a"), {})
    with claim_folder(tmp_path, plan="a", command="sweep --a"):  # same text of the command
        pass
    require_refused(tmp_path, "`sweep --a`", plan="a", command="sweep")


def test_a_second_process_is_refused_and_a_killed_one_unlocks(tmp_path):
    script = (
        "import sys, time\nfrom rockwobble.compare.storage.claim import claim_folder\n"
        "with claim_folder(sys.argv[1], plan='a', command='sweep'):\n"
        " print('ready', flush=True)\n time.sleep(60)"
    )
    with subprocess.Popen(
        [sys.executable, "-c", script, str(tmp_path)], stdout=subprocess.PIPE, text=True
    ) as other:
        assert other.stdout is not None
        assert other.stdout.readline() == "ready\n"
        require_refused(tmp_path, "another process is", plan="a", command="sweep", overwrite=True)
        other.kill()
    with claim_folder(tmp_path, plan="b", command="simulate"):  # it had finished nothing
        pass
    assert names(tmp_path) == set()
