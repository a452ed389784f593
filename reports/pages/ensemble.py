"""Values for the page of an ensemble: its words are in the template ensemble.md.j2."""

from __future__ import annotations

import math
from collections.abc import Iterable, Iterator, Mapping, Sequence

from rockwobble.compare.metrics.statistics import (
    FEWEST,
    MARGIN,
    POWER,
    SIGNIFICANCE,
    largest_share_unseen,
    least_significant_count,
    value_if_enough,
)
from rockwobble.models.diagnostic import codes_in
from rockwobble.studies import Ensemble
from rockwobble.studies.fragility.study import Row

from ..figures.ensemble import main_pairs, pictures
from .page import Page
from .table import number

_SHOWN = 4  # pairs of methods that a sentence names
_NOT_DETECTABLE = 1e9  # ratio that no interval of the members could tell from 1
# of tables kept before there were bounds for runs that failed
_UNBOUNDED = dict.fromkeys(("peak_median_least", "peak_median_most", "ratio_least", "ratio_most"), math.nan)


def page_of(found: Ensemble) -> Page:
    """Return the page of an ensemble."""
    values = {**ensemble_values(found), "about": found.manifest}
    return Page(name="ensemble", template="ensemble", values=values, pictures=pictures(found))


def ensemble_values(found: Ensemble) -> dict[str, object]:
    """Return the values of the template of an ensemble."""
    contrasts = found.contrasts
    methods: list[Row] = [
        {str(name): value for name, value in row.items()} for row in found.methods.to_dict("records")
    ]
    rows, main = (
        [
            {**_UNBOUNDED, **row, "ratio": value_if_enough(row["ratio"], row["compared"], ratio=True)}
            for row in each
        ]
        for each in (contrasts.to_dict("records"), main_pairs(found))
    )
    # those that matter first, then the others by their probability
    ordered = main + (contrasts.sort_values("ratio_p").to_dict("records") if rows else [])
    every = {(row["method"], row["against"]): row for row in ordered}
    for row in rows:
        both = row["both_overturned"]
        row["only"], row["only_there"] = row["overturned"] - both, row["against_overturned"] - both
        row["neither"] = row["count"] - both - row["only"] - row["only_there"]
    any_falls = bool(found.methods["overturned"].any())
    one_column = any("one_column" in codes_in(cell) for cell in found.members["diagnostics"])
    return {
        "facts": found.facts,
        "sizes": _range_of(found.facts["semidiagonal"]),
        "slenderness": _range_of(found.facts["tan_alpha"]),
        "count": found.members["member"].nunique(),
        "methods": methods,
        "contrasts": rows,
        "main": main,
        "notes": ["Engines run one column, under a slab that only translates."] if one_column else [],
        "headline": _headline(main, found.members["member"].nunique()),
        "findings": [
            *(_findings(main, rows, [*every.values()], any_falls=any_falls) if main else ()),
            *_failures(methods),
        ],
        "any_falls": any_falls,
        "power": POWER,
    }


def _range_of(values: Mapping[str, float]) -> str:
    """A number that all members have, or the first and the last of several."""
    first, last = number(values["from"]), number(values["to"])
    return f"{first} to {last}" if values["count"] > 1 else first


def _headline(main: Sequence[Row], members: int) -> str:
    """Which pairs of methods are equivalent, which are not, and which are undecided."""
    if not main:
        return "Fewer than two members ran by any two methods: there is nothing to compare."
    within = f"within {number(MARGIN, 'percent')} in the median: "
    known = {"within": f"Equivalent {within}", "beyond": f"Not {within}", "undecided": "Undecided: "}
    lines = [
        f"{words}{_pairs((row for row in main if row['verdict'] == verdict), 'with')}."
        for verdict, words in known.items()
        if any(row["verdict"] == verdict for row in main)
    ]
    if members < FEWEST:
        lines.append(f"Below {FEWEST} members no median and no ratio is stated.")
    return " ".join(lines)


def _findings(
    main: Sequence[Row], rows: Sequence[Row], every: Sequence[Row], *, any_falls: bool
) -> Iterator[str]:
    """Sentences on the main pairs, and on what differs significantly: peaks, and which members overturn."""
    yield from map(_finding, main)
    tested = f"p below {number(SIGNIFICANCE)}"
    if len(rows) > 1:
        tested += f" after Holm's correction for {len(rows)} pairs"
    if apart := [row for row in every if row["ratio_p_adjusted"] < SIGNIFICANCE]:
        each = (
            f"{row['method']} and {row['against']} (higher in {row['higher']}, lower in {row['lower']})"
            for row in apart[:_SHOWN]
        )
        more = f" and {len(apart) - _SHOWN} more" if len(apart) > _SHOWN else ""
        yield f"Significant differences of peaks ({tested}): {', '.join(each)}{more}."
    else:
        yield f"No significant differences of peaks ({tested}), which does not prove equality."
    if not any_falls:
        unseen = number(largest_share_unseen(min(int(row["count"]) for row in rows)), "percent")
        yield f"No member overturns by any method: the overturning probability is below {unseen} (95 %)."
    elif differ := [row for row in rows if row["overturned_p_adjusted"] < SIGNIFICANCE]:
        yield f"Significant differences in overturning: {_pairs(differ, 'and')}."
    else:
        yield (
            "No significant differences in overturning; that takes at least "
            f"{least_significant_count()} members that overturn by only one of two methods."
        )


def _finding(row: Row) -> str:
    """Return how the members of one pair of methods differ."""
    line = f"{row['method']} against {row['against']}: "
    if row["compared"]:
        if row["ratio"] is not None and math.isfinite(row["ratio"]):
            ends = (number(row[name], ".3f") for name in ("ratio", "ratio_low", "ratio_high"))
            line += "median ratio {} ({} to {}), ".format(*ends)
        line += f"higher in {row['higher']} and lower in {row['lower']} of {row['compared']} members "
        line += f"({_p(row['ratio_p'])}); "
        least = number(row["within_reach"], ".3f")
        power = number(POWER, "percent")
        detectable = row["within_reach"] < _NOT_DETECTABLE
        line += f"smallest detectable ratio {least} (power {power})" if detectable else "no detectable ratio"
    else:
        line += "no member has a ratio"
    if row["ratio_least"] < row["ratio_most"]:
        least, most = (number(row[name], ".3f") for name in ("ratio_least", "ratio_most"))
        line += f"; median ratio {least} to {most}, for any outcome of the failed runs"
    if row["overturned"] or row["against_overturned"]:
        line += f"; {row['overturned']} and {row['against_overturned']} of {row['count']} overturn, "
        line += f"{row['both_overturned']} by both ({_p(row['overturned_p'])})"
    return f"{line}."


def _failures(methods: Iterable[Row]) -> Iterator[str]:
    """Sentences on the methods with runs that failed."""
    for row in ({**_UNBOUNDED, **each} for each in methods if each["failed"]):
        line = f"{row['method']} failed in {row['failed']} of {row['runs']} runs, which are left out: "
        line += str(row["failed_members"])
        if row["peak_median_least"] < row["peak_median_most"]:
            least, most = (number(row[f"peak_median_{end}"], ".3f") for end in ("least", "most"))
            line += f"; the median peak is {least} α if they were all at rest, {most} α if they all overturn"
        yield f"{line}."


def _p(value: float) -> str:
    return "p < 0.001" if value < 0.001 else f"p = {number(value, '.3f' if value < 0.1 else '.2f')}"


def _pairs(rows: Iterable[Row], word: str) -> str:
    return ", ".join(f"{row['method']} {word} {row['against']}" for row in rows)
