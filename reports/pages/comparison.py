"""Report of a comparison: few cases in full, many as an overview with one case at a time."""

from __future__ import annotations

import dataclasses
import math
from collections.abc import Iterator, Mapping, Sequence

import pandas as pd

from rockwobble.compare import SUMMARY_COLUMNS, WORTH_EXPLAINING, Comparison
from rockwobble.compare.comparison.findings import AGREE
from rockwobble.compare.comparison.summary import SummaryRow, own_rows, rows_of
from rockwobble.models import Run
from rockwobble.models.diagnostic import codes_in
from rockwobble.models.finding import Finding
from rockwobble.models.support import EXTERNAL
from rockwobble.models.trace import NO_PEAK

from ..figures.budget import all_budgets_picture, budget_picture, parts_picture
from ..figures.case_view import CaseView, case_views
from ..figures.comparison import (
    azimuth_picture,
    contact_picture,
    excitation_picture,
    orbit_picture,
    residual_picture,
    tilt_picture,
    turn_picture,
)
from ..figures.picture import Line, Picture
from ..figures.playback import playback
from .cases import case_lines, group_of
from .diagnostics import code_counts, remarks
from .page import Page, fragment
from .table import Row, enumeration
from .wording import lines_of, some_of, statement, words

# up to so many cases each has a part of the report of its own
SINGLY = 3
# points of all lines of a page together: eleven bytes each
_ALL_POINTS = 60_000
# upper and lower limit of visible points of a curve
_MOST_POINTS, _FEWEST_POINTS = 1500, 90
_ALONE = ("figure", "budget")


def page_of(results: Comparison) -> Page:
    """Report of a comparison."""
    views = case_views(results)
    many, findings = len(views) > SINGLY, results.findings()
    summary, lengths = results.summary, {view.case.name: view.case.length for view in views}
    pictures = {place: list(_pictures(view, place, many)) for place, view in enumerate(views)}
    whole = _thin([picture for of_case in pictures.values() for picture in of_case])
    bars = all_budgets_picture(results) if results.budgets else None
    if bars is not None:
        whole.append(bars)
    blocks = _blocks(views, many=many)
    values: dict[str, object] = {
        "many": many,
        "about": results.manifest,
        "title": some_of([view.case.name for view in views[:1]], len(views) - 1),
        "overview_pictures": [] if bars is None else [bars.name],
        "cases": [
            {
                **_case(view, results, many=many),
                "matrices": matrix_tables(results.matrix[results.matrix["case"] == view.case.name]),
                "pictures": [picture.name for picture in pictures[place]],
                "player": name if (name := f"player-{place}") in blocks else "",
            }
            for place, view in enumerate(views)
        ],
    }
    if many:
        answer, *others = (each for each in findings if not each.runs)
        values |= {
            "answer": statement(answer),
            "group_rows": group_rows(summary, lengths),
            "worst": worst_rows(summary, lengths),
            "matrices": matrix_tables(results.matrix),
            "findings": [*map(statement, others), *counted_diagnostics(summary)],
        }
    return Page(
        name="report",
        template="comparison/report",
        values=values,
        pictures=whole,
        alone=_ALONE,
        blocks=blocks,
    )


def _case(view: CaseView, results: Comparison, *, many: bool) -> dict[str, object]:
    rows, name = view.rows, view.case.name
    # too many for a page of many cases
    numbers, columns = ([], []) if many else all_columns(rows)
    findings = results.case_findings(name)
    return {
        "name": name,
        "lines": case_lines(view.case),
        "headline": headline(findings),
        "short": [statement(each, short=True) for each in findings if each.key in _ANSWERS],
        "findings": [statement(each) for each in findings if each.key not in (*_HEADLINE, *_SUPPORTS)],
        "unusual": [statement(each) for each in findings if each.key not in _USUAL],
        "supports": [statement(each) for each in findings if each.key in _SUPPORTS],
        "diagnostics": run_diagnostics(view),
        "first": first_rows(rows),
        "rows": main_rows(view, results.causes[name]),
        "external": external_rows(rows),
        "numbers": numbers,
        "columns": columns,
    }


_MODES = tuple(f"mode.{name}" for name in words()["mode"])
_HEADLINE = (*_MODES, *AGREE[0], *AGREE[1], "comparison.none")
_ANSWERS = tuple(key for key in _HEADLINE if key != "mode.rocks")  # what a terminal says first
_SUPPORTS = ("comparison.on_guide", "comparison.on_flat", "comparison.on_walls")
# parts omitted in a terminal
_CAUSES = ("slides", "support", "walls", "pass", "near_passes", "distributions")
_USUAL = (*_HEADLINE, *_SUPPORTS, *(f"comparison.{cause}" for cause in _CAUSES))


def headline(findings: Sequence[Finding]) -> str:
    """Mode of motion, and agreement times of the runs with the model of their support."""
    return " ".join(statement(each) for each in findings if each.key in _HEADLINE)


