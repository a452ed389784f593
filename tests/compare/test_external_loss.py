"""A free trajectory that loses energy is explained by that, not by near passes."""

from pathlib import Path

import numpy as np
import pytest

from rockwobble import reduced
from rockwobble.compare.external.trajectory import read_trajectory
from rockwobble.compare.external.verdict import judge
from rockwobble.models import Case, Cylinder, InitialState

CYLINDER = Cylinder.from_dimensions(base_radius=1.0, height=4.0)
CASE = Case(CYLINDER, initial=InitialState(0.5 * CYLINDER.alpha, rolling_rate=0.3), duration=3.0)


@pytest.mark.parametrize("resistance", [0.01, 0.03])
def test_the_rolling_resistance_of_a_trajectory_is_found(tmp_path: Path, resistance: float) -> None:
    case = Case(CYLINDER, initial=CASE.initial, duration=3.0, rolling_resistance=resistance)
    trace = reduced.simulate(case)
    rows = np.column_stack([trace.time, np.degrees(trace.tilt), np.degrees(trace.rolling_angle)])
    path = tmp_path / "rolls.csv"
    np.savetxt(path, rows, delimiter=",", header="time [s],tilt [deg],azimuth [deg]", comments="")
    row = judge(read_trajectory(path, CASE), reduced.simulate(CASE), CASE)
    assert row["likely_mistake"] == ("energy_loss", "rolling_resistance")
    # the finest of the lengths that are tried are 2 % apart
    assert row["likely_mistake_value"][1] == pytest.approx(resistance, rel=0.05)


def test_no_loss_is_reported_where_none_exists(tmp_path: Path) -> None:
    other = Case(CYLINDER, initial=InitialState(0.45 * CYLINDER.alpha, rolling_rate=0.3), duration=3.0)
    trace = reduced.simulate(other)
    path = tmp_path / "other.csv"
    rows = np.column_stack([trace.time, np.degrees(trace.tilt)])
    np.savetxt(path, rows, delimiter=",", header="time [s],tilt [deg]", comments="")
    row = judge(read_trajectory(path, CASE), reduced.simulate(CASE), CASE)
    assert "energy_loss" not in row["likely_mistake"]
