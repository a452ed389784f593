"""Findings of the limits of the model, from the numbers of its tables."""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping
from typing import TYPE_CHECKING, Literal

from rockwobble.compare.metrics.statistics import MARGIN
from rockwobble.models.finding import Finding, Findings
from rockwobble.models.support import RECESSES_FIRST

from .limits import Numbers

if TYPE_CHECKING:
    from .plan import Structure

Limits = Mapping[str, Numbers]
Verdict = Literal["contradicted", "established", "undecided"]


def model_verdict(limits: Limits) -> Verdict:
    """Return the verdict on the reduced model in an ideal recess, by an engine in one.

    It is contradicted where one release is that of another motion, or where the median ratio of the peaks at
    one point is known to be beyond the margin; established where the median is known to be within the margin
    at some point, and beyond it at none.
    """
    if limits["free_response"]["contradicted"] or limits["records"]["recess_beyond"]:
        return "contradicted"
    return "established" if limits["records"]["recess_within"] else "undecided"


def converges_by_record(limits: Limits) -> bool:
    """Whether runs in a recess with clearance have converged record by record.

    Nine in ten of them have the same peak at half the step, within the margin.
    """
    low, high = (limits["records"][name] for name in ("halved_05_least", "halved_95_largest"))
    return not (low < 1.0 / (1.0 + MARGIN) or high > 1.0 + MARGIN)


def findings_of(limits: Limits, structure: Structure) -> Findings:
    """Return the findings, by group: limit_scope, limit_model, limit_requirement and so on."""
    groups = [_scope(structure), _model(limits), _requirements(limits), _records(limits)]
    groups += [_releases(limits["free_response"]), _forces(limits, structure)]
    return Findings(each for group in [*groups, _ring(limits)] for each in group)


def _scope(structure: Structure) -> Iterator[Finding]:
    if structure.slab_mass_ratio:
        yield Finding(key="limit_scope.slab", values={"ratio": structure.slab_mass_ratio})
    if tendon := structure.tendon:
        given = {"given": tendon.prestress, "given_stiffness": tendon.stiffness, "factor": structure.uplift}
        yield Finding(key="limit_scope.tendon", values=given)


def _model(limits: Limits) -> Iterator[Finding]:
    free, records = limits["free_response"], limits["records"]
    verdict = model_verdict(limits)
    if verdict == "contradicted":
        runs = {"runs": free["contradicted"] or math.nan, "runs_all": free["points"]}
        points = {"count": records["recess_beyond"] or math.nan, "count_all": records["points"]}
        yield Finding(key="limit_model.contradicted", level="not satisfied", values={**runs, **points})
    known = {
        "runs": records["members"],
        "ratio_least": records["recess_least"],
        "ratio_largest": records["recess_largest"],
        "count": records["recess_within"],
        "count_all": records["points"],
        "share": MARGIN,
    }
    if verdict == "established":
        yield Finding(key="limit_model.established", level="satisfied", values=known)
    elif verdict == "undecided":
        yield Finding(key="limit_model.undecided", level="not tested", values=known)
    strays = {
        f"ratio_{name}_{end}": records.get(f"{name}_95_{end}", math.nan)
        for name in (*RECESSES_FIRST, "copy")
        for end in ("least", "largest")
    }
    if verdict != "contradicted" and not all(map(math.isnan, strays.values())):
        yield Finding(
            key="limit_model.strays", level="caution", values={**strays, "runs": records["members"]}
        )
        if not records["strays_bounded"]:
            yield Finding(key="limit_model.unbounded", level="caution")
    # False without such recesses, and of too few records to know
    if records.get("ring_95_largest", 0.0) > 1.0:
        yield Finding(key="limit_clearance.unconservative", level="caution")


def _requirements(limits: Limits) -> Iterator[Finding]:
    contact, soft = limits["contact"], limits["soft_contact"]
    yield Finding(key="limit_requirement.friction", values={"ratio": limits["friction"]["shaken"]})
    values = {"runs": contact["runs"], "bound": contact["least_held"]}
    if lost := contact["lost"]:
        values |= {"runs_lost": lost, "ratio": contact["lost_from"]}
        values |= {"factor": contact["lost_intensity"]}
    yield Finding(
        key="limit_requirement.contact_lost" if lost else "limit_requirement.contact", values=values
    )
    yield Finding(key="limit_requirement.recess", values={"ratio": limits["restraining_moment"]["shaken"]})
    if tendon := limits.get("tendon"):
        yield Finding(key="limit_requirement.tendon", values={"ratio": tendon["shaken"]})
    values = {
        "bound": soft["held_up_to"],
        "share": soft["held_peak"],
        "runs": soft["held_runs"],
        "runs_ended": soft["held_ended"],
        "ratio": soft["failed_up_to"],
        "given_least": soft["failed_damping_least"],
        "given_largest": soft["failed_damping_largest"],
    }
    yield Finding(key="limit_requirement.stiffness", values=values)
    yield Finding(key="limit_requirement.question")


