"""`rockwobble extremes` from the outside, with verdicts that are given: a scan takes minutes."""

from __future__ import annotations

import math
from pathlib import Path

import pandas as pd
import pytest

from rockwobble.compare.studies import extremes
from rockwobble.reports.cli.main import main


def call(*arguments: str) -> int:
    with pytest.raises(SystemExit) as ended:
        main(["extremes", *arguments])
    assert isinstance(ended.value.code, int)
    return ended.value.code


def given(worst: str) -> pd.DataFrame:
    rows = [
        ("spin", "0", "a", "fine", 1e-7),
        ("spin", "0", "b", worst, 0.3),
        ("spin", "9", "a", "n/a", math.nan),
    ]
    names = ("extreme", "value", "method", "verdict", "error")
    return pd.DataFrame([dict(zip(names, row, strict=True)) for row in rows]).assign(
        backed_by="a reference", message="<b>said</b>"
    )


@pytest.mark.parametrize(("worst", "code"), [("inaccurate", 0), ("silent", 1)])
def test_the_exit_code_tells_whether_anything_is_silently_wrong(
    worst, code, tmp_path: Path, monkeypatch, capsys
):
    monkeypatch.setattr(extremes, "measure_extremes", lambda **_: given(worst))
    assert call("--out", str(tmp_path)) == code
    printed = " ".join(capsys.readouterr().out.split())
    assert ("Nothing is silently wrong: of 2 runs 1 are fine" in printed) == (code == 0)
    assert ("Silently wrong: b, spin 0: an error of 3e-01" in printed) == (code == 1)
    assert {path.name for path in tmp_path.iterdir()} == {
        f"extremes.{ending}" for ending in ("html", "md", "svg", "parquet", "json")
    }
    page = (tmp_path / "extremes.html").read_text()
    assert "&lt;b&gt;said&lt;/b&gt;" in page
    assert "<b>said" not in page
    assert "(extremes.svg)" in (tmp_path / "extremes.md").read_text()


def test_bad_input_is_one_line(tmp_path, monkeypatch, capsys):
    monkeypatch.chdir(tmp_path)
    (tmp_path / "taken").write_text("")
    assert call("--out", "taken") == 2
    captured = capsys.readouterr()
    assert "the output folder must be a folder" in captured.err
    assert captured.err.count("\n") == 1
