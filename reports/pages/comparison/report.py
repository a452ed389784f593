"""The report of a comparison: of few cases each in full, of many an overview and one at a time."""

from __future__ import annotations

import dataclasses
from collections.abc import Iterator, Sequence

from rockwobble.compare import WORTH_EXPLAINING, Comparison

from ...figures.comparison.budget import all_budgets_picture, budget_picture, parts_picture
from ...figures.comparison.contact import azimuth_picture, contact_picture, turn_picture
from ...figures.comparison.excitation import excitation_picture
from ...figures.comparison.place import orbit_picture, residual_picture
from ...figures.comparison.playback import playback
from ...figures.comparison.tilt import tilt_picture
from ...figures.comparison.view import CaseView, case_views, own_rows
from ...figures.picture import Line, Picture
from ..page import Page
from ..words.cases import describe, group_of
from ..words.sentences import fragment
from .findings import budget_sentences, counted_remarks, divergence_counts, early_sentences, headline, notes
from .tables import all_columns, external_rows, group_rows, main_rows, matrix_tables, worst_rows

# up to so many cases each has a part of the report of its own
SINGLY = 3
# points of all lines of a page together: eleven bytes each
_ALL_POINTS = 60_000
# more are not to be seen, fewer are no curve
_MOST_POINTS, _FEWEST_POINTS = 1500, 90
_ALONE = ("figure", "budget")


def page_of(found: Comparison) -> Page:
    """Return the report of a comparison."""
    views = case_views(found)
    many = len(views) > SINGLY
    summary, lengths = found.summary, {view.case.name: view.case.length for view in views}
    pictures = {place: list(_pictures(view, place, many)) for place, view in enumerate(views)}
    whole = _thinned([picture for of_case in pictures.values() for picture in of_case])
    bars = all_budgets_picture(found) if found.budgets else None
    if bars is not None:
        whole.append(bars)
    blocks = _blocks(views, many=many)
    values: dict[str, object] = {
        "many": many,
        "about": found.manifest,
        "budgets": bars is not None,
        "cases": [
            {
                **_case(view),
                "matrices": matrix_tables(found.matrix[found.matrix["case"] == view.case.name]),
                "pictures": [picture.name for picture in pictures[place]],
                "player": name if (name := f"player-{place}") in blocks else "",
            }
            for place, view in enumerate(views)
        ],
    }
    if many:
        values |= {
            "group_rows": group_rows(summary, lengths),
            "worst": worst_rows(summary, lengths),
            "failed": int((own_rows(summary)["outcome"] == "failed").sum()),
            "matrices": matrix_tables(found.matrix),
            "remarks": [
                *budget_sentences(summary),
                *early_sentences(summary),
                *divergence_counts(summary),
                *counted_remarks(summary),
            ],
        }
    return Page(
        name="report",
        template="comparison/report",
        values=values,
        pictures=whole,
        alone=_ALONE,
        blocks=blocks,
    )


def _case(view: CaseView) -> dict[str, object]:
    rows = view.rows
    numbers, columns = all_columns(rows)
    return {
        "name": view.case.name,
        "lines": describe(view.case),
        "headline": headline(rows, view.case.length),
        "notes": notes(view),
        "rows": main_rows(view),
        "external": external_rows(rows),
        "numbers": numbers,
        "columns": columns,
    }


def _pictures(view: CaseView, place: int, many: bool) -> Iterator[Picture]:
    """Yield the pictures of a case; of many cases what every one has to show."""
    yield tilt_picture(view, f"tilt-{place}" if place else "figure")
    if not many:
        yield orbit_picture(view, f"orbits-{place}")
        yield contact_picture(view, f"contact-{place}")
    else:
        yield azimuth_picture(view, f"contact-{place}")
    yield turn_picture(view, f"turns-{place}", notes=not many)
    if view.budgets:
        yield from filter(None, [budget_picture(view, f"shares-{place}")])
        # where there is nothing to explain they are a megabyte for nothing
        yield from filter(
            None, [parts_picture(view, f"parts-{place}", above=WORTH_EXPLAINING if many else 0.0)]
        )
    if not many:
        yield residual_picture(view, f"residuals-{place}")
        yield from filter(None, [excitation_picture(view, f"excitation-{place}")])


def _thinned(pictures: Sequence[Picture]) -> list[Picture]:
    """Return the pictures with as many points as the page can hold, the same for every curve."""
    layers = [layer for picture in pictures for panel in picture.panels for layer in panel.layers]
    curves = sum(isinstance(layer, Line) and layer.style.dash != "none" for layer in layers)
    points = min(_MOST_POINTS, max(_FEWEST_POINTS, _ALL_POINTS // max(1, curves)))
    return [dataclasses.replace(picture, points=points) for picture in pictures]


def _blocks(views: Sequence[CaseView], *, many: bool) -> dict[str, str]:
    """Return what only a page shows: the chooser of many cases, the player of each of few."""
    if many:
        groups: dict[str, list[tuple[int, str]]] = {}
        for place, view in enumerate(views):
            groups.setdefault(group_of(view.case.name), []).append((place, view.case.name))
        found = {f"open-{place}": f'<template id="case-{place}">' for place in range(len(views))}
        return {
            **found,
            "close": "</template>",
            "chooser": fragment("comparison/chooser.html.j2", groups=groups),
        }
    specs = {f"player-{place}": playback(view) for place, view in enumerate(views)}
    return {
        name: fragment("comparison/player.html.j2", name=name, spec=spec)
        for name, spec in specs.items()
        if spec is not None
    }
