"""Grades of an advice: each topic gets the level of its first satisfied criterion.

A grade rests on what was run: "not tested" is the grade of what nothing was run for.
"""

from __future__ import annotations

import math
from collections.abc import Iterable, Iterator, Mapping
from typing import Any

from rockwobble.compare.comparison.prediction import BEATEN, UNTESTED
from rockwobble.compare.metrics.statistics import FEWEST
from rockwobble.models import AGREEMENT, CLOSED_TILT
from rockwobble.models.diagnostic import codes_in
from rockwobble.models.finding import GRADES, Finding, Grade, Value
from rockwobble.models.trace import NO_PEAK

from .demands import COVERED
from .members import ACCELERATION, VELOCITY
from .scales import AS_STRONG

Advice = Any  # class of `.advice`, which imports this module
Criterion = tuple[bool, str, Grade, Mapping[str, Value]]  # whether it holds, key, level, values

POOR: tuple[Grade, ...] = ("caution", "not satisfied")
# share of the moving time for which contact or friction may be missing before the motion is another one:
# below it stand the spikes of single passes, milliseconds each
BROKEN = 0.01
# a lowest overturning scale below this is near: records of one site differ by as much
NEAR = 1.5
# share of a group that overturns from which on a cylinder is not safe
UNSAFE = 0.1
# ratio by which the largest tilt may change under shaking as strong
SENSITIVE = 1.5
# margin of the ratio, for peaks between the simulated scales
BETWEEN_SCALES = 1.05
RANGE: Mapping[str, Value] = {"share_weaker": 1.0 - AS_STRONG[0], "share_stronger": AS_STRONG[1] - 1.0}

# numbers that the words of a criterion name, by topic
_SHARES = {"share": BROKEN, "share_covered": COVERED, "runs": FEWEST}
_CRITERIA: Mapping[str, Mapping[str, Value]] = {
    "overturning": {"factor": NEAR, "share": UNSAFE},
    "friction": _SHARES,
    "contact": _SHARES,
    "tendon": _SHARES,
    "intensity": {"factor": SENSITIVE, "share_margin": BETWEEN_SCALES - 1.0},
    "engine": {"factor": BEATEN},
}


def criterion(topic: str, grade: Grade) -> Finding:
    """Criterion for a grade of a topic, in words."""
    key = f"criterion.{topic}_{grade.replace(' ', '_')}"
    return Finding(key=key, level=grade, values=_CRITERIA.get(topic, {}))


def overall(grades: Iterable[Grade]) -> Grade:
    """Worst of some grades; "not tested" of none."""
    return max(grades, key=GRADES.index, default="not tested")


def grade_chance(chance: float) -> Grade:
    """Grade of the share of runs that overturn; "not tested" of NaN."""
    if math.isnan(chance):
        return "not tested"
    return "not satisfied" if chance > UNSAFE else "caution" if chance > 0.0 else "satisfied"


def graded(advice: Advice) -> Iterator[Finding]:
    """Grade of each topic that applies to the case, with the values that decide it."""
    outcome, facts = advice.response["outcome"], advice.facts
    if outcome in NO_PEAK:
        yield Finding(key=f"trace.{outcome}", level="not satisfied")
    elif advice.slides_at_rest:
        values = {"given": facts["friction"], "demand": facts["motion"]["friction_at_rest"]}
        yield Finding(key="friction.slides_at_rest", level="not satisfied", values=values)
    elif advice.moves and not advice.slides:
        topics = {
            "overturning": _overturning,
            "friction": _friction,
            "contact": lambda advice: _missing(advice, advice.missing[1], "lost", {}),
            "trace": _trace,
            "tendon": _tendon,
            "intensity": _intensity,
            "engine": _engine,
        }
        for topic, criteria in topics.items():
            first = next((each for each in criteria(advice) if each[0]), None)
            if first is not None:
                yield Finding(key=f"{topic}.{first[1]}", level=first[2], values=first[3])


def group_name(advice: Advice, group: str) -> str:
    """Words-table name of a group of runs; for other records with their kind."""
    return f"{group}_{advice.facts['records']}" if group in (ACCELERATION, VELOCITY) else group


