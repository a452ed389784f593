"""Doubts about lengths, gravity and components that are probably in another unit, or given twice."""

import pytest

from rockwobble.models import Case, Cylinder, GroundMotion
from rockwobble.models.doubts import doubts_of_cases


def codes(
    cylinder: Cylinder, gravity: float = 9.81, motion: GroundMotion | None = None
) -> list[tuple[str, str]]:
    """Return code and detail of the doubts about a case."""
    found = doubts_of_cases([Case(cylinder, motion, duration=1.0, gravity=gravity)])
    return [(str(each["code"]), str(each["detail"])) for each in found]


@pytest.mark.parametrize(("factor", "unit"), [(1e3, "mm"), (1e2, "cm"), (1.0 / 0.0254, "in")])
def test_a_pier_in_another_unit_is_doubted_with_that_unit(factor: float, unit: str) -> None:
    pier = Cylinder.from_dimensions(base_radius=0.8 * factor, height=9.0 * factor)
    assert codes(pier) == [("unlikely_length", unit)]


@pytest.mark.parametrize("height", [2e-3, 0.1, 9.0, 299.0])
def test_lengths_of_structures_and_models_are_not_doubted(height: float) -> None:
    assert codes(Cylinder.from_dimensions(base_radius=0.4 * height, height=height)) == []


@pytest.mark.parametrize(("gravity", "unit"), [(32.2, "ft/s2"), (386.0, "in/s2"), (981.0, "cm/s2")])
def test_a_gravity_in_another_unit_is_doubted(gravity: float, unit: str) -> None:
    assert codes(Cylinder(semidiagonal=6.0, tan_alpha=0.2), gravity) == [("unlikely_gravity", unit)]


def test_one_component_given_twice_is_doubted() -> None:
    pier = Cylinder(semidiagonal=6.0, tan_alpha=0.2)
    assert codes(pier, motion=GroundMotion([[0, 0], [1, 1]], 0.1)) == [("same_components", "x and y")]
    assert codes(pier, motion=GroundMotion([[0, 0], [1, 0.9]], 0.1)) == []
