"""Findings of an advice: mode of motion, grades with their reasons, notes."""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping
from typing import Any

from rockwobble.models.diagnostic import codes_in
from rockwobble.models.finding import Finding, Findings, Level, Value
from rockwobble.models.support import FLAT, RECESS, support_named
from rockwobble.models.trace import NO_PEAK
from rockwobble.reduced.body import restitution_from_momentum

from ..spectrum.parts import PLANAR_X, PLANAR_Y, SPATIAL
from ..spectrum.verification import CHECK_RTOL, NUDGE
from .demands import PASSED, SPIKES
from .grades import (
    POOR,
    RANGE,
    agreed_until,
    end_of_motion,
    grade_chance,
    graded,
    group_name,
    has_run,
    overall,
    predicted_until,
    tolerance,
)
from .members import ACCELERATION, COPIES, HORIZONTAL, VELOCITY, VERTICAL, WEAKER_COUNT
from .scales import AS_STRONG
from .slides import engine_finding, slide_findings

Advice = Any  # class of `.advice`, which imports this module
# times a ground motion: what has to be made stronger than that uplifts nothing, such as still ground
_NO_SCALE = 1e9
_NOTHING = 1e-3  # share of a demand below which a simultaneous action is omitted
_ACTING = ("shear", "force", "moment")
# columns of a frame: a slab on more than three rests on the highest ones
_EVENLY_LOADED = 3


def findings_of(advice: Advice) -> Findings:
    """Findings of an advice in order of weight: verdict, motion, grades, groups, demands, steps, details."""
    parts = (_verdict, _motion, graded, _groups, _demands, _steps, _checks, _case, _assumptions)
    return Findings(each for part in parts for each in part(advice))


def _note(key: str, **values: Value) -> Finding:
    return Finding(key=key, values=values)


def _verdict(advice: Advice) -> Iterator[Finding]:
    """Verdict on the body, and on whether the model may be used."""
    model, outcome, grades = advice.facts["model"], advice.response["outcome"], dict(advice.grades)
    level = grades.pop("overturning", "not tested")
    keys = {
        outcome: outcome in NO_PEAK,
        "slides": advice.slides,
        "slides_at_rest": advice.slides_at_rest,
        "at_rest": not advice.moves,
    }
    if still := next((key for key, holds in keys.items() if holds), ""):
        moved = advice.response["displacement"] if advice.slides else math.nan
        yield _note(f"verdict.{still}", name=model, displacement=moved)
        if not advice.slides_at_rest:
            return
    else:
        ends = "yields" if advice.yields else "overturns" if advice.overturned else level.replace(" ", "_")
        yield Finding(key=f"verdict.{ends}", level=level)
    use = overall(grades.values())
    yield Finding(key=f"use.{use.replace(' ', '_')}", level=use, values={"name": model})


def _motion(advice: Advice) -> Iterator[Finding]:
    """Mode of motion, vertical component, reason for rest, limit of the tendon, and uneven load."""
    yield from _mode(advice)
    yield from _vertical(advice)
    if not advice.moves and not advice.slides:
        yield _at_rest(advice)
    yield from _limit_of_tendon(advice)
    if advice.facts["cylinder"].get("columns", 1) > _EVENLY_LOADED and advice.moves:
        yield Finding(key="caution.uneven_load", level="caution")


def _mode(advice: Advice) -> Iterator[Finding]:
    facts, response = advice.facts, advice.response
    for each in facts.get("mode", ()):  # an earlier version stated none
        values = {name: part["value"] for name, part in each["values"].items()}
        yield Finding(key=each["key"], level=each["level"], values=values)
    if advice.slides:
        moved = response["displacement"], response["residual_displacement"]
        yield from slide_findings(advice.tables["slides"], *moved, source=facts["records"], gap=facts["gap"])
    if (engine := facts.get("rocks_and_slides")) is not None:
        yield engine_finding(advice.tables.get("slipped"), engine, response["peak_tilt"])
    if not advice.slides and facts["friction"] is None and facts["motion"] is not None:
        yield _note("mode.no_friction_given", bound=advice.cylinder.tan_alpha)


