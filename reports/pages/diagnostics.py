"""Diagnostics in words: each code of `rockwobble.models.diagnostic`, with its numbers."""

from __future__ import annotations

import math
from collections import Counter
from collections.abc import Iterable, Mapping

from rockwobble.models import Diagnostic
from rockwobble.models.diagnostic import FAILURES
from rockwobble.models.doubts import GRAVITIES, LENGTHS
from rockwobble.models.plain_json import Facts
from rockwobble.models.records.plausibility import likely_unit

# why halving the step did not settle it
_UNSETTLED = {
    "fails": "a smaller step fails",
    "still_changes": "it still changes at the smallest step allowed",
    "no_later": "a smaller step does not delay the divergence",
    "no_closer": "a smaller step does not reduce the difference",
    "unresolved_pass": "a near-upright pass is left to chance, so that the error is unknown",
    "energy": "contact adds or dissipates energy, so that the error is unknown",
}
# why runs at successive steps have no limit
_NOT_EXTRAPOLATED = {
    "fails": "a run at a coarser step fails",
    "diverged": "the runs diverge there",
    "no_closer": "the runs do not converge",
    "unresolved_pass": "a near-upright pass is left to chance there",
    "energy": "contact adds or dissipates energy",
}
# with the numbers of `_fields`
_WORDS: Mapping[str, str] = {
    "step_budget": "the {size:.0f} steps allowed were used up{at}: the motion chatters near upright: "
    "use a larger rest threshold",
    "tolerance": "no step met the tolerance of {bound:g}{at}",
    "slip": "contact slipped{since}",
    "lift_off": "the cylinder left the ground{at}",
    "tension": "contact is lost{at}, for {duration} in all: the ground would have to pull (normal force "
    "{size:.3g} weights)",
    "friction_needed": "the rim would slip{at}, for {duration} in all: friction demand {size:.3g}, friction "
    "coefficient {bound:g}",
    "wall_contact": "the cylinder touched a wall{since}",
    "energy": "contact {made} {share:.2g} % of the energy of the motion; above the reporting threshold"
    "{since}",
    "rolling_loss": "rolling resistance dissipated another {share:.2g} % of it",
    "undecided": "it stays so close to its balance that rounding or the error of the solution decides "
    "whether it overturns: the outcome is unknown",
    "solver": "the solver had not converged in {size:.0f} of {bound:.0f} steps examined",
    "early_uplift": "the base opened{at} at {percent:.2g} % less load than uplifts it: what follows from "
    "a small uplift is not known",
    "unresolved_pass": "{passes_are} closer to upright than the {bound:.1e} rad that contact resolves, "
    "first{at}",
    "settled": "until {duration} the tilt is within {size:.1e} alpha of its limit at zero step, by "
    "Richardson extrapolation with order {bound:.2g}",
    "unsettled": "the tilt has not converged by halving the step: {why}; until {duration} it differs by "
    "{size:.1e} alpha from the tilt at twice the step",
    "extrapolated": "until {duration} the motion is the Richardson extrapolation of three time steps, of "
    "order {bound:.0f}; estimated error {size:.1e} alpha",
    "not_extrapolated": "no extrapolation{later}, where it is the run at the finest time step: {why}",
    "one_column": "the engine runs one of the {size:.0f} columns, under its share of a slab that only "
    "translates: whether the slab turns, or the columns keep in step, is not tested",
    "side": "it passed exactly through upright, first{at}: the ground had moved in one plane, and the side "
    "of such a pass is undetermined",
    "spent_spin": "rolling resistance has stopped the spin, in a near-upright pass{at}: only the sense of "
    "rolling is left, in which the motion continues",
    "large_peak": "its peak is {size:.3g} g, more than {bound:g} g, which few records have{other_unit}",
    "unlike_components": "the peaks of its components differ by a factor of {size:.3g}, {detail} is the "
    "larger: their units may differ",
    "same_components": "its components {detail} are the same: is one file given twice?",
    "unlikely_length": "a length of {size:g} m is that of no structure ({beyond} {bound:g} m): with the "
    "number in {detail} it would be {stated:.4g} m; give it in m",
    "unlikely_gravity": "{size:g} m/s2 is the gravity of no planet (above {bound:g} m/s2): with the number "
    "in {detail} it would be {stated:.4g} m/s2; give it in m/s2",
    "offset": "the mean of {detail} is {percent:.0f} % of its peak: the offset of the sensor was not "
    "removed; remove it with --remove-mean (remove_mean=True)",
    "gravity_in_record": "the mean of {detail} is {size:.3g} g: gravity is in the record; remove it with "
    "--remove-mean (remove_mean=True)",
    "unlikely_step": "its time step is {size:g} s, {beyond} {bound:g} s as no recorder has: is the unit of "
    "its times another?",
    "ends_in_strong_motion": "it ends in strong motion, {percent:.0f} % of its peak: is it cut?",
    "other_direction": "by its file, the component given as {detail}",
    "note": "{detail}",
    "missed_pass": "{passes_fell} between two samples, first{at}",
}
# the same where the size is not known, or infinite: no friction suffices where the ground would have to pull
_UNKNOWN: Mapping[str, str] = {
    "tension": "contact is lost{at}: a joint holds the rim down",
    "friction_needed": "a joint holds the rim{at}, where the friction of the case would let it slip",
    "unsettled": "the tilt has not converged by halving the step: {why}",
    "rolling_loss": "rolling resistance dissipated energy besides",
    "one_column": "the engine runs one column, under a slab that only translates",
}
_INFINITE: Mapping[str, str] = {
    "friction_needed": "the rim would slip{at}, for {duration} in all: no friction suffices",
}
# what each is called where many runs are counted
_MANY: Mapping[str, str] = {
    "slip": "slipped",
    "lift_off": "left the ground",
    "wall_contact": "touched a wall",
    "tension": "lost contact except for a joint",
    "friction_needed": "needed more friction than there is",
    "energy": "lost or gained energy in contact",
    "solver": "had steps whose solver did not converge",
    "unsettled": "did not converge with the time step",
    "not_extrapolated": "could not be extrapolated in the time step to the end",
    "early_uplift": "opened before the load was at the rim",
    "unresolved_pass": "had passes closer to upright than contact resolves",
    "undecided": "had an undecided end",
    "one_column": "ran one column, under a slab that only translates",
    "side": "passed exactly through upright",
    "spent_spin": "rolled until their spin was dissipated",
}


