"""Values for the page of an advice: its sentences are in the template advice.md.j2."""

from __future__ import annotations

import math
from collections.abc import Hashable, Iterator, Mapping
from typing import Any

from rockwobble.compare.comparison.prediction import BEATEN, UNTESTED
from rockwobble.compare.metrics.statistics import FEWEST
from rockwobble.compare.studies.advice.advice import Advice
from rockwobble.compare.studies.advice.grades import BROKEN, NEAR, SENSITIVE, UNSAFE
from rockwobble.compare.studies.advice.members import COPIES, SPIKES
from rockwobble.compare.studies.advice.scales import planar_shares
from rockwobble.compare.studies.advice.trust import Verification
from rockwobble.compare.studies.spectrum.maps import PLANAR_X, PLANAR_Y, SPATIAL
from rockwobble.compare.studies.spectrum.study import CHECK_RTOL, NUDGE
from rockwobble.models import AGREEMENT
from rockwobble.models.diagnostic import CODES, parted
from rockwobble.models.support import support_named
from rockwobble.models.trace import NO_PEAK
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
# heading of the row: demand at the base, and under the slab
_DEMANDS = {
    "friction": ("friction", "top_friction"),
    "shear": ("shear", "top_shear"),
    "moment about the vertical": ("moment", ""),
    "force of that moment on a wall": ("wall_force", ""),
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

_NO_PEAK = {"failed": "failed", "undecided": "is undecided"}  # of a run without a peak


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
        "failed": found.response["outcome"] in NO_PEAK,
        "meanings": [CODES[code][1] for code in found.response["diagnostics"]],
        "grades": grades,
        "numbers": _numbers(found),
        "limits": {
            **{"near": NEAR, "unsafe": UNSAFE, "broken": BROKEN, "sensitive": SENSITIVE, "beaten": BEATEN},
            "fewest": FEWEST,
        },
        "demanded": list(_demanded(found)),
        "groups": _groups(found),
        "headings": {row["group"]: row["name"] for row in _groups(found)},
        "checks": list(_checks(found)),
        "shares": planar_shares(found.planar) if len(found.planar) else [],
        "loss": 1.0 - restitution_from_momentum(found.cylinder),
        "holds": support_named(facts["support"]),
        "reasons": _reasons(found) if grades else {},
        **dict(zip(("slips", "lost"), found.missing, strict=True)),
    }
    return Page(name="advice", template="advice", values=values, pictures=drawn)


def _reasons(found: Advice) -> dict[str, str]:
    """What the grade of each topic rests on in this case."""
    if found.response["outcome"] in NO_PEAK:
        return {"trace": f"the run {_NO_PEAK[found.response['outcome']]}"}
    slip, lost = found.missing
    few = f"fewer than {FEWEST} runs differ"
    contact = "never lost in 95 % of all runs" if found.grades["contact"] == "satisfied" else few
    if lost > 0.0:
        contact = f"lost for {number(lost, 'percent')} of the time in motion"
    return {
        "overturning": _reason_of_overturning(found),
        "friction": _reason_of_friction(found, slip, few),
        "contact": contact,
        "trace": _reason_of_trace(found),
        "intensity": _reason_of_intensity(found),
        "engine": _reason_of_engine(found),
    }


def _reason_of_overturning(found: Advice) -> str:
    if found.overturned:
        return "it overturns as given"
    grade, lowest = found.grades["overturning"], found.lowest_factor
    chance, name = max(
        ((row["chance"], row["name"]) for row in _groups(found) if row["chance"] > 0.0), default=(0.0, "")
    )
    reasons = [f"of {name}, {number(chance, 'percent')} overturn"] if chance else []
    if grade == "not satisfied":
        return reasons[0]
    if grade == "caution":
        near = [f"{number(lowest)} times this shaking overturns it"] if lowest < NEAR else []
        return "; ".join([*reasons, *near])
    if found.facts["motion"] is None:
        return "no copy overturns" if grade == "satisfied" else "the copies are all one run"
    if not len(found.lowest):
        return "no run overturns, but no other scales of this shaking were run"
    if math.isnan(lowest):
        return f"no run overturns, nor up to {number(found.scales['factor'].max())} times this shaking"
    return f"no run overturns; the lowest scale found to is {number(lowest)}"


def _reason_of_friction(found: Advice, slip: float, few: str) -> str:
    given, grade = found.facts["friction"], found.grades["friction"]
    if given is None:
        demand = found.demands.set_index("demand")["value"].get("friction", math.nan)
        return "not given" if math.isnan(demand) else f"not given, the demand is {number(demand)}"
    if given < found.cylinder.tan_alpha and found.response["uplift_time"] > 0.0:
        return (
            f"{number(given)} is below b/h = {number(found.cylinder.tan_alpha)}: it slides before it uplifts"
        )
    if slip > 0.0:
        return f"{number(given)} is too little for {number(slip, 'percent')} of the time in motion"
    return f"{number(given)} suffices in 95 % of all runs" if grade == "satisfied" else few


def _reason_of_trace(found: Advice) -> str:
    trust, engine = found.trust, found.verification
    if not found.copies_differ and trust.kind != "statistics":
        return "the copies are all one run"
    ran = engine is not None and engine.outcome not in NO_PEAK
    if trust.kind == "trace":
        return f"{'model, engine' if ran else 'model'} and copies agree to the end"
    ends = "the engine diverges" if ran else "engines should diverge"
    if trust.because == "data":
        ends = "the copies diverge"
    reason = f"largest tilt at {number(found.response['peak_time'])} s, {ends} at {number(trust.until)} s"
    return f"{reason}: trust statistics" if trust.kind == "statistics" else reason