def _vertical(advice: Advice) -> Iterator[Finding]:
    """Copies with and without the vertical component; a caution where the grades differ."""
    vertical, ratios = advice.vertical, advice.vertical.ratios
    if vertical.source == "other":
        yield _note("vertical.not_given")
    elif ratios is not None and advice.yielded:
        yield _note("vertical.yields")
    elif ratios is not None:
        pair = advice.groups[advice.groups["group"].isin([COPIES, VERTICAL, HORIZONTAL])]["chance"]
        matters = "overturning" in advice.grades and pair.map(grade_chance).nunique() == 2
        yield Finding(
            key="vertical.left_out" if vertical.source == "shipped" else "vertical.counted",
            level=advice.grades["overturning"] if matters else "note",
            values={
                "overturned": int(ratios["overturned"]),
                "overturned_without": int(ratios["against_overturned"]),
                "runs": int(ratios["members"]),
            },
        )


def _at_rest(advice: Advice) -> Finding:
    """Reason why a case stays at rest, and the scale that would move it."""
    motion, vertical = advice.facts["motion"], advice.vertical
    if codes := advice.response["diagnostics"]:
        return _note("rest.diagnosed", names=tuple(codes))
    if motion is None:
        return _note("rest.nothing")
    if motion["uplift_factor"] >= _NO_SCALE:
        return _note("rest.no_scale")
    return _note(
        "rest.factor",
        demand=motion.get("friction_at_rest", 0.0) or math.nan,
        factor=motion["uplift_factor"],
        factor_vertical=vertical.uplift_factor if vertical.source == "shipped" else math.nan,
    )


def _limit_of_tendon(advice: Advice) -> Iterator[Finding]:
    """Range in which the tendon stays elastic."""
    tendon, alpha = advice.facts.get("tendon"), advice.cylinder.alpha
    if tendon is not None and tendon["yield_force"] is None:
        of = "prestress" if tendon["prestress"] else "weight_of_column"
        tilts = {f"tilt_{n}": alpha * tilt for n, tilt in tendon["tilts"].items()}
        yield _note("steel.elastic", reason=of, **tilts)
    elif tendon is not None:
        beyond, runs = advice.yielded + advice.yields, int(advice.counting["runs"].sum()) + 1
        counts = {"count": beyond, "runs": runs} if beyond else {"count": None, "runs": None}
        yield _note("steel.yields", tilt=alpha * tendon["yield_tilt"], **counts)


def _groups(advice: Advice) -> Iterator[Finding]:
    """Each group of runs; groups other than copies with their comparison."""
    # results of earlier versions have no count of yielding runs
    rows = {str(row["group"]): {"yielded": 0} | row for row in advice.groups.to_dict("records")}
    for group, row in rows.items():
        yielded = int(row.get("yielded", 0))  # missing in results of earlier versions
        values: dict[str, Value] = {
            "name": group_name(advice, group),
            "runs": int(row["runs"] - row["failed"]),
        }
        grade: Level = "note"
        if not row["single"]:
            values |= {
                "overturned": int(row["overturned"]),
                "share": (row["chance"], row["chance_low"], row["chance_high"]),
                "count": yielded or int(row["covered"]),
            }
            grade = grade_chance(row["chance"]) if row["counts"] else "note"
            grade = "not tested" if yielded else grade
        values["peak"] = float(row["peak_tilt_95"])
        kind = "one_run" if row["single"] else "yielded" if yielded else "runs"
        yield Finding(key=f"group.{kind}", level=grade, values=values, runs=group)
    others = [group for group in (ACCELERATION, VELOCITY) if group in rows]
    if not others:
        return
    one, records = rows[others[0]], str(advice.facts["records"])
    plane = "one_component" if advice.response["in_one_plane"] else None
    compared: dict[str, Value] = {"count": int(one["runs"]), "name": records, "reason": plane}
    if not advice.moves:  # other records have no table for a case at rest
        moving = advice.members[advice.members["peak_tilt"] > 0.0]["group"]
        for group in others:
            compared[f"runs_{group}"] = int((moving == group).sum())
            compared[f"overturned_{group}"] = int(rows[group]["overturned"])
    yield _note("compared.moves" if advice.moves else "compared.at_rest", **compared)


