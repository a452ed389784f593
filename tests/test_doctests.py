"""The examples of all docstrings run; by module name, because the folders are installed under another."""

from __future__ import annotations

import doctest
import importlib
import pkgutil

import pytest

import rockwobble

FOLDERS = ["models", "reduced", "multibody", "compare", "studies", "reports"]


def examples(folder: str) -> list[doctest.DocTest]:
    found = pkgutil.walk_packages(rockwobble.__path__, "rockwobble.")
    names = [module.name for module in found if f"{module.name}.".startswith(f"rockwobble.{folder}.")]
    assert names
    finder = doctest.DocTestFinder()
    return [test for name in names for test in finder.find(importlib.import_module(name)) if test.examples]


@pytest.mark.slow
@pytest.mark.parametrize("folder", FOLDERS)
def test_examples_of_the_docstrings(folder: str) -> None:
    runner = doctest.DocTestRunner()
    report: list[str] = []
    for test in examples(folder):
        runner.run(test, out=report.append)
    assert runner.failures == 0, "".join(report)


def test_examples_are_found() -> None:
    found = {test.name for folder in ("models", "reduced") for test in examples(folder)}
    assert {"rockwobble.models.cylinder.Cylinder", "rockwobble.reduced.simulation.simulate"} <= found
