"""The table of what a ring costs: its runs, and its medians."""

from __future__ import annotations

import math

import pandas as pd
import pytest

from benchmarks.ring_losses import INTENSITIES, medians, ring_cases, ring_runs


def test_every_run_of_the_table_differs() -> None:
    runs = ring_runs()
    assert [run.support for run in runs[:2]] == ["recess", "flat"]
    assert len({(run.support, *run.settings.items()) for run in runs}) == len(runs)


def test_the_cases_turn() -> None:
    (free, shaken), (turned, turned_shaken) = (ring_cases(0.2, turn).values() for turn in (0.0, 0.1))
    assert free.initial is not None
    assert turned.initial is not None
    assert turned.initial.rolling_angle == pytest.approx(0.1)
    assert shaken.motion is not None
    assert turned_shaken.motion is not None
    assert turned_shaken.motion.peak == pytest.approx(shaken.motion.peak)
    # as many times the acceleration that uplifts as the table says
    assert shaken.motion.peak / (9.81 * 0.2) == pytest.approx(INTENSITIES[0.2])


def test_a_line_holds_the_medians_of_the_turns() -> None:
    same = {"outcome": "stands", "first_contact": math.inf, "contact_time": 0.0, "passes": 2,
            "rolled_out": 0.0, "at_end": 0.0, "twist": 0.0, "recess": 1e-5, "flat": 1e-2}  # fmt: skip
    rows = [{"case": "short", "run": "clearance 0.01", "loss": loss, **same} for loss in (0.01, 0.02, 0.06)]
    line = medians(pd.DataFrame(rows)).iloc[0]
    assert line[["lost", "from", "to", "a pass"]].tolist() == pytest.approx([2.0, 1.0, 6.0, 1.0])
    assert math.isnan(line["first"])
