"""Findings of a fragility, from the numbers of its tables."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence

from rockwobble.compare.metrics.statistics import FEWEST
from rockwobble.models.finding import Finding, Level, Value
from rockwobble.models.plain_json import Facts
from rockwobble.models.support import FLAT, SUPPORTS

from .fit import ALWAYS, EXTRAPOLATED, FALLING, FITTED, NEVER, ONE_MOTION, SEPARATED, TOO_FEW
from .intensity import MEASURES
from .tables import OVERTURNED, Row

FEWEST_LEVELS = 2  # one level gives a curve no slope
_MOST_WITHIN = 10.0  # margin beyond which an interval is no bound
_POOR = 0.05  # below this probability the counts do not follow a lognormal curve
_WALLED = tuple(each for each in SUPPORTS.values() if each.walls)
_VERDICTS: Mapping[str, tuple[str, Level]] = {
    "within": ("fragility.equivalent", "satisfied"),
    "beyond": ("fragility.different", "not satisfied"),
    "undecided": ("fragility.undecided", "not tested"),
}


def fragility_findings(
    facts: Facts,
    fits: Sequence[Row],
    answers: Mapping[str, Sequence[Row]],
    bound_of: Callable[[str, float], float | str],
) -> Iterator[Finding]:
    """Findings, in order of weight.

    Parameters
    ----------
    facts : mapping
        Of the fragility.
    fits : sequence of dict
        Rows of its fits.
    answers : mapping of str to sequence of dict
        Its `main_contrasts`.
    bound_of : callable
        Returns the median of a cylinder, or what bounds it.
    """
    yield from _problem(facts)
    several = len(facts["cylinders"]) > 1
    fallen = [row for row in fits if row["limit"] == OVERTURNED]
    if any(row["kind"] == TOO_FEW for row in fits):
        fewest: dict[str, Value] = {"count": FEWEST, "count_levels": FEWEST_LEVELS}
        yield Finding(key="fragility.few", level="not tested", values=fewest)
    elif fallen and not any(row["exceeded"] for row in fallen):
        yield Finding(key="fragility.nothing_overturns")
    else:
        unit = MEASURES[str(facts["measure"])].unit.replace("-", "")
        yield from _medians(fallen, unit, several, bound_of)
    for question, rows in answers.items():
        yield from (_pair(row, question, float(facts["margin"])) for row in rows)
    if poor := tuple(_method(row) for row in fallen if row["p"] < _POOR):
        yield Finding(key="fragility.poor_fit", level="caution", values={"bound": _POOR, "names": poor})
    for row in (each for each in fallen if each["failed"]):
        values = {"name": _method(row), "runs_failed": row["failed"], "runs": row["failed"] + row["runs"]}
        if math.isfinite(row["median_if_not"]):
            values |= {"intensity_most": row["median_if_exceeded"], "intensity": row["median_if_not"]}
        yield Finding(key="fragility.failed", level="caution", values=values)
    yield from _curveless(fits, several)
    if any(each["support"] in _WALLED for each in facts["methods"].values()):
        yield Finding(key="fragility.wall")


def _problem(facts: Facts) -> Iterator[Finding]:
    """Findings on the bodies, the mode that friction allows, and the intensities."""
    methods, given, several = facts["methods"].values(), float(facts["friction"]), len(facts["cylinders"]) > 1
    flat = any(each["support"] == str(FLAT) for each in methods)
    for name, body in facts["cylinders"].items():
        if flat and given < body["tan_alpha"]:
            values = {"reason": str(FLAT), "given": given, "bound": body["tan_alpha"]}
            yield Finding(key="mode.slides", values=values, runs=name)
        values = {"name": name, "factor": body.get("slab_mass_ratio") or None}
        if several:
            values |= {"length": body["semidiagonal"], "ratio": body["tan_alpha"]}
        yield Finding(key="fragility.body", values=values, runs=name)
    slabs = any(body.get("slab_mass_ratio") for body in facts["cylinders"].values())
    if slabs and any(each["engine"] for each in methods):
        yield Finding(key="fragility.one_column")
    if levels := facts["levels"]:
        own = facts.get("motions_of_levels")
        ends = {"intensity": levels[0], "intensity_end": levels[-1]}
        values = {"count": len(levels), "name": MEASURES[str(facts["measure"])].title, **ends}
        if own:
            more = max(own) if max(own) > min(own) else None
            values |= {"count_least": min(own), "count_most": more}
        yield Finding(key="fragility.own_levels" if own else "fragility.levels", values=values)
    else:
        scales = tuple(f"{scale:.4g}" for scale in facts["scales"] if facts["scales"] != [1.0])
        yield Finding(key="fragility.cloud", values={"names": scales})


def _medians(
    fallen: Sequence[Row], unit: str, several: bool, bound_of: Callable[[str, float], float | str]
) -> Iterator[Finding]:
    """Findings on each median of overturning, or on its bound."""
    for row in fallen:
        kind = row["kind"]
        values: dict[str, Value] = {"name": _method(row, several), "detail_unit": unit}
        if kind == FITTED:
            values["intensity"] = row["median"], row["median_low"], row["median_high"]
            yield Finding(key="fragility.median", values=values, runs=row["cylinder"])
        elif kind in (NEVER, ALWAYS, EXTRAPOLATED, ONE_MOTION):
            one = kind == ONE_MOTION and row["exceeded"] < row["runs"] / 2
            bound = bound_of(row["cylinder"], row["median"])
            values["reason"] = "one_motion_overturns" if one else f"bounded_{kind}"
            values["detail"] = bound if isinstance(bound, str) else f"{bound:.3g}"
            yield Finding(key="fragility.bounded", level="caution", values=values, runs=row["cylinder"])


def _pair(row: Row, question: str, margin: float) -> Finding:
    """Finding on the ratio of two medians: within the margin or not, and the effect of failed runs."""
    values: dict[str, Value] = {"name": row["method"], "name_reference": row["against"], "reason": question}
    if not math.isfinite(row["ratio"]) or not row["ratio"]:
        return Finding(key="fragility.no_ratio", level="not tested", values=values, runs=row["cylinder"])
    key, level = _VERDICTS[row["verdict"]]
    values |= {"ratio": (row["ratio"], row["ratio_low"], row["ratio_high"]), "share_margin": margin}
    values["share"] = row["within"] if row["within"] < _MOST_WITHIN else None
    least, most = row.get("ratio_least", math.nan), row.get("ratio_most", math.nan)
    if math.isfinite(most) and most > least:
        values |= {"ratio_least": least, "ratio_most": most}
    return Finding(key=key, level=level, values=values, runs=row["cylinder"])


def _curveless(fits: Iterable[Row], several: bool) -> Iterator[Finding]:
    """Findings on each reason for a missing curve, with its limits and methods."""
    for kind in (ONE_MOTION, SEPARATED, FALLING):
        methods: dict[str, list[str]] = {}
        for row in fits:
            # bounds of the overturning median are stated with the median
            if row["kind"] == kind and not (kind == ONE_MOTION and row["limit"] == OVERTURNED):
                methods.setdefault(str(row["limit"]).replace("_", " "), []).append(_method(row, several))
        limits: dict[tuple[str, ...], list[str]] = {}
        for limit, names in methods.items():
            limits.setdefault(tuple(names), []).append(limit)
        if limits:
            each = tuple(f"{', '.join(same)} by {', '.join(names)}" for names, same in limits.items())
            yield Finding(key="fragility.no_curve", values={"reason": f"no_curve_{kind}", "names": each})


def _method(row: Row, several: bool = True) -> str:
    return f"{row['method']} of {row['cylinder']}" if several else str(row["method"])