def run_diagnostics(view: CaseView) -> list[str]:
    """Diagnostics of the runs, each text once."""
    texts = {run: remarks(view.facts[run]) for run in dict.fromkeys(view.rows["run"])}
    names = {text: [run for run in texts if texts[run] == text] for text in texts.values() if text}
    return [f"{enumeration(runs)}: {text}." for text, runs in names.items()]


def counted_diagnostics(summary: pd.DataFrame) -> list[str]:
    """Number of runs with each diagnostic, over many cases."""
    runs = summary[(summary["outcome"] != "failed") & (summary["reference_outcome"] != "failed")]
    counts = code_counts(map(codes_in, runs.drop_duplicates(["case", "run"])["diagnostics"]))
    said = f"Of the runs {', '.join(counts)}: see the column diagnostics of summary.csv."
    return [said] if counts else []


def _pictures(view: CaseView, place: int, many: bool) -> Iterator[Picture]:
    """Yield the pictures of a case; with many cases only the common ones."""
    yield tilt_picture(view, f"tilt-{place}" if place else "figure")
    if not many:
        yield orbit_picture(view, f"orbits-{place}")
        yield contact_picture(view, f"contact-{place}")
    else:
        yield azimuth_picture(view, f"contact-{place}")
    yield turn_picture(view, f"turns-{place}", notes=not many)
    if view.budgets:
        yield from filter(None, [budget_picture(view, f"shares-{place}")])
        # of many cases only differences worth explaining: all would take a megabyte
        yield from filter(
            None, [parts_picture(view, f"parts-{place}", above=WORTH_EXPLAINING if many else 0.0)]
        )
    if not many:
        yield residual_picture(view, f"residuals-{place}")
        yield from filter(None, [excitation_picture(view, f"excitation-{place}")])


