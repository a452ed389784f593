"""Values for the page of an advice; the lines on its case are those of `advised_case`."""

from __future__ import annotations

import math
from collections.abc import Hashable, Iterator, Mapping
from typing import Any

from rockwobble.compare.comparison.prediction import UNTESTED
from rockwobble.compare.metrics.statistics import FEWEST
from rockwobble.models import AGREEMENT, CLOSED_TILT
from rockwobble.models.diagnostic import CODES, codes_in
from rockwobble.models.records import p695
from rockwobble.models.support import FLAT, RECESS, RING, support_named
from rockwobble.models.trace import NO_PEAK
from rockwobble.multibody import DEFAULT_ENGINE
from rockwobble.studies.advice.advice import Advice
from rockwobble.studies.advice.demands import SPIKES
from rockwobble.studies.advice.grades import CRITERIA, NEAR
from rockwobble.studies.advice.members import ACCELERATION, COPIES, HORIZONTAL, VELOCITY, VERTICAL
from rockwobble.studies.advice.scales import planar_shares
from rockwobble.studies.advice.trust import Verification, scatter_of
from rockwobble.studies.spectrum.parts import PLANAR_X, PLANAR_Y, SPATIAL
from rockwobble.studies.spectrum.verification import CHECK_RTOL, NUDGE

from ..figures.advice import pictures
from .advised_case import (
    STRONG,
    assumptions,
    cautions,
    no_planar_analysis,
    opening,
    other_record_lines,
    planar_words,
    problem_lines,
    vertical_words,
    wall_lines,
    weaker_mark,
    weaker_words,
    weight_words,
)
from .command_line import command_line, spectrum_line
from .page import Page
from .table import NONE, number, scattered

# rows of the box of demands
_DEMANDS = {
    "friction": "friction demand",
    "shear": "shear V",
    "force": "normal force N",
    "moment": "vertical moment M",
    "wall_force": "wall force M/b",
    "shear_and_wall": "V + M/b at once",
    "top_friction": "friction, top",
    "top_shear": "shear, top",
    "top_force": "normal force, top",
    "tendon": "tendon force, W: a column alone",
}
# units of a table, and in the box, where W is the weight that its head names
_UNITS = {"-": "", "weights": " W", "weights × b": " W b"}
_ACTING = {"shear": ("V", " W"), "force": ("N", " W"), "moment": ("M", " W b")}
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
    "much later": "inconclusive, more than ten times as long as predicted",
    "too little motion": "inconclusive, until then the model's tilt hardly changes",
    "earlier": "less than half as long as predicted: rely on neither before you know why",
}
# options of an advice that other commands do not have
PLAN = ("mass", "copies", "perturbation", "seed")
# share of a demand below which what acts beside another is none
_NOTHING = 1e-3
_YIELDS = "tendon yields"
Row = dict[str, object]

_NO_PEAK = {"failed": "failed", "undecided": "is undecided"}  # of a run without a peak


def page_of(found: Advice) -> Page:
    """Return the page of an advice."""
    drawn = list(pictures(found))
    facts, grades = found.facts, found.grades
    reasons = _reasons(found) if grades else {}
    frame, holds = "columns" in facts["cylinder"], support_named(facts["support"])
    values = {
        "title": f"{facts['case']}: {found.verdict}",
        "about": found.manifest,
        "moves": found.moves,
        "drawn": [picture.name for picture in drawn],
        "opening": list(opening(found)),
        "problem_lines": list(problem_lines(found)),
        "cautions": list(cautions(found)),
        "compared": _comparison_words(found),
        # what matters stands in the opening
        "vertical": "" if found.vertical_matters else vertical_words(found),
        "criteria": [
            {"topic": topic, "grade": grade, "reason": reasons[topic], **CRITERIA[topic].by_grade()}
            for topic, grade in grades.items()
        ],
        "part": "slab" if frame else "top",
        "numbers": list(_numbers(found)),
        "place": "recess" if holds.is_recess else "ground",
        "weight": weight_words(found),
        "demanded": list(_demand_rows(found)),
        "demand_columns": list(_demand_columns(found)),
        "together": _together(found),
        "wall": _wall(found),
        "weaker": weaker_words(found),
        "weaker_mark": weaker_mark(found),
        "steps": _steps(found),
        "groups": _groups(found),
        "perturbation": facts["perturbation"],
        "seed": facts["seed"],
        "record_lines": list(other_record_lines(found)),
        "closed": CLOSED_TILT,
        "wall_lines": list(wall_lines(found)),
        "checks": list(_checks(found)),
        "in_one_plane": planar_words(found),
        "shares": planar_shares(found.planar) if len(found.planar) and not found.yielded else [],
        "no_planar_analysis": no_planar_analysis(found),
        "assumptions": list(assumptions(found)),
    }
    return Page(name="advice", template="advice", values=values, pictures=drawn)


