"""`rockwobble spectrum` from the outside."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pandas as pd
import pytest

from rockwobble import reduced
from rockwobble.models import el_centro_1940
from rockwobble.reports.cli.main import main

# the factors on the record differ by a rounding, grown by a few passes
SAME_RUN = 1e-6
SMALL = ["--sizes", "6", "--intensities", "8", "--largest", "20", "--strongest", "9"]
FILES = {
    "spectrum.md",
    "spectrum.svg",
    "spectrum.parquet",
    "lowest.parquet",
    "islands.parquet",
    "contrast.parquet",
    "checked.parquet",
}


def call(*arguments: str) -> int:
    with pytest.raises(SystemExit) as ended:
        main(["spectrum", *arguments])
    assert isinstance(ended.value.code, int)
    return ended.value.code


def test_it_prints_a_table_and_sentences_and_writes_what_it_names(tmp_path: Path, capsys):
    (tmp_path / "kept.txt").write_text("mine")
    assert call(*SMALL, "--tan-alpha", "0.2", "--out", str(tmp_path)) == 0
    printed = capsys.readouterr().out
    assert "R = 0.5 to 20 m" in printed
    assert "alpha = 11.31 deg" in printed
    assert "Planar analysis is unconservative in" in " ".join(printed.split())
    assert {path.name for path in tmp_path.iterdir()} == FILES | {"kept.txt"}
    for name in FILES:
        assert name in printed

    cells = pd.read_parquet(tmp_path / "spectrum.parquet")
    assert len(cells) == 3 * 6 * 8
    space = cells[cells["series"] == "3d"]
    peaks = reduced.peak_tilts(
        np.linspace(0.5, 20.0, 6),
        0.2,
        el_centro_1940(),
        np.linspace(1.0, 9.0, 8) * 9.81 * 0.2 / el_centro_1940().peak,
        rtol=1e-8,
    )
    assert space["peak_tilt"].to_numpy().reshape(6, 8) == pytest.approx(peaks, rel=SAME_RUN)
    lowest = pd.read_parquet(tmp_path / "lowest.parquet")
    assert len(lowest) == 3 * 6
    assert lowest["search_step"].tolist() == [0.01] * 18
    assert lowest["confirmed"].any()
    assert (lowest["intensity"] <= lowest["on_grid"].fillna(np.inf)).sum() >= 6
    assert "in steps of 0.01, down to a sixteenth of it" in " ".join(printed.split())
    page = (tmp_path / "spectrum.md").read_text()
    assert "(spectrum.svg)" in page
    assert f"numpy {np.__version__}" in page
    assert page.splitlines()[0] == "# Overturning spectrum: El Centro 1940, tan α = 0.2"


def test_any_record_will_do(tmp_path: Path, capsys):
    time = np.arange(0.0, 3.0, 0.02)
    for name, phase in (("x.csv", 0.0), ("y.csv", 1.0)):
        rows = "\n".join(f"{t:.2f}, {0.3 * np.sin(5.0 * t + phase) * (t < 2.0):.6f}" for t in time)
        (tmp_path / name).write_text(f"time [s], acceleration [g]\n{rows}\n")
    records = ["--record-x", str(tmp_path / "x.csv"), "--record-y", str(tmp_path / "y.csv")]
    assert call(*SMALL, *records, "--out", str(tmp_path / "out")) == 0
    cells = pd.read_parquet(tmp_path / "out" / "spectrum.parquet")
    assert cells["overturned"].any()
    assert not cells["peak_tilt"].isna().any()


@pytest.mark.parametrize(
    ("arguments", "words"),
    [
        (["--sizes", "1"], "--sizes must be from 2 to 2000, got 1"),
        (["--intensities", "9999"], "--intensities must be from 2 to 2000, got 9999"),
        (["--smallest", "3", "--largest", "2"], "must be positive and increasing, got 3 and 2"),
        (["--smallest", "-1"], "must be positive and increasing, got -1 and 30"),
        (["--weakest", "nan"], "must be positive and increasing, got nan and 12"),
        (["--model", "planar"], "--model must be one of recess, flat, got 'planar'"),
        (["--search-step", "0"], "--search-step must be at least 1e-05 and finite, got 0"),
        (["--search-step", "inf"], "--search-step must be at least 1e-05 and finite, got inf"),
        (["--tan-alpha", "0"], "tan_alpha must be positive"),
        (["--record-x", "x.csv"], "both horizontal components are needed"),
        (["--out", "taken"], "the output folder must be a folder"),
    ],
)
def test_bad_input_is_one_line_and_writes_nothing(arguments, words, tmp_path, monkeypatch, capsys):
    monkeypatch.chdir(tmp_path)
    (tmp_path / "taken").write_text("")
    assert call(*arguments) == 2
    captured = capsys.readouterr()
    assert words in captured.err
    assert captured.err.count("\n") == 1
    assert captured.out == ""
    assert [path.name for path in tmp_path.iterdir()] == ["taken"]
