"""Published figures at print size: no text cut or overlapping."""

from __future__ import annotations

from collections.abc import Iterator
from itertools import pairwise
from pathlib import Path

import pytest
from matplotlib.axis import Axis
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.figure import Figure
from matplotlib.text import Text

from rockwobble.compare.storage.manifest import read_manifests
from rockwobble.reports.figures.svg import figure
from rockwobble.reports.pages import stored_page

pytestmark = pytest.mark.checkout

PUBLISHED = Path(__file__).parents[2] / "reports" / "published"


def words_of(drawn: Figure) -> Iterator[Text]:
    """Yield titles, labels, and visible tick labels."""
    for axes in (each for each in drawn.axes if each.axison):
        yield from (axes.title, axes.xaxis.label, axes.yaxis.label)
        for axis in (axes.xaxis, axes.yaxis):
            yield from numbers_of(axis)
    for legend in drawn.legends:
        yield from legend.get_texts()


def numbers_of(axis: Axis) -> list[Text]:
    """Visible tick labels of an axis, minor ticks included."""
    low, high = sorted(axis.get_view_interval())
    ticks = [*axis.get_major_ticks(), *axis.get_minor_ticks()]
    inside = [tick for tick in ticks if low <= tick.get_loc() <= high and tick.label1.get_text().strip()]
    return [tick.label1 for tick in sorted(inside, key=lambda tick: float(tick.get_loc()))]


@pytest.mark.slow
@pytest.mark.parametrize("name", ["ensemble/p695-2", "fragility/p695", "risk/tendon", "validity"])
def test_published_figures_have_no_cut_or_overlapping_text(name: str) -> None:
    kind = read_manifests(PUBLISHED / name)[0].kind
    for picture in stored_page(kind, PUBLISHED / name).pictures:
        drawn = figure(picture)
        canvas = FigureCanvasAgg(drawn)
        canvas.draw()
        shown = [text for text in words_of(drawn) if text.get_visible() and text.get_text().strip()]
        boxes = [(text.get_text(), text.get_window_extent(canvas.get_renderer())) for text in shown]
        whole = drawn.bbox.padded(2.0)  # a letter may be rounded beyond the edge
        cut = [text for text, box in boxes if not (whole.contains(*box.min) and whole.contains(*box.max))]
        assert cut == [], picture.name
        names = {axes.get_title() for axes in drawn.axes}
        titles = [box for text, box in boxes if text in names]
        for place, one in enumerate(titles):
            assert not any(one.padded(6.0).overlaps(other) for other in titles[place + 1 :]), picture.name
        for axis in (each for axes in drawn.axes if axes.axison for each in (axes.xaxis, axes.yaxis)):
            beside = [text.get_window_extent(canvas.get_renderer()) for text in numbers_of(axis)]
            assert not any(one.overlaps(other) for one, other in pairwise(beside)), picture.name