def _reasons(found: Advice) -> dict[str, str]:
    """What the grade of each topic rests on in this case."""
    if found.response["outcome"] in NO_PEAK:
        return {"trace": f"the run {_NO_PEAK[found.response['outcome']]}"}
    if not found.moves:
        return {"friction": _reason_at_rest(found)}
    slip, lost = found.missing
    few = f"fewer than {FEWEST} runs differ"
    if found.yielded:
        few = f"the tendon yields in {found.yielded} runs"
    contact = "never lost in 95 % of all runs" if found.grades["contact"] == "satisfied" else few
    if lost > 0.0:
        contact = f"lost for {number(lost, 'percent')} of the time in motion"
    return {
        "overturning": _reason_of_overturning(found),
        "friction": _reason_of_friction(found, slip, few),
        "contact": contact,
        "tendon": _reason_of_tendon(found),
        "trace": _reason_of_trace(found),
        "intensity": _reason_of_intensity(found),
        "engine": _reason_of_engine(found),
    }


def _reason_of_overturning(found: Advice) -> str:
    if found.overturned:
        return "it overturns as given"
    if found.yields:
        return "the tendon yields as given"
    grade, lowest = found.grades["overturning"], found.lowest_factor
    fell = [row for row in _groups(found) if row["counts"] and row["chance"] > 0.0]
    worst = max(fell, key=lambda row: float(row["chance"]), default=None)
    reasons = [f"{worst['overturned']} of {worst['name']} overturn"] if worst else []
    if grade == "not satisfied":
        return reasons[0]
    if grade == "caution":
        near = [f"{number(lowest)} times this shaking overturns it"] if lowest < NEAR else []
        return "; ".join([*reasons, *near])
    if found.yielded:
        return f"the tendon yields in {found.yielded} of {int(found.counting['runs'].sum())} runs"
    if found.yields_from < NEAR:
        return f"the tendon yields at {number(found.yields_from)} times this shaking"
    if found.facts["motion"] is None:
        return "no copy overturns" if grade == "satisfied" else "the copies are all one run"
    if not len(found.lowest):
        return "no run overturns, but no other scales of this shaking were run"
    if math.isnan(lowest) and not math.isnan(found.yields_from):
        return f"no run overturns; at {number(found.yields_from)} times this shaking the tendon yields"
    if math.isnan(lowest):
        return f"no run overturns, nor up to {number(found.scales['factor'].max())} times this shaking"
    return f"no run overturns; {number(lowest)} times this shaking does"


def _reason_at_rest(found: Advice) -> str:
    demand = number(found.facts["motion"]["friction_at_rest"])
    return f"{number(found.facts['friction'])} is below the demand at rest, {demand}: it slides"


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


def _reason_of_tendon(found: Advice) -> str:
    tendon = found.facts.get("tendon")
    if tendon is None:
        return ""
    largest, limit = f"{number(found.largest_tension)} weights of a column", tendon["yield_force"]
    if stress := tendon.get("unit_stress"):
        largest += f" = {number(stress * found.largest_tension, '.4g')} MPa"
    if limit is None:
        return f"no yield force was given, the demand is {largest}"
    over = "above" if found.grades["tendon"] == "not satisfied" else "below"
    return f"the demand, {largest}, is {over} its yield at {number(limit)}"