def covering_values(advice: Advice, row: Mapping[Any, Any]) -> dict[str, Value]:
    """Count and group of the runs whose demand is covered, with their shaking."""
    return {
        "count": int(row["covered"]),
        "runs": int(row["runs"]),
        "name": f"{group_name(advice, row['group'])}_runs",
        "factor": math.nan if row["factor"] == 1.0 else float(row["factor"]),
    }


def _demands(advice: Advice) -> Iterator[Finding]:
    """Each design demand, its simultaneous actions, and the wall."""
    if not advice.moves:
        return
    rows = {str(row["demand"]): row for row in advice.demands.to_dict("records")}
    for name, row in rows.items():
        if name in ("tilt", "wall_height", "clearance"):
            continue
        if math.isnan(row["value"]):
            yield _without(advice, row, "demand.", reason=f"demand_{name}")
        else:
            values = {"demand": float(row["value"]), "detail": row["unit"], **covering_values(advice, row)}
            yield Finding(key=f"demand.{name}", values=values, runs=str(row["group"]))
    given = {name: rows[name] for name in _ACTING if name in rows and not math.isnan(rows[name]["value"])}
    for name, row in given.items():
        # nothing beside the normal force itself, or where no sample is within all limits
        if name == "force" or math.isnan(row["with_force"]):
            continue
        acting = {part: row[f"with_{part}"] for part in given}
        said = f"{acting[name]:.3g}" == f"{row['value']:.3g}"  # equal to the demand in print
        yield Finding(
            key=f"together.{name}",
            values={
                f"force_{part}": value if value > _NOTHING * given[part]["value"] else 0.0
                for part, value in acting.items()
                if part != name or not said
            },
        )
    if "clearance" in rows:
        row, tendon = rows["clearance"], advice.facts.get("tendon") or {"balance_tilt": 1.0}
        if math.isnan(row["value"]):
            yield _without(advice, row, "wall.")
        else:
            tilt = rows["tilt"]["value"]
            yield _note(
                "wall.size",
                length_height=rows["wall_height"]["value"],
                length_clearance=row["value"],
                tilt=tilt * advice.cylinder.alpha,
                reason="beyond_balance" if tilt > tendon["balance_tilt"] else None,
                **covering_values(advice, row),
            )
    if len(advice.weaker):
        factors = ", ".join(f"{factor:.2g}" for factor in sorted(set(advice.weaker["factor"])))
        yield _note("demand.weaker")
        yield _note("demand.levels", detail=factors, runs=WEAKER_COUNT)
    if support_named(advice.facts["support"]).is_recess:
        yield _note("wall.moment")
        yield _note("wall.balance", factor=PASSED)


def _without(advice: Advice, row: Mapping[Any, Any], group: str, **about: Value) -> Finding:
    """Reason for a missing demand, with its group."""
    reason = row["reason"] if row["reason"] in ("yields", "overturns") else "other"
    about |= {"detail": row["reason"]} if reason == "other" else covering_values(advice, row)
    return Finding(key=f"{group}none_{reason}", level="not tested", values=about)


def _steps(advice: Advice) -> Iterator[Finding]:
    """Next steps, the most urgent first; pages have the commands."""
    if not advice.moves:
        return
    grades, facts, border = advice.grades, advice.facts, advice.cylinder.tan_alpha
    (slip, lost), friction, holds = advice.missing, facts["friction"], support_named(facts["support"])
    slides = friction is not None and friction < border
    less = friction is not None and not slides and grades.get("friction") in POOR
    steps: dict[str, tuple[bool, dict[str, Value]]] = {
        "friction_unknown": (friction is None, {"bound": border}),
        "slides": (slides and facts["release"] is None, {"given": friction, "bound": border}),
        "more_friction": (less, {"given": friction, "share": slip}),
        "contact": (grades.get("contact") in POOR, {"share": lost}),
        "budget": (grades.get("engine") == "not satisfied", {}),
        "engine": (advice.verification is None, {}),
        "spectrum": (grades.get("overturning") != "satisfied" and facts["motion"] is not None, {}),
        "ensemble": (advice.trust.kind == "statistics", {}),
        "clearance": (holds.guided and facts.get("tendon") is None, {}),
        "in_a_recess": (not holds.is_recess, {}),
        "vertical": (advice.vertical.source == "other", {}),
        "records": (facts["records"] == "synthetic", {}),
    }
    yield from (_note(f"step.{name}", **values) for name, (due, values) in steps.items() if due)


