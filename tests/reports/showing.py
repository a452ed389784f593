"""Assertions for results of every study, and a call of the command line."""

from __future__ import annotations

import dataclasses
import os
from pathlib import Path

import pandas as pd
import pytest

from rockwobble.compare import Results
from rockwobble.compare.storage.manifest import Manifest
from rockwobble.models.shown import LONGEST, Shown
from rockwobble.reports.cli.main import main
from rockwobble.reports.pages import page_of


def call(*arguments: str) -> int:
    """Exit code of a command."""
    with pytest.raises(SystemExit) as ended:
        main(list(arguments))
    code = ended.value.code or 0
    assert isinstance(code, int)
    return code


def shows_itself(result: Shown, *facts: str) -> None:
    """Assert that a result has these facts in its repr and in a table, and a plot."""
    line = repr(result)
    assert line.startswith(f"{type(result).__name__}(")
    assert line.isprintable()
    assert len(line) <= LONGEST
    page = result._repr_html_()
    assert page.count("<table") == 1
    for fact in facts:
        assert fact in line
    figure = result.plot()
    assert any(axes.has_data() for axes in figure.axes)
    with pytest.raises(ValueError, match="got 'nowhere'"):
        result.plot("nowhere")


def loads_as_it_was(made: Results, folder: Path) -> None:
    """Assert that loaded results equal the saved ones: facts and tables, bitwise and by type."""
    made.save(folder)
    loaded = type(made).load(folder)
    assert repr(loaded.facts) == repr(made.facts)  # to which a NaN is equal, and a tuple is no list
    assert list(loaded.tables) == list(made.tables)
    for name, table in made.tables.items():
        pd.testing.assert_frame_equal(loaded.tables[name], table, check_exact=True, obj=name)
    assert repr(dict(loaded.headline())) == repr(dict(made.headline()))


MANIFEST = Manifest(kind="", date="2026-01-01", processor="a CPU", versions={"rockwobble": "0"})
GOLDEN = Path(__file__).parent / "golden"


def is_golden(made: Results) -> None:
    """Assert that the page of results equals its file in the folder `golden`."""
    kind = made.kind.rpartition(" ")[2]
    manifest = dataclasses.replace(MANIFEST, kind=made.kind, command=f"rockwobble {kind}", about=made.facts)
    page = page_of(dataclasses.replace(made, manifest=manifest)).markdown()
    if os.environ.get("GOLDEN") == "anew":  # to be read before it is committed
        (GOLDEN / f"{kind}.md").write_text(page)
    assert page == (GOLDEN / f"{kind}.md").read_text()
