"""Agreement matrix: engine against engine, not only against the model."""

from __future__ import annotations

import numpy as np
import pandas as pd
import pytest

from rockwobble.compare.comparison.summary import MATRIX_COLUMNS, agreement_matrix
from rockwobble.models import Case, InitialState, Run
from rockwobble.reports.pages.comparison import matrix_tables

TIME = np.arange(101) * 0.01


@pytest.fixture
def motions(cylinder, make_trace):
    alpha = cylinder.alpha
    base = 0.5 * alpha * (1.5 + np.sin(TIME))
    late = np.where(TIME > 0.5 - 1e-9, 0.02 * alpha, 0.0)
    return {
        ("a", "mujoco recess"): make_trace(TIME, base + 1e-3 * alpha, run=Run("mujoco", "recess")),
        ("a", "dart recess"): make_trace(TIME, base - 1e-3 * alpha + late, run=Run("dart", "recess")),
        ("a", "recess model"): make_trace(TIME, base, run=Run(None, "recess")),
        ("a", "mujoco flat"): make_trace(TIME, base, run=Run("mujoco", "flat")),
        ("a", "flat-ground model"): make_trace(TIME, base, run=Run(None, "flat")),
    }


@pytest.fixture
def matrix(cylinder, motions):
    case = Case(cylinder, initial=InitialState(0.5 * cylinder.alpha), duration=1.0, name="a")
    return agreement_matrix({"a": case}, motions)


def test_a_matrix_has_each_pair_on_one_support(matrix) -> None:
    assert list(matrix.columns) == list(MATRIX_COLUMNS)
    assert set(matrix["support"]) == {"recess"}
    assert len(matrix) == 6
    assert not (matrix["run"] == matrix["other"]).any()


def test_the_matrix_has_the_numbers_of_each_pair(matrix, motions, cylinder) -> None:
    rows = matrix.set_index(["run", "other"])
    both = rows.loc["mujoco recess", "dart recess"]
    # difference of 2e-3 alpha, and from 0.5 s on of 18e-3 alpha
    assert both["diverged"]
    assert both["agreement_time"] == pytest.approx(0.5)
    assert both["tilt_rms"] == pytest.approx(np.sqrt((50 * 2e-3**2 + 51 * 18e-3**2) / 101))
    own = rows.loc["mujoco recess", "recess model"]
    assert (own["diverged"], own["agreement_time"]) == (False, 1.0)
    tilt = motions["a", "recess model"].tilt
    assert own["tilt_rms_relative"] == pytest.approx(1e-3 * cylinder.alpha / np.sqrt(np.mean(tilt**2)))
    assert own["peak_tilt_difference"] == pytest.approx(1e-3)
    other_way = rows.loc["dart recess", "mujoco recess"]
    assert other_way["tilt_rms"] == pytest.approx(both["tilt_rms"])


def test_the_agreement_matrix_has_a_row_and_column_per_run(matrix) -> None:
    (table,) = matrix_tables(matrix)
    assert table["support"] == "recess"
    assert [row["run"] for row in table["rows"]] == ["mujoco", "dart", "model"]
    assert [heading for _, heading, _ in table["columns"]] == ["recess", "mujoco", "dart", "model"]
    ends = [table["rows"][0][name] for name in ("mujoco recess", "dart recess", "recess model")]
    assert ends == [None, "0.50 s", "1.00+ s"]
    # counts over many cases
    (table,) = matrix_tables(pd.concat([matrix, matrix.assign(case="b", diverged=False)]))
    assert table["rows"][0]["dart recess"] == "1 of 2"
