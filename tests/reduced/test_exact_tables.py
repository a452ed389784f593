"""The exact solutions against tables that were made without this code."""

import csv
import math
from pathlib import Path

import numpy as np
import pytest

from rockwobble.models import Cylinder, InitialState
from rockwobble.reduced.body import body_of
from rockwobble.reduced.exact import (
    angle_of_turn,
    free_response,
    limiting_angle_of_turn,
    planar_quarter_period,
    rocking_period,
)

REFERENCE = Path(__file__).parents[1] / "reference"
SIX_DECIMALS = 0.5e-6 + 1e-9  # the table is rounded to 6 decimals; ours adds rounding of order 1e-13
FOUR_DECIMALS = 0.5e-4 + 1e-9  # the same for a table of 4 decimals
ROUNDING = 1e-13  # of a quarter period, next to half a unit in the last printed digit
FLATTEST = 1e-9  # height over radius standing for the table's disc of no height: changes the turn by 1e-16


def table(name: str) -> list[dict[str, str]]:
    lines = (REFERENCE / name).read_text().splitlines()
    return list(csv.DictReader(line for line in lines if not line.startswith("#")))


def cylinder_of(h_over_b: float) -> Cylinder:
    return Cylinder.from_dimensions(base_radius=1.0, height=2.0 * h_over_b)


def half_unit(printed: str) -> float:
    return 0.5 * 10.0 ** -len(printed.partition(".")[2])


@pytest.mark.parametrize(
    "row", table("finite_release.csv"), ids=lambda row: f"{row['h_over_b']}-{row['phi_rate']}"
)
def test_finite_release(row: dict[str, str]) -> None:
    cylinder = cylinder_of(float(row["h_over_b"]))
    initial = InitialState(tilt=0.5 * cylinder.alpha, rolling_rate=float(row["phi_rate"]))
    response = free_response(cylinder, initial)
    assert math.degrees(response.angle_of_turn) == pytest.approx(
        float(row["recess_turn_deg"]), rel=0, abs=SIX_DECIMALS
    )
    assert response.period == pytest.approx(float(row["recess_period_s"]), rel=0, abs=SIX_DECIMALS)


@pytest.mark.parametrize("row", table("angle_of_turn_limit.csv"), ids=lambda row: row["h_over_b"])
def test_angle_of_turn_in_the_limit_of_vanishing_spin(row: dict[str, str]) -> None:
    cylinder = cylinder_of(max(float(row["h_over_b"]), FLATTEST))
    expected = pytest.approx(float(row["turn_deg"]), rel=0, abs=FOUR_DECIMALS)
    assert math.degrees(cylinder.alpha) == pytest.approx(float(row["alpha_deg"]), rel=0, abs=1e-3)
    assert math.degrees(limiting_angle_of_turn(cylinder)) == expected
    initial = InitialState(tilt=0.5 * cylinder.alpha, rolling_rate=1e-15)
    assert math.degrees(angle_of_turn(cylinder, initial)) == expected


@pytest.mark.parametrize("alpha", [0.1, 0.2, 0.3])
def test_planar_quarter_period(alpha: float) -> None:
    cylinder = Cylinder(semidiagonal=6.0, tan_alpha=math.tan(alpha))
    p = math.sqrt(body_of(cylinder, 9.81).p2)
    rows = table("planar_quarter_period.csv")
    tilts = np.array([float(row["theta0_over_alpha"]) for row in rows]) * cylinder.alpha
    quarters, cycles = planar_quarter_period(cylinder, tilts), rocking_period(cylinder, tilts)
    for row, quarter, cycle in zip(rows, quarters, cycles, strict=True):
        printed = row[f"alpha_{alpha}"]
        assert p * quarter == pytest.approx(float(printed), rel=0, abs=half_unit(printed) + ROUNDING)
        assert cycle == 4.0 * quarter


def test_planar_quarter_period_of_a_slender_block_is_housners() -> None:
    slenderness = 1e-5
    cylinder = Cylinder(semidiagonal=6.0, tan_alpha=slenderness)
    p = math.sqrt(body_of(cylinder, 9.81).p2)
    for row in table("planar_quarter_period.csv"):
        quarter = p * planar_quarter_period(cylinder, float(row["theta0_over_alpha"]) * cylinder.alpha)
        # the correction goes with alpha^2, by 0.05 at most in the columns of the table
        budget = half_unit(row["linear"]) + 0.1 * slenderness**2
        assert quarter == pytest.approx(float(row["linear"]), rel=0, abs=budget)
