"""Values for the page of an advice: its sentences are in the template advice.md.j2."""

from __future__ import annotations

import math
from collections.abc import Iterator
from typing import Any

from rockwobble.compare.comparison.prediction import BEATEN
from rockwobble.compare.metrics.statistics import FEWEST
from rockwobble.compare.studies.advice.advice import Advice
from rockwobble.compare.studies.advice.grades import BROKEN, GRADES, NEAR, SENSITIVE, UNSAFE
from rockwobble.compare.studies.advice.members import COPIES, SPIKES
from rockwobble.compare.studies.advice.scales import planar_shares
from rockwobble.compare.studies.spectrum.maps import PLANAR_X, PLANAR_Y, SPATIAL
from rockwobble.compare.studies.spectrum.study import CHECK_RTOL, NUDGE
from rockwobble.models import AGREEMENT
from rockwobble.models.diagnostic import CODES, parted
from rockwobble.models.support import support_named
from rockwobble.multibody import DEFAULT_ENGINE
from rockwobble.reduced.body import restitution_from_momentum

from ..figures.advice import pictures
from .page import Page
from .table import number

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
        "engine": DEFAULT_ENGINE,
        "failed": found.response["outcome"] == "failed",
        "meanings": [CODES[code][1] for code in found.response["diagnostics"]],
        "grades": grades,
        "every_grade": GRADES,
        "limits": {
            **{"near": NEAR, "unsafe": UNSAFE, "broken": BROKEN, "sensitive": SENSITIVE, "beaten": BEATEN},
            "fewest": FEWEST,
        },
        "runs": list(_runs(found)),
        "demanded": list(_demanded(found)),
        "groups": _groups(found),
        "checks": list(_checks(found)),
        "shares": planar_shares(found.planar) if len(found.planar) else [],
        "loss": 1.0 - restitution_from_momentum(found.cylinder),
        "holds": support_named(facts["support"]),
        "slips": found.groups["slip_95"].max() if len(found.groups) else math.nan,
        "lost": found.groups["lost_95"].max() if len(found.groups) else math.nan,
    }
    return Page(name="advice", template="advice", values=values, pictures=drawn)


def _groups(found: Advice) -> list[dict[str, Any]]:
    off = number(found.facts["perturbation"], "percent")
    named = found.groups.assign(name=[_GROUPS[group].format(off) for group in found.groups.get("group", [])])
    return [{str(key): value for key, value in row.items()} for row in named.to_dict("records")]


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
            "name": row["name"],
            **{f"tilt_{share}": alpha * row[f"peak_tilt_{share}"] for share in ("50", "95")},
            **{f"top_{share}": found.top(row[f"peak_tilt_{share}"]) for share in ("50", "95")},
            "overturned": f"{row['overturned']} of {row['runs'] - row['failed']}",
            "chance": "one run" if math.isnan(row["chance"]) else chance,
        }


def _demanded(found: Advice) -> Iterator[Row]:
    """Rows of the design demands, as a designer enters them."""
    values = dict(zip(found.demands["demand"], found.demands["value"], strict=True))
    for row in found.demands.to_dict("records"):
        name, unit, tonne = row["demand"], row["unit"], row["per_tonne"]
        if name in _DEMANDS:
            kilo = "" if math.isnan(tonne) else f"{number(tonne)} {'kNm' if name == 'moment' else 'kN'}"
            value = number(row["value"]) + ("" if unit == "-" else f" {unit}")
            yield {"name": _DEMANDS[name], "value": value, "per_tonne": kilo}
    if "clearance" in values:
        tilt = number(math.degrees(values["tilt"] * found.cylinder.alpha))
        for name, part in ((f"wall height, tilt {tilt}°", "wall_height"), ("wall clearance", "clearance")):
            yield {"name": name, "value": f"{number(1e3 * values[part])} mm", "per_tonne": ""}


