"""Baselines: kept numbers, changed only with a reason, and versions that have none."""

from __future__ import annotations

import dataclasses
import json
from collections.abc import Sequence

import numpy as np
import pytest

from rockwobble import reduced
from rockwobble.compare.check import FAILED, NO_BASELINE, PASSED, Bench, baseline_file
from rockwobble.compare.check.baseline_file import Baseline, changes, read_baseline, updated
from rockwobble.compare.check.engines import engine_baseline
from rockwobble.compare.check.measures.made_traces import made
from rockwobble.compare.check.models import reduced_baseline as kept_numbers
from rockwobble.compare.runs.execution import Job
from rockwobble.models import Suite, Trace, read_suite

SUITE = read_suite("quick")
ONE = Suite(SUITE.cases[:1], SUITE.runs[:1])


def bench_with(shift: float, version: str) -> Bench:
    """A bench whose engine gives the tilts of the baseline of MuJoCo, plus `shift` alpha."""
    case, run = ONE.cases[0], ONE.runs[0]
    kept = next(
        values for name, values in read_baseline("engines").values.items() if name.startswith("mujoco")
    )
    label = f"{run.engine} {run.support}"
    times = case.length * np.arange(1, engine_baseline.INSTANTS + 1) / engine_baseline.INSTANTS
    tilts = [kept[f"{case.name}, {label}: tilt at {time:g} s [alpha]"] for time in times]
    tilt = (np.array(tilts) + shift) * case.cylinder.alpha
    trace = made(times, tilt, case=case, run=run, version=version)

    class Made(Bench):
        def traces(self, jobs: Sequence[Job]) -> list[Trace]:
            return [trace]

    return Made(reduced=reduced, suite=ONE)


def known_version() -> str:
    return next(name.split()[1] for name in read_baseline("engines").values if name.startswith("mujoco"))


@pytest.mark.parametrize(("shift", "outcome"), [(0.0, PASSED), (1e-8, PASSED), (1e-6, FAILED)])
def test_a_known_version_is_held_against_its_numbers(shift: float, outcome: str) -> None:
    (finding,) = engine_baseline.check(bench_with(shift, known_version()))
    assert finding.outcome == outcome


@pytest.mark.parametrize(("shift", "verdict"), [(1e-7, "passed"), (1e-3, "FAILED")])
def test_an_unknown_version_is_no_failure_but_said(shift: float, verdict: str) -> None:
    (finding,) = engine_baseline.check(bench_with(shift, "99.0"))
    assert finding.outcome == NO_BASELINE
    assert finding.note == (
        f"no baseline for mujoco 99.0; held against mujoco {known_version()} with loose bounds: {verdict}"
    )


def test_the_reduced_models_give_the_numbers_that_are_kept() -> None:
    findings = list(kept_numbers.check(Bench(reduced=reduced, suite=SUITE)))
    assert len(findings) == 8
    assert not [finding for finding in findings if finding.failed]


def test_a_number_that_moved_fails_and_is_shown(monkeypatch: pytest.MonkeyPatch) -> None:
    old = read_baseline("reduced")
    values = {group: {**numbers} for group, numbers in old.values.items()}
    name = "recess, El Centro doubled: tilt at 5 s [alpha]"
    values[kept_numbers.GROUP][name] += 1e-7
    monkeypatch.setattr(kept_numbers, "read_baseline", lambda _: Baseline(values=values))
    failed = [f for f in kept_numbers.check(Bench(reduced=reduced, suite=SUITE)) if f.failed]
    assert [f.name for f in failed] == ["recess, El Centro doubled"]
    assert "tilt at 5 s" in failed[0].note
    assert failed[0].note.endswith(f", the baseline is {values[kept_numbers.GROUP][name]!r}")
    assert failed[0].part == "the recess model gives other numbers than it did"


def test_an_update_keeps_the_reason_and_the_other_groups() -> None:
    old = Baseline(values={"a 1": {"x": 1.0}, "b 1": {"y": 2.0}}, reasons=({"reason": "first"},))
    new = {"a 1": {"x": 1.5, "z": 3.0}}
    assert changes(old, new) == [("a 1", "x", 1.0, 1.5), ("a 1", "z", None, 3.0)]
    found = json.loads(
        updated(old, new, reason=" a  new kernel ", date="2026-11-21", versions={"numpy": "2"})
    )
    assert found["values"] == {"a 1": {"x": 1.5, "z": 3.0}, "b 1": {"y": 2.0}}
    assert [entry["reason"] for entry in found["reasons"]] == ["first", "a new kernel"]
    with pytest.raises(ValueError, match="a reason must be given"):
        updated(old, new, reason="  ", date="", versions={})


@pytest.mark.parametrize("name", ["reduced", "engines"])
def test_every_baseline_that_ships_says_why(name: str) -> None:
    kept = read_baseline(name)
    assert kept.values
    assert all(entry["reason"] and entry["date"] and entry["versions"] for entry in kept.reasons)
    assert baseline_file.folder().is_dir()


def test_no_bound_holds_for_a_value_that_is_no_number() -> None:
    bench = bench_with(np.nan, known_version())
    (finding,) = engine_baseline.check(bench)
    assert finding.outcome == FAILED
    assert dataclasses.replace(finding, outcome=PASSED).failed is False