def _thin(pictures: Sequence[Picture]) -> list[Picture]:
    """Pictures thinned to the point budget of a page, equally for every curve."""
    layers = [layer for picture in pictures for panel in picture.panels for layer in panel.layers]
    curves = sum(isinstance(layer, Line) and layer.style.dash != "none" for layer in layers)
    points = min(_MOST_POINTS, max(_FEWEST_POINTS, _ALL_POINTS // max(1, curves)))
    return [dataclasses.replace(picture, points=points) for picture in pictures]


def _blocks(views: Sequence[CaseView], *, many: bool) -> dict[str, str]:
    """HTML-only parts: a case chooser for many cases, a player each for few."""
    if many:
        groups: dict[str, list[tuple[int, str]]] = {}
        for place, view in enumerate(views):
            groups.setdefault(group_of(view.case.name), []).append((place, view.case.name))
        blocks = {f"open-{place}": f'<template id="case-{place}">' for place in range(len(views))}
        return {
            **blocks,
            "close": "</template>",
            "chooser": fragment("comparison/chooser.html.j2", groups=groups),
        }
    specs = {f"player-{place}": playback(view) for place, view in enumerate(views)}
    return {
        name: fragment("comparison/player.html.j2", name=name, spec=spec)
        for name, spec in specs.items()
        if spec is not None
    }


def first_rows(rows: pd.DataFrame) -> list[Row]:
    """One row per run, compared with the model of its support until divergence."""
    return [
        {
            **row._asdict(),
            "agrees": _agrees(row),
            "uplift": 1e3 * row.uplift_time_difference,
            "direction": math.degrees(row.uplift_direction_difference),
        }
        for row in rows_of(own_rows(rows))
    ]


def main_rows(view: CaseView, causes: Sequence[str]) -> list[Row]:
    """Main columns of the rows of a case; overturned and failed runs have a word for the peak."""
    return [
        {
            **row._asdict(),
            "reference": row.reference.removesuffix(" model"),
            "peak": _peak(row.peak_tilt, row.outcome),
            "reference_peak": _peak(row.reference_peak_tilt, row.reference_outcome),
            "agrees": _agrees(row),
            "predicted": min(row.predicted_until, view.case.length),
            "cause": lines_of(f"comparison.{cause}")[0] if cause else None,
        }
        for row, cause in zip(rows_of(view.rows), causes, strict=True)
    ]


def _agrees(row: SummaryRow) -> str:
    """Agreement time as in the headline, on the time axis of the run; with + to the end of the run."""
    return f"{row.within_tolerance_until:.2f}{'' if row.left_tolerance else '+'}"


def _until(row: SummaryRow, start: float) -> str:
    """Agreement time within 1 % of alpha [s], with + if it lasts to the end of the run."""
    return f"{row.agreement_time + start:.2f}" if row.diverged else f"{row.agreement_time:.2f}+"


def _peak(value: float, outcome: str) -> float | str:
    return outcome if outcome in ("overturned", *NO_PEAK) else value


def external_rows(summary: pd.DataFrame) -> list[Row]:
    """Return one line of numbers and codes for each external trajectory."""
    return [
        {
            **row._asdict(),
            "uplift": row.uplift_time_difference if math.isfinite(row.uplift_time_uncertainty) else None,
            "direction": _degrees(row.uplift_direction_difference, row.uplift_direction_uncertainty),
            "direction_uncertainty": _degrees(
                # at half a turn nothing is known of a direction: no more is stated
                min(row.uplift_direction_uncertainty, math.pi),
                row.uplift_direction_uncertainty,
            ),
            "differs_in": "; ".join(row.differs_in) or None,
            "likely_mistake": "; ".join(
                f"{part}: {code}"
                for part, code in zip(row.likely_mistake_in, row.likely_mistake, strict=True)
            )
            or None,
        }
        for row in rows_of(summary[summary["support"] == EXTERNAL])
    ]


def _degrees(angle: float, uncertainty: float) -> float | None:
    return math.degrees(angle) if math.isfinite(uncertainty) else None


def all_columns(rows: pd.DataFrame) -> tuple[list[Row], list[list[str]]]:
    """One line for each column of the summary, and the columns of that table, one per row of the summary."""
    listed = list(rows_of(rows))
    lines: list[Row] = [
        {
            "all": "All numbers",
            "name": name.replace("_", " ") + (f" [{unit}]" if unit else ""),
            **{str(index): getattr(row, name) for index, row in enumerate(listed)},
        }
        for name, (unit, _) in SUMMARY_COLUMNS.items()
        if name not in ("case", "run", "reference")
    ]
    columns = [[str(index), f"{row.run} − {row.reference}", ".4g"] for index, row in enumerate(listed)]
    return lines, [["name", "column", "words"], *columns]


def group_rows(summary: pd.DataFrame, lengths: Mapping[str, float]) -> list[Row]:
    """One line for each group of cases and run, shortest agreement first.

    Parameters
    ----------
    summary : DataFrame
        That of the comparison.
    lengths : mapping
        Length of the run of each case [s].
    """
    rows = _with_shares(summary, lengths)
    shortest = rows.groupby("group")["share"].min().sort_values(kind="stable")
    return [
        {
            "group": group,
            "run": run,
            "cases": len(chosen),
            "agree": int((~chosen["left_tolerance"]).sum()),
            "least": float(chosen["share"].min()),
            "peak": float(chosen["peak_tilt_difference"].abs().max()),
            "time": float(chosen["wall_time"].sum(min_count=1)),
        }
        for group in shortest.index
        for run, chosen in rows[rows["group"] == group].groupby("run", sort=False)
    ]


def worst_rows(summary: pd.DataFrame, lengths: Mapping[str, float]) -> list[Row]:
    """Worst run of each case, worst case first, with the index of the case on the page."""
    rows = _with_shares(summary, lengths)
    worst = rows.sort_values("share", kind="stable")
    places = {name: place for place, name in enumerate(lengths)}
    return [
        {
            **row._asdict(),
            "place": places[row.case],
            "length": lengths[row.case],
            "peak": abs(row.peak_tilt_difference),
            "agrees": _agrees(row),
        }
        for row in rows_of(worst.drop_duplicates("case"))
    ]


def _with_shares(summary: pd.DataFrame, lengths: Mapping[str, float]) -> pd.DataFrame:
    """Add the group of each case, and the agreement time over the length of the run."""
    rows = own_rows(summary)
    share = (rows["within_tolerance_until"] / rows["case"].map(lengths)).clip(upper=1.0)
    share = share.where(rows["left_tolerance"], 1.0)
    known = share.where(share.map(math.isfinite), 0.0)
    return rows.assign(group=rows["case"].map(group_of), share=known)


def matrix_tables(matrix: pd.DataFrame) -> list[Row]:
    """One table per support: support, rows, and template columns.

    A cell says for one case how long two agree; for many in how many of them they agree to the end.
    """
    return [_matrix(str(support), part) for support, part in matrix.groupby("support", sort=False)]


def _matrix(support: str, part: pd.DataFrame) -> Row:
    labels = list(dict.fromkeys(part["run"]))
    cells = {pair: _cell(rows) for pair, rows in part.groupby(["run", "other"], sort=False)}
    rows: list[Row] = [
        {"run": _short(run, support), **{other: cells.get((run, other)) for other in labels}}
        for run in labels
    ]
    columns = [[label, _short(label, support), "words"] for label in labels]
    return {"support": support, "rows": rows, "columns": [["run", support, "words"], *columns]}


def _cell(rows: pd.DataFrame) -> str:
    if len(rows) == 1:
        (row,) = rows_of(rows)
        return f"{_until(row, row.other_uplift_time)} s"
    return f"{int((~rows['diverged']).sum())} of {len(rows)}"


def _short(label: str, support: str) -> str:
    return {str(Run(None, support)): "model"}.get(label, label.removesuffix(f" {support}"))
