"""Values for the page of an advice: its sentences are in the template advice.md.j2."""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping
from typing import Any

from rockwobble.compare.comparison.prediction import BEATEN
from rockwobble.compare.metrics.order_statistics import FEWEST
from rockwobble.compare.studies.advice.advice import Advice
from rockwobble.compare.studies.advice.grades import BROKEN, GRADES, NEAR, SENSITIVE, UNSAFE, Grade
from rockwobble.compare.studies.advice.members import SPIKES
from rockwobble.compare.studies.advice.scales import planar_shares
from rockwobble.compare.studies.spectrum.spectrum import PLANAR_X, PLANAR_Y, SPATIAL
from rockwobble.compare.studies.spectrum.tables import CHECK_RTOL, NUDGE
from rockwobble.models import AGREEMENT
from rockwobble.models.diagnostic import CODES, parted
from rockwobble.models.support import support_named
from rockwobble.reduced.body import restitution_from_momentum

from ..figures.advice import pictures
from .page import Page
from .table import number

_STANDS: Mapping[Grade, str] = {
    "satisfied": "it stands",
    "not tested": "it stands, its margin is not tested",
    "caution": "it may overturn",
    "not satisfied": "it is not safe against overturning",
}
_USE: Mapping[Grade, str] = {
    "satisfied": "the {} may be used",
    "not tested": "whether the {} may be used is not tested",
    "caution": "use the {} with caution",
    "not satisfied": "do not rely on the {}",
}
_FEW = f"fewer than {FEWEST} runs that differ"
_BRIEFLY = f"for at most {100 * BROKEN:g} % of the time in motion"
# topic: the criterion of each of `GRADES`
CRITERIA: Mapping[str, Mapping[Grade, str]] = {
    topic: dict(zip(GRADES, criteria, strict=True))
    for topic, criteria in {
        "overturning": (
            f"no run overturns, nor any scale up to {NEAR:g} times this shaking",
            "no run overturns, but no other scales of this shaking were run",
            f"at most {100 * UNSAFE:g} % of a group overturn, or a scale below {NEAR:g} does",
            f"the case as given overturns, or more than {100 * UNSAFE:g} % of a group",
        ),
        "friction": (
            "the friction given suffices in 95 % of all runs",
            _FEW,
            f"not given, or too little {_BRIEFLY}",
            "too little for longer, or below b/h: it slides before it uplifts",
        ),
        "contact": (
            "never lost in 95 % of all runs",
            _FEW,
            f"lost {_BRIEFLY}",
            "lost for longer: the models do not know flight",
        ),
        "trace": (
            "the largest tilt comes before two methods, or the copies, diverge",
            "the copies are all one run",
            "the largest tilt comes after methods or copies diverge: trust statistics",
            "the run failed",
        ),
        "intensity": (
            f"12 % more or less shaking changes the tilt by less than {SENSITIVE:g} times",
            "no other scales of this shaking were run",
            f"12 % more or less shaking changes the tilt by {SENSITIVE:g} times, or overturns",
            "never: the percentiles say it",
        ),
        "engine": (
            "agrees with the model as long as predicted, and to the same end",
            f"not run, failed, agrees {BEATEN:g} times as long as predicted, or hardly any motion",
            "comes to another end, or stays at rest where the model moves",
            "diverges earlier than half of what is predicted",
        ),
    }.items()
}
_GROUPS = {
    "copies": "copies, {} off",
    "acceleration": "records, same PGA",
    "velocity": "records, same PGV",
}
_DEMANDS = {
    "friction": "friction",
    "shear": "shear at the base",
    "top_friction": "friction under the slab",
    "top_shear": "shear under the slab",
    "moment": "moment about the vertical",
    "wall_force": "its force on a wall",
}
_UNITS = {"-": "", "weights": " weights", "weights × b": " weights × b"}
_ENDS = {
    "methods": "reduced model and engine diverge",
    "data": "copies are spread over half of the peak tilt",
}
_PREDICTED = {
    "": "nothing ends it before",
    "pass": "a pass comes closer to upright than contact resolves",
    "growth": "near-upright passes have multiplied the error of an engine's step",
    "model form": "the reduced models of the two supports diverge",
}
_DIVERGENCE = {
    "never, as predicted": "as predicted",
    "in time": "as predicted",
    "later": "longer than predicted",
    "much later": "more than ten times as long as predicted, which tests nothing",
    "too little motion": "the model's tilt hardly changes, which tests nothing",
    "earlier": "less than half as long as predicted: rely on neither before you know why",
}
Row = dict[str, object]


