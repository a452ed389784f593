"""What every result must show of itself; for the tests of each study."""

from __future__ import annotations

from pathlib import Path

import pandas as pd
import pytest

from rockwobble.compare import Results
from rockwobble.models.shown import LONGEST, Shown


def shows_itself(result: Shown, *facts: str) -> None:
    """Hold that a result says these facts on a line and in a table, and draws them."""
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
    """Hold that results are the same value when they are loaded: facts and tables, to the bit and by type."""
    made.save(folder)
    loaded = type(made).load(folder)
    assert repr(loaded.facts) == repr(made.facts)  # to which a NaN is equal, and a tuple is no list
    assert list(loaded.tables) == list(made.tables)
    for name, table in made.tables.items():
        pd.testing.assert_frame_equal(loaded.tables[name], table, check_exact=True, obj=name)
    assert repr(dict(loaded.headline())) == repr(dict(made.headline()))
