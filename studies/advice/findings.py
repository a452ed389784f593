"""Findings of an advice: mode of motion, grades with their reasons, notes."""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping
from typing import Any

from rockwobble.compare.comparison.prediction import UNTESTED
from rockwobble.compare.metrics.statistics import FEWEST
from rockwobble.models import AGREEMENT, CLOSED_TILT
from rockwobble.models.diagnostic import codes_in
from rockwobble.models.finding import Finding, Findings, Level, Value
from rockwobble.models.support import FLAT, RECESS, support_named
from rockwobble.models.trace import NO_PEAK
from rockwobble.reduced.body import restitution_from_momentum

from ..spectrum.parts import PLANAR_X, PLANAR_Y, SPATIAL
from ..spectrum.verification import CHECK_RTOL, NUDGE
from .demands import PASSED, SPIKES
from .grades import NEAR, grade_chance
from .members import ACCELERATION, COPIES, VELOCITY, WEAKER_COUNT
from .scales import AS_STRONG
from .trust import Verification

Advice = Any  # class of `.advice`, which imports this module
_RANGE: Mapping[str, Value] = {"share_weaker": 1.0 - AS_STRONG[0], "share_stronger": AS_STRONG[1] - 1.0}
# times a ground motion: what has to be made stronger than that uplifts nothing, such as still ground
_NO_SCALE = 1e9
_NOTHING = 1e-3  # share of a demand below which what acts beside another is none
_ACTING = ("shear", "force", "moment")
Reason = tuple[str, Mapping[str, Value]]


def findings_of(advice: Advice) -> Findings:
    """Findings of an advice in order of weight: verdict, motion, grades, groups, demands, steps, details."""
    parts = (_verdict, _motion, _graded, _groups, _demands, _steps, _checks, _case, _assumptions)
    return Findings(each for part in parts for each in part(advice))


def group_name(advice: Advice, group: str) -> str:
    """Name of a group of runs in the table of words; of other records with what they are."""
    return f"{group}_{advice.facts['records']}" if group in (ACCELERATION, VELOCITY) else group


def _note(key: str, **values: Value) -> Finding:
    return Finding(key=key, values=values)


def _verdict(advice: Advice) -> Iterator[Finding]:
    model, outcome = advice.facts["model"], advice.response["outcome"]
    grade, key = advice.grades.get("overturning", "not tested"), ""
    if outcome in NO_PEAK:
        key = f"verdict.{outcome}"
    elif advice.slides:
        key = "verdict.slides"
    elif advice.slides_at_rest:
        key = "verdict.slides_at_rest"
    elif not advice.moves:
        key = "verdict.at_rest"
    if key:
        moved = advice.response["displacement"] if advice.slides else math.nan
        yield Finding(key=key, level="note", values={"name": model, "displacement": moved})
    if key and not advice.slides_at_rest:
        return
    if not key:
        key = "verdict.overturns" if advice.overturned else f"verdict.{grade.replace(' ', '_')}"
        yield Finding(key="verdict.yields" if advice.yields else key, level=grade)
    use = advice.model_grade
    yield Finding(key=f"use.{use.replace(' ', '_')}", level=use, values={"name": model})


def _motion(advice: Advice) -> Iterator[Finding]:
    """Motion, vertical component, why nothing moves, limit of a tendon; what a case asks of its builder."""
    yield from advice.mode_findings
    if vertical := _vertical(advice):
        yield vertical
    if not advice.moves and not advice.slides:
        yield _at_rest(advice)
    yield from _limit_of_tendon(advice)
    if advice.shares_load_unevenly and advice.moves:
        yield Finding(key="caution.uneven_load", level="caution")


def _vertical(advice: Advice) -> Finding | None:
    vertical, ratios = advice.vertical, advice.vertical.ratios
    if vertical.source == "other":
        return _note("vertical.not_given")
    if not vertical.source or ratios is None:
        return None
    if advice.yielded:
        return _note("vertical.yields")
    matters = advice.vertical_matters and "overturning" in advice.grades
    level: Level = advice.grades["overturning"] if matters else "note"
    values = {
        "overturned": int(ratios["overturned"]),
        "overturned_without": int(ratios["against_overturned"]),
        "runs": int(ratios["members"]),
    }
    key = "vertical.left_out" if vertical.source == "shipped" else "vertical.counted"
    return Finding(key=key, level=level, values=values)