def page_of(found: Advice) -> Page:
    """Return the page of an advice."""
    drawn = list(pictures(found))
    facts, grades = found.facts, found.grades
    values = {
        **facts,
        "found": found,
        "about": found.manifest,
        "drawn": bool(drawn),
        "verdict": _verdict(found),
        "meanings": [CODES[code][1] for code in found.response["diagnostics"]],
        "criteria": [
            {"topic": topic, "grade": grade, "criterion": CRITERIA[topic][grade], **CRITERIA[topic]}
            for topic, grade in grades.items()
        ],
        "grades": grades,
        "runs": list(_runs(found)),
        "demanded": list(_demanded(found)),
        "groups": [{**row, "name": _GROUPS[row["group"]].format(_off(found))} for row in _groups(found)],
        "checks": list(_checks(found)),
        "shares": planar_shares(found.planar) if len(found.planar) else [],
        "loss": 1.0 - restitution_from_momentum(found.cylinder),
        "holds": support_named(facts["support"]),
        "slips": found.groups["slip_95"].max() if len(found.groups) else math.nan,
        "lost": found.groups["lost_95"].max() if len(found.groups) else math.nan,
    }
    return Page(name="advice", template="advice", values=values, pictures=drawn)


def _verdict(found: Advice) -> str:
    if found.response["outcome"] == "failed":
        return f"no advice, the {found.facts['model']} failed"
    if not found.moves:
        return "the cylinder stays at rest"
    stands = "it overturns as given" if found.overturned else _STANDS[found.grades["overturning"]]
    return f"{stands}; {_USE[found.model_grade].format(found.facts['model'])}"


def _groups(found: Advice) -> list[dict[str, Any]]:
    return [{str(name): value for name, value in row.items()} for row in found.groups.to_dict("records")]


def _off(found: Advice) -> str:
    return number(found.facts["perturbation"], "percent")


def _demands(found: Advice) -> dict[str, float]:
    return dict(zip(found.demands["demand"], found.demands["value"], strict=True))


def _runs(found: Advice) -> Iterator[Row]:
    """Rows of the three numbers: as given, and the median and 95th percentile of each group."""
    alpha = math.degrees(found.cylinder.alpha)
    given = math.inf if found.overturned else found.peak
    yield {
        "name": "as given",
        "tilt_50": alpha * given,
        "top_50": found.top(given),
        "overturned": "yes" if found.overturned else "no",
    }
    for row in _groups(found):
        low, high = (number(100.0 * row[f"chance_{end}"], ".2g") for end in ("low", "high"))
        chance = f"{number(row['chance'], 'percent')} ({low} to {high} %)"
        yield {
            "name": _GROUPS[row["group"]].format(_off(found)),
            **{f"tilt_{share}": alpha * row[f"peak_tilt_{share}"] for share in ("50", "95")},
            **{f"top_{share}": found.top(row[f"peak_tilt_{share}"]) for share in ("50", "95")},
            "overturned": f"{row['overturned']} of {row['runs'] - row['failed']}",
            "chance": "one run" if math.isnan(row["chance"]) else chance,
        }


def _demanded(found: Advice) -> Iterator[Row]:
    """Rows of the design demands, as a designer enters them."""
    values = _demands(found)
    for row in found.demands.to_dict("records"):
        if row["demand"] not in _DEMANDS:
            continue
        kilo = " kNm" if row["unit"].endswith("b") else " kN"
        yield {
            "name": _DEMANDS[row["demand"]],
            "value": number(row["value"]) + _UNITS[row["unit"]],
            "per_tonne": number(row["per_tonne"]) + kilo if row["per_tonne"] == row["per_tonne"] else "",
        }
    if "clearance" in values:
        tilt = number(math.degrees(values["tilt"] * found.cylinder.alpha))
        yield {
            "name": f"wall height, tilt {tilt}°",
            "value": _millimetres(values["wall_height"]),
            "per_tonne": "",
        }
        yield {"name": "wall clearance", "value": _millimetres(values["clearance"]), "per_tonne": ""}


def _millimetres(length: float) -> str:
    return f"{number(1e3 * length)} mm"


