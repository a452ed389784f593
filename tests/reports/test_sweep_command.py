"""`rockwobble sweep` from the outside."""

from __future__ import annotations

import errno
from pathlib import Path

import pytest
from showing import call

from rockwobble.compare.runs import scheduler
from rockwobble.compare.runs.progress import FailedTask
from rockwobble.compare.storage.manifest import file_state, read_manifests
from rockwobble.studies import study
from rockwobble.studies.sweep import SweepStudy

GRID = ["--semidiagonal", "1:20:4", "--tan-alpha", "0.1,0.2", "--scale", "0.3,2", "--workers", "1"]


@pytest.mark.slow
@pytest.mark.parametrize("full_at", ["sweep.parquet", "manifest.json"])
def test_a_full_disk_leaves_complete_chunks_only(
    tmp_path: Path, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch, full_at: str
) -> None:
    write = Path.write_bytes

    def full(path: Path, content: bytes) -> int:
        if full_at in path.name:
            raise OSError(errno.ENOSPC, "No space left on device")
        return write(path, content)

    with monkeypatch.context() as patch:
        patch.setattr(Path, "write_bytes", full)
        assert call("sweep", *GRID, "--out", str(tmp_path)) == 2
    assert "No space left on device" in capsys.readouterr().err
    assert {path.name for path in tmp_path.iterdir()} == {"finished", ".plan.json"}
    monkeypatch.setattr(SweepStudy, "row", lambda _: pytest.fail("a finished chunk ran again"))
    assert call("sweep", *GRID, "--out", str(tmp_path)) == 0
    (made,) = read_manifests(tmp_path)
    assert {"sweep.html"} == set(made.pages)
    assert all(file_state(tmp_path, made, name) == "whole" for name in made.files)


def test_a_dead_scheduler_leaves_no_folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    def dead(*_: object, **__: object) -> None:
        raise ValueError("no Dask scheduler answers")

    monkeypatch.setattr(scheduler, "on_cluster", dead)
    assert call("sweep", *GRID, "--scheduler", "tcp://127.0.0.1:1", "--out", str(tmp_path / "a" / "b")) == 2
    assert [*tmp_path.iterdir()] == []


def test_a_sweep_that_cannot_be_finished_says_so_in_one_line(tmp_path, capsys, monkeypatch):
    monkeypatch.setattr(study, "run_tasks", lambda _, tasks, **__: [FailedTask("killed") for _ in tasks])
    assert call("sweep", *GRID, "--chunk", "8", "--out", str(tmp_path)) == 1
    (line,) = capsys.readouterr().err.splitlines()
    assert line.startswith("rockwobble: 2 of 2 chunks ended their processes 3 times, all others are")
