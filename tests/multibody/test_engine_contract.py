"""Every engine that is installed here, by the contract that any engine can run."""

from __future__ import annotations

import tomllib
from functools import cache
from importlib.metadata import entry_points
from pathlib import Path
from typing import Any

import pytest

from rockwobble.models import Trace
from rockwobble.multibody import available_engines, engine_names
from rockwobble.multibody.contract import interface, mechanics, problem, sweep
from rockwobble.multibody.engines.registry import GROUP, find_engine
from rockwobble.multibody.testing import ContractCheck, contract_checks


@cache
def released(engine: str, support: str) -> Trace:
    return problem.run(engine, support)


def run_once(engine: str, support: str, **changes: Any) -> Trace:
    """Run as the contract does, but the release that many rules look at only once."""
    return problem.run(engine, support, **changes) if changes else released(engine, support)


@pytest.mark.parametrize(
    "check", [check for name in available_engines() for check in contract_checks(name)], ids=str
)
def test_contract(check: ContractCheck, monkeypatch: pytest.MonkeyPatch) -> None:
    # 72 deg apart, close to between the corners of any polygon of 4, 8 or 12 of them; all of the contract's
    # are tried by `tests/benchmarks version_figures`
    monkeypatch.setattr(sweep, "SWEEP_DIRECTIONS", 5)
    monkeypatch.setattr(sweep, "SWEEP_SLENDERNESS", (0.1, 1.0))
    for rules in (interface, mechanics):
        monkeypatch.setattr(rules, "run", run_once)
    check()


def test_our_engines_are_declared_as_anybody_would_declare_them() -> None:
    project = tomllib.loads((Path(__file__).parents[2] / "pyproject.toml").read_text())["project"]
    declared = project["entry-points"][GROUP]
    assert (
        tuple(declared)
        == engine_names()[: len(declared)]
        == ("mujoco", "pybullet", "dart", "drake", "exudyn", "rapier")
    )
    assert {point.name: point.value for point in entry_points(group=GROUP)} == declared
    for name in available_engines():
        assert declared[name] == f"{type(find_engine(name)).__module__}:{type(find_engine(name)).__name__}"