def _checks(advice: Advice) -> Iterator[Finding]:
    """Findings on the evidence for the grades."""
    if not advice.moves:
        return
    response, copies = advice.response, advice.members
    copies = copies[(copies["group"] == COPIES) & (~copies["outcome"].isin(NO_PEAK))]
    if response["uplift_time"] > 0.0:
        yield _note("evidence.uplift", time=response["uplift_time"])
    less = float((copies["peak_tilt"] < advice.peak).mean()) if advice.copies_differ else math.nan
    yield _note("evidence.peak", reason=end_of_motion(advice), time=response["peak_time"], share=less)
    yield from _agreement(advice)
    yield from _scales(advice)
    if not advice.yielded:
        other = FLAT if support_named(advice.facts["support"]).is_recess else RECESS
        vertical = advice.vertical
        record = vertical.record if vertical.source == "other" else None
        yield from _ratio(f"on_{other}", advice.facts["other_support"], None)
        yield from _ratio("with_vertical", vertical.ratios, record)
    spike = response["largest_normal_force"]
    if len(advice.groups) and spike > advice.groups["force_95"].max():
        yield _note("evidence.spike", force=spike, share=SPIKES)
    if response["in_one_plane"]:
        yield _note("evidence.in_one_plane")
    if advice.yielded:
        yield _note("planar.yields")
    elif not len(advice.planar):
        yield _note("planar.release" if advice.facts["release"] else "planar.vertical")


def _agreement(advice: Advice) -> Iterator[Finding]:
    """Time until which the trace can be trusted, its prediction, and the engine run."""
    trust, engine, ran = advice.trust, advice.verification, has_run(advice)
    ends = {"methods": "methods_diverge" if ran else "methods_predicted", "data": "copies_spread"}
    whole = trust.kind == "trace"
    reason = None if whole else ends.get(trust.because, "copies_spread")
    yield _note("evidence.trusted", until=math.inf if whole else trust.until, reason=reason)
    reason = f"predicted_{advice.facts['prediction']['reason']}"
    difference, predicted = tolerance(advice), predicted_until(advice)
    yield _note("evidence.predicted", difference=difference, predicted=predicted, reason=reason)
    if engine is None:
        return
    values: dict[str, Value] = {"name": f"{engine.label} {engine.version}", "duration": engine.time_step}
    if not ran:
        codes = tuple(codes_in(engine.diagnostics))
        yield _note("evidence.engine_failed", **values, names=codes, reason=engine.outcome)
        return
    fell = engine.outcome == "overturned"
    yield _note(
        "evidence.engine",
        **values,
        until=agreed_until(advice),
        reason=f"divergence_{engine.divergence}",
        reason_end="overturns" if fell else "moves" if engine.moves else "at_rest",
        peak=engine.peak_tilt if engine.moves and not fell else math.nan,
    )


def _scales(advice: Advice) -> Iterator[Finding]:
    """Peak tilts under equally strong shaking, and the lowest overturning scales."""
    low, high = advice.range_as_strong
    if not math.isnan(low) and not advice.overturned and advice.grades["intensity"] != "not tested":
        count = len(advice.as_strong)
        yield _note("evidence.as_strong", count=count, **RANGE, peak_least=low, peak_largest=high)
    lowest, factor = advice.lowest.set_index("series"), advice.lowest_factor
    if not len(lowest):
        return
    gap = "in_a_gap" if factor < 1.0 and not advice.overturned else None
    if math.isnan(factor) and math.isnan(advice.yields_from):
        yield _note("evidence.no_lowest", factor=float(advice.scales["factor"].max()))
    elif math.isnan(factor):
        yield _note("evidence.lowest_yields", factor=advice.yields_from)
    elif lowest["confirmed"][SPATIAL]:
        yield _note("evidence.lowest", factor=factor, reason=gap)
    else:
        yield _note("evidence.lowest_by_chance", factor=factor, reason=gap, bound=CHECK_RTOL, share=NUDGE)
    planar = float(lowest["factor"].reindex([PLANAR_X, PLANAR_Y]).min())
    if not math.isnan(planar):
        yield _note("evidence.lowest_planar", factor=planar)


