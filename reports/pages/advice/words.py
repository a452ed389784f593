"""What an advice says, in sentences made from its numbers: one for each topic, with the run behind it."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import TYPE_CHECKING

from rockwobble.compare.metrics.agreement import AGREEMENT
from rockwobble.compare.studies.advice.demands import Demands
from rockwobble.compare.studies.advice.grades import Trust

from ..words import seconds

if TYPE_CHECKING:
    from rockwobble.compare.studies.advice import Verification

# a difference in the largest tilt that is none
_TINY = 1e-3
# a couple that is rounding [weight x b]
_NO_COUPLE = 1e-9


@dataclass(frozen=True, slots=True, kw_only=True)
class Statement:
    """One thing that an advice says.

    Parameters
    ----------
    topic : str
    grade : {"good", "care", "bad", ""}
        Empty for what is neither good nor bad.
    text : str
    run : str
        The run behind it.
    """

    topic: str
    grade: str
    text: str
    run: str


def friction_words(demands: Demands, tan_alpha: float) -> str:
    """Say what friction it takes, and whether there is as much."""
    given = f"{demands.friction:g}"
    if demands.slides:
        return (
            f"A friction of {given} is below b/h = {tan_alpha:g}: at rest the cylinder slides where it would "
            "have uplifted, and none of what follows happens."
        )
    usual = f"{demands.friction_usual:.3g}"
    need = f"{demands.friction_needed:.3g} at most, and {usual} in 99 % of the time in motion"
    if not math.isfinite(demands.friction_needed):
        need = f"{usual} in 99 % of the time in motion, and more than any where contact is lost"
        if not math.isfinite(demands.friction_usual):
            need = "more than any friction for over 1 % of the time in motion, because contact is lost"
    if demands.slip_time > 0.0:
        return (
            f"A friction of {given} does not suffice: it takes {need}. The cylinder would slip from "
            f"{seconds(demands.slip_from)} on, for {_brief(demands.slip_time)} in all "
            f"({_percent(demands.slip_time, demands.moving_time)} of the time in motion)."
        )
    return f"A friction of {given} suffices: it takes {need}."


def couple_words(demands: Demands, support: str) -> str:
    """Say what couple holds the cylinder in its place."""
    if support == "flat":
        return "Open ground supplies no couple: nothing keeps the cylinder from rolling out of its place."
    if demands.couple_in_radii < _NO_COUPLE:
        return "In a motion without spin nothing rolls out, and the recess supplies no couple."
    return (
        f"To keep the cylinder from rolling out, the recess must supply a couple of up to "
        f"{demands.couple:.3g} kN m for each tonne of its mass ({demands.couple_in_radii:.3g} weight × b), "
        f"and {demands.couple_usual:.3g} kN m per tonne in 99 % of the time in motion."
    )


def contact_words(demands: Demands) -> str:
    """Say whether and when contact would be lost."""
    if demands.lost_time > 0.0:
        return (
            f"Contact would be lost from {seconds(demands.lost_from)} on, for "
            f"{_brief(demands.lost_time)} in all "
            f"({_percent(demands.lost_time, demands.moving_time)} of the time in motion): the ground would "
            f"have to pull with {-demands.least_normal_force:.2g} weights."
        )
    return (
        f"Contact is never lost: the normal force stays between {demands.least_normal_force:.3g} and "
        f"{demands.largest_normal_force:.3g} weights."
    )


def horizon_words(length: float, reason: str, uplift: float, run_length: float) -> str:
    """Say when reduced model and engine have to part.

    Parameters
    ----------
    length, reason
        As in `Prediction`.
    uplift : float
        [s]
    run_length : float
        [s]
    """
    within = f"within {100.0 * AGREEMENT:g} % of α"
    if not reason:
        return f"Reduced model and engine should agree {within} to the end ({seconds(run_length)})."
    why = {
        "pass": "a pass then comes closer to upright than contact resolves",
        "growth": "by then near passes have multiplied the error of an engine's step to that size",
        "model form": "by then the two supports make a difference",
    }[reason]
    return (
        f"Reduced model and engine should agree {within} for {seconds(length)} from uplift or release, until "
        f"{seconds(uplift + length)}: {why}."
    )


def engine_words(found: Verification, peak: float) -> str:
    """Say what the run of the engine showed; `peak` is that of the reduced model [alpha]."""
    if found.outcome == "failed":
        return f"{found.label} could not verify that: {found.message}."
    if found.diverged:
        predicted = {
            "in time": "as predicted",
            "later": "longer than predicted, which stays on the safe side",
            "earlier": "less than half as long as predicted: do not rely on either before you know why",
        }[found.divergence]
        said = f"{found.label} agreed for {seconds(found.agreement)}, {predicted}."
    else:
        said = f"{found.label} agreed to the end."
    if found.outcome == "overturned":
        return f"{said} It overturns."
    return f"{said} Its largest tilt is {found.peak_tilt:.3g} α against {peak:.3g} α."


def trust_words(
    trust: Trust,
    peak_time: float,
    count: int,
    percent: float,
    *,
    what: str = "largest tilt",
    verified: bool = True,
    in_one_plane: bool = False,
) -> str:
    """Say whether to trust the trace or only statistics.

    Parameters
    ----------
    trust : Trust
    peak_time : float
        [s]
    count : int
        Perturbed members.
    percent : float
        By how much they differ.
    what : str, optional
        What happens at `peak_time`.
    verified : bool, optional
        Whether an engine has shown when the methods part.
    in_one_plane : bool, optional
        Whether the motion never leaves its plane.
    """
    plane = (
        " This motion stays in one plane and goes straight through upright; the slightest motion across it "
        "goes round to the left or to the right instead, which no start here has tried."
        if in_one_plane
        else ""
    )
    return _trust(trust, peak_time, count, percent, what, verified) + plane


def _trust(trust: Trust, peak_time: float, count: int, percent: float, what: str, verified: bool) -> str:
    if trust.kind == "trace":
        return (
            "Trust the trace to its end: neither the method nor "
            f"a {percent:g} % change of the data ({count} starts) makes it another one."
        )
    why = {
        "methods": "reduced model and engine part there" + ("" if verified else ", as predicted"),
        "data": f"{count} starts {percent:g} % off are spread over half of the largest tilt there",
    }[trust.because]
    if trust.kind == "peak":
        return (
            f"Trust the trace until {seconds(trust.until)}, the {what} ({seconds(peak_time)}) "
            f"included; {why}. Of what follows trust statistics."
        )
    return (
        f"Trust the trace until {seconds(trust.until)} and only statistics from then on, those of the {what} "
        f"(here at {seconds(peak_time)}) included: {why}."
    )


def error_words(data: float, form: float, low: float, high: float, percent: float, *, single: bool) -> str:
    """Say what error in the largest tilt to expect, and where it comes from.

    Parameters
    ----------
    data : float
        Relative error from data that are off by `percent`; NaN if unknown.
    form : float
        Relative difference that the other support makes; NaN if unknown.
    low, high : float
        5 % and 95 % quantiles of the largest tilt [alpha].
    percent : float
        [%]
    single : bool
        Whether `form` is that of the single runs, not of the medians.
    """
    if math.isnan(data):
        return ""
    of = "in this run" if single else "in the median of the starts"
    main = (
        "the data"
        if data >= abs(form) or math.isnan(form)
        else "the support: know whether it holds like a recess"
    )
    if math.isinf(data):
        said = f"Data {percent:g} % off give {low:.3g} α to overturning (90 % of the starts)."
    else:
        said = (
            f"Data {percent:g} % off give {low:.3g} to {high:.3g} α (90 % of the starts), an error of up to "
            f"{_relative(data)}."
        )
    if math.isfinite(form):
        said += (
            f" The other support (recess or open ground) would make {_signed(form)} {of}. The "
            f"larger of the two is due to {main}."
        )
    return said


def _brief(value: float) -> str:
    return f"{value:.2g} s"


def _percent(part: float, whole: float) -> str:
    return f"{100.0 * part / whole:.2g} %" if whole > 0.0 else "all"


def _relative(value: float) -> str:
    if abs(value) < _TINY:
        return f"less than {100.0 * _TINY:g} %"
    return f"{100.0 * value:.1f} %" if abs(value) < 0.1 else f"{100.0 * value:.0f} %"


def _signed(value: float) -> str:
    if abs(value) < _TINY:
        return "no difference"
    return f"{100.0 * value:+.1f} %" if abs(value) < 0.1 else f"{100.0 * value:+.0f} %"
