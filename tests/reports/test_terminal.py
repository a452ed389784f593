"""Terminal output of commands on 80 columns."""

from __future__ import annotations

import io
import re
from collections.abc import Callable
from pathlib import Path

import pytest
from rich.console import Console
from showing import call

import rockwobble as rw
from rockwobble.models import Case, Cylinder, Run
from rockwobble.reports.pages import page_of


@pytest.mark.slow
@pytest.mark.usefixtures("in_this_process", "six_records")
@pytest.mark.parametrize(
    ("command", "most"),
    [
        ("compare", 14),
        ("simulate", 16),
        ("advise --diameter 1.6 --height 9 --friction 0.5 --copies 20", 26),
        ("fragility --synthetic 4 --levels 1,4,8", 8),
    ],
)
def test_command_output_fits_a_screen_of_80_columns(
    command: str,
    most: int,
    no_engines: Callable[..., None],
    tmp_path: Path,
    monkeypatch: pytest.MonkeyPatch,
    capsys: pytest.CaptureFixture[str],
) -> None:
    no_engines()
    monkeypatch.setenv("COLUMNS", "80")
    monkeypatch.chdir(tmp_path)
    assert call(*command.split(), "--out", "rockwobble-answer") == 0
    lines = capsys.readouterr().out.splitlines()
    assert max(map(len, lines)) <= 80
    assert len(lines) <= most


def printed(comparison: rw.Comparison, width: int) -> str:
    screen = io.StringIO()
    page_of(comparison.made_by()).show(Console(width=width, file=screen, no_color=True))
    return screen.getvalue()


@pytest.mark.parametrize("width", [80, 100])
def test_comparison_table_prints_one_line_per_row(comparison: rw.Comparison, width: int) -> None:
    text = printed(comparison, width)
    assert "…" not in text
    assert max(len(line.rstrip()) for line in text.splitlines()) <= width
    rows = re.findall(r"^(?:mujoco|pybullet) (?:recess|flat) +stands ", text, re.MULTILINE)
    assert len(rows) == comparison.summary["run"].nunique()
    for heading in ("agrees", "tilt", "contact", "turn", "uplift", "cost"):
        assert heading in text
    assert "more column" not in text


def test_failed_run_prints_no_number(no_engines: Callable[..., None]) -> None:
    no_engines(outcome="failed", peak_tilt=float("nan"), residual_displacement=float("nan"))
    case = Case(Cylinder(semidiagonal=6.0, tan_alpha=0.2), duration=1.0, name="still")
    text = printed(rw.comparison(case, runs=[Run("mujoco", "recess")]), 100)
    assert "failed" in text
    assert "nan" not in text
