"""The page of many cases: an overview, the worst first, and one case at a time below it."""

from __future__ import annotations

import json
import math
from collections.abc import Iterator
from typing import TYPE_CHECKING, Any

from rockwobble.compare import WORTH_EXPLAINING

from ...figures import charts
from ...figures.budget_figure import budget_figure
from ...figures.case_view import CaseView, case_views
from ...figures.thinning import kept_samples
from ..case_words import describe, group_of
from ..template import PLOT_CONFIG, render
from .budget_words import budget_lines, divergence_lines
from .findings import counted_remarks, finding_sentences, headline
from .suite_table import suite_headline, worst_first

if TYPE_CHECKING:
    import plotly.graph_objects as go

    from rockwobble.compare import Comparison

# points of all lines of a page together: ten bytes each, and the page stays below 8 MB
_ALL_POINTS = 150_000
# more are not to be seen, fewer are no curve
_MOST_POINTS, _FEWEST_POINTS = 1500, 120


def suite_page(comparison: Comparison, command: str = "") -> str:
    """Return the page as HTML, plotly.js inside; a case is drawn when it is chosen.

    Parameters
    ----------
    comparison : Comparison
    command : str, optional
        What made it, for the reader who wants to make it again.
    """
    from rockwobble.compare import SUMMARY_COLUMNS

    views = {view.case.name: view for view in case_views(comparison)}
    lengths = {name: view.case.length for name, view in views.items()}
    overview = worst_first(comparison.summary, lengths)
    figures = {name: list(_figures(view)) for name, view in views.items()}
    points = _points_of_a_line(figures)
    return render(
        "suite.html.j2",
        command=command,
        plot_template=_template(),
        plot_config=_json(PLOT_CONFIG),
        headline=suite_headline(comparison.summary),
        budget=[
            *budget_lines(comparison.summary),
            *divergence_lines(comparison.summary),
            *counted_remarks(comparison.summary),
        ],
        budget_picture=_budget_picture(comparison),
        overview=overview,
        groups=_grouped(views),
        cases=[_case(view, index, figures[name], points) for index, (name, view) in enumerate(views.items())],
        columns=[
            {"name": name, "unit": unit, "meaning": meaning}
            for name, (unit, meaning) in SUMMARY_COLUMNS.items()
            # results may be older than a column
            if name in comparison.summary and name not in ("case", "run")
        ],
        versions=comparison.versions,
    )


def _budget_picture(comparison: Comparison) -> str:
    """SVG of all budgets to stand in the page; empty without budgets."""
    if not comparison.budgets:
        return ""
    import matplotlib as mpl

    with mpl.rc_context({"svg.fonttype": "none"}):  # letters as outlines weigh ten times as much
        picture = budget_figure(comparison).decode()
    return picture[picture.index("<svg") :]


def _grouped(views: dict[str, CaseView]) -> dict[str, list[tuple[int, str]]]:
    """Number and name of each case by its group, for the chooser."""
    groups: dict[str, list[tuple[int, str]]] = {}
    for index, name in enumerate(views):
        groups.setdefault(group_of(name), []).append((index, name))
    return groups


def _case(
    view: CaseView, index: int, figures: list[tuple[str, str, go.Figure]], points: int
) -> dict[str, Any]:
    return {
        "name": view.case.name,
        "index": index,
        "lines": describe(view.case),
        "headline": headline(view.rows, view.case.length),
        "findings": finding_sentences(view),
        "rows": [{name: _cell(value) for name, value in row.items()} for _, row in view.rows.iterrows()],
        "figures": [
            {
                "title": title,
                "words": words,
                "id": f"figure-{index}-{number}",
                "height": figure.layout.height,
                "spec": _spec(figure, points),
            }
            for number, (title, words, figure) in enumerate(figures)
        ],
    }


def _figures(view: CaseView) -> Iterator[tuple[str, str, go.Figure]]:
    """Yield title, explanation and figure of what is drawn of a case."""
    yield "Tilt", "All runs over each other, in units of the slenderness α.", charts.tilt_chart(view)
    yield (
        "How the traces part",
        "Largest difference of the tilt within the last second. Diamonds mark the agreement horizon.",
        charts.difference_chart(view),
    )
    yield (
        "Where the rim touches",
        "Azimuth of the contact point, counted through whole turns.",
        charts.azimuth_chart(view),
    )
    yield (
        "Angle of turn of each pass",
        "From one tilt maximum to the next; open symbols are closer to upright than the contact resolves.",
        charts.turn_chart(view),
    )
    bars = charts.budget_bars(view)
    if bars is not None:
        yield (
            "What the difference is made of",
            "RMS of model form, numerics and what nobody explains, until 80 % of the agreement.",
            bars,
        )
    # four lines for each run and reference: where there is nothing to explain they are a megabyte for nothing
    for title, figure in charts.budget_charts(view, above=WORTH_EXPLAINING):
        yield f"Parts of {title}", "Each as its largest value within the last second.", figure
    excitation = charts.excitation_chart(view)
    if excitation is not None:
        yield "Excitation", "Acceleration of the ground.", excitation


def _points_of_a_line(figures: dict[str, list[tuple[str, str, go.Figure]]]) -> int:
    """As many points as the page can hold, the same for every line."""
    lines = sum(
        _is_line(trace) for drawn in figures.values() for *_, figure in drawn for trace in figure.data
    )
    return min(_MOST_POINTS, max(_FEWEST_POINTS, _ALL_POINTS // max(1, lines)))


def _is_line(trace: Any) -> bool:
    return getattr(trace, "mode", None) == "lines" and trace.x is not None and len(trace.x) > 2


def _spec(figure: go.Figure, points: int) -> str:
    """Return data and layout for the script of the page, without the template that all have in common."""
    for trace in figure.data:
        if _is_line(trace) and len(trace.x) > points:
            keep = kept_samples(trace.y, points=points)
            trace.update(x=trace.x[keep], y=trace.y[keep])
    content = json.loads(figure.to_json())
    content["layout"].pop("template", None)
    return _json(content)


def _template() -> str:
    """Return the template that plotly would repeat in every figure."""
    import plotly.graph_objects as go

    return _json(json.loads(go.Figure().to_json())["layout"]["template"])


def _json(content: Any) -> str:
    # the end of a script element must not stand in a name
    return json.dumps(content, separators=(",", ":"), ensure_ascii=False).replace("</", "<\\/")


def _cell(value: Any) -> str:
    if isinstance(value, bool):
        return "yes" if value else "no"
    if isinstance(value, float):
        return f"{value:.4g}" if math.isfinite(value) else "–"
    return str(value)
