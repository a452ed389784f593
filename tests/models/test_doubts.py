"""Doubts about lengths, gravity and components that are probably in another unit, or given twice."""

import numpy as np
import pytest

from rockwobble.models import Case, Cylinder, GroundMotion, Tendon
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


@pytest.mark.parametrize("factor", [1e-3, 1.0, 1e3])
def test_mass_and_tendon_in_another_unit_are_doubted(factor: float) -> None:
    pier = Cylinder.from_dimensions(base_radius=0.8, height=9.0)
    steel = Tendon(prestress=4.19 * factor, stiffness=59.4 * factor)
    doubts = doubts_of_cases([Case(pier, duration=1.0, tendon=steel)], 45.0 * factor)
    expected = [] if factor == 1.0 else ["unlikely_mass", "unlikely_tendon"]
    assert [each["code"] for each in doubts] == expected


def test_one_component_given_twice_is_doubted() -> None:
    pier = Cylinder(semidiagonal=6.0, tan_alpha=0.2)
    assert codes(pier, motion=GroundMotion([[0, 0], [1, 1]], 0.1)) == [("same_components", "x and y")]
    assert codes(pier, motion=GroundMotion([[0, 0], [1, 0.9]], 0.1)) == []


LENGTHS = {"mm": 1e-3, "cm": 1e-2, "in": 0.0254, "ft": 0.3048, "km": 1e3}
GRAVITIES = {"ft/s2": 0.3048, "in/s2": 0.0254, "cm/s2": 1e-2, "mm/s2": 1e-3}


def likely(number: float, units: dict[str, float], usual: float) -> str:
    """Return the unit in which a number is nearest to a usual one, by their ratio."""
    return min(units, key=lambda unit: max(number * units[unit] / usual, usual / (number * units[unit])))


def test_a_doubtful_length_is_stated_with_its_limit() -> None:
    """Of any body: the height of its outline first, then its diameter; 1 mm to 300 m are usual."""
    chance = np.random.default_rng(2)
    seen = set()
    for height, slenderness, centre in zip(
        10.0 ** chance.uniform(-4.5, 4.5, 300),
        10.0 ** chance.uniform(-1.5, 1.5, 300),
        chance.uniform(0.2, 0.9, 300),
        strict=True,
    ):
        radius = height * slenderness
        body = Cylinder.from_dimensions(base_radius=radius, height=height, mass_centre_height=centre * height)
        found = [each for each in doubts_of_cases([Case(body, duration=1.0)]) if each["record"] == "cylinder"]
        beyond = [length for length in (height, 2.0 * radius) if not 1e-3 <= length <= 300.0]
        assert len(found) == bool(beyond)
        for each, length in zip(found, beyond, strict=False):
            assert each["size"] == pytest.approx(length, rel=1e-12)
            assert each["bound"] == (300.0 if length > 1.0 else 1e-3)
            assert each["detail"] == likely(length, LENGTHS, 8.0)
            seen.add((length == height, length > 1.0, each["detail"]))
    assert len(seen) >= 6  # heights and diameters, below and above, in several units


def test_the_doubt_about_a_gravity_states_it_and_its_limit() -> None:
    pier = Cylinder(semidiagonal=6.0, tan_alpha=0.2)
    for gravity in 10.0 ** np.random.default_rng(3).uniform(-1.0, 5.0, 100):
        found = doubts_of_cases([Case(pier, duration=1.0, gravity=gravity)])
        assert len(found) == (gravity > 25.0)
        for each in found:
            assert (each["record"], each["size"], each["bound"]) == ("gravity", gravity, 25.0)
            assert each["detail"] == likely(gravity, GRAVITIES, 9.81)


@pytest.mark.parametrize(("one", "other", "columns"), [(0, 1, 2), (0, 1, 3), (0, 2, 3), (1, 2, 3)])
def test_equal_components_are_named(one: int, other: int, columns: int) -> None:
    pier = Cylinder(semidiagonal=6.0, tan_alpha=0.2)
    samples = np.random.default_rng(4).uniform(-1.0, 1.0, (60, columns))
    samples[:, other] = samples[:, one]
    assert codes(pier, motion=GroundMotion(samples, 0.1)) == [
        ("same_components", f"{'xyz'[one]} and {'xyz'[other]}")
    ]
    samples[37, other] += 1e-9
    assert codes(pier, motion=GroundMotion(samples, 0.1)) == []
    samples[:, [one, other]] = 0.0  # as of a motion along the third
    assert codes(pier, motion=GroundMotion(samples, 0.1)) == []