def _overturning(advice: Advice) -> Iterator[Criterion]:
    """Criteria on overturning: the run as given, the groups, and other scales without tendon yield."""
    lowest, beyond, groups = advice.lowest_factor, advice.yields_from, advice.counting
    shaken, yielded = advice.facts["motion"] is not None, advice.yielded
    known = len(advice.lowest) > 0 if shaken else advice.copies_differ
    grade: Grade = "satisfied" if known and not (advice.yields or yielded or beyond < NEAR) else "not tested"
    chances = overall(map(grade_chance, groups["chance"]))
    if advice.overturned or chances == "not satisfied":
        grade = "not satisfied"
    elif chances == "caution" or lowest < NEAR:
        grade = "caution"
    near = {"factor": lowest if grade == "caution" and lowest < NEAR else math.nan}
    yield advice.overturned, "as_given", grade, {}
    yield advice.yields, "yields_as_given", grade, {}
    if (groups["chance"] > 0.0).any():
        worst = groups.loc[groups["chance"].idxmax()]
        counts = {"overturned": int(worst["overturned"]), "runs": int(worst["runs"] - worst["failed"])}
        yield True, "group", grade, counts | {"name": group_name(advice, worst["group"]), **near}
    yield grade == "caution", "scale", grade, near
    yield yielded > 0, "yielded", grade, {"count": yielded, "runs": int(groups["runs"].sum())}
    yield beyond < NEAR, "yields_at", grade, {"factor": beyond}
    yield not shaken, "no_copy" if grade == "satisfied" else "one_run", grade, {}
    yield not known, "no_scales", grade, {}
    yield lowest > 0.0, "none_but", grade, {"factor": lowest}
    yield not math.isnan(beyond), "none_but_yields", grade, {"factor": beyond}
    yield True, "none_up_to", grade, {"factor": float(advice.scales["factor"].max())}


def _friction(advice: Advice) -> Iterator[Criterion]:
    given, border = advice.facts["friction"], advice.cylinder.tan_alpha
    demand = float(advice.demands.set_index("demand")["value"].get("friction", math.nan))
    if given is None:
        yield True, "not_given", "caution", {"demand": demand}
        return
    values = {"given": given, "demand": demand}
    slides = given < border and advice.response["uplift_time"] > 0.0
    yield slides, "below_border", "not satisfied", {**values, "bound": border}
    yield from _missing(advice, advice.missing[0], "too_little", values)


def _missing(advice: Advice, share: float, key: str, values: Mapping[str, Value]) -> Iterator[Criterion]:
    """Criteria on a share of the time without friction or contact, exceeded by at most 5 % of the runs."""
    groups = advice.counting
    spread = not advice.yielded and bool((~groups["single"] & groups["lost_95"].notna()).any())
    yield share > BROKEN, key, "not satisfied", {**values, "share": share}
    yield share > 0.0, key, "caution", {**values, "share": share}
    yield spread, "enough", "satisfied", values
    yield advice.yielded > 0, "yielded", "not tested", {"count": advice.yielded}
    yield True, "few", "not tested", {"runs": FEWEST}


def _trace(advice: Advice) -> Iterator[Criterion]:
    trust, ran, copies = advice.trust, has_run(advice), math.isfinite(advice.divergence_time)
    statistics, methods = trust.kind == "statistics", trust.because == "methods"
    grade: Grade = "caution" if statistics else "satisfied" if advice.copies_differ else "not tested"
    yield advice.yields, "yields", "not satisfied", {}
    yield grade == "not tested", "one_run", grade, {}
    yield trust.kind == "trace", "whole", grade, {"names": ("model", *(["engine"] if ran else []), "copies")}
    yield advice.peak <= CLOSED_TILT, "hardly", grade, {"peak": advice.peak}
    values: dict[str, Value] = {
        "reason": end_of_motion(advice),
        "time": advice.response["peak_time"],
        # a smaller difference may precede the divergence of the copies
        "difference": tolerance(advice) if methods else math.nan,
        "time_engine": trust.until if methods and ran else math.nan,
        "time_predicted": trust.until if methods and not ran else math.nan,
        "share": advice.facts["perturbation"],
        "time_copies": advice.divergence_time if copies else math.nan,
    }
    yield True, trust.kind, grade, values