def _ratios_of_tendon(found: Advice) -> dict[str, str]:
    """Options that state the tendon by ratios, whichever the user gave."""
    tendon = found.facts.get("tendon") or {}
    return {f"tendon_{name}": f"{tendon[name]:.6g}" for name in ("prestress", "stiffness") if name in tendon}


def _reason_of_trace(found: Advice) -> str:
    trust, verification = found.trust, found.verification
    if found.yields:
        return "the tendon yields: what comes after is not modelled"
    if not found.copies_differ and trust.kind != "statistics":
        return "the copies are all one run"
    ran = verification is not None and verification.outcome not in NO_PEAK
    if trust.kind == "trace":
        return f"{'model, engine' if ran else 'model'} and copies agree to the end"
    ends = []
    if trust.because == "methods":
        # a smaller difference than that of the copies, which is why it may come before
        differs = f"by {number(_tolerance(found))} α from {number(trust.until, '.4g')} s on"
        ends = [f"{'the engine differs' if ran else 'an engine is predicted to differ'} {differs}"]
    if math.isfinite(found.copies_part):
        off = number(found.facts["perturbation"], "percent")
        ends.append(f"copies {off} off spread over half of it from {number(found.copies_part, '.4g')} s on")
    if found.peak <= CLOSED_TILT:
        return f"the base hardly opens, by {number(found.peak)} α: trust statistics"
    what = "it falls" if found.overturned else "largest tilt"
    reason = f"{what} at {number(found.response['peak_time'])} s, {', '.join(ends)}"
    return f"{reason}: trust statistics" if trust.kind == "statistics" else reason


def _reason_of_intensity(found: Advice) -> str:
    low, high = found.range_as_strong
    if math.isnan(low):
        return "no other scales of this shaking were run"
    if found.grades["intensity"] == "not tested":
        return f"the tendon yields at {number(found.yields_from)} times this shaking"
    which = f"at {len(found.as_strong)} scales, {STRONG}"
    if math.isinf(high):
        lowest, share = found.overturning_as_strong
        return (
            f"{STRONG} it overturns in {number(share, 'percent')} of the range, "
            f"first at {number(lowest)} times this shaking"
        )
    if high <= CLOSED_TILT:
        return f"the base hardly opens, by at most {number(high)} α {which}"
    if low == 0.0:
        return f"it stays at rest at some of {which.removeprefix('at ')}"
    low, peak = max(low, CLOSED_TILT), max(found.peak, CLOSED_TILT)
    return f"the tilt is {number(low / peak)} to {number(high / peak)} times as large {which}"


def _reason_of_engine(found: Advice) -> str:
    verification = found.verification
    if verification is None:
        return "not run"
    if verification.outcome in NO_PEAK:
        return f"it {_NO_PEAK[verification.outcome]}: {_failure(verification)}"
    # copies part earlier: they are shaken by a little more or less
    until, predicted = _agreed_until(verification), _predicted_until(found)
    agrees = f"shaken the same, it agrees until {until}, "
    agrees += "as predicted" if until == predicted else f"predicted until {predicted}"
    if verification.divergence == "earlier":
        return f"{agrees}: less than half as long"
    if not verification.moves:
        return "it stays at rest, the model moves"
    if (verification.outcome == "overturned") != found.overturned:
        return "it stands, the model overturns" if found.overturned else "it overturns, the model stands"
    if verification.divergence == "too little motion":
        return f"inconclusive: it agrees until {until}, in which the model's tilt hardly changes"
    if verification.divergence in UNTESTED:
        return f"inconclusive: it agrees until {until}, where {predicted} was predicted: too early to test it"
    return agrees


def _groups(found: Advice) -> list[dict[str, Any]]:
    """Rows of the groups with their names."""
    rows = found.groups.to_dict("records")
    return [{str(key): value for key, value in row.items()} | {"name": _name(found, row)} for row in rows]