def _at_rest(advice: Advice) -> Finding:
    """Why a case does not move, or what it would take."""
    motion, vertical = advice.facts["motion"], advice.vertical
    if codes := advice.response["diagnostics"]:
        return _note("rest.diagnosed", names=tuple(codes))
    if motion is None:
        return _note("rest.nothing")
    if motion["uplift_factor"] >= _NO_SCALE:
        return _note("rest.no_scale")
    return _note(
        "rest.factor",
        # an earlier version stated none
        demand=motion.get("friction_at_rest", 0.0) or math.nan,
        factor=motion["uplift_factor"],
        factor_vertical=vertical.uplift_factor if vertical.source == "shipped" else math.nan,
    )


def _limit_of_tendon(advice: Advice) -> Iterator[Finding]:
    """Up to where the tendon is what the models take it for; an earlier version knew nothing of it."""
    tendon, alpha = advice.facts.get("tendon"), advice.cylinder.alpha
    if tendon is None or "tilts" not in tendon:
        return
    if tendon["yield_force"] is None:
        of = "prestress" if tendon["prestress"] else "weight_of_column"
        tilts = {f"tilt_{n}": alpha * tilt for n, tilt in tendon["tilts"].items()}
        yield _note("steel.elastic", reason=of, **tilts)
        return
    beyond, runs = advice.yielded + advice.yields, int(advice.counting["runs"].sum()) + 1
    yield _note(
        "steel.yields", tilt=alpha * tendon["yield_tilt"], count=beyond or None, runs=runs if beyond else None
    )


def _graded(advice: Advice) -> Iterator[Finding]:
    """Each grade with what it rests on in this case."""
    reasons = {
        "overturning": _overturning,
        "friction": _friction,
        "contact": _contact,
        "tendon": _tendon,
        "trace": _trace,
        "intensity": _intensity,
        "engine": _engine,
    }
    for topic, grade in advice.grades.items():
        key, values = reasons[topic](advice)
        yield Finding(key=key, level=grade, values=values)


def _overturning(advice: Advice) -> Reason:
    if advice.overturned:
        return "overturning.as_given", {}
    if advice.yields:
        return "overturning.yields_as_given", {}
    grade, lowest, beyond = advice.grades["overturning"], advice.lowest_factor, advice.yields_from
    rows = advice.counting.to_dict("records")
    worst = max(
        (row for row in rows if row["chance"] > 0.0), key=lambda row: float(row["chance"]), default=None
    )
    near = {"factor": lowest if grade == "caution" and lowest < NEAR else math.nan}
    if worst is not None:
        name = group_name(advice, str(worst["group"]))
        runs = int(worst["runs"] - worst["failed"])
        return "overturning.group", {
            "overturned": int(worst["overturned"]),
            "runs": runs,
            "name": name,
            **near,
        }
    if grade == "caution":
        return "overturning.scale", near
    if advice.yielded:
        return "overturning.yielded", {"count": advice.yielded, "runs": int(advice.counting["runs"].sum())}
    if beyond < NEAR:
        return "overturning.yields_at", {"factor": beyond}
    if advice.facts["motion"] is None:
        return ("overturning.no_copy" if grade == "satisfied" else "overturning.one_run"), {}
    if not len(advice.lowest):
        return "overturning.no_scales", {}
    if math.isnan(lowest) and not math.isnan(beyond):
        return "overturning.none_but_yields", {"factor": beyond}
    if math.isnan(lowest):
        return "overturning.none_up_to", {"factor": float(advice.scales["factor"].max())}
    return "overturning.none_but", {"factor": lowest}


def _friction(advice: Advice) -> Reason:
    given, slip, border = advice.facts["friction"], advice.missing[0], advice.cylinder.tan_alpha
    if not advice.moves:
        return "friction.slides_at_rest", {
            "given": given,
            "demand": advice.facts["motion"]["friction_at_rest"],
        }
    demand = float(advice.demands.set_index("demand")["value"].get("friction", math.nan))
    if given is None:
        return "friction.not_given", {"demand": demand}
    values = {"given": given, "demand": demand}
    if given < border and advice.response["uplift_time"] > 0.0:
        return "friction.below_border", {**values, "bound": border}
    if slip > 0.0:
        return "friction.too_little", {**values, "share": slip}
    return _enough(advice, "friction.", values)