def _reason_of_intensity(found: Advice) -> str:
    low, high = found.beside
    if math.isnan(low):
        return "no other scales of this shaking were run"
    off = "12 % more or less shaking"
    if math.isinf(high):
        return f"{off} overturns it"
    if low == 0.0:
        return f"{off} leaves it at rest"
    return f"{off} changes the tilt by {number(max(high / found.peak, found.peak / low))} times"


def _reason_of_engine(found: Advice) -> str:
    engine = found.verification
    if engine is None:
        return "not run"
    if engine.outcome in NO_PEAK:
        return f"it {_NO_PEAK[engine.outcome]}: {_failure(engine)}"
    agrees = f"agrees until {_agreed_until(engine)}, predicted until {_predicted_until(found)}"
    if engine.divergence == "earlier":
        return f"{agrees}: less than half as long"
    if not engine.moves:
        return "it stays at rest, the model moves"
    if (engine.outcome == "overturned") != found.overturned:
        return "it stands, the model overturns" if found.overturned else "it overturns, the model stands"
    if engine.divergence == "too little motion":
        return "the model's tilt hardly changes, which tests nothing"
    return f"{agrees}, which tests nothing" if engine.divergence in UNTESTED else agrees


def _groups(found: Advice) -> list[dict[str, Any]]:
    off = number(found.facts["perturbation"], "percent")
    named = found.groups.assign(name=[_GROUPS[group].format(off) for group in found.groups.get("group", [])])
    return [{str(key): value for key, value in row.items()} for row in named.to_dict("records")]


def _numbers(found: Advice) -> list[Row]:
    """Rows of the three numbers: as given, and what 95 % of each group do not exceed."""
    alpha = math.degrees(found.cylinder.alpha)
    part = "slab" if "columns" in found.facts["cylinder"] else "top"
    tilt: Row = {"name": "largest tilt, 95 % of runs [°]"}
    top: Row = {"name": f"{part} displacement, 95 % [m]"}
    chance: Row = {"name": "overturning probability (95 %)"}
    given = math.inf if found.overturned else found.peak
    for group, peak in [("given", given), *((row["group"], row["peak_tilt_95"]) for row in _groups(found))]:
        tilt[group] = "overturns" if math.isinf(peak) else number(alpha * peak)
        top[group] = "overturns" if math.isinf(peak) else number(found.top(peak))
    chance["given"] = "overturns" if found.overturned else "stands"
    for row in _groups(found):
        low, high = (number(row[f"chance_{end}"], "percent").removesuffix(" %") for end in ("low", "high"))
        share = f"{number(row['chance'], 'percent')} ({low} to {high} %)"
        chance[row["group"]] = "one run" if math.isnan(row["chance"]) else share
    return [tilt, top, chance]


def _demanded(found: Advice) -> Iterator[Row]:
    """Rows of the design demands, as a designer enters them."""
    values = {row["demand"]: row for row in found.demands.to_dict("records")}
    for name, places in _DEMANDS.items():
        cells = {
            place: _demand(demand, values[demand])
            for place, demand in zip(("base", "slab"), places, strict=True)
            if demand in values
        }
        if cells:
            yield {"name": name, "slab": "", **cells}
    if "clearance" in values:
        height, clearance = (number(1e3 * values[part]["value"]) for part in ("wall_height", "clearance"))
        tilt = number(math.degrees(values["tilt"]["value"] * found.cylinder.alpha))
        yield {
            "name": f"wall, for a tilt of {tilt}°",
            "base": f"height {height} mm, clearance {clearance} mm",
        }


def _demand(name: str, row: Mapping[Hashable, Any]) -> str:
    """A demand in weights, and per tonne that is carried."""
    value = number(row["value"]) + ("" if row["unit"] == "-" else f" {row['unit']}")
    unit = "kNm" if name == "moment" else "kN"
    return value if math.isnan(row["per_tonne"]) else f"{value} = {number(row['per_tonne'])} {unit}/t"


def _checks(found: Advice) -> Iterator[Row]:
    """Rows of what the grades rest on."""
    if not found.moves:
        return
    response, groups, copies = found.response, found.groups, found.members
    copies = copies[(copies["group"] == COPIES) & (~copies["outcome"].isin(NO_PEAK))]
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
    trust, engine = found.trust, found.verification
    until, note = "its end", ""
    if trust.kind != "trace":
        until, note = f"{number(trust.until, '.4g')} s", f"then {_ENDS[trust.because]}"
    yield _check("the trace can be trusted until", until, note)
    tolerance = min(AGREEMENT, found.response["tolerance"])
    name = f"model and engine agree within {number(tolerance)} α, predicted, until"
    yield _check(name, _predicted_until(found), _PREDICTED[found.facts["prediction"]["reason"]])
    if engine is None:
        return
    method = f"{engine.label} {engine.version}, step {number(engine.time_step)} s, agrees until"
    if engine.outcome in NO_PEAK:
        yield _check(method, engine.outcome, _failure(engine))
        return
    tilt = f"largest tilt {number(engine.peak_tilt)} α" if engine.moves else "it stays at rest"
    tilt = "it overturns" if engine.outcome == "overturned" else tilt
    yield _check(method, _agreed_until(engine), f"{_DIVERGENCE[engine.divergence]}; {tilt}")


def _predicted_until(found: Advice) -> str:
    prediction = found.facts["prediction"]
    end = found.response["uplift_time"] + prediction["length"]
    return f"{number(end, '.4g')} s" if prediction["reason"] else "the end"


def _agreed_until(engine: Verification) -> str:
    return f"{number(engine.agreed_until, '.4g')} s" if engine.diverged else "the end"


def _failure(engine: Verification) -> str:
    return "; ".join(CODES[code][1] for code in parted(engine.diagnostics))


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