def _name(found: Advice, row: Mapping[Hashable, Any]) -> str:
    """The name of a group: how many, measured or not, and as strong in which way."""
    group, runs = row["group"], row["runs"] - row["failed"]
    copies = {
        COPIES: f"copies, {number(found.facts['perturbation'], 'percent')} off",
        VERTICAL: "copies with vertical",
        HORIZONTAL: "copies without vertical",
    }
    if group in copies:
        return f"{runs} {copies[group]}"
    both = " in both directions" if found.response["in_one_plane"] else ""
    return f"{runs} {_others(found)}{both}, same {'PGA' if group == ACCELERATION else 'PGV'}"


def _others(found: Advice) -> str:
    return {"p695": "measured records", "synthetic": "synthetic motions"}.get(
        found.facts["records"], "motions"
    )


def _comparison_words(found: Advice) -> str:
    """What the case is compared with, beside copies of itself."""
    rows = [row for row in _groups(found) if row["group"] in (ACCELERATION, VELOCITY)]
    if not rows:
        return ""
    kind = f"{rows[0]['runs']} far-field records of FEMA P-695"
    if found.facts["records"] == "synthetic":
        kind = f"{rows[0]['runs']} synthetic (not recorded) motions"
    plane = (
        ", which shake in both directions while this one has one component"
        if found.response["in_one_plane"]
        else ""
    )
    if found.moves:
        return f"Compared with {kind}, scaled to its PGA and its PGV{plane}."
    # no table says what they do to what stays at rest as given
    others = found.members[found.members["peak_tilt"] > 0.0]["group"]
    peaks = {ACCELERATION: "PGA", VELOCITY: "PGV"}
    did = [
        f"to its {peaks[row['group']]} {(others == row['group']).sum()} uplift it and {row['overturned']} "
        "overturn it"
        for row in rows
    ]
    return f"Of {kind}{plane}, scaled {'; scaled '.join(did)}."


def _numbers(found: Advice) -> Iterator[Row]:
    """Rows of the numbers: the run as given, and the order statistic that 95 % of each group make."""
    alpha = math.degrees(found.cylinder.alpha)

    def row(name: str, overturn: str, covered: str, peak: float, form: str = ".3g") -> Row:
        tilt, top = alpha * peak, found.top(peak)
        # "21 of 22" beside "overturns" would say that so many do
        without = "no limit" if covered else "overturns"
        if overturn == _YIELDS:
            without = _YIELDS
        words = [without if math.isinf(peak) else number(each, form) for each in (tilt, top)]
        covered = "" if math.isinf(peak) else covered
        return {"name": name, "overturn": overturn, "covered": covered, "tilt": words[0], "top": words[1]}

    given = math.inf if found.overturned or found.yields else found.peak
    ends = _YIELDS if found.yields else "overturns" if found.overturned else "stands"
    copies = found.members[found.members["group"] == COPIES]["peak_tilt"]
    yield row("as given, one run", ends, "", given, scattered(scatter_of(found.peak, copies), most=3))
    for group in _groups(found):
        known, peak = group["runs"] - group["failed"], group["peak_tilt_95"]
        if group["single"]:
            ends = "overturns" if math.isinf(peak) else "stands"
            yield row(f"{group['name']}: all one run", ends, "", peak)
            continue
        low, high = (number(group[f"chance_{end}"], "percent").removesuffix(" %") for end in ("low", "high"))
        share = f"{group['overturned']} of {known} ({low} to {high} %)"
        if beyond := group.get("yielded", 0):
            share = f"not tested, the tendon yields in {beyond} of {known}"
        covered = f"{group['covered']} of {known}" if group["covered"] else ""
        yield row(group["name"], share, covered, peak)


