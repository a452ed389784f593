"""Registry of commands and results: complete, and without missing targets."""

from __future__ import annotations

import importlib
import inspect
from importlib.util import find_spec

import pytest

from rockwobble.compare import Results
from rockwobble.compare.check import Checks
from rockwobble.compare.check.measurement import not_run
from rockwobble.reports.registry import COMMANDS, ENTRIES, HEADINGS, KINDS


@pytest.mark.parametrize("kind", KINDS)
def test_each_kind_has_a_results_class_and_a_page(kind: str) -> None:
    made = KINDS[kind].results_class()
    assert made.kind == kind
    name = f"rockwobble.reports.pages.{KINDS[kind].name}"
    if KINDS[kind].study and find_spec(name) is None:
        return  # a study's page is that of its tables until there is one
    page = importlib.import_module(name)
    parameters = inspect.signature(page.page_of, eval_str=True).parameters.values()
    assert [each.annotation for each in parameters] == [made]


@pytest.mark.slow
@pytest.mark.parametrize("name", [name for name, each in COMMANDS.items() if not each.study])
def test_each_command_is_a_function_of_its_group_module(name: str) -> None:
    module = importlib.import_module(f"rockwobble.reports.cli.{COMMANDS[name].group}")
    assert inspect.isfunction(getattr(module, name))


def test_registry_names_are_unique_and_groups_in_heading_order() -> None:
    for field in ("name", "command", "kind"):
        stated = [getattr(each, field) for each in ENTRIES]
        assert len({*stated}) == len(stated), field
    assert [*dict.fromkeys(each.group for each in ENTRIES if each.group)] == list(HEADINGS)


@pytest.mark.slow
def test_registry_lists_every_results_class() -> None:
    assert all(entry.results_class() for entry in KINDS.values())
    below = [Results]
    for each in below:
        below += each.__subclasses__()
    assert {each.kind for each in below[1:] if each.__module__.startswith("rockwobble.")} == {*KINDS}


def test_plotting_results_without_figures_is_refused() -> None:
    with pytest.raises(ValueError, match="there is nothing to draw of"):
        Checks.of([not_run("a case", "nothing moves")], seconds=0.0).plot()
