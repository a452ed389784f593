"""Paths that are no record: each is refused at once, in a line that names it."""

from __future__ import annotations

import os
import socket
from collections.abc import Iterator
from functools import partial
from pathlib import Path

import pytest

from rockwobble.models import read_hazard, read_record, read_records, read_suite

PATHS = {
    "circle": "Too many levels of symbolic links",
    "pipe": "a pipe or a socket",
    "socket": "a pipe or a socket",
    "/dev/zero": "a device",
    "gigabytes.txt": "it has 1000000 MB, allowed are 200",
    "empty.csv": "is empty",
    "blank.csv": "is empty",
    "none.csv": "No such file",
    "null\0byte": "null byte",
    50 * "deeper/" + "none.csv": "No such file",
    "e" * 300: "File name too long",
}
FOLDERS = {
    "folder": "got 0 files",
    "folder_of_folders": "got 0 files",
    "folder_of_papers": "is a PDF",
    "folder_of_many": "got 61 files: a folder of many records is for --records",
}


@pytest.fixture
def folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Iterator[Path]:
    monkeypatch.chdir(tmp_path)
    Path("circle").symlink_to("edge")
    Path("edge").symlink_to("circle")
    os.mkfifo("pipe")
    with Path("gigabytes.txt").open("wb") as file:
        file.truncate(10**12)  # takes no space on the disk
    Path("empty.csv").write_text("")
    Path("blank.csv").write_text(" \n\n\t\n")
    for name in FOLDERS:
        Path(name).mkdir()
    Path("folder_of_folders/inner").mkdir()
    Path("folder_of_folders/inner/a.csv").write_text("t,E [g]\n0,1\n1,2\n")
    Path("folder_of_papers/paper.pdf").write_bytes(b"%PDF-1.7")
    for number in range(61):
        Path(f"folder_of_many/{number}.csv").write_text("1")
    with socket.socket(socket.AF_UNIX) as bound:
        bound.bind("socket")
        yield tmp_path


def message_of(path: str) -> str:
    with pytest.raises(ValueError, match=r"\S") as caught:
        read_record(path, *([] if path in FOLDERS else ["zero"]))
    return str(caught.value)


@pytest.mark.usefixtures("folder")
def test_a_path_that_is_no_record_or_table_is_refused(monkeypatch: pytest.MonkeyPatch) -> None:
    for path, words in (PATHS | FOLDERS).items():
        message = message_of(path)
        assert words in message
        assert message.isprintable()
        assert len(message) < 250
    for path in ("pipe", "socket", "circle", "/dev/zero", "gigabytes.txt", "folder"):
        with pytest.raises(ValueError, match=f"the table of records {path}.* cannot be read"):
            read_records(path)

    def refuse(path: Path) -> bytes:  # the user who runs the tests may be allowed to read everything
        raise PermissionError(13, "Permission denied", str(path))

    monkeypatch.setattr(Path, "read_bytes", refuse)
    assert message_of("blank.csv") == "cannot read the record blank.csv: Permission denied"


def test_a_device_is_no_hazard_curve_and_no_suite() -> None:
    for read in (partial(read_hazard, measure="pga"), read_suite):
        with pytest.raises(ValueError, match=r"zero.* no (file|text)"):
            read("/dev/zero")
