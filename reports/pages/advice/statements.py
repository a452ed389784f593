"""The verdict of an advice and its statements, in the order in which they are read."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

from rockwobble.compare.studies.advice.grades import GRADES
from rockwobble.compare.studies.spectrum.series import SPATIAL

from ..words import seconds
from . import scale_words, words
from .words import Statement

if TYPE_CHECKING:
    from rockwobble.compare.studies.advice import Advice

GRADE_WORDS = {"good": "sound", "care": "care", "bad": "fails", "": ""}
_LEADS = {
    "good": "Use the {model} model",
    "care": "Use the {model} model with care",
    "bad": "Do not rely on the {model} model here",
}


def verdict(advice: Advice) -> str:
    """Return the one sentence that stands first."""
    if advice.response.outcome == "failed":
        return f"No advice: the {advice.model} model failed, {advice.response.message}."
    if not advice.moves:
        return _stays(advice.uplift_factor)
    lead = _LEADS[advice.model_grade].format(model=advice.model)
    reasons = _reasons(advice)
    if advice.model_grade == "bad":
        return f"{lead}: {'; '.join(reasons)}."
    parts = [f"{lead}{_how_far(advice)}", _what_happens(advice), *reasons]
    if advice.planar is not None and advice.planar.kind == "unconservative":
        parts.append("a planar analysis would be unconservative")
    return "; ".join(parts) + "."


def verdict_grade(advice: Advice) -> str:
    """Return the grade of the verdict; a cylinder that overturns is not good news either."""
    return max([advice.model_grade, *advice.grades.values()], key=GRADES.index)


def statements(advice: Advice) -> list[Statement]:
    """Return what there is to say of a case, each with the run behind it."""
    if advice.response.outcome == "failed":
        return []
    found = [*_of_motion(advice)] if advice.moves else []
    return [*found, *_of_scales(advice)]


def _stays(factor: float) -> str:
    if not math.isfinite(factor):
        return "The cylinder stays at rest: this ground motion uplifts it at no scale."
    return f"The cylinder stays at rest: it takes {factor:.3g} times this shaking to uplift it."


def _reasons(advice: Advice) -> list[str]:
    """What rules the model out or, where nothing does, wants care."""
    demands, grade = advice.demands, advice.model_grade
    said = {
        "friction": f"a friction of {demands.friction:g} does not suffice, it takes "
        f"{max(demands.friction_usual, advice.case.cylinder.tan_alpha):.3g} and more",
        "contact": "contact would be lost for "
        f"{100.0 * demands.lost_time / max(demands.moving_time, 1e-300):.2g} % of the time in motion",
        "engine": "the engine leaves it earlier than predicted"
        if grade == "bad"
        else "the engine comes to another end",
    }
    return [text for topic, text in said.items() if grade != "good" and advice.grades.get(topic) == grade]


def _how_far(advice: Advice) -> str:
    trust = advice.trust
    if trust.kind == "trace":
        return ": its trace holds to the end"
    if trust.kind == "peak":
        return f": its trace holds until {seconds(trust.until)}, the {_event(advice)} included"
    return f", for statistics and not for its trace, which holds until {seconds(trust.until)} only"


def _event(advice: Advice) -> str:
    return "fall" if advice.overturned else "largest tilt"


def _what_happens(advice: Advice) -> str:
    spread = advice.spread
    if advice.overturned:
        return (
            f"the cylinder overturns, and so do {100.0 * advice.overturning_share:.0f} % of perturbed starts"
        )
    tilt = f"the largest tilt is {advice.peak:.3g} α"
    if spread is not None:
        percent = 100.0 * spread.perturbation
        tilt += f" as given, and {_range(advice)} with data known to {percent:g} %"
    lowest = advice.lowest_overturning
    if math.isfinite(lowest) and advice.grades["overturning"] != "good":
        tilt += f"; {'already ' if lowest < 1.0 else ''}{lowest:.3g} times this shaking overturns it"
        assert advice.scan is not None
        if not advice.scan.confirmed[SPATIAL]:
            tilt += ", by chance"
    return tilt


def _range(advice: Advice) -> str:
    assert advice.spread is not None
    low, high = (advice.spread.quantile(share) for share in (0.05, 0.95))
    top = "overturning" if high >= advice.overturned_peak else f"{high:.3g} α"
    return f"{low:.3g} to {top}"


def _of_motion(advice: Advice) -> list[Statement]:
    grades, demands, spread = advice.grades, advice.demands, advice.spread
    assert spread is not None
    percent = 100.0 * spread.perturbation
    rtol = advice.response.problem.rtol
    whole = f"{advice.model} model, {seconds(advice.case.length)} at a relative tolerance of {rtol:g}"
    if advice.overturned:
        whole += ", until the fall"
    starts = f"{spread.count} perturbed starts, {percent:g} %, seed {spread.seed}, {advice.model} model"
    found = [
        Statement(
            topic="Trust",
            grade=grades["trust"],
            text=words.trust_words(
                advice.trust,
                advice.peak_time,
                spread.count,
                percent,
                what=_event(advice),
                verified=advice.verification is not None,
                in_one_plane=advice.in_one_plane,
            ),
            run=starts,
        ),
        Statement(
            topic="Agreement",
            grade="",
            text=words.horizon_words(
                advice.prediction.length,
                advice.prediction.reason,
                advice.response.uplift_time,
                advice.case.length,
            ),
            run=f"{advice.model} model and a disturbed twin of it",
        ),
    ]
    if advice.verification is not None:
        engine = advice.verification
        found.append(
            Statement(
                topic="Engine",
                grade=grades["engine"],
                text=words.engine_words(engine, advice.peak),
                run=f"{engine.label} {engine.version}, step {engine.time_step:.3g} s",
            )
        )
    error = words.error_words(
        advice.data_error,
        advice.form_error,
        spread.quantile(0.05),
        spread.quantile(0.95),
        percent,
        single=advice.trust.kind != "statistics",
    )
    when = seconds(advice.peak_time) if advice.peak_time > 0.0 else "the release"
    if error:
        found.append(
            Statement(
                topic="Largest tilt",
                grade="",
                text=f"{advice.peak:.3g} α = {math.degrees(advice.response.peak_tilt):.3g}° at {when}. "
                f"{error}",
                run=f"{starts}, and the same by the {advice.other} model",
            )
        )
    return [
        *found,
        Statement(
            topic="Friction",
            grade=grades["friction"],
            text=words.friction_words(demands, advice.case.cylinder.tan_alpha),
            run=whole,
        ),
        Statement(topic="Couple", grade="", text=words.couple_words(demands, advice.support), run=whole),
        Statement(topic="Contact", grade=grades["contact"], text=words.contact_words(demands), run=whole),
    ]


def _of_scales(advice: Advice) -> list[Statement]:
    found = []
    scan = advice.scan
    released = advice.case.initial is not None and advice.case.initial.tilt > 0.0
    if math.isfinite(advice.uplift_factor) and not released:
        found.append(
            Statement(
                topic="Uplift",
                grade="",
                text=scale_words.uplift_words(advice.uplift_factor),
                run="none: the condition of uplift at every sample of the record",
            )
        )
    if advice.moves or scan is not None:
        runs = "the run itself" if scan is None else _scan_run(advice)
        found.append(
            Statement(
                topic="Overturning",
                grade=advice.grades.get("overturning", ""),
                text=scale_words.overturning_words(
                    falls=advice.overturned,
                    fall=float(advice.response.time[-1]),
                    lowest=advice.lowest_overturning,
                    planar=math.nan if advice.planar is None else advice.planar.lowest_planar,
                    chance=advice.overturning_share,
                    highest=math.nan if scan is None else float(scan.factors[-1]),
                    search=math.nan if scan is None else scan.search_step,
                    confirmed=scan is not None and scan.confirmed[SPATIAL],
                ),
                run=runs,
            )
        )
    if advice.planar is not None:
        found.append(
            Statement(
                topic="Planar analysis",
                grade="care" if advice.planar.kind == "unconservative" else "",
                text=scale_words.planar_words(advice.planar, advice.case.cylinder.alpha),
                run=f"{_scan_run(advice)}; planar model of each component, without loss at impact",
            )
        )
    elif advice.moves:
        why = (
            "Without a ground motion there is no planar analysis to hold this against."
            if scan is None
            else "A planar analysis of one component knows no release out of its plane: not compared."
        )
        found.append(Statement(topic="Planar analysis", grade="", text=why, run="none"))
    return found


def _scan_run(advice: Advice) -> str:
    assert advice.scan is not None
    factors, start = advice.scan.factors, advice.scan.searched_from[SPATIAL]
    return (
        f"{advice.model} model at {len(factors)} scales, {factors[0]:g} to {factors[-1]:g} times, and from "
        f"{start:.3g} times up to the lowest that overturns"
    )
