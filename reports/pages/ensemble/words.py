"""What an ensemble says, in tables and in sentences made from its numbers."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Any

from rockwobble.compare.metrics.distributions import (
    MARGIN,
    POWER,
    SIGNIFICANCE,
    fewest_to_tell,
    largest_share_unseen,
)

from ...figures.ensemble_ratios import main_pairs

if TYPE_CHECKING:
    from rockwobble.compare import Ensemble

WITHIN = f"{100.0 * MARGIN:g} %"
METHODS = ("method", "runs", "uplift", "overturn", "fail", "median [α]", "16 to 84 % [α]")
CONTRASTS = (
    *("method", "against", "n", "higher", "lower", "median ratio", "5 to 95 %", "p", "p (Holm)"),
    *(f"within {WITHIN}", "within reach"),
)
OVERTURNING = ("method", "against", "both", "only method", "only against", "neither", "difference [%]", "p")
# the columns that hold no numbers
WORDS = ("method", "against")
INTRODUCTION = (
    "Once traces have diverged, single runs say little about each other; many members do. They are the same "
    "for every method, so each is held against itself."
)
CAPTION = (
    "Above: share of the members whose peak tilt is at most that of the axis; what a curve lacks to 1 at the "
    "triangle overturns. Below: ratio of the two peaks of each member (dots; triangles at the edges count "
    "those that overturn by one method alone), the median with its 95 % interval (diamond and thick bar), 5 "
    f"to 95 % of the members (thin bar), and the margin of {WITHIN} (shaded)."
)
LEGEND = (
    "Peak tilt in α; an overturned run is larger than all others. In brackets: 95 % intervals, from order "
    "statistics. Ratio: of the two peaks of a member, ∞ where it overturns by the method alone, 0 where by "
    "the other alone; members that overturn or rest by both have none, n have one. 5 to 95 %: of these. p: "
    "Wilcoxon's signed ranks of the log ratios; in the table of overturning McNemar's exact test; Holm: "
    f"corrected for all pairs. within {WITHIN}: yes only where the whole interval of the median ratio is, no "
    "where none of it is; a p above 0.05 is no agreement. within reach: median ratio that as many members, "
    f"so scattered, tell from 1 as well as its inverse, with a power of {100.0 * POWER:g} %."
)
VERDICTS = {"within": "yes", "beyond": "no", "undecided": "undecided"}
_MOST_NAMED = 4


def tables(found: Ensemble) -> list[tuple[str, tuple[str, ...], list[tuple[str, ...]]]]:
    """Return title, headings and rows of each table of a page that has rows."""
    every = [
        ("Methods", METHODS, method_rows(found)),
        ("Peaks of the same member, each method against each", CONTRASTS, contrast_rows(found)),
        ("Overturning: members of each two methods", OVERTURNING, overturning_rows(found)),
    ]
    return [table for table in every if table[2]]


def method_rows(found: Ensemble) -> list[tuple[str, ...]]:
    """Return the cells of the table of methods, by `METHODS`."""
    return [
        (
            row["method"],
            *(str(row[name]) for name in ("runs", "rocked", "overturned", "failed")),
            f"{_peak(row['peak_median'])} "
            f"({_peak(row['peak_median_low'])} to {_peak(row['peak_median_high'])})",
            f"{_peak(row['peak_16'])} to {_peak(row['peak_84'])}",
        )
        for row in found.methods.to_dict("records")
    ]


def contrast_rows(found: Ensemble) -> list[tuple[str, ...]]:
    """Return the cells of the table of each method against each, by `CONTRASTS`."""
    return [
        (
            row["method"],
            row["against"],
            *(str(row[name]) for name in ("compared", "higher", "lower")),
            ratio_with_interval(row),
            f"{_ratio(row['ratio_05'])} to {_ratio(row['ratio_95'])}",
            _probability(row["ratio_p"]),
            _probability(row["ratio_p_adjusted"]),
            VERDICTS[row["verdict"]],
            _ratio(row["within_reach"]) if math.isfinite(row["within_reach"]) else "-",
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
        rows.append(
            (
                *(row["method"], row["against"]),
                *map(str, counts),
                _difference(row),
                _probability(row["overturned_p"]),
            )
        )
    return rows if found.methods["overturned"].any() else []


def statements(found: Ensemble) -> list[str]:
    """Return what the members say: what is the same, what differs, what is open; and those that matter."""
    contrasts = found.contrasts
    if not len(contrasts):
        return ["Fewer than two members ran by any two methods: there is nothing to hold against each other."]
    main = main_pairs(found)
    groups = {
        verdict: [f"{row['method']} with {row['against']}" for row in main if row["verdict"] == verdict]
        for verdict in VERDICTS
    }
    said = {
        "within": f"peaks of the same member agree within {WITHIN} in the median: ",
        "beyond": f"they do not agree within {WITHIN}: "
        if groups["within"]
        else f"peaks of the same member do not agree within {WITHIN} in the median: ",
        "undecided": "undecided: "
        if groups["within"] or groups["beyond"]
        else f"it is undecided whether peaks of the same member agree within {WITHIN} in the median: ",
    }
    headline = "; ".join(said[verdict] + ", ".join(names) for verdict, names in groups.items() if names)
    lines = [f"{headline[0].upper()}{headline[1:]}.", *map(_pair_line, main), _told(found), *_falls(found)]
    failed = found.methods[found.methods["failed"] > 0]
    return lines + [
        f"{row['method']} failed in {row['failed']} of {row['runs']} runs, which are left out: "
        f"{row['failed_members']}."
        for row in failed.to_dict("records")
    ]


def _pair_line(row: dict[Any, Any]) -> str:
    name = f"{row['method']} against {row['against']}"
    fallen = f"{row['overturned']} and {row['against_overturned']} of {row['count']} overturn, "
    fallen += f"{row['both_overturned']} by both ({_stated(row['overturned_p'])})."
    if not row["compared"]:
        return f"{name}: no member has a ratio; {fallen}"
    reach = row["within_reach"]
    tell = f"{row['compared']} members so scattered tell " + (
        f"a ratio of {_ratio(reach)} or its inverse" if math.isfinite(reach) else "no ratio on one side of 1"
    )
    return (
        f"{name}: median ratio {ratio_with_interval(row)}, higher in {row['higher']} and lower in "
        f"{row['lower']} of {row['compared']} members ({_stated(row['ratio_p'])}); {tell}"
        + (f"; {fallen}" if row["overturned"] or row["against_overturned"] else ".")
    )


def _told(found: Ensemble) -> str:
    """Return which methods are told apart, chance taken into account for every pair."""
    contrasts, pairs = found.contrasts, len(found.contrasts)
    after = f" after Holm's correction for {pairs} pairs" if pairs > 1 else ""
    # those that matter first, then the others by their probability
    rows = main_pairs(found) + contrasts.sort_values("ratio_p").to_dict("records")
    every = {(row["method"], row["against"]): row for row in rows}
    apart = [row for row in every.values() if row["ratio_p_adjusted"] < SIGNIFICANCE]
    if not apart:
        return (
            f"No peaks are told apart (p below {SIGNIFICANCE:g}{after}), which does not make them the same."
        )
    told = [
        f"{row['method']} from {row['against']} (higher in {row['higher']}, lower in {row['lower']})"
        for row in apart
    ]
    more = f" and {len(told) - _MOST_NAMED} more" if len(told) > _MOST_NAMED else ""
    return f"Told apart (p below {SIGNIFICANCE:g}{after}): {', '.join(told[:_MOST_NAMED])}{more}."


def _falls(found: Ensemble) -> list[str]:
    """Return what the members that overturn tell, and what they cannot."""
    contrasts = found.contrasts
    if not found.methods["overturned"].any():
        most = 100.0 * largest_share_unseen(int(contrasts["count"].min()))
        return [f"No member overturns by any method: the share that would is below {most:.0f} % (95 %)."]
    apart = contrasts[contrasts["overturned_p_adjusted"] < SIGNIFICANCE].to_dict("records")
    if apart:
        names = ", ".join(f"{row['method']} from {row['against']}" for row in apart)
        return [f"Told apart by which members overturn: {names}."]
    return [
        "No methods are told apart by which members overturn; it takes at least "
        f"{fewest_to_tell()} that overturn by one of two methods alone."
    ]


def facts(found: Ensemble) -> list[str]:
    """Return what the members are, one line each."""
    about = found.about
    size, tan_alpha = (_span(about[name]) for name in ("semidiagonal", "tan_alpha"))
    members = found.members["member"].nunique()
    return [
        f"R = {size} m, tan α = {tan_alpha}",
        f"{members} members: {about['members']}",
        f"seed {about['seeds']['ensemble']}",
    ]


def ratio_with_interval(row: dict[Any, Any]) -> str:
    """Return the median ratio of a row of the contrasts with its interval."""
    return f"{_ratio(row['ratio'])} ({_ratio(row['ratio_low'])} to {_ratio(row['ratio_high'])})"


def _span(span: dict[str, Any]) -> str:
    return f"{span['from']:g}" if span["count"] == 1 else f"{span['from']:g} to {span['to']:g}"


def _difference(row: dict[Any, Any]) -> str:
    ends = (round(100.0 * row[f"overturned_difference{end}"]) for end in ("", "_low", "_high"))
    value, low, high = (f"{end:+d}" if end else "0" for end in ends)
    return f"{value} ({low} to {high})"


def _probability(value: float) -> str:
    if value >= 0.1:
        return f"{value:.2f}"
    return f"{value:.3f}" if value >= 0.001 else "<0.001"


def _stated(value: float) -> str:
    said = _probability(value)
    return f"p {said[0]} {said[1:]}" if said.startswith("<") else f"p = {said}"


def _peak(value: float) -> str:
    return "overturned" if value == math.inf else f"{value:.3f}" if math.isfinite(value) else "-"


def _ratio(value: float) -> str:
    if value == math.inf:
        return "∞"
    return "-" if math.isnan(value) else "0" if value == 0.0 else f"{value:.3f}"
