"""What an ensemble says, in tables and in sentences made from its numbers."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Any

from rockwobble.compare.distributions import CONFIDENCE, smallest_distance

if TYPE_CHECKING:
    from rockwobble.compare import Ensemble

METHODS = ("method", "runs", "uplift", "overturn", "fail", "median [α]", "16 to 84 % [α]")
CONTRASTS = ("method", "against", "KS distance", "p", "Wasserstein [α]", "median ratio", "single peaks")
OVERTURNING = ("method", "against", "both fall", "only method", "only against", "neither", "p")
# the columns that hold no numbers
WORDS = ("method", "against")
LEGEND = (
    "Peak tilt in α; a run that overturns counts as the largest, and not in the Wasserstein distance. In "
    "brackets: 95 % of a bootstrap over the members; drawn members differ by chance as well, so distances "
    "tend to grow. p: the probability of so large a difference if both "
    "methods were one distribution. single peaks: median factor between the two peaks of a member."
)
_MOST_NAMED = 4


def tables(found: Ensemble) -> list[tuple[str, tuple[str, ...], list[tuple[str, ...]]]]:
    """Return title, headings and rows of each table of a page that has rows."""
    every = [
        ("Methods", METHODS, method_rows(found)),
        ("Each against each", CONTRASTS, contrast_rows(found)),
        ("Overturning: members of each two methods", OVERTURNING, overturning_rows(found)),
    ]
    return [table for table in every if table[2]]


def method_rows(found: Ensemble) -> list[tuple[str, ...]]:
    """Return the cells of the table of methods, by `METHODS`."""
    return [
        (
            row["method"],
            *(str(row[name]) for name in ("runs", "rocked", "overturned", "failed")),
            _peak(row["peak_median"]),
            f"{_peak(row['peak_16'])} to {_peak(row['peak_84'])}",
        )
        for row in found.methods.to_dict("records")
    ]


def contrast_rows(found: Ensemble, *, intervals: bool = True) -> list[tuple[str, ...]]:
    """Return the cells of the table of each method against each, by `CONTRASTS`."""

    def cell(row: dict[Any, Any], name: str, form: str) -> str:
        value = _number(row[name], form)
        between = [_number(row[f"{name}_{end}"], form) for end in ("low", "high")]
        return f"{value} ({between[0]} to {between[1]})" if intervals and value != "-" else value

    return [
        (
            row["method"],
            row["against"],
            cell(row, "ks", ".2f"),
            _probability(row["ks_p"]),
            cell(row, "wasserstein", ".2g"),
            cell(row, "median_ratio", ".2f"),
            _number(row["member_factor"], ".2f"),
        )
        for row in found.contrasts.to_dict("records")
    ]


def overturning_rows(found: Ensemble) -> list[tuple[str, ...]]:
    """Return the cells of the overturning table, by `OVERTURNING`: members of each two methods.

    None where nothing overturns.
    """
    rows = []
    for row in found.contrasts.to_dict("records"):
        both = row["both_overturned"]
        ours, theirs = row["overturned"] - both, row["against_overturned"] - both
        counts = (both, ours, theirs, row["count"] - both - ours - theirs)
        rows.append((row["method"], row["against"], *map(str, counts), _probability(row["overturned_p"])))
    return rows if found.methods["overturned"].any() else []


def statements(found: Ensemble) -> list[str]:
    """Return what the distributions say: what can be told apart, what cannot be seen, and each engine."""
    contrasts = found.contrasts
    if not len(contrasts):
        return ["Fewer than two members ran by any two methods: there is nothing to hold against each other."]
    chance = (1.0 - CONFIDENCE) / len(contrasts)
    apart = contrasts[contrasts["ks_p"] < chance].sort_values("ks_p").to_dict("records")
    told = [f"{row['method']} from {row['against']} (p = {row['ks_p']:.1g})" for row in apart]
    if told:
        more = f" and {len(told) - _MOST_NAMED} more" if len(told) > _MOST_NAMED else ""
        headline = f"The distributions of peak tilt tell {', '.join(told[:_MOST_NAMED])}{more}."
    else:
        least = contrasts.sort_values("ks_p").iloc[0]
        names = f"{least['method']} against {least['against']}"
        headline = (
            f"No method is told from another by its distribution of peak tilt: p is {least['ks_p']:.2f} "
            f"({names})."
            if len(contrasts) == 1
            else f"No method is told from another by its distribution of peak tilt: the smallest p of "
            f"{len(contrasts)} pairs is {least['ks_p']:.2f} ({names})."
        )
    count = int(contrasts["count"].min())
    lines = [
        headline,
        f"With {count} members a KS distance below {smallest_distance(count):.2f} is within chance; a "
        "difference that is smaller takes more members to be seen.",
    ]
    lines += [_engine_line(found, row) for row in found.methods.to_dict("records") if row["own_model"]]
    if not found.methods["overturned"].any():
        lines.append("No member overturns by any method.")
    failed = found.methods[found.methods["failed"] > 0]
    return [line for line in lines if line] + [
        f"{row['method']} failed in {row['failed_members']}, which are left out."
        for row in failed.to_dict("records")
    ]


def _engine_line(found: Ensemble, method: dict[Any, Any]) -> str:
    name, own = method["method"], method["own_model"]
    rows = found.contrasts[(found.contrasts["method"] == name) & (found.contrasts["against"] == own)]
    if not len(rows):
        return ""
    row = rows.iloc[0]
    factor, fallen = _number(row["member_factor"], ".2f"), (row["overturned"], row["against_overturned"])
    return (
        f"{name} against {own}, its own model: KS distance {row['ks']:.2f} (p = {row['ks_p']:.2f})"
        + (f", single peaks differ by a factor of {factor} in the median" if factor != "-" else "")
        + (f", {fallen[0]} and {fallen[1]} of {row['count']} overturn." if any(fallen) else ".")
    )


def facts(found: Ensemble) -> list[str]:
    """Return what the members are, one line each."""
    about = found.about
    size, tan_alpha = (_span(about[name]) for name in ("semidiagonal", "tan_alpha"))
    members = found.members["member"].nunique()
    return [
        f"R = {size} m, tan α = {tan_alpha}",
        f"{members} members: {about['members']}",
        f"seed {about['seeds']['ensemble']}, {about['draws']:,} draws of the bootstrap",
    ]


def _span(span: dict[str, Any]) -> str:
    return f"{span['from']:g}" if span["count"] == 1 else f"{span['from']:g} to {span['to']:g}"


def _probability(value: float) -> str:
    return f"{value:.2f}" if value >= 0.01 else "<0.01"


def _peak(value: float) -> str:
    return "falls" if value == math.inf else _number(value, ".3f")


def _number(value: float, form: str) -> str:
    return f"{value:{form}}" if math.isfinite(value) else "-"