def _records(limits: Limits) -> Iterator[Finding]:
    records = limits["records"]
    if "ring_least" in records:
        if math.isfinite(records["halved_95_least"]):
            names = ("least", "largest", "95_least", "95_largest")
            values = {f"ratio_{name}": records[f"halved_{name}"] for name in names}
            converged = converges_by_record(limits)
            yield Finding(
                key="limit_records.converged" if converged else "limit_records.not_converged",
                level="note" if converged else "caution",
                values=values,
            )
        if records["ring_passed"]:
            values = {"runs": records["ring_passed"], "runs_all": records["ring_standing"]}
            peak = {"peak": records["ring_passed_largest"]}
            yield Finding(key="limit_records.beyond_alpha", level="caution", values={**values, **peak})
        touched = {"runs": records["touched"], "share": records["ring_loss_worst"]}
        yield Finding(key="limit_records.touched", values=touched)
    if records["failed"]:  # all without a peak
        ends = {"runs": records["runs"], "count": records["failed"] - records["undecided"]}
        yield Finding(key="limit_records.left_out", values={**ends, "count_undecided": records["undecided"]})


def _releases(free: Numbers) -> Iterator[Finding]:
    engine = {
        "runs": free["confirmed"],
        "runs_all": free["points"],
        "count": free["releases"],
        "runs_contradicted": free["contradicted"] or math.nan,
    }
    if "alike_up_to" not in free:
        yield Finding(key="limit_release.confirmed", values=engine)
        return
    yield Finding(key="limit_release.alike", values={"ratio": free["alike_up_to"]})
    off = {
        "share_period": free["period_largest"],
        "share_peak": free["peak_gain"],
        "share_turn": free["turn_largest"],
        "bound": free["turn_largest_deg"],
        "ratio": free["worst_tan_alpha"],
        "peak": free["worst_release"],
        "factor": free["worst_spin"],
    }
    yield Finding(key="limit_release.off", values=off)
    open_runs = free["points"] - free["confirmed"] - free["contradicted"]
    yield Finding(key="limit_release.decided", values={**engine, "runs_open": open_runs or math.nan})


def _forces(limits: Limits, structure: Structure) -> Iterator[Finding]:
    friction, contact = limits["friction"], limits["contact"]
    yield Finding(key="limit_force.friction", values={"ratio": friction["free_response"]})
    slips = {"share": friction["slips_at"], "bound": friction["holds_from"]}
    if not structure.slab_mass_ratio:  # where slip at the base is not all
        slips |= {"ratio": friction["slip"], "share_tilt": friction["tilt_error"]}
    yield Finding(key="limit_force.slip", values=slips)
    normal = {
        "bound": contact["shaken_least"],
        "bound_free": contact["free_least"],
        "ratio": contact["free_least_tan_alpha"],
        "ratio_lost": contact["free_lost_from"],
    }
    yield Finding(key="limit_force.normal", values=normal)
    yield Finding(key="limit_force.moment", values={"ratio": limits["restraining_moment"]["slight_up_to"]})


def _ring(limits: Limits) -> Iterator[Finding]:
    if not (rings := limits.get("rings")):
        return
    place = {"ratio": rings["tightest"], "ratio_end": rings["tightest_at_end"]}
    twist = {"bound": rings["twist"], "bound_free": rings["free_twist"]}
    yield Finding(key="limit_ring.place", values={**place, **twist})
    touched = {"runs": rings["touched"], "runs_all": rings["runs"], "share": rings["loss_worst"]}
    yield Finding(key="limit_ring.touched", values=touched)
    names = ("tan_alpha", "turn", "clearance", "inclination", "friction")
    worst = {f"given_{name}": rings[f"worst_{name}"] for name in names}
    yield Finding(key="limit_ring.worst", values={"ratio": rings["worst_ratio"], **worst})
    halved = {
        "runs": rings["halved_alike"],
        "runs_all": rings["halved_known"],
        "share": rings["halved_worst"],
        "count": rings["failed"] or math.nan,
    }
    yield Finding(key="limit_ring.halved", values=halved)
