"""Speed against accuracy: all methods on all problems, and the page; see script.py beside its folder."""

from __future__ import annotations

import math
import sys
from pathlib import Path

import pandas as pd

from rockwobble.reports.pages.page import Page
from rockwobble.reports.pages.table import NONE, number
from rockwobble.reports.published.script import run
from rockwobble.reports.published.tradeoff.figures import ERRORS, TITLES, pictures
from rockwobble.reports.published.tradeoff.points import (
    ROUNDS,
    Tradeoff,
    costs,
    engine_factors,
    measure,
    plateaus,
    rest_tilt_price,
)

_NOT_ENGINES = ("reduced", "scipy")
_TEMPLATE = Path(__file__).with_name("page.md.j2")


def page_of(results: Tradeoff) -> Page:
    """Return the report."""
    points, cheapest = results.points, costs(results.points)
    scipy = cheapest.loc[cheapest["family"] == "scipy", "ratio"]
    price = rest_tilt_price(points)
    tightest = price.loc[price.groupby(["problem", "line"], sort=False)["value"].idxmin()]
    values: dict[str, object] = {
        "answer": _answer(*engine_factors(points)),
        "scipy": _of_scipy(scipy.min(), scipy.max()),
        "ways": [[family, family, "words"] for family in points["family"].unique()],
        "costs": _rows(_ways(cheapest)),
        "plateaus": _rows(plateaus(points)),
        "rest": _rows(tightest),
        "scenes": results.scenes.sort_values(["engine", "ratio"]).to_dict("records"),
        "problems": _rows(results.problems),
        "chance": _within_chance(results),
        "failed": _rows(points[points["error"].isna()]),
        "rounds": ROUNDS,
        "load": _of_load(*results.facts["load"]),
        "about": results.manifest,
    }
    drawn = pictures(results)
    values["drawn"] = [picture.name for picture in drawn]
    return Page(name="tradeoff", template=_TEMPLATE, values=values, pictures=drawn)


def _answer(least: float, largest: float) -> str:
    """Cost of an engine, on two lines of the document; `least` is NaN if none reaches a target error."""
    if not least > 0.0:
        return "No engine reaches any of the target errors."
    return (
        f"At an error that both reach in a recess, an engine takes {number(least, ',.0f')} to "
        f"{number(largest, ',.0f')} times\nthe computing time of the recess model at its default tolerance, "
        "by problem, error and engine."
    )


def _of_scipy(least: float, largest: float) -> str:
    """Cost of the cheapest scipy solver; empty if `least` is NaN: none reaches a target error."""
    if not least > 0.0:
        return ""
    return (
        f"The cheapest of scipy's solvers on the same equations takes {number(least, ',.0f')} to "
        f"{number(largest, ',.0f')} times."
    )


def _of_load(before: float, after: float) -> str:
    """Machine load in words; empty if unknown."""
    if not math.isfinite(before):
        return ""
    return f"The load of the machine was {number(before, '.1f')} before and {number(after, '.1f')} after."


def _rows(table: pd.DataFrame) -> list[dict[str, object]]:
    """Rows of a table with problem titles and error units."""
    titles = {name: f"{title} [{ERRORS[name][1]}]" for name, title in TITLES.items()}
    return [
        {str(name): value for name, value in row.items()}
        for row in table.assign(problem=table["problem"].map(titles)).to_dict("records")
    ]


def _ways(cheapest: pd.DataFrame) -> pd.DataFrame:
    """Cheapest method of each family in words, one row per problem, support and asked error."""
    said = [
        f"{number(row['ratio'], '.2g' if row['ratio'] < 10.0 else ',.0f')}: {row['line']}, {row['value']:g}"
        for row in cheapest.to_dict("records")
    ]
    keys = ["problem", "support", "target"]
    wide = cheapest.assign(said=said).pivot_table("said", keys, "family", aggfunc="first")
    order = cheapest[keys].drop_duplicates()
    return order.merge(wide.fillna(NONE).reset_index(), on=keys)


def _within_chance(results: Tradeoff) -> list[dict[str, object]]:
    """Count engine points within the sampling distance of an ensemble to their reference, by support."""
    points = results.points[
        (results.points["problem"] == "peaks") & ~results.points["family"].isin(_NOT_ENGINES)
    ]
    rows: list[dict[str, object]] = []
    for row in results.problems[results.problems["chance"].notna()].to_dict("records"):
        own = points[points["support"] == row["support"]]
        good = own[own["error"] <= row["chance"]]
        least = good.nsmallest(1, "ratio").to_dict("records")
        cheapest = [f"{each['line']}, {each['value']:g} s" for each in least]
        rows.append(
            {"support": row["support"], "points": len(own), "good": len(good), "cheapest": "".join(cheapest)}
        )
    return rows


if __name__ == "__main__":
    sys.exit(
        run(
            __file__,
            Tradeoff,
            lambda given: measure(quick=given.quick),
            page_of,
            options=lambda parser: parser.add_argument("--quick", action="store_true", help="fewer points"),
        )
    )