def _demand_rows(found: Advice) -> Iterator[Row]:
    """Rows of the design demands, as a designer enters them; each names the group that it is of."""
    rows = found.demands.to_dict("records")
    values = {str(row["demand"]): {str(key): each for key, each in row.items()} for row in rows}
    if "moment" in values:
        moment, b = values["moment"], found.cylinder.base_radius
        forces = {name: moment[name] / b for name in ("per_tonne", "for_mass")}
        values["wall_force"] = moment | forces | {"unit": "weights"}
    for demand, name in _DEMANDS.items():
        if demand not in values:
            continue
        row = values[demand]
        if math.isnan(row["value"]):
            yield {"name": name, "value": "not given", "of": _reason(found, row)}
            continue
        unit = "kNm" if demand == "moment" else "kN"
        cells: Row = {"name": name, "value": f"{number(row['value'])}{_UNITS[row['unit']]}"}
        if not math.isnan(row.get("peak", math.nan)):  # an earlier version stated none
            cells["peak"] = f"{number(row['peak'])}{_UNITS[row['unit']]}"
            if not math.isnan(row["for_mass"]):
                cells["peak"] = f"{_rounded(row['peak'] / row['value'] * row['for_mass'])} {unit}"
        if not math.isnan(row["per_tonne"]):
            cells["tonne"] = f"{_rounded(row['per_tonne'])} {unit}/t"
            if not math.isnan(row["for_mass"]):
                cells["mass"] = f"{_rounded(row['for_mass'])} {unit}"
        yield {**cells, "of": _of(found, row)}


def _demand_columns(found: Advice) -> Iterator[list[str]]:
    """Columns of the design demands; forces of a body only where its mass was given."""
    yield from (["name", "demand", "words"], ["value", "value", "words"], ["tonne", "per tonne", "words"])
    if found.facts["mass"] is not None:
        yield ["mass", "one column" if "columns" in found.facts["cylinder"] else "in all", "words"]
    yield from (["peak", "peak", "words"], ["of", "not exceeded by", "words"])


def _rounded(value: float) -> str:
    """Three digits of a force as a designer writes it: without a power of ten where it is large."""
    return f"{float(f'{value:.3g}'):.10g}" if value >= 1.0 else number(value)


def _together(found: Advice) -> str:
    """What acts together where shear, and where moment, is largest and nothing is beyond its demand."""
    rows = found.demands.set_index("demand").to_dict("index")
    given = [name for name in _ACTING if name in rows and not math.isnan(rows[name]["value"])]
    parts = []
    for name in given:
        # no moment where the support supplies none, or none is known
        acting = {part: rows[name][f"with_{part}"] for part in given}
        if name == "force" or math.isnan(acting["force"]):
            continue
        beside = [
            f"{_ACTING[part][0]} of {number(value if value > _NOTHING * rows[part]['value'] else 0.0)}"
            f"{_ACTING[part][1]}"
            for part, value in acting.items()
            if part != name
        ]
        symbol, unit = _ACTING[name]
        value, most = number(acting[name]), number(rows[name]["value"])
        # an earlier version stated none
        at = "" if value in (most, NONE) else f", at {symbol} of {value}{unit}"
        parts.append(f"{symbol} acts with {' and '.join(beside)}{at}")
    return f"{'; '.join(parts)}." if parts else ""


def _wall(found: Advice) -> str:
    """Height and clearance of the wall of a recess, for which tilt, and of which group."""
    rows = found.demands.set_index("demand").to_dict("index")
    if "clearance" not in rows:
        return ""
    row = rows["clearance"]
    if math.isnan(row["value"]):
        return f"Wall: no size, {_reason(found, row)}."
    height, clearance = (number(1e3 * rows[part]["value"]) for part in ("wall_height", "clearance"))
    tilt = number(math.degrees(rows["tilt"]["value"] * found.cylinder.alpha))
    size = f"{height} mm high, {clearance} mm clear of the rim"
    tendon = found.facts.get("tendon") or {"balance_tilt": 1.0}
    beyond = ", beyond its balance" if rows["tilt"]["value"] > tendon["balance_tilt"] else ""
    return f"Wall: {size}, for a tilt of {tilt}° ({_of(found, row)}{beyond})."


