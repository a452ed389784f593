"""Engines by the checks of any engine: installed engines pass, and each fault is detected."""

from __future__ import annotations

import dataclasses
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from declared_engines import Install, installer
from faulty_subjects import answered, field

from rockwobble.compare.check import GROUPS, Subject, agreement, engine, invariance, lagrange, laws
from rockwobble.models import Trace
from rockwobble.multibody import available_engines
from rockwobble.multibody.engines.registry import engine_facts, standard_engines

SLOW = 1e-4  # [s] of a step
# one run of a case serves every test of this file
ENGINES = {name: engine(name) for name in available_engines()}


# checks that every engine must pass, from the groups that are skipped for a slow engine
CONTRACT = tuple(
    each
    for group in ("rest", "invariance")
    for each in GROUPS[group]
    if each.measure in (laws.stands, laws.falls, invariance.frame)
)
ASKED = {**GROUPS, "contract": CONTRACT}


def asked_of(name: str) -> tuple[str, ...]:
    """Groups for an engine here: a step of some engines takes ten times as long as one of others."""
    if name in standard_engines():
        return tuple(group for group in GROUPS if group not in ("equations", "baseline"))
    quick = engine_facts(name).step_time < SLOW
    return (
        ("exact", "rest", "invariance", "protocol", "agreement")
        if quick
        else ("exact", "protocol", "agreement", "contract")
    )


@pytest.mark.slow
@pytest.mark.parametrize(
    ("name", "group"), [(name, group) for name in available_engines() for group in asked_of(name)]
)
def test_an_installed_engine_passes_checks(name: str, group: str, monkeypatch: pytest.MonkeyPatch) -> None:
    # 72 deg apart, near to midway between the corners of a polygon of 4, 8 or 12 of them; all directions are
    # tried by `tests/benchmarks version_figures`
    monkeypatch.setattr(laws, "DIRECTIONS", 5)
    monkeypatch.setattr(laws, "SLENDERNESS", (0.1, 1.0))
    subject, chosen = ENGINES[name], ASKED[group]
    if name not in standard_engines():  # its first support, and the agreement that `check` tests
        subject = dataclasses.replace(subject, supports=subject.supports[:1])
        chosen = chosen[:1] if group == "agreement" else chosen
    results = [result for each in chosen if each.applies(subject) for result in each.run(subject)]
    assert results
    assert [f"{each.name}: {each.value}, {each.note}" for each in results if each.failed] == []


@pytest.mark.slow
@pytest.mark.parametrize(
    ("fault", "measure"),
    [
        ("Backwards", agreement.fields),
        ("OneSided", invariance.frame),
        ("Heavy", laws.steady_wobble),
        ("Heavy", lagrange.free_motion),
        ("Random", invariance.repetition),
        ("Loud", invariance.repetition),
        ("Careless", invariance.description),
        ("Absolute", invariance.scale),
        ("Early", invariance.stepping),
        ("Slippery", laws.slip),
    ],
)
def test_a_fault_of_an_engine_is_detected(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, fault: str, measure: Any
) -> None:
    install: Install = installer(tmp_path, monkeypatch)
    install(faulty=f"external_engine:{fault}", sound="external_engine:Sound")
    assert [each for each in measure(engine("faulty"), "flat") if each.failed]
    assert not [each for each in measure(engine("sound"), "flat") if each.failed]


def changed(name: str, change: Any) -> Subject:
    return field(name, change)(ENGINES["mujoco"])


@pytest.mark.parametrize(
    ("measure", "name", "change"),
    [
        (agreement.fields, "tilt_rate", lambda values: 1.001 * values),
        (agreement.fields, "twist", lambda values: values + 1e-4),
        (agreement.fields, "contact_force", lambda values: values * [1.0, 1.0, 0.9]),
        (agreement.fields, "contact_point", lambda values: values + 1e-4),
        (agreement.fields, "energy", lambda values: 1.001 * values),
        (agreement.fields, "energy_error", lambda values: values + 1e-3),
        (agreement.release, "rolling_angle", lambda values: values + 1e-3),
        (agreement.ramp, "tilt", lambda values: 1.1 * values),
        (agreement.record, "tilt", lambda values: 1.01 * values),
        (laws.uplift, "uplift_time", lambda value: value + 1e-3),
        (laws.uplift, "uplift_direction", lambda value: -value),
        (laws.slip, "slip", lambda values: values + 1e-2),
        (laws.stands, "tilt", lambda values: values + 1e-4),
        (laws.falls, "outcome", lambda _: "stands"),
        (laws.falls, "time", lambda values: values[::-1]),
        (invariance.time_grid, "time", lambda values: values + 1e-6),
        (invariance.time_grid, "tilt", lambda values: 1.00001 * values),
        (invariance.time_grid, "rolling_rate", lambda values: 1.00001 * values),
    ],
)
def test_a_wrong_field_is_detected(measure: Any, name: str, change: Any) -> None:
    assert not [each for each in measure(ENGINES["mujoco"], "flat") if each.failed]
    assert [each for each in measure(changed(name, change), "flat") if each.failed]


def test_walls_that_let_the_cylinder_out_are_detected() -> None:
    wrong = changed("residual_displacement", lambda value: value + 1.0)
    assert not [each for each in agreement.ring(ENGINES["mujoco"], "ring") if each.failed]
    assert [each.cause for each in agreement.ring(wrong, "ring") if each.failed] == ["the walls let it out"]


def test_samples_at_the_nearest_step_are_detected() -> None:
    def nearest(trace: Trace) -> Trace:
        off = trace.time - np.round(trace.time / trace.time_step) * trace.time_step
        return dataclasses.replace(trace, rolling_angle=trace.rolling_angle - off * trace.rolling_rate)

    results = agreement.fields(answered(nearest)(ENGINES["mujoco"]), "flat")
    assert {each.name for each in results if each.failed} >= {"rolling_angle"}


@pytest.mark.parametrize(
    ("measure", "settings"),
    [
        (agreement.order, {"contact_damping_ratio": 0.01}),
        (laws.free_response, {"time_step": 1e-3}),
    ],
)
def test_settings_that_spoil_contact_are_detected(measure: Any, settings: dict[str, float]) -> None:
    assert [each for each in measure(engine("mujoco", **settings), "recess") if each.failed]
