"""Diagnostics in words: each code of `rockwobble.models.diagnostic`, with its numbers."""

from __future__ import annotations

import math
from collections import Counter
from collections.abc import Callable, Iterable, Mapping
from typing import Any

from rockwobble.models import Diagnostic
from rockwobble.models.diagnostic import FAILURES
from rockwobble.models.records.units import likely_unit

# why halving the step did not settle it
_UNSETTLED = {
    "fails": "a smaller step fails",
    "still_changes": "it still changes at the smallest step allowed",
    "no_later": "a smaller step does not put off the divergence",
    "no_closer": "a smaller step does not bring it closer",
    "unresolved_pass": "a pass is left to chance, so that its error is not known",
    "energy": "contact makes or takes energy, so that its error is not known",
}
# why runs at successive steps tell no limit
_NOT_EXTRAPOLATED = {
    "fails": "a run at a coarser step fails",
    "diverged": "the runs diverge there",
    "no_closer": "the runs do not come closer to one another",
    "unresolved_pass": "a pass is left to chance there",
    "energy": "contact makes or takes energy",
}
_WORDS: Mapping[str, Callable[[Diagnostic], str]] = {
    "step_budget": lambda fact: (
        f"the {fact.size:.0f} steps allowed were used up{_at(fact)}: the motion chatters near upright, "
        "which a larger rest threshold ends"
    ),
    "tolerance": lambda fact: f"no step met the tolerance of {fact.bound:g}{_at(fact)}",
    "slip": lambda fact: f"contact slipped{_from(fact)}",
    "lift_off": lambda fact: f"the cylinder left the ground{_at(fact)}",
    "tension": lambda fact: (
        f"contact is lost{_at(fact)}: a joint holds the rim down"
        if math.isnan(fact.size)
        else f"contact is lost{_at(fact)}, for {_s(fact.duration)} in all: the ground would have to pull "
        f"(normal force {fact.size:.3g} weights)"
    ),
    "friction_needed": lambda fact: (
        f"a joint holds the rim{_at(fact)}, where the friction of the case would let it slip"
        if math.isnan(fact.size)
        else f"the rim would slip{_at(fact)}, for {_s(fact.duration)} in all: "
        + (
            "no friction suffices"  # where the ground would have to pull
            if math.isinf(fact.size)
            else f"it needs a friction of {fact.size:.3g}, where there is {fact.bound:g}"
        )
    ),
    "wall_contact": lambda fact: f"the cylinder touched a wall{_from(fact)}",
    "energy": lambda fact: (
        f"contact {'made' if fact.size > 0.0 else 'took'} {abs(fact.size):.1e} of the energy of the "
        f"motion, which shows{_from(fact)}"
    ),
    "undecided": lambda _: (
        "it ends in motion, which comes to no maximum of its tilt in the time for which it is followed: "
        "whether it overturns is not decided"
    ),
    "solver": lambda fact: (
        f"the solver had not converged in {fact.size:.0f} of the {fact.bound:.0f} steps looked at"
    ),
    "unresolved_pass": lambda fact: (
        f"{_count(fact.size, 'pass', 'is', 'are')} closer to upright than the {fact.bound:.1e} rad that "
        f"contact resolves, first{_at(fact)}"
    ),
    "settled": lambda fact: (
        f"the tilt is, until {_s(fact.duration)}, within {fact.size:.1e} alpha of its limit for a "
        f"vanishing step, by Richardson with order {fact.bound:.2g}"
    ),
    "unsettled": lambda fact: (
        f"the tilt has not settled by halving the step: {_UNSETTLED[fact.detail]}"
        + (
            ""
            if math.isnan(fact.size)
            else f"; until {_s(fact.duration)} it differs by {fact.size:.1e} alpha from that at twice "
            "the step"
        )
    ),
    "extrapolated": lambda fact: (
        f"the motion is, until {_s(fact.duration)}, what runs at three time steps tend to, with order "
        f"{fact.bound:.0f}: within {fact.size:.1e} alpha, by estimate"
    ),
    "not_extrapolated": lambda fact: (
        f"it is not extrapolated{_from(fact) if fact.time > 0.0 else ''}, but the run at the finest time "
        f"step: {_NOT_EXTRAPOLATED[fact.detail]}"
    ),
    "side": lambda fact: (
        f"it passed through upright itself, first{_at(fact)}: the ground had moved in one plane, and the "
        "side of such a pass is undetermined"
    ),
    "large_peak": lambda fact: (
        f"its peak is {fact.size:.3g} g, more than any record has ({fact.bound:g} g): it would be "
        f"{likely_unit(fact.size)[1]:.2g} g with its numbers in {fact.detail}; give the unit of the file"
    ),
    "unlike_components": lambda fact: (
        f"the peaks of its components differ by a factor of {fact.size:.3g}, {fact.detail} is the larger: "
        "their units may differ"
    ),
    "note": lambda fact: fact.detail,
    "missed_pass": lambda fact: (
        f"{_count(fact.size, 'near pass', 'fell', 'fell')} between two samples, first{_at(fact)}"
    ),
}
# what each is called where many runs are counted
_MANY: Mapping[str, str] = {
    "slip": "slipped",
    "lift_off": "left the ground",
    "wall_contact": "touched a wall",
    "tension": "lost contact but for a joint",
    "friction_needed": "needed more friction than there is",
    "energy": "lost or gained energy",
    "solver": "had steps whose solver did not converge",
    "unsettled": "did not settle with the time step",
    "not_extrapolated": "could not be extrapolated in the time step to the end",
    "unresolved_pass": "had passes closer to upright than contact resolves",
    "undecided": "ended in motion that was not decided",
    "side": "passed through upright itself",
}


def sentence(fact: Diagnostic) -> str:
    """Return a diagnostic in words, without capital and full stop."""
    if fact.code in _WORDS:
        return _WORDS[fact.code](fact)
    return f"{fact.meaning}{_at(fact)}" + (f": {fact.detail}" if fact.detail else "")


def remarks(facts: Iterable[Diagnostic]) -> str:
    """Return diagnostics in words, separated by semicolons."""
    return "; ".join(map(sentence, facts))


def warnings(doubts: Iterable[Mapping[str, Any]]) -> list[str]:
    """Return a line on each doubt about a record, as `doubts_of` gives them."""
    lines = []
    for doubt in doubts:
        fields = {name: value for name, value in doubt.items() if name != "record"}
        lines.append(f"Warning: {doubt['record']}: {sentence(Diagnostic(**fields))}.")
    return lines


def failure(facts: Iterable[Diagnostic]) -> str:
    """Return why a run failed, in words."""
    return remarks(fact for fact in facts if fact.code in FAILURES) or "it failed"


def counted(codes: Iterable[Iterable[str]]) -> list[str]:
    """Return how many runs have which diagnostic, from the codes of each run; failures left out."""
    found = Counter(code for of_run in codes for code in set(of_run))
    return [f"{found[code]} {words}" for code, words in _MANY.items() if found[code]]


def _at(fact: Diagnostic) -> str:
    return "" if math.isnan(fact.time) else f" at {_s(fact.time)}"


def _from(fact: Diagnostic) -> str:
    return "" if math.isnan(fact.time) else f" from {_s(fact.time)} on"


def _s(time: float) -> str:
    return f"{time:.4g} s"


def _count(number: float, what: str, one: str, many: str) -> str:
    return f"1 {what} {one}" if number == 1 else f"{number:.0f} {what}es {many}"