def _tendon(advice: Advice) -> Iterator[Criterion]:
    tendon = advice.facts.get("tendon")
    if tendon is None:
        return
    force = float(advice.demands.set_index("demand")["value"].get("tendon", math.nan))
    force = force if math.isfinite(force) else advice.response["tension"]
    stress, limit = tendon.get("unit_stress"), tendon["yield_force"]
    values = {"force": force, "stress": stress * force if stress else math.nan}
    if limit is None:
        yield True, "no_yield_force", "caution", values
        return
    values["bound"] = limit
    yield force > limit, "above", "not satisfied", values
    yield True, "below", "satisfied" if advice.copies_differ else "not tested", values


def _intensity(advice: Advice) -> Iterator[Criterion]:
    """Criteria on the peak tilt under equally strong shaking; tilts of a closed base count as equal."""
    if advice.facts["motion"] is None or advice.overturned:
        return
    (least, most), limit = advice.range_as_strong, SENSITIVE / BETWEEN_SCALES
    low, peak, high = (max(each, CLOSED_TILT) for each in (least, advice.peak, most))
    grade: Grade = "caution" if high > limit * peak or low * limit < peak else "satisfied"
    lowest, share = advice.overturning_as_strong
    values = {"count": len(advice.as_strong), **RANGE}
    yield math.isnan(least), "not_run", "not tested", {}
    yield advice.yields_from <= AS_STRONG[1], "yields_at", "not tested", {"factor": advice.yields_from}
    yield math.isinf(most), "overturns", grade, {**values, "share": share, "factor": lowest}
    yield most <= CLOSED_TILT, "hardly", grade, {**values, "peak": most}
    yield least == 0.0, "rests", grade, values
    yield True, "ratio", grade, {**values, "ratio_least": low / peak, "ratio_largest": high / peak}


def _engine(advice: Advice) -> Iterator[Criterion]:
    """Criteria on an engine run: it may diverge earlier than the copies if its difference is smaller."""
    engine = advice.verification
    if engine is None:
        yield True, "not_run", "not tested", {}
        return
    until, predicted = agreed_until(advice), predicted_until(advice)
    stopped = engine.stopped if math.isfinite(engine.stopped) else math.nan
    values = {"until": until, "predicted": predicted, "time": stopped}
    falls = engine.outcome == "overturned"
    yield (
        engine.outcome in NO_PEAK,
        engine.outcome,
        "not tested",
        {"names": tuple(codes_in(engine.diagnostics))},
    )
    yield engine.divergence == "earlier", "earlier", "not satisfied", values
    yield not engine.moves, "rests", "caution", {}
    yield falls != advice.overturned, "overturns" if falls else "stands", "caution", {}
    yield engine.divergence == "too little motion", "little", "not tested", values
    yield engine.divergence in UNTESTED, "untested", "not tested", values
    yield True, "as_predicted" if until == predicted else "agrees", "satisfied", values


def end_of_motion(advice: Advice) -> str:
    """Reason for the time of the peak tilt: overturning, or the maximum itself."""
    return "it_falls" if advice.overturned else "largest_tilt"


def has_run(advice: Advice) -> bool:
    """Whether an engine run exists and did not fail."""
    return advice.verification is not None and advice.verification.outcome not in NO_PEAK


def tolerance(advice: Advice) -> float:
    """Tilt difference of model and engine that ends their agreement [alpha]."""
    return float(min(AGREEMENT, advice.response["tolerance"]))


def predicted_until(advice: Advice) -> float:
    """Predicted end of the agreement [s]; inf: that of the run."""
    prediction = advice.facts["prediction"]
    return float(advice.response["uplift_time"] + prediction["length"]) if prediction["reason"] else math.inf


def agreed_until(advice: Advice) -> float:
    """End of the agreement of an engine [s]; inf: that of the run."""
    return float(advice.verification.agreed_until) if advice.verification.diverged else math.inf