def _enough(advice: Advice, group: str, values: Mapping[str, Value]) -> Reason:
    if advice.grades[group.removesuffix(".")] == "satisfied":
        return f"{group}enough", values
    return (
        (f"{group}yielded", {"count": advice.yielded})
        if advice.yielded
        else (f"{group}few", {"runs": FEWEST})
    )


def _contact(advice: Advice) -> Reason:
    lost = advice.missing[1]
    return ("contact.lost", {"share": lost}) if lost > 0.0 else _enough(advice, "contact.", {})


def _tendon(advice: Advice) -> Reason:
    tendon, largest = advice.facts["tendon"], advice.largest_tension
    stress = tendon.get("unit_stress")
    values = {"force": largest, "stress": stress * largest if stress else math.nan}
    if tendon["yield_force"] is None:
        return "tendon.no_yield_force", values
    above = advice.grades["tendon"] == "not satisfied"
    return ("tendon.above" if above else "tendon.below"), {**values, "bound": tendon["yield_force"]}


def _ran(verification: Verification | None) -> bool:
    return verification is not None and verification.outcome not in NO_PEAK


def _trace(advice: Advice) -> Reason:
    trust, ran = advice.trust, _ran(advice.verification)
    if advice.response["outcome"] in NO_PEAK:
        return f"trace.{advice.response['outcome']}", {}
    if advice.yields:
        return "trace.yields", {}
    if not advice.copies_differ and trust.kind != "statistics":
        return "trace.one_run", {}
    if trust.kind == "trace":
        return "trace.whole", {"names": ("model", *(["engine"] if ran else []), "copies")}
    if advice.peak <= CLOSED_TILT:
        return "trace.hardly", {"peak": advice.peak}
    methods, copies = trust.because == "methods", math.isfinite(advice.divergence_time)
    return "trace.statistics" if trust.kind == "statistics" else "trace.peak", {
        "reason": "it_falls" if advice.overturned else "largest_tilt",
        "time": advice.response["peak_time"],
        # a smaller difference than that of the copies, which is why it may come before
        "difference": _tolerance(advice) if methods else math.nan,
        "time_engine": trust.until if methods and ran else math.nan,
        "time_predicted": trust.until if methods and not ran else math.nan,
        "share": advice.facts["perturbation"],
        "time_copies": advice.divergence_time if copies else math.nan,
    }


def _intensity(advice: Advice) -> Reason:
    low, high = advice.range_as_strong
    values = {"count": len(advice.as_strong), **_RANGE}
    if math.isnan(low):
        return "intensity.not_run", {}
    if advice.grades["intensity"] == "not tested":
        return "intensity.yields_at", {"factor": advice.yields_from}
    if math.isinf(high):
        lowest, share = advice.overturning_as_strong
        return "intensity.overturns", {**values, "share": share, "factor": lowest}
    if high <= CLOSED_TILT:
        return "intensity.hardly", {**values, "peak": high}
    if low == 0.0:
        return "intensity.rests", values
    low, peak = max(low, CLOSED_TILT), max(advice.peak, CLOSED_TILT)
    return "intensity.ratio", {**values, "ratio_least": low / peak, "ratio_largest": high / peak}


def _engine(advice: Advice) -> Reason:
    verification = advice.verification
    if verification is None:
        return "engine.not_run", {}
    if verification.outcome in NO_PEAK:
        return f"engine.{verification.outcome}", {"names": tuple(codes_in(verification.diagnostics))}
    # copies part earlier: they are shaken by a little more or less
    until, predicted = _agreed_until(verification), _predicted_until(advice)
    stopped = verification.stopped if math.isfinite(verification.stopped) else math.nan
    values = {"until": until, "predicted": predicted, "time": stopped}
    if verification.divergence == "earlier":
        return "engine.earlier", values
    if not verification.moves:
        return "engine.rests", {}
    if (verification.outcome == "overturned") != advice.overturned:
        return ("engine.stands" if advice.overturned else "engine.overturns"), {}
    if verification.divergence == "too little motion":
        return "engine.little", values
    if verification.divergence in UNTESTED:
        return "engine.untested", values
    return ("engine.as_predicted" if until == predicted else "engine.agrees"), values


def _tolerance(advice: Advice) -> float:
    """Tilt difference of model and engine that ends their agreement [alpha]."""
    return float(min(AGREEMENT, advice.response["tolerance"]))


