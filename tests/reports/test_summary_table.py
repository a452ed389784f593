from __future__ import annotations

import io

import pytest
from rich.console import Console

from rockwobble.compare import compare
from rockwobble.models import Case, Cylinder, Run
from rockwobble.reports.console.summary_table import summary_table


@pytest.mark.parametrize("width", [80, 100])
def test_table_fits_its_terminal_whole(comparison, width):
    console = Console(width=width, record=True, file=io.StringIO())
    console.print(summary_table(comparison.summary, width))
    text = console.export_text()
    assert "…" not in text
    assert max(len(line) for line in text.splitlines()) <= width
    assert len(text.splitlines()) == 3 + len(comparison.summary)
    for heading in ("agrees", "[α]", "[%]", "[s]", "[deg]", "[b]"):
        assert heading in text


def test_a_failed_run_is_no_number(no_engines):
    no_engines(outcome="failed", peak_tilt=float("nan"), residual_displacement=float("nan"))
    case = Case(Cylinder(semidiagonal=6.0, tan_alpha=0.2), duration=1.0, name="still")
    console = Console(width=100, record=True, file=io.StringIO())
    console.print(summary_table(compare(case, runs=[Run("mujoco", "recess")]).summary, 100))
    text = console.export_text()
    assert "failed" in text
    assert "nan" not in text
