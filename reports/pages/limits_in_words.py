"""Limits of the reduced model in sentences, each made from its numbers alone.

A sentence of several lines has the lines of the document.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator, Mapping

from rockwobble.compare.metrics.statistics import MARGIN
from rockwobble.models.plain_json import Facts
from rockwobble.models.support import RECESSES_FIRST
from rockwobble.studies.validity.criteria import (
    Limits,
    Verdict,
    clearance_is_unconservative,
    converges_by_record,
    model_verdict,
)
from rockwobble.studies.validity.plan import Structure

from .table import Row, number

_PLACES: Mapping[str, str] = {
    **{support: support.place for support in RECESSES_FIRST},
    "copy": "by a record 1 % stronger alone",
}


def scope(structure: Structure) -> Iterator[str]:
    """Yield a paragraph on bodies that are no single cylinders; its lines are those of the document."""
    if slab := structure.slab_mass_ratio:
        yield (
            f"Of one column under a slab of {number(slab)} times its mass, which only translates: friction, "
            "contact and moment are those\nof base or top, whichever asks for more, over the weight that it "
            "carries. A recess with clearance takes no slab, and is left out."
        )
    if tendon := structure.tendon:
        yield (
            f"Of columns held by a tendon: prestress {number(tendon.prestress, 'g')} weights of a column, "
            f"stiffness {number(tendon.stiffness, 'g')} weights\nper base radius. It raises uplift to "
            f"{number(structure.uplift, 'g')} g tan α, and all shaking here by the same factor. No model on "
            "flat ground\nknows a tendon: there the engine stands beside the model of the recess alone."
        )


def _contradiction(limits: Limits) -> str:
    free, records = limits["free_response"], limits["records"]
    reasons = []
    if free["contradicted"]:
        reasons.append(
            f"the engine contradicts it in {free['contradicted']:.0f} of {free['points']:.0f} runs"
        )
    if records["recess_beyond"]:
        reasons.append(
            f"at {records['recess_beyond']:.0f} of {records['points']:.0f} points its peaks over "
            f"{records['members']:.0f} records are not those of the engine within "
            f"{number(MARGIN, 'percent')} in the median"
        )
    return f"The reduced model is not established even in an ideal recess: {', and '.join(reasons)}."


def _agreement(limits: Limits) -> str:
    records = limits["records"]
    words = (
        f"In an ideal recess the engine has the model's peak tilt: over {records['members']:.0f} records its "
        f"median ratio is {_range(records, 'recess')},\nknown within {number(MARGIN, 'percent')} at "
        f"{records['recess_within']:.0f} of {records['points']:.0f} points and beyond at none."
    )
    return "\n".join(filter(None, [words, _single_records(records)]))


def _doubt(limits: Limits) -> str:
    records = limits["records"]
    known = f"{records['members']:.0f} records are too few for an interval."
    if math.isfinite(records["recess_least"]):
        known = f"over {records['members']:.0f} records its median ratio is {_range(records, 'recess')}."
    words = (
        "It is undecided whether the engine in an ideal recess has the model's peak tilt within "
        f"{number(MARGIN, 'percent')} in the median:\n{known}"
    )
    return " ".join(filter(None, [words, _single_records(records)]))


_VERDICTS: Mapping[Verdict, Callable[[Limits], str]] = {
    "contradicted": _contradiction,
    "established": _agreement,
    "undecided": _doubt,
}


def verdict_words(limits: Limits) -> str:
    """Return the verdict on the reduced model in an ideal recess, with what it rests on."""
    return _VERDICTS[model_verdict(limits)](limits)


def _range(numbers: Mapping[str, float], name: str, form: str = ".3f") -> str:
    """Least and largest of a ratio over the points, once where they are alike."""
    return " to ".join(dict.fromkeys(number(numbers[f"{name}_{end}"], form) for end in ("least", "largest")))


def _single_records(records: Mapping[str, float]) -> str:
    """What the median does not say of the peak of one record; empty where too few records know it."""
    strays = _strays(records)
    if not strays:
        return ""
    alone = " (∞: it overturns by one of the two alone)" if any("∞" in each for each in strays) else ""
    unknown = "" if records["strays_bounded"] else "; no upper bound is known"
    return (
        "The peak of one record is another matter: by point, one record in twenty exceeds the model's by a "
        f"factor of more than\n{', '.join(strays)}{alone},\n"
        f"in samples of {records['members']:.0f} records{unknown}."
    )


def clearance_words(limits: Limits) -> str:
    """Whether the model is safe for a recess with clearance; empty where it is, or too few records know."""
    if not clearance_is_unconservative(limits):
        return ""
    return (
        "A recess with clearance is another system, and the model is not on the safe side of it: this is of "
        "single peaks, not of overturning."
    )


def requirements(limits: Limits) -> Iterator[Row]:
    """Yield what must hold for the model to be used, and the limit of each."""
    friction, contact, moment = (limits[name] for name in ("friction", "contact", "restraining_moment"))
    yield {
        "need": "Friction",
        "limit": f"at most {number(friction['shaken'], 'most .3g')} tan α in all motions, by slenderness and "
        "intensity below; under tan α it slides first",
    }
    kept = (
        f"kept in all {contact['runs']:.0f} motions that rock without overturning, with at least "
        f"{number(contact['least_held'], 'least .2g')} of the weight"
    )
    lost = (
        f"lost in {contact['lost']:.0f} of {contact['runs']:.0f} motions, from tan α = "
        f"{number(contact['lost_from'], 'g')} and {number(contact['lost_intensity'], 'g')} g tan α on"
    )
    yield {"need": "Contact", "limit": lost if contact["lost"] else kept}
    yield {
        "need": "Recess",
        "limit": f"supplies κ, at most {number(moment['shaken'], 'most .2g')} weight × b in all motions; (1 "
        "+ cos θ) κ about the vertical",
    }
    if tendon := limits.get("tendon"):
        yield {
            "need": "Tendon",
            "limit": f"carries at most {number(tendon['shaken'], 'most .3g')} weights of a column in all "
            "motions that do not overturn it; it must not yield",
        }
    soft = limits["soft_contact"]
    stiff = "at no contact tried is the peak within 5 %"
    if math.isfinite(soft["held_up_to"]):
        stiff = (
            f"a time constant of at most {number(soft['held_up_to'], 'least .2g')}/p: there the peak is off "
            f"by at most {number(soft['held_peak'], 'most percent')}{_runs_that_end(soft)}"
        )
    yield {"need": "Stiffness of contact", "limit": stiff}
    yield {
        "need": "Question",
        "limit": "a distribution over records, or one peak as a draw of many; not one trace on flat ground",
    }


def _runs_that_end(soft: Mapping[str, float]) -> str:
    """Of how many runs a contact that is stiff enough is known, and which of them failed."""
    if soft["held_ended"] == soft["held_runs"]:
        return f" in all {soft['held_runs']:.0f} runs"
    dampings = dict.fromkeys(number(soft[f"failed_damping_{end}"], "g") for end in ("least", "largest"))
    return (
        f" in the {soft['held_ended']:.0f} of {soft['held_runs']:.0f} runs that ended; the others failed, "
        f"with up to {number(soft['failed_up_to'], 'most .2g')}/p and damping ratios of "
        f"{' to '.join(dampings)}"
    )


def record_findings(limits: Limits, *, slab: bool) -> Iterator[str]:
    """Yield what became of the runs over records: convergence and walls with clearance, failures."""
    records = limits["records"]
    if not slab and math.isfinite(records["halved_95_least"]):
        converged = "converged" if converges_by_record(limits) else "not converged"
        yield (
            f"Recess with clearance at half its step: median peak {_range(records, 'halved')} times as "
            f"large, one record in twenty {_range(records, 'halved_95', '.2f')}: {converged} record by "
            "record."
        )
    if not slab and records["ring_passed"]:
        yield (
            f"In a recess with clearance {records['ring_passed']:.0f} of the "
            f"{records['ring_standing']:.0f} runs counted as standing pass α and reach up to "
            f"{number(records['ring_passed_largest'], 'most .2f')} α: its walls lean by α and hold them."
        )
    if not slab:
        yield (
            f"Runs that touch its walls: {records['touched']:.0f}, which lose at most "
            f"{number(records['ring_loss_worst'], 'most percent')} of their largest energy."
        )
    if records["failed"]:  # all without a peak
        ends = {"failed": records["failed"] - records["undecided"], "undecided": records["undecided"]}
        left_out = " and ".join(f"{count:.0f} {end}" for end, count in ends.items() if count)
        yield f"Left out of {records['runs']:.0f} runs: {left_out}."


def agreement_rows(traces: Mapping[str, float], *, tendon: bool) -> Iterator[Row]:
    """Yield agreement times of the engine with each model; a tendon is known to the recess model alone."""
    yield _trace_row(traces, "recess", "ideal recess", "recess", counted=True)
    if not tendon:
        yield _trace_row(traces, "flat", "flat ground", "recess", counted=False)
        yield _trace_row(traces, "own", "flat ground", "flat ground", counted=True)


def _trace_row(traces: Mapping[str, float], name: str, place: str, model: str, *, counted: bool) -> Row:
    row: Row = {
        "run": f"engine, {place}",
        "model": model,
        "low": traces[name],
        "high": traces[f"{name}_longest"],
    }
    return {**row, "whole": traces[f"{name}_whole"], "runs": traces[f"{name}_runs"]} if counted else row


def free_findings(free: Mapping[str, float], *, tendon: bool) -> Iterator[str]:
    """Yield how recess and flat ground differ in free response, and what an engine confirms of it."""
    against = f", contradicts it in {free['contradicted']:.0f}" if free["contradicted"] else ""
    runs = f"in {free['confirmed']:.0f} of {free['points']:.0f} runs"
    releases = f"{free['releases']:.0f} releases"
    if tendon:
        yield f"The engine confirms the model {runs} ({releases}){against}."
        return
    alike = "for no slenderness mapped"
    if math.isfinite(free["alike_up_to"]):
        alike = f"up to tan α = {number(free['alike_up_to'], 'g')}"
    yield f"Period and angle of turn as on flat ground to 1 %, at every release and spin: {alike}."
    tan_alpha, release, spin = (
        number(free[f"worst_{name}"], "g") for name in ("tan_alpha", "release", "spin")
    )
    yield (
        f"Off by at most: period {number(free['period_largest'], 'most percent')}; peak in ten periods "
        f"{number(free['peak_gain'], 'most percent')};\nangle of turn "
        f"{number(free['turn_largest'], 'most percent')}, "
        f"or {number(free['turn_largest_deg'], 'most .2g')}°,\nat tan α = {tan_alpha}, release {release} α, "
        f"{spin} of the steady rate."
    )
    open_runs = free["points"] - free["confirmed"] - free["contradicted"]
    unsure = f"; in {open_runs:.0f} its error exceeds half of their difference" if open_runs else ""
    known = f"{runs} ({releases} on two supports){against}{unsure}"
    yield f"The engine confirms the right one of the two models {known}."


def force_findings(limits: Limits, *, slab: bool) -> Iterator[str]:
    """Yield what friction, contact and recess must supply, and what less of it does."""
    friction, contact, moment = (limits[name] for name in ("friction", "contact", "restraining_moment"))
    yield f"Friction demand in free response: at most {number(friction['free_response'], 'most .2g')} tan α."
    if math.isfinite(friction["slips_at"]):
        words = f"At {number(friction['slips_at'], 'g')} of the demand the engine "
        words += (
            "parts from the model"
            if slab  # where slip at the base is not all
            else f"slides {number(friction['slip'], '.2g')} b in one period, and the tilt errs by "
            f"{number(friction['tilt_error'], 'percent')} of α"
        )
        if math.isfinite(friction["holds_from"]):
            words += f"; from {number(friction['holds_from'], 'g')} of it on it holds"
        yield f"{words}."
    else:
        yield "The engine did not slip at any friction tried."
    words = (
        "Least normal force, in weights: of the shaken motions that do not overturn "
        f"{number(contact['shaken_least'], 'least .2g')}; of free response "
        f"{number(contact['free_least'], 'least .2g')}, at tan α = "
        f"{number(contact['free_least_tan_alpha'], 'g')}"
    )
    if math.isfinite(contact["free_lost_from"]):
        words += f", lost there from tan α = {number(contact['free_lost_from'], 'g')} on"
    yield f"{words}."
    slight = "at no slenderness mapped"
    if math.isfinite(moment["slight_up_to"]):
        slight = f"up to tan α = {number(moment['slight_up_to'], 'g')}"
    yield f"A recess that supplies κ = 0.1 weight × b is enough {slight}."


def ring_findings(rings: Mapping[str, float], worst: Facts) -> Iterator[str]:
    """Yield what a recess with clearance does to place, energy and peak."""
    yield (
        f"Tightest clearance, {number(rings['tightest'], 'g')} b, under El Centro: at the end at most "
        f"{number(rings['tightest_at_end'], 'most .2g')} b from its place. Residual twist of all: up to "
        f"{number(rings['twist'], 'most .2g')} rad under El Centro, "
        f"{number(rings['free_twist'], 'most .2g')} rad in free response."
    )
    yield (
        f"Walls are touched in {rings['touched']:.0f} of {rings['runs']:.0f} runs, which lose at most "
        f"{number(rings['loss_worst'], 'most percent')} of their largest energy."
    )
    lean = f"{worst['inclination']:g} rad" if worst["inclination"] else "α"
    yield (
        f"Worst: {number(worst['ratio'], '.2f')} times, at tan α = {number(worst['tan_alpha'], 'g')}, turned "
        f"by {number(worst['turn'], 'g')} rad,\nclearance {number(worst['clearance'], 'g')} b, walls that "
        f"lean by {lean},\nfriction {number(worst['friction'], 'g')}."
    )
    runs = "run" if rings["failed"] == 1.0 else "runs"
    failed = f"; {rings['failed']:.0f} {runs} failed" if rings["failed"] else ""
    yield (
        f"At half the step the peak is the same within 5 % in {rings['halved_alike']:.0f} of "
        f"{rings['halved_known']:.0f} runs, and changes by at most "
        f"{number(rings['halved_worst'], 'most percent')}{failed}."
    )


def _strays(records: Mapping[str, float]) -> list[str]:
    """What one record in twenty exceeds at the points, in words, of what enough records know it."""
    found = []
    for name, place in _PLACES.items():
        ends = [records.get(f"{name}_95_{end}", math.nan) for end in ("least", "largest")]
        if not math.isnan(ends[0]):
            span = dict.fromkeys(number(end, ".2f") for end in ends)
            found.append(f"{' to '.join(span)} {place}")
    return found