def _predicted_until(advice: Advice) -> float:
    """Predicted end of the agreement [s]; inf: that of the run."""
    prediction = advice.facts["prediction"]
    return float(advice.response["uplift_time"] + prediction["length"]) if prediction["reason"] else math.inf


def _agreed_until(verification: Verification) -> float:
    """End of the agreement [s]; inf: that of the run."""
    return verification.agreed_until if verification.diverged else math.inf


def _groups(advice: Advice) -> Iterator[Finding]:
    """Each group of runs; what they are compared with, beside copies."""
    rows = {str(row["group"]): row for row in advice.groups.to_dict("records")}
    for group, row in rows.items():
        values: dict[str, Value] = {
            "name": group_name(advice, group),
            "runs": int(row["runs"] - row["failed"]),
        }
        if row["single"]:
            yield Finding(
                key="group.one_run", values={**values, "peak": float(row["peak_tilt_95"])}, runs=group
            )
            continue
        values |= {
            "overturned": int(row["overturned"]),
            "share": (row["chance"], row["chance_low"], row["chance_high"]),
            "count": int(row["covered"]),
            "peak": float(row["peak_tilt_95"]),
        }
        if row.get("yielded", 0):
            yield Finding(
                key="group.yielded",
                level="not tested",
                values={**values, "count": int(row["yielded"])},
                runs=group,
            )
            continue
        level = grade_chance(row["chance"]) if row["counts"] else "note"
        yield Finding(key="group.runs", level=level, values=values, runs=group)
    others = [group for group in (ACCELERATION, VELOCITY) if group in rows]
    if not others:
        return
    one, records = rows[others[0]], str(advice.facts["records"])
    plane = "one_component" if advice.response["in_one_plane"] else None
    compared: dict[str, Value] = {"count": int(one["runs"]), "name": records, "reason": plane}
    if not advice.moves:  # no table says what they do to what stays at rest as given
        moving = advice.members[advice.members["peak_tilt"] > 0.0]["group"]
        for group in others:
            compared[f"runs_{group}"] = int((moving == group).sum())
            compared[f"overturned_{group}"] = int(rows[group]["overturned"])
    yield Finding(key="compared.moves" if advice.moves else "compared.at_rest", values=compared)


def covering_values(advice: Advice, row: Mapping[Any, Any]) -> dict[str, Value]:
    """Number and group of the runs whose demand is covered, and their shaking."""
    return {
        "count": int(row["covered"]),
        "runs": int(row["runs"]),
        "name": f"{group_name(advice, row['group'])}_runs",
        "factor": math.nan if row["factor"] == 1.0 else float(row["factor"]),
    }


def _demands(advice: Advice) -> Iterator[Finding]:
    """Each design demand, what acts together, and the wall."""
    if not advice.moves:
        return
    rows = {str(row["demand"]): row for row in advice.demands.to_dict("records")}
    for name, row in rows.items():
        if name in ("tilt", "wall_height", "clearance"):
            continue
        if math.isnan(row["value"]):
            yield _without(advice, row, "demand.", name)
        else:
            values = {"demand": float(row["value"]), "detail": row["unit"], **covering_values(advice, row)}
            yield Finding(key=f"demand.{name}", values=values, runs=str(row["group"]))
    given = [name for name in _ACTING if name in rows and not math.isnan(rows[name]["value"])]
    for name in given:
        acting = {part: rows[name][f"with_{part}"] for part in given}
        # no moment where the support supplies none, or none is known
        if name == "force" or math.isnan(acting["force"]):
            continue
        values = {
            f"force_{part}": value if value > _NOTHING * rows[part]["value"] else 0.0
            for part, value in acting.items()
        }
        if f"{acting[name]:.3g}" == f"{rows[name]['value']:.3g}":
            del values[f"force_{name}"]
        yield Finding(key=f"together.{name}", values=values)
    if "clearance" in rows:
        row, tendon = rows["clearance"], advice.facts.get("tendon") or {"balance_tilt": 1.0}
        if math.isnan(row["value"]):
            yield _without(advice, row, "wall.", "")
        else:
            yield _note(
                "wall.size",
                length_height=rows["wall_height"]["value"],
                length_clearance=row["value"],
                tilt=rows["tilt"]["value"] * advice.cylinder.alpha,
                reason="beyond_balance" if rows["tilt"]["value"] > tendon["balance_tilt"] else None,
                **covering_values(advice, row),
            )
    if len(advice.weaker):
        factors = ", ".join(f"{factor:.2g}" for factor in sorted(set(advice.weaker["factor"])))
        yield _note("demand.weaker")
        yield _note("demand.levels", detail=factors, runs=WEAKER_COUNT)
    if support_named(advice.facts["support"]).is_recess:
        yield _note("wall.moment")
        yield _note("wall.balance", factor=PASSED)


