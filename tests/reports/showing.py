"""What every result must show of itself; for the tests of each study."""

from __future__ import annotations

import pytest

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
