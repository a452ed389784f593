"""Every engine that is installed here, by the contract that any engine can run."""

from __future__ import annotations

import tomllib
from importlib.metadata import entry_points
from pathlib import Path

import pytest

from rockwobble.multibody import available_engines, engine_names
from rockwobble.multibody.engines.registry import GROUP, find_engine
from rockwobble.multibody.testing import ContractCheck, contract_checks


@pytest.mark.parametrize(
    "check", [check for name in available_engines() for check in contract_checks(name)], ids=str
)
def test_contract(check: ContractCheck) -> None:
    check()


def test_our_engines_are_declared_as_anybody_would_declare_them() -> None:
    project = tomllib.loads((Path(__file__).parents[2] / "pyproject.toml").read_text())["project"]
    declared = project["entry-points"][GROUP]
    assert (
        tuple(declared)
        == engine_names()[: len(declared)]
        == ("mujoco", "pybullet", "dart", "drake", "exudyn")
    )
    assert {point.name: point.value for point in entry_points(group=GROUP)} == declared
    for name in available_engines():
        assert declared[name] == f"{type(find_engine(name)).__module__}:{type(find_engine(name)).__name__}"
