"""The layer traces holds, and finds traces of engines that are wrong in one field."""

from __future__ import annotations

import dataclasses
import importlib.util
from typing import Any

import numpy as np
import pytest

from rockwobble import reduced
from rockwobble.compare.check import Bench, bench, run_checks
from rockwobble.compare.check.engines import traces
from rockwobble.compare.check.finding import NOT_RUN, PASSED
from rockwobble.compare.runs.execution import simulate_run
from rockwobble.compare.storage.fingerprint import fingerprint
from rockwobble.models import Case, GroundMotion, Run, Trace, read_suite
from rockwobble.models.traces.trace_source import Known
from rockwobble.multibody import available_engines
from rockwobble.multibody.engines.registry import engine_packages, standard_engines

KEPT: dict[str, Trace] = {}
TRACES: dict[str, Trace] = {}  # made once, and given to every test with another fault in them


def made() -> Bench:
    return Bench(reduced=reduced, suite=read_suite("quick"), workers=1, kept=KEPT)


def once(case: Case, run: Run, **options: Any) -> Trace:
    key = fingerprint([case, run, options])
    if key not in TRACES:
        TRACES[key] = simulate_run(case, run, **options)
    return TRACES[key]


def failed(monkeypatch: pytest.MonkeyPatch) -> list[str]:
    monkeypatch.setattr(bench, "ENGINES", ("mujoco",))
    return [finding.part for finding in traces.check(made()) if finding.failed]


@pytest.mark.parametrize("engine", ["mujoco", "pybullet"])
def test_traces_of_an_engine_hold(monkeypatch: pytest.MonkeyPatch, engine: str) -> None:
    if engine not in available_engines():
        pytest.skip(f"{engine} has no wheel for this Python")
    monkeypatch.setattr(bench, "ENGINES", (engine,))
    monkeypatch.setattr(traces, "simulate_run", once)
    findings = list(traces.check(made()))
    assert len(findings) == 36
    assert not [f"{f.name}: {f.value}" for f in findings if f.failed]


@pytest.mark.parametrize("share", [1.0, 1.001])
def test_an_engine_that_not_every_installation_has_is_held_too(
    monkeypatch: pytest.MonkeyPatch, share: float
) -> None:
    pytest.importorskip("exudyn")

    def run(case: Case, run: Run, **options: Any) -> Trace:
        trace = once(case, run, **options)
        return dataclasses.replace(trace, tilt_rate=share * trace.tilt_rate)

    monkeypatch.setattr(traces, "simulate_run", run)
    monkeypatch.setattr(traces, "engines_here", lambda among: ())
    monkeypatch.setattr(bench, "own_engines", lambda: (*standard_engines(), "exudyn"))
    found = [f for f in traces.check(made()) if f.outcome != NOT_RUN]
    assert len(found) == 13
    assert [f.part for f in found if f.failed] == ["tilt_rate of a trace of exudyn"] * (share != 1.0)
    # a certificate of one engine has claims of no other
    assert not list(traces.check(dataclasses.replace(made(), engines=())))


def test_an_engine_that_is_not_installed_is_said(monkeypatch: pytest.MonkeyPatch) -> None:
    packages, find = (*engine_packages().values(), "pydrake"), importlib.util.find_spec
    monkeypatch.setattr(importlib.util, "find_spec", lambda name: None if name in packages else find(name))
    found = list(run_checks(made(), ["traces"]))
    *missing, geometry = found
    assert [(f.outcome, f.part) for f in missing] == [(NOT_RUN, name) for name in standard_engines()]
    assert (geometry.outcome, geometry.part) == (PASSED, "geometry of a ring")
    assert found[1].note.startswith(f"{standard_engines()[1]} is not installed here: pip install")


@pytest.mark.parametrize(
    ("field", "change"),
    [
        ("tilt_rate", lambda values: 1.001 * values),
        ("twist", lambda values: values + 1e-4),
        ("contact_force", lambda values: values * [1.0, 1.0, 0.9]),
        ("contact_point", lambda values: values + 1e-4),
        ("energy", lambda values: 1.001 * values),
        ("energy_error", lambda values: values + 1e-3),
        ("slip", lambda values: values + 1e-3),
        ("residual_displacement", lambda value: value + 1e-3),
        ("twist", lambda values: values + 1e-3 * (np.arange(len(values)) == len(values) - 1)),
        ("uplift_time", lambda value: value + 1e-4),
        ("uplift_direction", lambda value: -value),
    ],
)
def test_a_wrong_field_is_found(monkeypatch: pytest.MonkeyPatch, field: str, change: Any) -> None:
    def wrong(case: Case, run: Run, **options: Any) -> Trace:
        trace = once(case, run, **options)
        value = change(getattr(trace, field))
        if field in trace.late:
            return dataclasses.replace(trace, source=Known({**trace.late, field: value}))
        return dataclasses.replace(trace, **{field: value})

    monkeypatch.setattr(traces, "simulate_run", wrong)
    assert any(field.replace("_", " ").split()[0] in part.replace("_", " ") for part in failed(monkeypatch))


@pytest.mark.parametrize("sign", [0.0, -1.0])
def test_a_wrong_vertical_component_is_found(monkeypatch: pytest.MonkeyPatch, sign: float) -> None:
    def wrong(case: Case, run: Run, **options: Any) -> Trace:
        motion = case.motion
        if motion is not None and motion.has_vertical:
            motion = GroundMotion(motion.acceleration * [1.0, 1.0, sign], motion.time_step)
        return once(dataclasses.replace(case, motion=motion), run, **options)

    monkeypatch.setattr(traces, "simulate_run", wrong)
    parts = failed(monkeypatch)
    assert "uplift of a trace of mujoco, or its vertical component" in parts
    assert "tilt of a trace of mujoco" in parts


def test_samples_at_the_nearest_step_are_found(monkeypatch: pytest.MonkeyPatch) -> None:
    def nearest(case: Case, run: Run, **options: Any) -> Trace:
        trace = once(case, run, **options)
        off = trace.time - np.round(trace.time / trace.time_step) * trace.time_step
        return dataclasses.replace(trace, rolling_angle=trace.rolling_angle - off * trace.rolling_rate)

    monkeypatch.setattr(traces, "simulate_run", nearest)
    assert "rolling_angle of a trace of mujoco" in failed(monkeypatch)
