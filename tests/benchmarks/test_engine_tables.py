"""Commands for engine evidence: their functions on small problems."""

from __future__ import annotations

import dataclasses

import pytest

from benchmarks import engine_settings
from rockwobble.models import el_centro_1940
from rockwobble.multibody import available_engines
from rockwobble.multibody.engines.registry import find_engine


def test_values_belong_to_engine_settings_and_include_the_default() -> None:
    for engine, values in engine_settings.SETTINGS.items():
        if engine in available_engines():
            kind = getattr(find_engine(engine), "settings_type")  # noqa: B009  # of an engine of this package
            defaults = {field.name: field.default for field in dataclasses.fields(kind)}
            assert {*values} <= {*defaults}
            for name in {*values} - {*engine_settings.SCALED}:
                assert defaults[name] in values[name], name


def test_exact_solutions_reject_settings_with_damped_slip(
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


def test_base_on_fixed_contact_points_uplifts_like_followed_contact(monkeypatch: pytest.MonkeyPatch) -> None:
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
