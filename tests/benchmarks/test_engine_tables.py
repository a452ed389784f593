"""The commands that print the evidence for the engines: their functions on small problems."""

from __future__ import annotations

import dataclasses

import numpy as np
import pytest

from benchmarks import convergence, engine_settings
from rockwobble.models import Case, Cylinder, InitialState, el_centro_1940
from rockwobble.multibody import available_engines
from rockwobble.multibody.engines.registry import find_engine

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


def test_values_belong_to_engine_settings_and_include_the_default() -> None:
    for engine, values in engine_settings.SETTINGS.items():
        if engine in available_engines():
            kind = getattr(find_engine(engine), "settings_type")  # noqa: B009  # of an engine of this package
            defaults = {field.name: field.default for field in dataclasses.fields(kind)}
            assert {*values} <= {*defaults}
            for name in {*values} - {*engine_settings.SCALED}:
                assert defaults[name] in values[name], name


def test_settings_are_judged_by_exact_solutions_that_a_damped_slip_misses(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    monkeypatch.setattr(engine_settings, "STEP", 4e-4)
    monkeypatch.setitem(engine_settings.SETTINGS, "mujoco", {"friction_damping": (1.0, 1.8)})
    monkeypatch.setattr(
        engine_settings, "SOLUTIONS", {"free": engine_settings.free, "wobble": engine_settings.wobble}
    )
    default, damped, marked = engine_settings.settings_table("mujoco")
    for solution in ("free", "wobble"):
        assert marked[solution] == f"{default[solution]} *"
        assert float(damped[solution]) > 2.0 * float(default[solution])
    # of first order in the step, 3e-5 and 5e-7 at the default
    assert float(default["free"]) < 3e-4
    assert float(default["wobble"]) < 5e-6


def test_a_base_on_points_uplifts_as_one_that_is_followed(monkeypatch: pytest.MonkeyPatch) -> None:
    for name, value in {"BODIES": ((6.0, 0.2),), "POINTS": (16,), "LENGTH": 2.5, "EARLY": 0.3}.items():
        monkeypatch.setattr(engine_settings, name, value)
    monkeypatch.setattr(engine_settings, "motions_of", lambda _: [el_centro_1940().scaled(2.0)])
    rows = list(engine_settings.uplift_table())
    assert [(row["support"], row["base"]) for row in rows] == [
        (support, base) for support in ("recess", "flat") for base in ("follows", "16 points")
    ]
    for row in rows:
        assert row["uplift"] < 0.1  # one step
        assert row["direction"] < 0.1
        assert row["tilt"] < 1e-3
