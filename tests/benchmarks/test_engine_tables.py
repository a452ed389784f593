"""The commands that print the evidence for the engines: their functions on small problems."""

from __future__ import annotations

import numpy as np
import pytest

from benchmarks import convergence, engine_settings
from rockwobble.models import Case, Cylinder, InitialState

PIER = Cylinder(semidiagonal=6.0, tan_alpha=0.2)
RELEASE = InitialState(0.8 * PIER.alpha, rolling_rate=0.5)
# slopes of first and second order are told apart; a quarter of a second is too short for a sharper one
SLOPE = 0.3


def test_the_order_is_a_slope() -> None:
    steps = [4.0, 2.0, 1.0]
    assert convergence.order(steps, [48.0, 12.0, 3.0]) == pytest.approx(2.0)
    assert convergence.order(steps, [1.0, np.nan, 0.25]) == pytest.approx(1.0)
    assert np.isnan(convergence.order(steps, [np.nan, np.nan, 1.0]))


def test_a_convergence_row() -> None:
    case = Case(PIER, initial=RELEASE, duration=1.0, name="short")
    table = convergence.convergence([case], engines=["mujoco"], steps=(8e-4, 4e-4, 2e-4), workers=1)
    assert list(table["support"]) == ["recess", "flat"]
    assert (table["error_3"] < table["error_1"]).all()
    # 3e-6 alpha over 8 s at the default step, first order
    assert (table["error_3"] < 1e-5).all()
    assert table["order"].to_numpy() == pytest.approx(np.ones(2), abs=SLOPE)


def test_variants_differ_from_the_default_in_one_setting() -> None:
    found = engine_settings.variants(["mujoco"])
    assert found[0].run("flat", 1e-4, 1.0).settings == {}
    for variant in found[1:]:
        assert 1 <= len(variant.run("recess", 1e-4, 1.0).settings) <= 2
    names = [(variant.engine, variant.what) for variant in found]
    assert len(set(names)) == len(names)


def test_settings_are_measured_on_a_record_that_is_turned() -> None:
    one, three = engine_settings.cases(), engine_settings.cases(3)
    assert [case.motion is None for case in one] == [False] * 2 + [True] * 3
    assert [case.motion is None for case in three] == [False] * 6 + [True] * 3
    assert {case.name for case in one} < {case.name for case in three}
    peaks = [case.motion.acceleration[:, 0].max() for case in three[:3] if case.motion is not None]
    assert len(set(peaks)) == 3
