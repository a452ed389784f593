"""Lines of an advice on its case: what was asked, what becomes of it at rest, what is assumed of it.

Each is a line of the document, so that a long sentence may have two.
"""

from __future__ import annotations

import math
from collections.abc import Iterator

from rockwobble.models.diagnostic import CODES
from rockwobble.models.support import support_named
from rockwobble.reduced.body import restitution_from_momentum
from rockwobble.studies.advice.advice import WEAKER_COUNT, Advice
from rockwobble.studies.advice.demands import PASSED
from rockwobble.studies.advice.scales import AS_STRONG

from .cases import conditions
from .table import number
from .wording import statement

# in words, the range of shaking as strong as that given
STRONG = f"{100.0 * (1.0 - AS_STRONG[0]):.0f} % weaker to {100.0 * (AS_STRONG[1] - 1.0):.0f} % stronger"
# times a ground motion: what has to be made stronger than that uplifts nothing, such as still ground
_NO_SCALE = 1e9


_PLAIN = ("mode.rest", "mode.rocks", "mode.rocks_in_one_plane", "mode.no_friction_given")


def opening(found: Advice) -> Iterator[str]:
    """Yield what a reader must not miss: motion, vertical component, why nothing moves, limit of a tendon."""
    if said := [each for each in found.mode_findings if each.key not in _PLAIN]:
        yield " ".join(map(statement, said))
    if found.vertical_matters:
        yield vertical_words(found)
    if not found.moves and not found.slides:
        yield _at_rest(found)
    yield from _limit_of_tendon(found)


def _limit_of_tendon(found: Advice) -> Iterator[str]:
    """Up to where the tendon is what the models take it for; an earlier version knew nothing of it."""
    tendon, alpha = found.facts.get("tendon"), math.degrees(found.cylinder.alpha)
    if tendon is None or "tilts" not in tendon:
        return
    if tendon["yield_force"] is None:
        of = "its prestress" if tendon["prestress"] else "the weight of a column"
        tilts = [f"{n} times {of} {_at_tilt(alpha * tilt)}" for n, tilt in tendon["tilts"].items()]
        at_rest = f"{of} upright, " if tendon["prestress"] else ""
        yield (
            f"The tendon is taken as elastic without limit: it would carry {at_rest}{' and '.join(tilts)}."
        )
        return
    words = f"The tendon yields {_at_tilt(alpha * tendon['yield_tilt'])}; what comes after is not modelled"
    if beyond := found.yielded + found.yields:
        runs = int(found.counting["runs"].sum())
        words += f", and nothing is known of {beyond} of {runs + 1} runs that pass it"
    yield f"{words}."


def _at_tilt(degrees: float) -> str:
    return f"at a tilt of {number(degrees)}°" if math.isfinite(degrees) else "at no tilt below 90°"


def _at_rest(found: Advice) -> str:
    """Why a case does not move, or what it would take."""
    if codes := found.response["diagnostics"]:
        return f"{', '.join(CODES[code][1] for code in codes).capitalize()}."
    motion = found.facts["motion"]
    if motion is None:
        return "Nothing moves it."
    if motion["uplift_factor"] >= _NO_SCALE:
        return "This ground motion uplifts it at no scale."
    words = f"It takes {number(motion['uplift_factor'])} times this shaking to uplift it"
    if found.vertical.source == "shipped":
        words += f", {number(found.vertical.uplift_factor)} times with the vertical component of the record"
    # an earlier version stated none
    if demand := motion.get("friction_at_rest", 0.0):
        words = f"At rest the friction demand is {number(demand)}. {words}"
    return f"{words}."


