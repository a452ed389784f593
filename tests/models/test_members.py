"""Copies of a case: the perturbed inputs and their size, with the others unchanged."""

from __future__ import annotations

import dataclasses
from typing import Any

import numpy as np
import pytest

from rockwobble.models import Case, Cylinder, GroundMotion, InitialState, perturbed_copies
from rockwobble.models.members import perturbed_in_gravity, perturbed_in_strength

PIER = Cylinder(semidiagonal=6.0, tan_alpha=0.2)
MOTION = GroundMotion(np.random.default_rng(1).normal(size=(30, 3)), 0.01, "noise")
RELEASE = InitialState(0.1, tilt_rate=0.3, rolling_angle=0.7, rolling_rate=0.5)
AT_REST = InitialState(0.0, rolling_angle=0.7)
STARTS = {
    "release": {"initial": RELEASE, "duration": 2.0},
    "shaken release": {"initial": RELEASE, "motion": MOTION},
    "shaken": {"motion": MOTION},
    "shaken from a stated rest": {"motion": MOTION, "initial": AT_REST},
}


def changed(case: Case, copy: Case) -> dict[str, Any]:
    """Factors of all numbers of a start, of a motion and of gravity that differ."""
    factors: dict[str, Any] = {}
    if case.initial is not None and copy.initial is not None:
        for name, value in dataclasses.asdict(case.initial).items():
            if getattr(copy.initial, name) != value:
                factors[name] = getattr(copy.initial, name) / value
    if case.motion is not None and copy.motion is not None:
        parts = copy.motion.acceleration / case.motion.acceleration
        assert np.ptp(parts, axis=0) == pytest.approx([0.0, 0.0, 0.0], abs=1e-12)
        factors |= {axis: part for axis, part in zip("xyz", parts[0].tolist(), strict=True) if part != 1.0}
    if copy.gravity != case.gravity:
        factors["gravity"] = copy.gravity / case.gravity
    assert (copy.cylinder, copy.duration, copy.friction) == (case.cylinder, case.duration, case.friction)
    return factors


@pytest.mark.parametrize("start", STARTS)
def test_each_input_is_perturbed_independently_by_one_seed(start: str) -> None:
    """Tilt and rolling rate of a release, both horizontal components of a motion from rest."""
    case = Case(PIER, name="a", **STARTS[start])
    due = 1.0 + 0.01 * np.random.default_rng(4).standard_normal((5, 2))
    names = ("tilt", "rolling_rate") if "release" in start else ("x", "y")
    for at, copy in enumerate(perturbed_copies(case, 5, perturbation=0.01, seed=4)):
        factors = changed(case, copy)
        assert tuple(factors) == names
        assert list(factors.values()) == pytest.approx(due[at], rel=1e-12)
        assert copy.name == f"a #{at + 1}"


@pytest.mark.parametrize("start", STARTS)
@pytest.mark.parametrize("relative", [-0.02, 0.0, 0.03])
def test_strength_scales_the_motion_or_the_tilt_of_a_release(start: str, relative: float) -> None:
    case = Case(PIER, **STARTS[start])
    names = ("tilt",) if start == "release" else ("x", "y", "z")
    due = dict.fromkeys(names if relative else (), pytest.approx(1.0 + relative, rel=1e-12))
    assert changed(case, perturbed_in_strength(case, relative)) == due
    due = {"gravity": pytest.approx(1.0 + relative, rel=1e-12)} if relative else {}
    assert changed(case, perturbed_in_gravity(case, relative)) == due


def test_a_number_of_copies_or_a_size_out_of_range_is_refused() -> None:
    case = Case(PIER, MOTION)
    assert len(perturbed_copies(case, 2, perturbation=0.1, seed=1)) == 2
    for count, size, words in (
        (1, 0.01, "count must be a whole number, at least 2, got 1"),
        (2, 0.0, "perturbation must be above 0 and at most 0.1, got 0.0"),
        (2, 0.1001, "perturbation must be above 0 and at most 0.1, got 0.1001"),
    ):
        with pytest.raises(ValueError, match=f"^{words}$"):
            perturbed_copies(case, count, perturbation=size, seed=1)
    with pytest.raises(ValueError, match="a perturbed copy needs a release or a ground motion"):
        perturbed_copies(Case(PIER, initial=AT_REST, duration=1.0), 2, perturbation=0.01, seed=1)
