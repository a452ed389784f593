"""A tendon in weights and base radii, from steel, and its refusals."""

from __future__ import annotations

import math

import pytest

import rockwobble as rw
from rockwobble.compare.metrics.pair import balance_of, beyond_yield
from rockwobble.models import Tendon


def test_steel_in_newtons_and_metres_is_the_same_tendon() -> None:
    pier = rw.Cylinder.from_dimensions(base_radius=0.8, height=9.0)
    tendon = Tendon.from_steel(
        prestress=300e3, axial_rigidity=200e9 * 1.5e-4, length=11.0, column_mass=45e3, base_radius=0.8,
        yield_force=600e3,
    )  # fmt: skip
    tilt = 0.1
    stretch = 2.0 * 0.8 * math.sin(0.5 * tilt)
    force = 300e3 + 200e9 * 1.5e-4 / 11.0 * stretch
    assert tendon.tension(pier, tilt) * 45e3 * 9.81 == pytest.approx(force, rel=1e-14)
    assert tendon.yield_force == pytest.approx(600e3 / (45e3 * 9.81))


def test_a_tendon_under_a_slab_crosses_two_gaps() -> None:
    pier = rw.Cylinder(semidiagonal=6.0, tan_alpha=0.2)
    tendon = Tendon(prestress=0.5, stiffness=3.0)
    frame = rw.WobblingFrame(pier, 2.0)
    assert (tendon.gaps(pier), tendon.gaps(frame)) == (1, 2)
    assert tendon.tension(frame, 0.2) - 0.5 == pytest.approx(2.0 * (tendon.tension(pier, 0.2) - 0.5))
    assert tendon.initial_stiffness(pier) == pytest.approx(3.0 - 5.0)
    assert tendon.initial_stiffness(frame) == pytest.approx(12.0 - 25.0)
    assert tendon.uplift_factor(frame) == pytest.approx(1.0 + 2.0 * 0.5 / 5.0)


@pytest.mark.parametrize("slab", [0.0, 2.0])
def test_tension_at_the_yield_tilt_is_the_yield_force(slab: float) -> None:
    body = rw.WobblingFrame(rw.Cylinder(semidiagonal=6.0, tan_alpha=0.2), slab)
    tilt = Tendon(prestress=0.5, stiffness=3.0, yield_force=1.7).yield_tilt(body)
    assert Tendon(prestress=0.5, stiffness=3.0).tension(body, tilt) == pytest.approx(1.7, rel=1e-14)
    for tendon in (Tendon(prestress=0.5, yield_force=0.6), Tendon(stiffness=0.1, yield_force=2.0), Tendon()):
        assert math.isinf(tendon.yield_tilt(body))  # not below 90 degrees


def test_a_run_beyond_yield_answers_only_if_its_balance_comes_first() -> None:
    pier = rw.Cylinder(semidiagonal=6.0, tan_alpha=0.2)
    for force in (0.6, 1.2):
        tendon = Tendon(prestress=0.5, stiffness=1.0, yield_force=force)
        case = rw.Case(pier, duration=1.0, tendon=tendon)
        limit, balance = tendon.yield_tilt(pier), balance_of(case)
        peaks = [0.9 * limit, 1.1 * limit, 0.5 * math.pi, math.nan]
        assert beyond_yield(peaks, case).tolist() == [False, True, limit < balance, False]
    assert not beyond_yield([1.5], rw.Case(pier, duration=1.0, tendon=Tendon(stiffness=1.0))).any()


@pytest.mark.parametrize(
    ("options", "words"),
    [
        ({"prestress": -0.1}, "prestress of a tendon must not be negative, got -0.1"),
        ({"stiffness": -1.0}, "stiffness of a tendon must not be negative"),
        ({"prestress": math.nan}, "prestress"),
        ({"prestress": 1.0, "yield_force": 1.0}, "above the prestress, 1 weights, got 1"),
        ({"yield_force": 0.0}, "yield_force"),
        ({"stiffness": "much"}, "stiffness"),
    ],
)
def test_an_invalid_tendon_is_refused(options: dict[str, object], words: str) -> None:
    with pytest.raises(ValueError, match=words):
        Tendon(**options)  # type: ignore[arg-type]


def test_a_case_refuses_anything_but_a_tendon() -> None:
    pier = rw.Cylinder(semidiagonal=6.0, tan_alpha=0.2)
    with pytest.raises(ValueError, match="tendon"):
        rw.Case(pier, rw.el_centro_1940(), tendon=0.5)  # type: ignore[arg-type]