def _reason(found: Advice, row: Mapping[Any, Any]) -> str:
    """Why a demand has no value, and in which group."""
    words = {"yields": "the tendon yields in {}", "overturns": "{} overturn"}.get(row["reason"])
    return words.format(_of(found, row)) if words else str(row["reason"])


def _of(found: Advice, row: Mapping[Any, Any]) -> str:
    """How many runs of which group ask no more than a demand, and under which shaking."""
    runs = int(row["runs"])
    count = "one run of" if runs == 1 else f"{int(row['covered'])} of {runs}"
    return f"{count}{_group(found, row)}"


_OF_GROUP = {
    COPIES: " copies",
    VERTICAL: " with vertical",
    ACCELERATION: ", same PGA",
    VELOCITY: ", same PGV",
}


def _group(found: Advice, row: Mapping[Any, Any]) -> str:
    """The group of a demand, and its shaking."""
    measured = row["group"] in (COPIES, VERTICAL) or found.facts["records"] == "p695"
    level = "" if row["factor"] == 1.0 else f", × {number(row['factor'])}"
    return f"{'' if measured else ' synthetic'}{_OF_GROUP[row['group']]}{level}"


def _steps(found: Advice) -> list[str]:
    """Lines of what to do next: words, and the whole command where there is one."""
    options, slender = found.facts["options"], number(found.cylinder.tan_alpha)
    slips, lost = (number(share, "percent") for share in found.missing)
    friction, support = number(found.facts["friction"]), found.facts["support"]
    if options is None:  # made in Python, where `case` is at hand
        call = 'rw.advise(case, support="{}")'
        commands = {
            "friction unknown": "dataclasses.replace(case, friction=...)",
            "budget": f'rw.comparison(case, runs=[rw.Run("{DEFAULT_ENGINE}", "{support}")], budget=True)',
            "engine": f'rw.advise(case, rw.Run("{DEFAULT_ENGINE}", "{support}"))',
            "spectrum": f"rw.spectrum({found.cylinder.tan_alpha:.6g}, case.motion)",
            "ensemble": "rw.ensemble(case)",
            "clearance": call.format(RING),
            "in a recess": call.format(RECESS),
            "vertical": "rw.read_record(x, y, z)",
        }
    else:
        # the mass of a column states a tendon, too
        plan = [name for name in PLAN if name != "mass" or not options.get("tendon_force")]
        problem = {name: value for name, value in options.items() if name not in plan}
        commands = {
            "friction unknown": command_line("advise", options | {"friction": "MU"}),
            "budget": command_line("compare", problem | {"support": support, "budget": True}),
            "engine": command_line("advise", options | {"engine": DEFAULT_ENGINE}),
            "spectrum": spectrum_line(options | _ratios_of_tendon(found), found.cylinder.tan_alpha),
            "ensemble": command_line("ensemble", problem | {"support": support}),
            "clearance": command_line("advise", options | {"support": RING}),
            "in a recess": command_line("advise", options | {"support": RECESS}),
            "vertical": command_line("advise", options | {"record_z": "Z"}),
        }
    words = {
        "friction unknown": f"find the friction MU; to uplift and not to slide takes b/h = {slender}",
        "slides": f"a friction of {friction} is below b/h = {slender}: it slides, and nothing here applies",
        "more friction": f"more friction: with {friction} it slips for up to {slips} of the time in motion",
        "contact": f"contact is lost for up to {lost} of the time in motion: the models do not know flight",
        "budget": "why the engine diverges so early",
        "engine": "an engine verifies the model",
        "spectrum": "which sizes and intensities overturn; with records of your site",
        "ensemble": "percentiles of engines beside these; do not report one trace",
        "clearance": "a recess as it is built has walls and clearance",
        "in a recess": "nothing here keeps the cylinder from rolling out of its place",
        "vertical": "with the vertical component Z of the record",
        "records": f"the records of FEMA P-695 in place of synthetic motions: `{p695.REMEDY}`",
    }
    return [
        f"{words[step][0].upper()}{words[step][1:]}" + (f": `{commands[step]}`" if step in commands else "")
        for step in found.next_steps
    ]


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
    trust, verification = found.trust, found.verification
    until, note = "its end", ""
    if trust.kind != "trace":
        ends = "copies are spread over half of the peak tilt"
        if trust.because == "methods":
            ran = verification is not None and verification.outcome not in NO_PEAK
            ends = f"reduced model and engine {'' if ran else 'are predicted to '}diverge"
        until, note = f"{number(trust.until, '.4g')} s", f"then {ends}"
    yield _check("the trace can be trusted until", until, note)
    name = f"shaken the same, model and engine agree within {number(_tolerance(found))} α, predicted, until"
    yield _check(name, _predicted_until(found), _PREDICTED[found.facts["prediction"]["reason"]])
    if verification is None:
        return
    method = (
        f"{verification.label} {verification.version}, step {number(verification.time_step)} s, agrees until"
    )
    if verification.outcome in NO_PEAK:
        yield _check(method, verification.outcome, _failure(verification))
        return
    tilt = f"largest tilt {number(verification.peak_tilt)} α" if verification.moves else "it stays at rest"
    tilt = "it overturns" if verification.outcome == "overturned" else tilt
    yield _check(method, _agreed_until(verification), f"{_DIVERGENCE[verification.divergence]}; {tilt}")


