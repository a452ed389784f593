"""The examples of all docstrings run; by module name, because the folders are installed under another."""

from __future__ import annotations

import doctest
import importlib
import pkgutil

import pytest

import rockwobble


def modules() -> list[str]:
    found = pkgutil.walk_packages(rockwobble.__path__, "rockwobble.")
    return sorted(module.name for module in found if not module.name.endswith("__main__"))


def examples(name: str) -> list[doctest.DocTest]:
    return [test for test in doctest.DocTestFinder().find(importlib.import_module(name)) if test.examples]


@pytest.mark.parametrize("name", [name for name in modules() if examples(name)])
def test_examples(name: str) -> None:
    runner = doctest.DocTestRunner()
    report: list[str] = []
    for test in examples(name):
        runner.run(test, out=report.append)
    assert runner.failures == 0, "".join(report)


def test_examples_are_found_in_the_folders() -> None:
    with_examples = {test.name for name in modules() for test in examples(name)}
    assert {"rockwobble.models.cylinder.Cylinder", "rockwobble.reduced.simulate.simulate"} <= with_examples
