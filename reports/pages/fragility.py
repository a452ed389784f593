"""Values for the page of a fragility: its words are in the template fragility.md.j2."""

from __future__ import annotations

import math
from collections.abc import Iterable, Iterator, Sequence

from rockwobble.compare.metrics.statistics import FEWEST
from rockwobble.models.support import SUPPORTS
from rockwobble.studies import Fragility
from rockwobble.studies.fragility.fit import (
    ALWAYS,
    EXTRAPOLATED,
    FALLING,
    FITTED,
    NEVER,
    ONE_MOTION,
    SEPARATED,
    TOO_FEW,
)
from rockwobble.studies.fragility.intensity import MEASURES
from rockwobble.studies.fragility.study import FEWEST_LEVELS, Row, known_ratio, main_contrasts
from rockwobble.studies.fragility.tables import ALL, OVERTURNED

from ..figures.fragility import pictures
from ..figures.risk import risk_pictures
from .page import Page
from .risk import risk_values
from .table import number
from .wording import statement

_WALLED = tuple(each for each in SUPPORTS.values() if each.walls)
# why a median of overturning is only bounded
_BOUNDED = {
    NEVER: "nothing overturns",
    ALWAYS: "everything overturns",
    EXTRAPOLATED: "outside the intensities that were run",
    ONE_MOTION: "all runs that stand are of one motion",
}
_QUESTIONS = {
    "planar": "Planar analysis (worse plane: the larger peak of the two):",
    "support": "Support:",
    "engine": "Engine:",
}
_MOST_WITHIN = 10.0  # margin above which an interval bounds nothing
# below this probability the counts do not follow a lognormal curve
_POOR = 0.05


def page_of(found: Fragility) -> Page:
    """Return the page of a fragility."""
    drawn = pictures(found)
    names = [picture.name for picture in drawn]
    drawn += risk_pictures(found)
    values = {**fragility_values(found), "about": found.manifest, "pictures": names}
    return Page(name="fragility", template="fragility", values=values, pictures=drawn)


def fragility_values(found: Fragility) -> dict[str, object]:
    """Return the values of the template of a fragility."""
    measure = MEASURES[str(found.facts["measure"])]
    cylinders = found.facts["cylinders"]
    whole = ALL if len(cylinders) > 1 else next(iter(cylinders))
    answers = main_contrasts(found)
    fits: list[Row] = [
        {str(name): value for name, value in row.items()} for row in found.fits.to_dict("records")
    ]
    fallen = [
        {**_with_known_spread(row, fits), "median": found.median_or_bound(row["cylinder"], row["median"])}
        for row in fits
        if row["limit"] == OVERTURNED
    ]
    efficiency = [
        {**row, "title": MEASURES[str(row["measure"])].title} for row in found.efficiency.to_dict("records")
    ]
    contrasts = _by_cylinder(
        [
            {**_with_known_spread(row, fits), "ratio": known_ratio(row["ratio"])}
            for rows in answers.values()
            for row in rows
        ],
        [*cylinders, ALL],
    )
    several, few = len(cylinders) > 1, any(row["kind"] == TOO_FEW for row in fits)
    margin = float(found.facts["margin"])
    return {
        "facts": found.facts,
        "modes": [statement(each) for each in found.findings() if each.key == "mode.slides"],
        "risk": risk_values(found),
        "measure": measure,
        "bodies": list(_bodies(found)),
        "answers": list(_answers(fallen, measure.unit, several=several, few=few, compares=bool(contrasts))),
        "undetermined": [] if few else list(_bounds_of_medians(fallen, measure.unit, several=several)),
        "questions": {
            _QUESTIONS[question]: [_answer(row, margin) for row in rows if row["cylinder"] == whole]
            for question, rows in answers.items()
            if any(row["cylinder"] == whole for row in rows)
        },
        "contrasts": contrasts,
        "scaling": _scaling(found, measure.title),
        "fallen": fallen,
        "remarks": [*_remarks(fallen), *_curveless(fits, several=several)],
        "few": few,
        **_counts(found),
        "states": _states(found),
        "state_columns": [["method", "method", "words"]]
        + [[limit, limit.replace("_", " "), ".3g"] for limit in found.facts["limits"]],
        "states_title": "Medians of all limits" + ("" if measure.unit == "-" else f" [{measure.unit}]"),
        "notes": list(_notes(found, few=few)),
        "efficiency": efficiency,
        "gaps": _gaps(found),
    }


