"""Records whose unit cannot be right."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from rockwobble.models import GroundMotion, el_centro_1940, read_record
from rockwobble.models.records.plausibility import LARGEST_PEAK
from rockwobble.models.records.units import doubts, doubts_of

RECORD = el_centro_1940()
G = 9.81  # [m/s^2]


def times(x: float, y: float) -> GroundMotion:
    return GroundMotion(RECORD.acceleration * [x, y], RECORD.time_step, "made")


# numbers in a unit, read as another: by how much too large that is
@pytest.mark.parametrize(
    ("read_as", "factor", "unit"),
    [("g for cm/s2", 981.0, "cm/s2"), ("m/s2 for cm/s2", 100.0, "cm/s2"), ("g for m/s2", 9.81 * 2.0, "m/s2")],
)
def test_a_peak_beyond_all_records_names_the_unit(read_as: str, factor: float, unit: str) -> None:
    (fact,) = doubts(times(factor, factor))
    assert (fact.code, fact.detail, fact.bound) == ("large_peak", unit, LARGEST_PEAK), read_as
    assert fact.size == pytest.approx(factor * RECORD.peak / G, rel=1e-12)


@pytest.mark.parametrize(("x", "y", "axis"), [(1.0, 100.0, "y"), (9.81, 0.01 * 9.81, "x"), (0.01, 1.0, "y")])
def test_components_in_two_units_are_told(x: float, y: float, axis: str) -> None:
    fact = doubts(times(x, y))[-1]
    peaks = np.abs(times(x, y).acceleration).max(axis=0)
    assert (fact.code, fact.detail) == ("unlike_components", axis)
    assert fact.size == pytest.approx(peaks.max() / peaks.min(), rel=1e-12)


def test_what_records_are_is_plausible() -> None:
    strong = RECORD.scaled(0.99 * LARGEST_PEAK * G / RECORD.peak)
    planar = times(1.0, 0.0)
    for motion in (RECORD, el_centro_1940(vertical=True), strong, planar, times(1.0, 0.03)):
        assert doubts(motion) == ()
    # turned by a degree, or by rounding, a planar motion stays one
    for angle in (0.01, 0.5 * np.pi):
        assert doubts(planar.rotated(angle)) == ()


def test_doubts_of_one_record_are_said_once() -> None:
    found = doubts_of([times(981.0, 981.0), None, times(2000.0, 2000.0), RECORD])
    assert [(doubt["record"], doubt["code"]) for doubt in found] == [("made", "large_peak")]


@pytest.mark.parametrize("degrees", [-450.0, 405.0, 1e4])
def test_degrees_beyond_a_full_turn_are_the_same_rotation(degrees: float, tmp_path: Path) -> None:
    path = tmp_path / "record.csv"
    times = np.arange(50) * 0.01
    np.savetxt(path, np.column_stack([times, np.sin(9.0 * times), np.cos(7.0 * times)]), delimiter=",",
        header="time [s],x [m/s2],y [m/s2]", comments="")  # fmt: skip
    beyond, within = (read_record(path, rotate=angle) for angle in (degrees, degrees % 360.0))
    assert np.allclose(beyond.acceleration, within.acceleration, atol=1e-9)  # rounding of the angle
