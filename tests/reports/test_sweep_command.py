"""`rockwobble sweep` from the outside."""

from __future__ import annotations

import pytest

from rockwobble.compare import read_sweep
from rockwobble.compare.runs.cache import CACHE
from rockwobble.reports.cli.main import main

GRID = ["--semidiagonal", "1:20:4", "--tan-alpha", "0.1,0.2", "--scale", "0.3,2", "--workers", "1"]


def call(*arguments: str) -> int:
    with pytest.raises(SystemExit) as ended:
        main(list(arguments))
    assert isinstance(ended.value.code, int)
    return ended.value.code


def test_a_sweep_prints_what_it_keeps_and_show_prints_it_again(tmp_path, capsys):
    assert call("sweep", *GRID, "--out", str(tmp_path)) == 0
    printed = capsys.readouterr().out
    assert "alpha = 5.711 to 11.31 deg" in printed
    assert "Runs: 16 (4 sizes, 2 slendernesses, 2 scales, 1 records, models recess)" in printed
    table = read_sweep(tmp_path)
    assert call("show", str(tmp_path)) == 0
    shown = capsys.readouterr().out
    assert shown.strip() in printed
    for outcome, count in table["outcome"].value_counts().items():
        assert f"{outcome} {count}" in " ".join(shown.split())


def test_a_sweep_that_is_started_again_says_what_it_found(tmp_path, capsys):
    assert call("sweep", *GRID, "--chunk", "1", "--out", str(tmp_path)) == 0
    kept = sorted((tmp_path / CACHE / "sweep").glob("*.parquet"))
    assert len(kept) == 16
    for path in kept[:13]:
        path.unlink()
    capsys.readouterr()
    assert call("sweep", *GRID, "--chunk", "1", "--out", str(tmp_path)) == 0
    assert "16 of 16 chunks (3 of them found finished)" in capsys.readouterr().err


@pytest.mark.parametrize(
    ("arguments", "words"),
    [
        (["--semidiagonal", "a"], "--semidiagonal must be a number, a list such as 1,2,6 or a range"),
        (["--scale", "1:2"], "--scale must be a number"),
        (["--tan-alpha", "1:2:1"], "--tan-alpha must be a number"),
        (["--model", "glued"], "models must be of recess, flat, planar, got 'glued'"),
        (["--record-x", "a.at2"], "each record needs both horizontal components"),
        (["--units", "g"], "--record-z and --units belong to a record"),
        (["no-such-suite"], "no-such-suite"),
        (["quick", "--units", "g"], "the records of a suite stand in its file"),
    ],
)
def test_bad_input_of_a_sweep_gets_one_clear_line(tmp_path, capsys, arguments, words):
    assert call("sweep", *arguments, "--out", str(tmp_path / "out")) == 2
    error = capsys.readouterr().err
    assert error.count("\n") == 1
    assert words in error
    assert not (tmp_path / "out").exists()