def problem_lines(found: Advice) -> Iterator[str]:
    """Yield what was asked: cylinder or frame, ground motion or release, support, and what is not usual."""
    if found.moves:
        yield from (statement(each) for each in found.mode_findings if each.key in _PLAIN)
    facts, cylinder = found.facts, found.cylinder
    if frame := facts["cylinder"] if "columns" in facts["cylinder"] else None:
        columns = f"{frame['columns']} columns" if frame["columns"] > 1 else "One column"
        yield f"{columns} under a slab of {number(frame['slab_mass_ratio'])} times their mass:"
    yield f"b = {number(cylinder.base_radius, '.4g')} m,"
    yield f"2h = {number(2.0 * cylinder.half_height, '.4g')} m,"
    yield f"α = {number(math.degrees(cylinder.alpha), '.4g')}°."
    length = number(facts["length"], ".4g")
    if motion := facts["motion"]:
        yield f"{motion['name'] or 'Record'}: peak {number(motion['peak'] / facts['gravity'])} g,"
        yield f"{number(1.0 / motion['uplift_factor'])} times the uplift threshold, {length} s."
    if release := facts["release"]:
        tilt, rate = number(math.degrees(release["tilt"])), number(release["rolling_rate"])
        yield f"Release at {tilt}°, {rate} rad/s, {length} s."
    friction, resistance = facts["friction"], facts["rolling_resistance"]
    words = f"{support_named(facts['support']).words.capitalize()}, friction "
    words += "not given" if friction is None else number(friction)
    yield f"{words}{f', rolling resistance {number(resistance)} m' if resistance else ''}."
    for line in conditions({"gravity": facts["gravity"]}):
        yield f"{line}."
    yield tendon_words(found)


def tendon_words(found: Advice) -> str:
    """What a tendon does to uplift, stiffness and balance; empty without one."""
    tendon = found.facts.get("tendon")
    if tendon is None:
        return ""
    stiffness, balance = tendon["initial_stiffness"], tendon["balance_tilt"]
    way = "grows" if stiffness > 0.0 else "falls"
    # elastic: beyond its yield it does not
    limit = min(balance, tendon.get("yield_tilt", math.inf))
    returns = f"tilts up to {number(limit)} α" if math.isfinite(limit) else "every tilt, if it stays elastic"
    steel = f"prestress {number(tendon['prestress'])} W, stiffness {number(tendon['stiffness'])} W/b"
    if stress := tendon.get("unit_stress"):
        steel += f"; {number(stress * tendon['prestress'], '.4g')} MPa at rest, {number(stress)} a W"
    return (
        f"Tendon: {steel}. Uplift at {number(tendon['uplift_factor'])} g tan α; initial stiffness "
        f"{number(stiffness)} m g b, the couple {way} with the tilt. It brings the column back "
        f"from {returns}."
    )


def cautions(found: Advice) -> Iterator[str]:
    """Yield what the case asks of its builder before any number here may be used."""
    if found.shares_load_unevenly and found.moves:
        yield (
            "Four columns or more share the load unevenly: use this only where their ends yield by more than "
            "the columns differ in height, so that each keeps a load (guide, A pier with a deck)."
        )


def vertical_words(found: Advice) -> str:
    """What is known of the vertical component: counts with and without it, or that it was not looked at."""
    vertical = found.vertical
    if not vertical.source:
        return ""
    if vertical.source == "other":
        return "No vertical component of this record was given: its effect was not looked at."
    if vertical.ratios is None:
        return ""
    if found.yielded:
        return "Whether the vertical component overturns it is not tested: the tendon yields."
    ratios = vertical.ratios
    with_it, without, count = (int(ratios[key]) for key in ("overturned", "against_overturned", "members"))
    words = f"With the vertical component of the record {with_it} of {count} copies overturn"
    words += f", without it {without}."
    return f"{words} This case leaves it out." if vertical.source == "shipped" else words


def weight_words(found: Advice) -> str:
    """The weight that demands are multiples of, with its mass where that was given [t]."""
    frame, mass = "columns" in found.facts["cylinder"], found.facts["mass"]
    words = "weight of one column with its share of the slab" if frame else "weight of the cylinder"
    if mass is not None:
        whole = number(mass * (1.0 + found.cylinder.slab_mass_ratio), ".4g")
        words += f", a mass of {whole} t{f' (column {number(mass)} t)' if frame else ''}"
    return f"{words}; in the rows of the top, of this share alone" if frame else words


