from __future__ import annotations

import io
import re

import pytest
from rich.console import Console

import rockwobble as rw
from rockwobble.models import Case, Cylinder, Run
from rockwobble.reports.pages import page_of


def printed(comparison, width: int) -> str:
    console = Console(width=width, file=io.StringIO(), force_terminal=True, no_color=True)
    page_of(comparison.made_by()).show(console)
    return re.sub(r"\x1b\[[\d;]*m", "", console.file.getvalue())


@pytest.mark.parametrize("width", [80, 100])
def test_the_table_fits_its_terminal_and_every_row_its_line(comparison, width):
    text = printed(comparison, width)
    assert "…" not in text
    assert max(len(line.rstrip()) for line in text.splitlines()) <= width
    rows = [line for line in text.splitlines() if re.match(r"(mujoco|pybullet) (recess|flat) +stands ", line)]
    assert len(rows) == comparison.summary["run"].nunique()
    for heading in ("agrees", "tilt", "contact", "turn", "uplift", "cost"):
        assert heading in text
    assert "more column" not in text


def test_a_failed_run_is_no_number(no_engines):
    no_engines(outcome="failed", peak_tilt=float("nan"), residual_displacement=float("nan"))
    case = Case(Cylinder(semidiagonal=6.0, tan_alpha=0.2), duration=1.0, name="still")
    text = printed(rw.comparison(case, runs=[Run("mujoco", "recess")]), 100)
    assert "failed" in text
    assert "nan" not in text