def _bodies(found: Fragility) -> Iterator[str]:
    """One line on each cylinder: its size where there are several, and its slab."""
    cylinders, methods = found.facts["cylinders"], found.facts["methods"].values()
    for name, body in cylinders.items():
        size = f": R = {number(body['semidiagonal'])} m, tan α = {number(body['tan_alpha'])}"
        line = name + size if len(cylinders) > 1 else name
        if slab := body.get("slab_mass_ratio", 0.0):
            line += f", under a slab of {number(slab)} times the mass of its columns"
            if any(each["engine"] for each in methods):
                line += ", in an engine one column under a slab that only translates"
        yield line


def _answers(fallen: Sequence[Row], unit: str, *, several: bool, few: bool, compares: bool) -> Iterator[str]:
    """Yield what the page answers: ratios, medians, that nothing overturns, or that motions are too few."""
    if few:
        fewest = f"{FEWEST} motions and {FEWEST_LEVELS} levels"
        yield f"Too few for a curve: a median takes at least {fewest}. Counts only."
    elif compares:
        mean = ", geometric mean of the cylinders" if several else ""
        yield (
            f"Ratios of the median overturning intensity (95 % interval){mean}: "
            "above 1 the first method is unconservative."
        )
    elif curved := [row for row in fallen if row["kind"] == FITTED]:
        medians = (f"{_interval(row, 'median', '.3g')} by {_method(row, several)}" for row in curved)
        yield f"Median overturning intensity [{unit}] (95 % interval): {'; '.join(medians)}."
    elif fallen and not any(row["exceeded"] for row in fallen):
        yield "Nothing overturns at these intensities."


def _notes(found: Fragility, *, few: bool) -> Iterator[str]:
    """Yield how curves and intervals are made, and what a wall may hide."""
    if not few:
        yield (
            f"Lognormal curves by maximum likelihood; 95 % intervals by {found.facts['resamples']} resamples "
            "of the motions, the same for every method."
        )
    if any(each["support"] in _WALLED for each in found.facts["methods"].values()):
        yield "A cylinder that rests on a wall beyond its balance at the end counts as overturned."


def _bounds_of_medians(fallen: Sequence[Row], unit: str, *, several: bool) -> Iterator[str]:
    """One sentence on each median of overturning that is only bounded, where something overturns."""
    for row in fallen if any(row["exceeded"] for row in fallen) else ():
        if row["kind"] in _BOUNDED:
            median = f"{number(row['median'])}{'' if unit == '-' else f' {unit}'}"
            why = _BOUNDED[row["kind"]]
            if row["kind"] == ONE_MOTION and row["exceeded"] < row["runs"] / 2:
                why = "all overturning runs are of one motion"
            yield f"The median of {_method(row, several)} is not determined: {median}, {why}."


def _answer(row: Row, margin: float) -> str:
    """Return a ratio of two medians in words: its interval, whether it is within the margin, its bounds."""
    line = f"{row['method']} against {row['against']}: "
    if not math.isfinite(row["ratio"]):
        return f"{line}no ratio."
    line += f"{_interval(row, 'ratio')}, {_equivalence(row, margin)}"
    least, most = row.get("ratio_least", math.nan), row.get("ratio_most", math.nan)
    if math.isfinite(most) and most > least:
        line += f"; {number(least, '.2f')} to {number(most, '.2f')} for any outcome of the failed runs"
    return f"{line}."


def _equivalence(row: Row, margin: float) -> str:
    if row["verdict"] == "beyond":
        return "not equivalent"
    within = number(row["within"], "percent")
    if row["verdict"] == "within":
        return f"equivalent within {within}"
    reach = f"up to {within}" if row["within"] < _MOST_WITHIN else "unbounded"
    return f"inconclusive: interval wider than ±{number(margin, 'percent')} ({reach})"


def _remarks(fallen: Sequence[Row]) -> Iterator[str]:
    """Sentences on curves that the counts do not follow, and on runs that failed."""
    if poor := [_method(row, True) for row in fallen if row["p"] < _POOR]:
        yield f"The counts do not follow a lognormal curve (p below {number(_POOR)}): {', '.join(poor)}."
    for row in fallen:
        if row["failed"]:
            runs = row["failed"] + row["runs"]
            line = f"{_method(row, True)} has no answer in {row['failed']} of {runs} runs, which are left out"
            if math.isfinite(row.get("median_if_not", math.nan)):
                exceeded, stands = number(row["median_if_exceeded"]), number(row["median_if_not"])
                line += f": the median is {exceeded} if they all overturn, {stands} if none does"
            yield f"{line}."


def _method(row: Row, several: bool) -> str:
    return f"{row['method']} of {row['cylinder']}" if several else str(row["method"])


def _interval(row: Row, name: str, form: str = ".2f") -> str:
    value, low, high = (number(row[f"{name}{end}"], form) for end in ("", "_low", "_high"))
    return f"{value} ({low} to {high})"