def _tolerance(found: Advice) -> float:
    """Tilt difference of model and engine that ends their agreement [alpha]."""
    return float(min(AGREEMENT, found.response["tolerance"]))


def _predicted_until(found: Advice) -> str:
    prediction = found.facts["prediction"]
    end = found.response["uplift_time"] + prediction["length"]
    return f"{number(end, '.4g')} s" if prediction["reason"] else _end(found.verification)


def _agreed_until(verification: Verification) -> str:
    until = f"{number(verification.agreed_until, '.4g')} s"
    return until if verification.diverged else _end(verification)


def _end(verification: Verification | None) -> str:
    """End of the run of an engine, which may be where copies part."""
    if verification is None or math.isinf(verification.stopped):
        return "the end"
    return f"{number(verification.stopped, '.4g')} s, where copies diverge and it ends"


def _failure(verification: Verification) -> str:
    return "; ".join(CODES[code][1] for code in codes_in(verification.diagnostics))


def _scales(found: Advice) -> Iterator[Row]:
    low, high = found.range_as_strong
    if not math.isnan(low) and not found.overturned and found.grades["intensity"] != "not tested":
        span = f"{number(low)} to {number(high)} α"
        yield _check(
            f"largest tilt at {len(found.as_strong)} scales, {STRONG}",
            span,
            "∞: overturns" if math.isinf(high) else "",
        )
    lowest = found.lowest.set_index("series")
    if not len(lowest):
        return
    name, factor, notes = "lowest scale found to overturn", found.lowest_factor, []
    if math.isnan(factor):
        notes = [f"up to {number(found.scales['factor'].max())} times; gaps may lie between the scales run"]
        if not math.isnan(found.yields_from):
            notes = [f"at {number(found.yields_from)} times the tendon yields"]
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
    if found.yielded:
        return
    facts, vertical = found.facts, found.vertical
    holds = support_named(facts["support"])
    place = (FLAT if holds.is_recess else RECESS).place
    other = f"tilt {place} over that here"
    shaken = "tilt with vertical shaking over that without"
    if vertical.source == "other":
        shaken += f" ({vertical.record} as strong, in place of this record)"
    for name, ratios in ((other, facts["other_support"]), (shaken, vertical.ratios)):
        if ratios is None:
            continue
        note = f"of {ratios['count']} copies {ratios['higher']} tilt more, {ratios['lower']} less"
        if not math.isnan(ratios["ratio"]):
            note = f"{number(ratios['low'])} to {number(ratios['high'])} (95 %); {note}"
        fell = ratios["overturned"], ratios["against_overturned"]
        note += f"; {fell[0]} of {ratios['members']} overturn, against {fell[1]}" if any(fell) else ""
        yield _check(name, number(ratios["ratio"]), note)