def _without(advice: Advice, row: Mapping[Any, Any], group: str, name: str) -> Finding:
    """Reason and group of a demand without a value."""
    reason = row["reason"] if row["reason"] in ("yields", "overturns") else "other"
    about: dict[str, Value] = {"reason": f"demand_{name}"} if name else {}
    if reason == "other":
        return Finding(
            key=f"{group}none_other", level="not tested", values={**about, "detail": row["reason"]}
        )
    values = {**about, **covering_values(advice, row)}
    return Finding(key=f"{group}none_{reason}", level="not tested", values=values)


def _steps(advice: Advice) -> Iterator[Finding]:
    slip, lost = advice.missing
    values: dict[str, dict[str, Value]] = {
        "friction unknown": {"bound": advice.cylinder.tan_alpha},
        "slides": {"given": advice.facts["friction"], "bound": advice.cylinder.tan_alpha},
        "more friction": {"given": advice.facts["friction"], "share": slip},
        "contact": {"share": lost},
    }
    for step in advice.next_steps:
        yield Finding(key=f"step.{step.replace(' ', '_')}", values=values.get(step, {}))


def _checks(advice: Advice) -> Iterator[Finding]:
    """Findings of the evidence for the grades."""
    if not advice.moves:
        return
    response, groups, copies = advice.response, advice.groups, advice.members
    copies = copies[(copies["group"] == COPIES) & (~copies["outcome"].isin(NO_PEAK))]
    if response["uplift_time"] > 0.0:
        yield _note("evidence.uplift", time=response["uplift_time"])
    less = float((copies["peak_tilt"] < advice.peak).mean()) if advice.copies_differ else math.nan
    reason = "it_falls" if advice.overturned else "largest_tilt"
    yield _note("evidence.peak", reason=reason, time=response["peak_time"], share=less)
    yield from _agreement(advice)
    yield from _scales(advice)
    yield from _ratios(advice)
    spike = response["largest_normal_force"]
    if len(groups) and spike > groups["force_95"].max():
        yield _note("evidence.spike", force=spike, share=SPIKES)
    if response["in_one_plane"]:
        yield _note("evidence.in_one_plane")
    if advice.yielded:
        yield _note("planar.yields")
    elif not len(advice.planar):
        yield _note("planar.release" if advice.facts["release"] else "planar.vertical")


def _agreement(advice: Advice) -> Iterator[Finding]:
    trust, verification, ran = advice.trust, advice.verification, _ran(advice.verification)
    whole = trust.kind == "trace"
    ends = (
        ("methods_diverge" if ran else "methods_predicted") if trust.because == "methods" else "copies_spread"
    )
    yield _note("evidence.trusted", until=math.inf if whole else trust.until, reason=None if whole else ends)
    yield _note(
        "evidence.predicted",
        difference=_tolerance(advice),
        predicted=_predicted_until(advice),
        reason=f"predicted_{advice.facts['prediction']['reason']}",
    )
    if verification is None:
        return
    engine: dict[str, Value] = {
        "name": f"{verification.label} {verification.version}",
        "duration": verification.time_step,
    }
    if not ran:
        yield _note(
            "evidence.engine_failed",
            **engine,
            names=tuple(codes_in(verification.diagnostics)),
            reason=verification.outcome,
        )
        return
    fell = verification.outcome == "overturned"
    yield _note(
        "evidence.engine",
        **engine,
        until=_agreed_until(verification),
        reason=f"divergence_{verification.divergence}",
        reason_end="overturns" if fell else "moves" if verification.moves else "at_rest",
        peak=verification.peak_tilt if verification.moves and not fell else math.nan,
    )


def _scales(advice: Advice) -> Iterator[Finding]:
    low, high = advice.range_as_strong
    if not math.isnan(low) and not advice.overturned and advice.grades["intensity"] != "not tested":
        yield _note(
            "evidence.as_strong", count=len(advice.as_strong), **_RANGE, peak_least=low, peak_largest=high
        )
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


