"""How far something is, in words that a person reads."""

from __future__ import annotations

import math

import pytest

from rockwobble.compare import Progress
from rockwobble.reports.console import sentence, shown_progress


@pytest.mark.parametrize(
    ("far", "words"),
    [
        ({"done": 0, "total": 10}, "0 of 10 runs"),
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


def test_few_tasks_have_a_line_each_and_many_one_at_the_end(capsys):
    with shown_progress("cells") as tell:
        tell(Progress(label="[a]", state="started", done=0, total=2))
        tell(Progress(label="[a]", state="finished", done=1, total=2))
    assert capsys.readouterr().err.splitlines()[0] == "running [a] ..."
    with shown_progress("cells") as tell:
        for done in range(1, 101):
            tell(Progress(label="[a]", state="finished", done=done, total=100))
    assert capsys.readouterr().err == "100 of 100 cells\n"


def test_progress_after_two_seconds_states_share_and_time_left(capsys, monkeypatch):
    now = 0.0
    monkeypatch.setattr("rockwobble.reports.console.time.monotonic", lambda: now)
    with shown_progress("checks", each=False) as tell:
        for done in range(1, 31):
            now += 0.9
            tell(Progress(label="a", state="finished", done=done, total=30, left=0.9 * (30 - done)))
    lines = capsys.readouterr().err.splitlines()
    assert lines[0] == "3 of 30 checks, about 24 s left"
    assert len(lines) == 3  # one after 2 s, and every 10 s
    now = 0.0
    with shown_progress("checks", each=False) as tell:
        tell(Progress(label="a", state="finished", done=30, total=30))
    assert capsys.readouterr().err == ""


def test_a_damaged_file_is_named_once(capsys):
    with shown_progress() as tell:
        for state in ("started", "finished"):
            tell(Progress(label="a", state=state, done=0, total=1, damaged=("out/finished/a.parquet",)))
    lines = capsys.readouterr().err.splitlines()
    assert [line for line in lines if "damaged" in line] == [
        "rockwobble: out/finished/a.parquet is damaged, what it held is computed again"
    ]
