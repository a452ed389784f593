"""The contract of an engine as a test that any engine can run.

In the tests of a package that declares an engine called "mine":

    import pytest
    from rockwobble.multibody.testing import ContractCheck, contract_checks

    @pytest.mark.parametrize("check", contract_checks("mine"), ids=str)
    def test_contract(check: ContractCheck) -> None:
        check()

or all at once, `check_engine("mine")`. It takes some seconds for each support.
"""

from __future__ import annotations

import os
import subprocess
import sys
import tempfile
from collections.abc import Iterable
from dataclasses import dataclass
from pathlib import Path

from .contract.interface import GENERAL, Check
from .contract.mechanics import FLAT
from .contract.sweep import uplifts_in_every_direction
from .engines.registry import find_engine


@dataclass(frozen=True, slots=True)
class ContractCheck:
    """One rule of the contract for one engine with one support; calling it raises an AssertionError."""

    engine: str
    support: str
    rule: Check

    def __call__(self) -> None:
        """Run the check."""
        self.rule(self.engine, self.support)

    def __str__(self) -> str:
        return f"{self.engine} {self.support} {self.rule.__name__}"


def contract_checks(engine: str) -> tuple[ContractCheck, ...]:
    """Return every check for an engine, with each support that it has.

    Raises
    ------
    ValueError
        If there is no such engine, or it does not load.
    """
    supports = find_engine(engine).supports
    rules = {support: (*GENERAL, *(FLAT if support in ("recess", "flat") else ())) for support in supports}
    checks = (ContractCheck(engine, support, rule) for support in supports for rule in rules[support])
    # a new process takes as long as all the rest, and what an engine prints does not depend on the support;
    # nor does what it stands on
    once = (leaves_no_trace, *((uplifts_in_every_direction,) if find_engine(engine).uplifts else ()))
    return (*checks, *(ContractCheck(engine, supports[0], rule) for rule in once))


def check_engine(engine: str, checks: Iterable[ContractCheck] | None = None) -> None:
    """Run all checks of an engine, or those given.

    Raises
    ------
    AssertionError
        With one line for each rule that does not hold.
    ValueError
        If there is no such engine, or it does not load.
    """
    broken = []
    for check in contract_checks(engine) if checks is None else checks:
        try:
            check()
        except AssertionError as error:
            broken.append(f"{check}: {error}")
        # an engine that raises breaks the contract too, and the other rules are still worth a look
        except Exception as error:
            broken.append(f"{check}: {type(error).__name__}: {error}")
    if broken:
        raise AssertionError("\n".join(broken))


def leaves_no_trace(engine: str, support: str) -> None:
    """Nothing is printed, and nothing written where the user works."""
    code = (
        f"from rockwobble.multibody.contract.problem import run; run({engine!r}, {support!r}, duration=0.01)"
    )
    environment = {**os.environ, "PYTHONPATH": os.pathsep.join(path for path in sys.path if path)}
    with tempfile.TemporaryDirectory() as folder:
        shown = subprocess.run(
            [sys.executable, "-c", code],
            cwd=folder,
            env=environment,
            stdout=subprocess.PIPE,
            stderr=subprocess.STDOUT,
            text=True,
            check=False,
        )
        left = sorted(path.name for path in Path(folder).iterdir())
    if shown.returncode or shown.stdout or left:
        raise AssertionError(f"it printed {shown.stdout[-500:]!r} and left the files {left}")