def _ratios(advice: Advice) -> Iterator[Finding]:
    """Largest tilts of copies by one of two ways over those by the other."""
    if advice.yielded:
        return
    facts, vertical = advice.facts, advice.vertical
    other = FLAT if support_named(facts["support"]).is_recess else RECESS
    record = vertical.record if vertical.source == "other" else None
    for name, ratios, said in (
        (f"on_{other}", facts["other_support"], None),
        ("with_vertical", vertical.ratios, record),
    ):
        if ratios is None:
            continue
        fell = int(ratios["overturned"]), int(ratios["against_overturned"])
        ratio = (ratios["ratio"], ratios["low"], ratios["high"])
        yield _note(
            "evidence.ratio",
            name=name,
            detail=said,
            ratio=math.nan if math.isnan(ratios["ratio"]) else ratio,
            count=int(ratios["count"]),
            count_more=int(ratios["higher"]),
            count_less=int(ratios["lower"]),
            overturned=fell[0] if any(fell) else None,
            overturned_without=fell[1] if any(fell) else None,
            runs=int(ratios["members"]),
        )


def _case(advice: Advice) -> Iterator[Finding]:
    """Findings of the input: body, ground motion or release, support, tendon, other records, mass."""
    facts, cylinder = advice.facts, advice.cylinder
    frame, motion, release, tendon = (
        "columns" in facts["cylinder"],
        facts["motion"],
        facts["release"],
        facts.get("tendon"),
    )
    if frame:
        yield _note(
            "case.frame", count=facts["cylinder"]["columns"], ratio=facts["cylinder"]["slab_mass_ratio"]
        )
    yield _note(
        "case.body",
        length=cylinder.base_radius,
        length_height=2.0 * cylinder.half_height,
        tilt=cylinder.alpha,
        ratio=cylinder.tan_alpha,
    )
    if motion:
        yield _note(
            "case.motion",
            name=motion["name"] or "Record",
            ratio=motion["peak"] / facts["gravity"],
            factor=1.0 / motion["uplift_factor"],
            duration=facts["length"],
        )
    if release:
        yield _note(
            "case.release", tilt=release["tilt"], rate=release["rolling_rate"], duration=facts["length"]
        )
    friction, resistance = facts["friction"], facts["rolling_resistance"]
    yield _note(
        "case.support",
        name=facts["support"],
        given=math.nan if friction is None else friction,
        length=resistance or math.nan,
    )
    if tendon:
        yield _steel(tendon)
    mass = facts["mass"]
    whole = math.nan if mass is None else mass * (1.0 + cylinder.slab_mass_ratio)
    yield _note(
        "weight.column" if frame else "weight.cylinder",
        mass=whole,
        mass_column=math.nan if mass is None else mass,
    )
    if facts["records"]:
        yield _note("case.records", name=f"records_{facts['records']}")


def _steel(tendon: Mapping[str, Any]) -> Finding:
    """Effect of a tendon on uplift, stiffness and balance."""
    stress = tendon.get("unit_stress")
    return _note(
        "steel.couple",
        given=tendon["prestress"],
        given_stiffness=tendon["stiffness"],
        stress=stress * tendon["prestress"] if stress else math.nan,
        stress_weight=stress or math.nan,
        factor=tendon["uplift_factor"],
        bound=tendon["initial_stiffness"],
        # elastic: beyond its yield it does not
        peak=min(tendon["balance_tilt"], tendon.get("yield_tilt", math.inf)),
    )


def _assumptions(advice: Advice) -> Iterator[Finding]:
    """Assumptions of the models."""
    facts, cylinder = advice.facts, advice.cylinder
    other = "besides_rolling" if facts["rolling_resistance"] else None
    yield _note("assumption.rigid", share=1.0 - restitution_from_momentum(cylinder), reason=other)
    if "columns" in facts["cylinder"]:
        yield _note("assumption.slab", count=facts["cylinder"]["columns"])
    yield _note("assumption.recess" if support_named(facts["support"]).is_recess else "assumption.flat")
    if facts.get("tendon") is not None:
        yield _note("assumption.tendon")
    motion = facts["motion"]
    yield _note("assumption.ground", reason=None if motion and motion["has_vertical"] else "no_vertical")
    if len(advice.as_strong):
        factor = AS_STRONG[1] / AS_STRONG[0]
        yield _note("assumption.as_strong", count=len(advice.as_strong), **_RANGE, factor=factor)
    yield _note("assumption.verified")