# why a limit has no curve, though some runs exceed it and some do not
_CURVELESS = {
    ONE_MOTION: "all runs beyond the limit, or all below, are of one motion",
    SEPARATED: "all runs above an intensity exceed the limit and none below does (separated)",
    FALLING: "runs that exceed the limit do not increase with the intensity",
}


def _curveless(fits: Iterable[Row], *, several: bool) -> Iterator[str]:
    """One sentence on each reason, with the limits and methods that have no curve for it."""
    for kind, words in _CURVELESS.items():
        methods: dict[str, list[str]] = {}
        for row in fits:
            # what bounds the median of overturning stands above the tables
            if row["kind"] == kind and not (kind == ONE_MOTION and row["limit"] == OVERTURNED):
                limit = str(row["limit"]).replace("_", " ")
                methods.setdefault(limit, []).append(_method(row, several))
        limits: dict[tuple[str, ...], list[str]] = {}
        for limit, names in methods.items():
            limits.setdefault(tuple(names), []).append(limit)
        if limits:
            each = (f"{', '.join(same)} by {', '.join(names)}" for names, same in limits.items())
            yield f"No curve, since {words}: {'; '.join(each)}."


def _with_known_spread(row: Row, fits: Iterable[Row]) -> Row:
    """Return a row without dispersions where a curve is not fitted: that of a step is 0 by convention."""
    methods = {row["method"], row.get("against", row["method"])}
    steps = (
        each["kind"] == SEPARATED
        for each in fits
        if each["method"] in methods
        and each["limit"] == row["limit"]
        and row["cylinder"] in (ALL, each["cylinder"])
    )
    unknown = any(steps)
    return {
        name: math.nan if unknown and name.startswith("dispersion") else value for name, value in row.items()
    }


def _scaling(found: Fragility, measure: str) -> str:
    levels, scales = found.facts["levels"], found.facts["scales"]
    if levels:
        own = found.facts.get("motions_of_levels")
        counts = f"{min(own)} to {max(own)}" if own and len(set(own)) > 1 else str(own[0]) if own else ""
        each = f"{counts} of their own at each of" if own else "each at"
        return f"{each} {len(levels)} levels of {measure} from {levels[0]:.4g} to {levels[-1]:.4g}"
    return "as they are" + ("" if scales == [1.0] else f", times {', '.join(f'{s:.4g}' for s in scales)}")


def _counts(found: Fragility) -> dict[str, object]:
    """One row for each cylinder, method and limit: motions that exceed it, by level where there are some."""
    levels: list[float] = [*found.counts["intensity"].unique()] if found.facts["levels"] else []
    rows = [
        {
            "cylinder": cylinder,
            "method": method,
            "limit": str(limit).replace("_", " "),
            "all": _share(own["k"].sum(), own["n"].sum()),
            **{f"{row['intensity']:g}": _share(row["k"], row["n"]) for row in own.to_dict("records")},
        }
        for (cylinder, method, limit), own in found.counts.groupby(
            ["cylinder", "method", "limit"], sort=False
        )
    ]
    columns = [(f"{level:g}", f"{level:g}") for level in levels]
    return {
        "count_rows": rows,
        "count_columns": [
            *([name, name, "words"] for name in ("method", "limit", "all")),
            *([*each, "words", "wide"] for each in columns),
        ],
    }


def _share(exceeded: float, runs: float) -> str:
    return f"{exceeded:g} of {runs:g}".replace(" ", "\u00a0")  # in one line


def _by_cylinder(rows: list[Row], cylinders: list[str]) -> list[Row]:
    return [row for cylinder in cylinders for row in rows if row["cylinder"] == cylinder]


def _gaps(found: Fragility) -> list[Row]:
    medians = ("median", "median_incremental")
    rows: Iterable[Row] = (
        {str(name): value for name, value in row.items()} for row in found.gaps.to_dict("records")
    )
    return [
        {
            **row,
            **{name: found.median_or_bound(row["cylinder"], row[name]) for name in medians},
            "bias": known_ratio(row["bias"]),
        }
        for row in rows
    ]


def _states(found: Fragility) -> list[Row]:
    """One row for each cylinder and method: the median of each limit, or what bounds it."""
    rows: dict[tuple[str, str], Row] = {}
    for row in found.fits.to_dict("records"):
        key = str(row["cylinder"]), str(row["method"])
        made = rows.setdefault(key, {"cylinder": key[0], "method": key[1]})
        made[str(row["limit"])] = found.median_or_bound(key[0], float(row["median"]))
    return list(rows.values())
