"""Progress of long work, in words."""

from __future__ import annotations

import math

import pytest

from rockwobble.compare import Progress
from rockwobble.reports.console import sentence, shown_progress


@pytest.mark.parametrize(
    ("far", "words"),
    [
        (
            {"done": 1500, "total": 3000, "found": 500, "left": 200.0},
            "1,500 of 3,000 runs (500 of them found finished), about 3.3 min left",
        ),
        ({"done": 10, "total": 10, "left": 0.0}, "10 of 10 runs"),
        ({"done": 1, "total": 10, "left": math.nan}, "1 of 10 runs"),
    ],
)
def test_progress_is_worded_by_share_and_time(far, words):
    assert sentence(Progress(label="a", state="finished", **far)) == words


def test_progress_is_stated_at_once_and_every_ten_seconds(capsys, monkeypatch):
    now = 0.0
    monkeypatch.setattr("rockwobble.reports.console.time.monotonic", lambda: now)
    with shown_progress("checks") as tell:
        for done in range(30):
            tell(Progress(label=f"[{done}]", state="started", done=done, total=30, left=30.0 - done))
            now += 0.9
            tell(Progress(label=f"[{done}]", state="finished", done=done + 1, total=30, left=29.0 - done))
    lines = capsys.readouterr().err.splitlines()
    assert lines[:2] == ["0 of 30 checks, about 30 s left: [0]", "12 of 30 checks, about 18 s left"]
    assert len(lines) == 3


def test_a_damaged_file_is_named_once(capsys):
    with shown_progress() as tell:
        for state in ("started", "finished"):
            tell(Progress(label="a", state=state, done=0, total=1, damaged=("out/finished/a.parquet",)))
    lines = capsys.readouterr().err.splitlines()
    assert [line for line in lines if "damaged" in line] == [
        "rockwobble: out/finished/a.parquet is damaged, what it held is computed again"
    ]