def _checks(found: Advice) -> Iterator[Row]:
    """Rows of what the grades rest on."""
    if not found.moves:
        return
    response, groups, copies = found.response, found.groups, found.members
    copies = copies[(copies["group"] == COPIES) & (copies["outcome"] != "failed")]
    if response["uplift_time"] > 0.0:
        yield _check("uplift", f"{number(response['uplift_time'], '.4g')} s")
    below = f"{number((copies['peak_tilt'] < found.peak).mean(), 'percent')} of the copies tilt less"
    name = "fall" if found.overturned else "largest tilt"
    yield _check(name, f"{number(response['peak_time'], '.4g')} s", below if found.copies_differ else "")
    yield from _agreement(found)
    yield from _scales(found)
    yield from _ratios(found)
    spike = response["largest_normal_force"]
    if len(groups) and spike > groups["force_95"].max():
        briefly = f"for less than {number(SPIKES, 'percent')} of its time: rigid contact, no design load"
        yield _check("largest normal force as given", f"{number(spike)} weights", briefly)


def _check(name: str, value: str, note: str = "") -> Row:
    return {"name": name, "value": value, "note": note}


def _agreement(found: Advice) -> Iterator[Row]:
    trust, prediction, engine = found.trust, found.facts["prediction"], found.verification
    until, note = "its end", ""
    if trust.kind != "trace":
        until, note = f"{number(trust.until, '.4g')} s", f"then {_ENDS[trust.because]}"
    yield _check("the trace can be trusted until", until, note)
    reason, tolerance = prediction["reason"], min(AGREEMENT, found.response["tolerance"])
    end = found.response["uplift_time"] + prediction["length"]
    until = f"{number(end, '.4g')} s" if reason else "the end"
    name = f"model and engine agree within {number(tolerance)} α, predicted, until"
    yield _check(name, until, _PREDICTED[reason])
    if engine is None:
        return
    method = f"{engine.label} {engine.version}, step {number(engine.time_step)} s, agrees until"
    if engine.outcome == "failed":
        failure = "; ".join(CODES[code][1] for code in parted(engine.diagnostics))
        yield _check(method, "failed", failure)
        return
    until = f"{number(engine.agreed_until, '.4g')} s" if engine.diverged else "the end"
    tilt = f"largest tilt {number(engine.peak_tilt)} α" if engine.moves else "it stays at rest"
    tilt = "it overturns" if engine.outcome == "overturned" else tilt
    yield _check(method, until, f"{_DIVERGENCE[engine.divergence]}; {tilt}")


def _scales(found: Advice) -> Iterator[Row]:
    low, high = found.beside
    if not math.isnan(low) and not found.overturned:
        span = f"{number(low)} to {number(high)} α"
        yield _check(
            "largest tilt for 12 % more or less shaking", span, "∞: overturns" if math.isinf(high) else ""
        )
    lowest = found.lowest.set_index("series")
    if not len(lowest):
        return
    name, factor, notes = "lowest scale found to overturn", found.lowest_factor, []
    if math.isnan(factor):
        notes = [f"up to {number(found.scales['factor'].max())} times; gaps may lie between the scales run"]
    elif not lowest["confirmed"][SPATIAL]:
        notes = [
            f"by chance: it stands at a tolerance of {number(CHECK_RTOL)} or perturbed by {number(NUDGE)}"
        ]
    if factor < 1.0 and not found.overturned:
        notes = ["as given it stands in a gap", *notes]
    yield _check(name, "none" if math.isnan(factor) else number(factor), "; ".join(notes))
    planar = float(lowest["factor"].reindex([PLANAR_X, PLANAR_Y]).min())
    if not math.isnan(planar):
        yield _check("the same by planar analysis of each component", number(planar))


def _ratios(found: Advice) -> Iterator[Row]:
    """Rows of the largest tilts of copies by one of two ways over those by the other."""
    facts, vertical = found.facts, found.facts["vertical"]
    holds = support_named(facts["support"])
    place = "on flat ground" if holds.guided or holds.walls else "in an ideal recess"
    other = f"tilt {place} over that here"
    shaken = "tilt with vertical shaking over that without"
    if vertical and not vertical["given"]:
        shaken += f" ({vertical['record']} as strong)"
    for name, ratios in ((other, facts["other_support"]), (shaken, vertical)):
        if ratios is None:
            continue
        note = f"of {ratios['count']} copies {ratios['higher']} tilt more, {ratios['lower']} less"
        if not math.isnan(ratios["ratio"]):
            note = f"{number(ratios['low'])} to {number(ratios['high'])} (95 %); {note}"
        fell = ratios["overturned"], ratios["against_overturned"]
        note += f"; {fell[0]} of {ratios['members']} overturn, {fell[1]} otherwise" if any(fell) else ""
        yield _check(name, number(ratios["ratio"]), note)
