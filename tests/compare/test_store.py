from __future__ import annotations

import os
from pathlib import Path

import pytest

from rockwobble.compare.storage.files import replace_files
from rockwobble.compare.storage.manifest import require_writable


def names(folder: Path) -> list[str]:
    return sorted(path.name for path in folder.rglob("*"))


def test_missing_folders_are_created(tmp_path):
    replace_files(tmp_path / "a" / "b", {"c.csv": b"1"})
    assert (tmp_path / "a" / "b" / "c.csv").read_bytes() == b"1"


def test_all_files_or_none(tmp_path):
    (tmp_path / "b.csv").mkdir()
    with pytest.raises(ValueError, match=r"must not be a folder, got .*b\.csv"):
        replace_files(tmp_path, {"a.csv": b"1", "b.csv": b"2"})
    assert names(tmp_path) == ["b.csv"]


def test_a_failure_while_writing_leaves_the_old_files_whole(tmp_path, monkeypatch):
    replace_files(tmp_path, {"a.csv": b"old", "b.csv": b"old"})
    write = Path.write_bytes

    def disk_full(self, data):
        if ".b.csv" in self.name:
            write(self, data[:1])
            raise OSError(28, "No space left on device")
        return write(self, data)

    monkeypatch.setattr(Path, "write_bytes", disk_full)
    with pytest.raises(ValueError, match=r"cannot be written: No space left on device"):
        replace_files(tmp_path, {"a.csv": b"new", "b.csv": b"new"})
    assert names(tmp_path) == ["a.csv", "b.csv"]
    assert (tmp_path / "a.csv").read_bytes() == b"old"


def test_files_and_their_names_outlive_a_loss_of_power(tmp_path, monkeypatch):
    forced = []
    monkeypatch.setattr(os, "fsync", lambda descriptor: forced.append(os.fstat(descriptor).st_ino))
    replace_files(tmp_path, {"a.csv": b"1"})
    assert forced == [(tmp_path / "a.csv").stat().st_ino, tmp_path.stat().st_ino]


def test_a_pipe_is_written_to_and_stays_a_pipe(tmp_path):
    pipe = tmp_path / "pipe"
    os.mkfifo(pipe)
    reader = os.open(pipe, os.O_RDONLY | os.O_NONBLOCK)
    replace_files(tmp_path, {"pipe": b"1", "a.csv": b"2"})
    assert os.read(reader, 10) == b"1"
    os.close(reader)
    assert pipe.is_fifo()
    assert names(tmp_path) == ["a.csv", "pipe"]


def test_behind_a_link_the_file_is_replaced_and_the_link_stays(tmp_path):
    (tmp_path / "real.csv").write_bytes(b"old")
    (tmp_path / "link.csv").symlink_to(tmp_path / "real.csv")
    replace_files(tmp_path, {"link.csv": b"new"})
    assert (tmp_path / "link.csv").is_symlink()
    assert (tmp_path / "real.csv").read_bytes() == b"new"
    assert names(tmp_path) == ["link.csv", "real.csv"]


def test_looking_whether_a_folder_can_be_written_leaves_no_trace(tmp_path):
    assert require_writable(tmp_path / "x" / "y") == tmp_path / "x" / "y"
    assert names(tmp_path) == []


def test_a_file_in_the_way(tmp_path):
    (tmp_path / "taken").write_text("")
    for folder in (tmp_path / "taken", tmp_path / "taken" / "below"):
        with pytest.raises(ValueError, match=r"output folder"):
            require_writable(folder)


def test_a_folder_that_refuses_files():
    with pytest.raises(ValueError, match=r"output folder /proc/1/none cannot be written"):
        require_writable("/proc/1/none")
