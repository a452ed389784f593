from __future__ import annotations

import dataclasses
import math
import pickle

import pytest

from rockwobble.models import Cylinder

ROUNDING = 1e-15  # a handful of operations, each half an ulp


def test_size_and_slenderness_locate_the_mass_centre() -> None:
    cylinder = Cylinder(semidiagonal=5.0, tan_alpha=0.75)
    assert cylinder.base_radius == pytest.approx(3.0, rel=ROUNDING)
    assert cylinder.half_height == pytest.approx(4.0, rel=ROUNDING)
    assert cylinder.mass_centre_height == pytest.approx(4.0, rel=ROUNDING)
    assert cylinder.alpha == pytest.approx(math.asin(0.6), rel=ROUNDING)


@pytest.mark.parametrize("tan_alpha", [1e-200, 0.2, 4.0 / 3.0, 1e200])
def test_dimensions_survive_the_round_trip_at_any_slenderness(tan_alpha: float) -> None:
    cylinder = Cylinder(semidiagonal=6.0, tan_alpha=tan_alpha)
    again = Cylinder.from_dimensions(base_radius=cylinder.base_radius, height=2.0 * cylinder.half_height)
    assert again.semidiagonal == pytest.approx(6.0, rel=ROUNDING)
    assert again.tan_alpha == pytest.approx(tan_alpha, rel=ROUNDING)


def test_one_of_base_radius_and_diameter_is_given() -> None:
    cylinder = Cylinder.from_dimensions(diameter=6.0, height=8.0)
    assert cylinder == Cylinder.from_dimensions(base_radius=3.0, height=8.0)
    assert (cylinder.semidiagonal, cylinder.tan_alpha) == (5.0, 0.75)
    for sizes, number in ({}, "neither"), ({"base_radius": 1.0, "diameter": 2.0}, "both"):
        with pytest.raises(ValueError, match=rf"^base_radius or diameter must be given .* got {number}$"):
            Cylinder.from_dimensions(height=9.0, **sizes)


def test_a_general_body_keeps_its_outline_apart_from_its_mass_centre() -> None:
    deck_on_pier = Cylinder.from_dimensions(
        base_radius=1.0, height=10.0, mass_centre_height=8.0, transverse_inertia=12.0, axial_inertia=2.0
    )
    assert deck_on_pier.half_height == 5.0
    assert deck_on_pier.height == 10.0
    assert deck_on_pier.mass_centre_height == pytest.approx(8.0, rel=ROUNDING)
    assert deck_on_pier.base_radius == pytest.approx(1.0, rel=ROUNDING)
    assert deck_on_pier.tan_alpha == 0.125
    assert (deck_on_pier.transverse_inertia, deck_on_pier.axial_inertia) == (12.0, 2.0)


def test_a_cylinder_is_frozen_hashable_and_pickled() -> None:
    cylinder = Cylinder(semidiagonal=6, tan_alpha=0.2)
    assert isinstance(cylinder.semidiagonal, float)
    with pytest.raises(dataclasses.FrozenInstanceError):
        cylinder.tan_alpha = 0.3  # type: ignore[misc]
    assert pickle.loads(pickle.dumps(cylinder)) == cylinder
    assert len({cylinder, Cylinder(semidiagonal=6.0, tan_alpha=0.2)}) == 1


def test_refuses_inertias_that_no_distribution_of_mass_has() -> None:
    """A given inertia is compared with the default of the other: I1 = (27 + 64)/12 = 7.58, I2 = 4.5."""
    for transverse, axial in ((1.0, 2.0), (None, 15.1), (2.3, None)):
        Cylinder(semidiagonal=5.0, tan_alpha=0.75, transverse_inertia=transverse, axial_inertia=axial)
    for transverse, axial, words in (
        *(
            (1.0, 2.01, "got 2.01 and 1 "),
            (None, 15.2, "got 15.2 and 7.58333"),
            (2.2, None, "got 4.5 and 2.2 "),
        ),
    ):
        with pytest.raises(ValueError, match=rf"^axial_inertia must not exceed twice .* {words}"):
            Cylinder(semidiagonal=5.0, tan_alpha=0.75, transverse_inertia=transverse, axial_inertia=axial)


def test_refuses_a_slenderness_that_leaves_no_base() -> None:
    with pytest.raises(ValueError, match=r"^tan_alpha must leave a base"):
        Cylinder(semidiagonal=1e-60, tan_alpha=1e-300)


@pytest.mark.parametrize("size", [1e-71, 1e71])
def test_refuses_a_size_whose_inertia_is_no_number(size: float) -> None:
    with pytest.raises(ValueError, match=r"^semidiagonal must be from 1e-70 to 1e\+70 m, got"):
        Cylinder(semidiagonal=size, tan_alpha=0.2)