def other_record_lines(found: Advice) -> Iterator[str]:
    """Yield what the other ground motions are, and what they were scaled to."""
    if records := found.facts["records"]:
        measured = "The 22 far-field pairs of FEMA P-695"
        yield f"{measured if records == 'p695' else '22 synthetic (not recorded) motions'},"
        yield (
            "scaled to the peak of this record, the largest resultant of its horizontal components (PGA, "
            "PGV): what this intensity does. Large bodies follow the peak velocity."
        )


def weaker_mark(found: Advice) -> str:
    """The meaning of the mark on a demand of weaker shaking; empty where none was run."""
    return "× n: under n times this shaking, as weaker shaking may ask more." if len(found.weaker) else ""


def weaker_words(found: Advice) -> str:
    """The weaker shaking that a demand is of, too; empty without one."""
    if not len(found.weaker):
        return ""
    factors = ", ".join(number(factor, ".2g") for factor in sorted(set(found.weaker["factor"])))
    return (
        f" and weaker shaking by the same records ({factors} times, at most {WEAKER_COUNT} runs of a group)"
    )


def wall_lines(found: Advice) -> Iterator[str]:
    """Yield what the moment of a recess means for its wall."""
    if support_named(found.facts["support"]).is_recess:
        yield (
            "M is (1 + cos θ) κ about the vertical through the contact point; a wall supplies it over the "
            "lever arm b, with blows besides."
        )
        yield (
            "Where friction supplies nothing, the wall takes V + M/b. A run that passes its balance, whether "
            f"it overturns or comes back, counts with {number(PASSED)} times the balance at least: such a "
            "wall holds the rim until then, and no wall holds what overturns."
        )


def planar_words(found: Advice) -> str:
    """What a motion that stays in one plane leaves open; empty of one in space."""
    if not found.response["in_one_plane"]:
        return ""
    return (
        "The motion stays in one plane and passes through upright itself; no copy has tried the slightest "
        "motion across it."
    )


def no_planar_analysis(found: Advice) -> str:
    """Why there is no planar analysis of what moves; empty where there is one."""
    if found.moves and found.yielded:
        return "No planar analysis: the tendon yields."
    if not found.moves or len(found.planar):
        return ""
    knows = "release out of its plane" if found.facts["release"] else "vertical shaking, and no still ground"
    return f"No planar analysis: it knows no {knows}."


def assumptions(found: Advice) -> Iterator[str]:
    """Yield what the models take for granted, a point each."""
    facts = found.facts
    other = "other " if facts["rolling_resistance"] else ""
    loss = number(1.0 - restitution_from_momentum(found.cylinder), "percent")
    yield (
        f"Rigid cylinder on rigid level ground, no {other}damping, no loss at impact: landing flat would "
        f"take\n  {loss} of the tilt rate (moment of momentum about the new pivot)."
    )
    if "columns" in facts["cylinder"]:
        count = facts["cylinder"]["columns"]
        yield (
            f"Rigid slab on {count} equal {'columns' if count > 1 else 'column'}, no slip at base and top; "
            "all move alike, so that the slab translates and does not turn."
        )
    if support_named(facts["support"]).is_recess:
        yield (
            "Ideal recess: the rim keeps to its circle, without clearance and without friction at its walls."
        )
    else:
        yield "Flat ground: the rim rolls without slip, free to roll out."
    if facts.get("tendon") is not None:
        yield (
            "Unbonded tendon along the axis, linear up to yield; no friction in its duct, no losses of "
            "prestress, no rupture."
        )
    motion = facts["motion"]
    level = "" if motion and motion["has_vertical"] else ", no vertical component in the case as given"
    yield f"One ground motion at the base, no soil, no neighbours{level}."
    if len(found.as_strong):
        yield (
            f"Shaking as strong: {len(found.as_strong)} scales from {STRONG}, a factor of 1.26. A peak "
            "acceleration says no more: between the geometric mean of both components and their\n"
            "  resultant lies a factor of 1.09 to 1.28 (5 to 95 % of the far-field records of FEMA P-695)."
        )
    yield (
        "Reduced models and engines are verified against each other; nothing here has been compared with "
        "experiments."
    )