def _ratio(name: str, ratios: Mapping[str, float] | None, record: str | None) -> Iterator[Finding]:
    """Ratio of the peak tilts of copies by two methods."""
    if ratios is None:
        return
    fell = int(ratios["overturned"]), int(ratios["against_overturned"])
    ratio = ratios["ratio"], ratios["low"], ratios["high"]
    yield _note(
        "evidence.ratio",
        name=name,
        detail=record,
        ratio=math.nan if math.isnan(ratio[0]) else ratio,
        count=int(ratios["count"]),
        count_more=int(ratios["higher"]),
        count_less=int(ratios["lower"]),
        overturned=fell[0] if any(fell) else None,
        overturned_without=fell[1] if any(fell) else None,
        runs=int(ratios["members"]),
    )


def _case(advice: Advice) -> Iterator[Finding]:
    """Findings of the input: body, ground motion or release, support, tendon, other records, mass."""
    facts, body = advice.facts, advice.cylinder
    motion, release, tendon, duration = (
        facts["motion"],
        facts["release"],
        facts.get("tendon"),
        facts["length"],
    )
    frame = facts["cylinder"] if "columns" in facts["cylinder"] else None
    if frame:
        yield _note("case.frame", count=frame["columns"], ratio=frame["slab_mass_ratio"])
    size = {"length": body.base_radius, "length_height": 2.0 * body.half_height}
    yield _note("case.body", **size, tilt=body.alpha, ratio=body.tan_alpha)
    if motion:
        ratio, factor = motion["peak"] / facts["gravity"], 1.0 / motion["uplift_factor"]
        name = motion["name"] or "Record"
        yield _note("case.motion", name=name, ratio=ratio, factor=factor, duration=duration)
    if release:
        yield _note("case.release", tilt=release["tilt"], rate=release["rolling_rate"], duration=duration)
    given, mass = (math.nan if facts[name] is None else facts[name] for name in ("friction", "mass"))
    length = facts["rolling_resistance"] or math.nan
    yield _note("case.support", name=facts["support"], given=given, length=length)
    if tendon:
        stress = tendon.get("unit_stress") or math.nan
        yield _note(
            "steel.couple",
            given=tendon["prestress"],
            given_stiffness=tendon["stiffness"],
            stress=stress * tendon["prestress"],
            stress_weight=stress,
            factor=tendon["uplift_factor"],
            bound=tendon["initial_stiffness"],
            # largest tilt of the model: balance, or yield if earlier
            peak=min(tendon["balance_tilt"], tendon.get("yield_tilt", math.inf)),
        )
    whole = mass * (1.0 + body.slab_mass_ratio)
    yield _note("weight.column" if frame else "weight.cylinder", mass=whole, mass_column=mass)
    if facts["records"]:
        yield _note("case.records", name=f"records_{facts['records']}")


def _assumptions(advice: Advice) -> Iterator[Finding]:
    """Assumptions of the models."""
    facts, body, motion = advice.facts, advice.cylinder, advice.facts["motion"]
    other = "besides_rolling" if facts["rolling_resistance"] else None
    yield _note("assumption.rigid", share=1.0 - restitution_from_momentum(body), reason=other)
    if "columns" in facts["cylinder"]:
        yield _note("assumption.slab", count=facts["cylinder"]["columns"])
    yield _note("assumption.recess" if support_named(facts["support"]).is_recess else "assumption.flat")
    if facts.get("tendon") is not None:
        yield _note("assumption.tendon")
    yield _note("assumption.ground", reason=None if motion and motion["has_vertical"] else "no_vertical")
    if len(advice.as_strong):
        factor = AS_STRONG[1] / AS_STRONG[0]
        yield _note("assumption.as_strong", count=len(advice.as_strong), **RANGE, factor=factor)
    yield _note("assumption.verified")