def _checks(found: Advice) -> Iterator[Row]:
    """Rows of what the grades rest on: name, value and reason."""
    facts, response, trust, engine = found.facts, found.response, found.trust, found.verification
    if not found.moves:
        return

    def row(name: str, value: object, reason: str = "", form: str = ".4g", unit: str = "") -> Row:
        return {"name": name, "value": number(value, form) + unit, "reason": reason}

    end = "fall" if found.overturned else "largest tilt"
    copies = found.members[(found.members["group"] == "copies") & (found.members["outcome"] != "failed")]
    if response["uplift_time"] > 0.0:
        yield row("uplift", response["uplift_time"], unit=" s")
    below = f"{number((copies['peak_tilt'] < found.peak).mean(), 'percent')} of the copies tilt less"
    yield row(end, response["peak_time"], below if found.copies_differ else "", unit=" s")
    if trust.kind == "trace":
        yield row("the trace can be trusted until", "its end")
    else:
        yield row("the trace can be trusted until", trust.until, f"then {_ENDS[trust.because]}", unit=" s")
    reason = facts["prediction"]["reason"]
    tight = number(AGREEMENT) if response["tolerance"] >= AGREEMENT else number(response["tolerance"])
    until = response["uplift_time"] + facts["prediction"]["length"] if reason else "the end"
    name = f"model and engine agree within {tight} α, predicted, until"
    yield row(name, until, _PREDICTED[reason], unit=" s" if reason else "")
    if engine is not None:
        method = f"{engine.label} {engine.version}, step {number(engine.time_step)} s, agrees until"
        if engine.outcome == "failed":
            yield row(method, "failed", "; ".join(CODES[code][1] for code in parted(engine.diagnostics)))
        else:
            reached = f"{number(engine.agreed_until, '.4g')} s" if engine.diverged else "the end"
            tilt = f"largest tilt {number(engine.peak_tilt)} α" if engine.moves else "it stays at rest"
            tilt = "it overturns" if engine.outcome == "overturned" else tilt
            yield row(method, reached, f"{_DIVERGENCE.get(engine.divergence, engine.divergence)}; {tilt}")
    yield from _scaled(found, row)
    other = "flat" if support_named(facts["support"]).compared_with[-1] == "recess" else "recess"
    for name, ratios in ((support_named(other).words, facts["other_support"]), ("", facts["vertical"])):
        if ratios is not None:
            of = f"of {ratios['count']} copies {ratios['higher']} tilt more, {ratios['lower']} less"
            if ratios["overturned"] or ratios["against_overturned"]:
                of += f"; {ratios['overturned']} of {ratios['members']} overturn, "
                of += (
                    f"{ratios['against_overturned']} without"
                    if not name
                    else f"{ratios['against_overturned']} here"
                )
            if ratios["ratio"] == ratios["ratio"]:
                of = f"{number(ratios['low'])} to {number(ratios['high'])} (95 %); {of}"
            under = "" if name or ratios["given"] else f" ({ratios['record']} as strong)"
            label = (
                f"tilt in {name} over that here"
                if name == "ideal recess"
                else f"tilt on {name} over that here"
            )
            yield row(
                label if name else f"tilt with vertical shaking over that without{under}",
                ratios["ratio"],
                of,
                ".3g",
            )
    spiked = response["largest_normal_force"]
    if len(found.groups) and spiked > found.groups["force_95"].max():
        yield row("largest normal force as given", spiked, _spike(), ".3g", " weights")


def _spike() -> str:
    return (
        f"for less than {number(SPIKES, 'percent')} of its time: rigid contact near upright, no design load"
    )


def _scaled(found: Advice, row: Any) -> Iterator[Row]:
    """Rows of other scales of the ground motion."""
    low, high = found.beside
    if low == low and not found.overturned:
        reason = "∞: it overturns" if math.isinf(high) else ""
        yield row("largest tilt for 12 % more or less shaking", f"{number(low)} to {number(high)} α", reason)
    for each in found.lowest.to_dict("records"):
        if each["series"] != SPATIAL:
            continue
        tested = f"up to {number(found.scales['factor'].max())} times; gaps may lie between the scales run"
        if each["factor"] != each["factor"]:
            yield row("lowest scale found to overturn", "none", tested)
            continue
        reasons = (
            ["below 1: as given it stands in a gap"] if each["factor"] < 1.0 and not found.overturned else []
        )
        if not each["confirmed"]:
            reasons += [
                f"by chance: it stands at a tolerance of {number(CHECK_RTOL)} or nudged by {number(NUDGE)}"
            ]
        yield row("lowest scale found to overturn", each["factor"], "; ".join(reasons), ".3g")
    planes = (
        found.lowest[found.lowest["series"].isin([PLANAR_X, PLANAR_Y])] if len(found.lowest) else found.lowest
    )
    if len(planes) and planes["factor"].notna().any():
        yield row("the same by planar analysis of each component", planes["factor"].min(), form=".3g")