def sentence(fact: Diagnostic) -> str:
    """Return a diagnostic in words, without capital and full stop."""
    special = _UNKNOWN if math.isnan(fact.size) else _INFINITE if math.isinf(fact.size) else {}
    words = special.get(fact.code) or _WORDS.get(fact.code)
    if words is None:
        words = "{meaning}{at}" + (": {detail}" if fact.detail else "")
    return words.format_map(_fields(fact))


def _fields(fact: Diagnostic) -> dict[str, str | float]:
    """Return what the words of a diagnostic may name."""
    known = not math.isnan(fact.time)
    time = _s(fact.time)
    since = f" from {time} on" if known else ""
    reasons = _UNSETTLED if fact.code == "unsettled" else _NOT_EXTRAPOLATED
    return {
        "meaning": fact.meaning,
        "size": fact.size,
        "share": 100.0 * abs(fact.size),
        "made": "added" if fact.size > 0.0 else "dissipated",
        "bound": fact.bound,
        "duration": _s(fact.duration),
        "detail": fact.detail,
        "why": reasons.get(fact.detail, ""),
        "at": f" at {time}" if known else "",
        "since": since,
        "later": since if fact.time > 0.0 else "",
        "passes_are": _count(fact.size, "pass", "is", "are"),
        "passes_fell": _count(fact.size, "near pass", "fell", "fell"),
        "stated": fact.size * {**LENGTHS, **GRAVITIES}.get(fact.detail, math.nan),
        "percent": 100.0 * fact.size,
        "beyond": "above" if fact.size > fact.bound else "below",
        "other_unit": _other_unit(fact) if fact.code == "large_peak" else "",
    }


def _other_unit(fact: Diagnostic) -> str:
    """Return the unit in which a peak would be usual, and that in which it was read where that is known."""
    unit, _, used = fact.detail.partition(" for ")
    if not unit:
        return ""
    peak = likely_unit(fact.size, used or None)[1]
    return f": it would be {peak:.2g} g with its numbers in {unit}" + (f", not {used}" if used else "")


def remarks(facts: Iterable[Diagnostic]) -> str:
    """Return diagnostics in words, separated by semicolons."""
    return "; ".join(map(sentence, facts))


def warnings(doubts: Iterable[Facts]) -> list[str]:
    """Return a line on each doubt about records, lengths or gravity, as `doubts_of_cases` gives them."""
    lines = []
    for doubt in doubts:
        fields = {name: value for name, value in doubt.items() if name != "record"}
        text = sentence(Diagnostic(**fields))
        lines.append(f"Warning: {doubt['record']}: {text}{'' if text.endswith('?') else '.'}")
    return lines


def failure(facts: Iterable[Diagnostic]) -> str:
    """Return why a run failed, in words."""
    return remarks(fact for fact in facts if fact.code in FAILURES) or "it failed"


def code_counts(codes: Iterable[Iterable[str]]) -> list[str]:
    """Return how many runs have which diagnostic, from the codes of each run; failures left out."""
    found = Counter(code for of_run in codes for code in set(of_run))
    return [f"{found[code]} {words}" for code, words in _MANY.items() if found[code]]


def _s(time: float) -> str:
    return f"{time:.4g} s"


def _count(number: float, what: str, one: str, many: str) -> str:
    return f"1 {what} {one}" if number == 1 else f"{number:.0f} {what}es {many}"
