"""The page of a run: its outcome in words, and the numbers that its method gives."""

from __future__ import annotations

import math
from collections.abc import Iterator

from rockwobble.models import Diagnostic, Trace
from rockwobble.models.mode import SLIDES
from rockwobble.studies.advice.demands import fall_of
from rockwobble.studies.single_run import SingleRun

from ..figures.trace import pictures
from .cases import case_lines
from .diagnostics import remarks
from .page import Page
from .table import Row, number
from .wording import statement

_DOUBT = "run.not_reproducible"


def page_of(found: SingleRun) -> Page:
    """Return the page of a run."""
    trace, said = found.trace, remarks(_limits(found.trace))
    values = {
        "title": f"{trace.case.name}, {found.facts['run']}: {trace.outcome}",
        "statements": [statement(each) for each in found.findings() if each.key != _DOUBT],
        "said": f"{said[0].upper()}{said[1:]}." if said else "",
        "warnings": [statement(each) for each in found.findings() if each.key == _DOUBT],
        "answer": found.facts.get("single_trace", {}).get("answer", ""),
        "rows": list(_rows(found)),
        "lines": case_lines(trace.case),
        "about": found.manifest,
    }
    return Page(name="run", template="runs/run", values=values, pictures=pictures(trace))


def _limits(trace: Trace) -> list[Diagnostic]:
    """Return the diagnostics of a run up to its fall, in which contact is lost and the rim slips."""
    held = trace.assumptions_until(fall_of(trace))
    return [*trace.facts, *(held.breaches if held else ())]


def _friction_at_rest(trace: Trace) -> float:
    """Friction demand of a base that stays closed, as a reduced model knows it; 0 of what moves."""
    return trace.case.friction_at_rest if trace.run.is_model and not trace.peak_tilt else 0.0


def _rows(found: SingleRun) -> Iterator[Row]:
    """Yield the numbers of a run, without those that do not belong to it."""
    trace, error = found.trace, found.error
    case, settings, engine = trace.case, trace.run.settings, not trace.run.is_model
    if math.isfinite(plane := settings.get("plane", math.nan)):
        yield _quantity("plane", f"{math.degrees(plane):.2f} deg")
    if restitution := settings.get("restitution", ""):
        yield _quantity("restitution", str(restitution))
    if error.source:
        size = (
            f"{number(error.size)} α"
            if math.isfinite(error.size)
            else "no number, as one stands and one overturns"
        )
        yield _quantity("error of the peak tilt", f"{size} ({error.source})")
    yield _quantity("end", _end(trace))
    if not case.initial and trace.mode != SLIDES:
        towards = math.degrees(math.remainder(trace.uplift_direction, math.tau))
        uplifts = math.isfinite(trace.uplift_time)
        yield _quantity(
            "uplift", f"{trace.uplift_time:.4f} s towards {towards:.2f} deg" if uplifts else "none"
        )
    if trace.mode != SLIDES:
        yield _quantity("near-upright passes", str(len(trace.passes)))
    closest = float(trace.passes["minimum_tilt"].min()) / case.cylinder.alpha
    if math.isfinite(closest):
        yield _quantity("closest pass", f"{number(closest)} α")
    yield from _demands(trace)
    if math.isfinite(trace.peak_tendon_force):
        yield _quantity("tendon force", f"largest {number(trace.peak_tendon_force)} weights of a column")
    if engine or not trace.run.support.guided:  # it may leave its place
        for name, moved in (("peak", trace.peak_displacement), ("residual", trace.residual_displacement)):
            share = number(moved / case.cylinder.base_radius)
            yield _quantity(f"{name} displacement", f"{number(moved)} m = {share} b")
        yield _quantity("residual twist", f"{number(math.degrees(trace.residual_twist))} deg")
    if math.isfinite(first := trace.first("wall_contact")):
        whole = number(trace.wall_contact[-1])
        yield _quantity("wall contact", f"{whole} s in all, first at {number(first, '.4g')} s")
    if engine:
        yield _quantity("time step", f"{number(trace.time_step, 'g')} s")
    yield _quantity("computing time", f"{number(trace.wall_time)} s")


def _quantity(name: str, value: str) -> Row:
    return {"name": name, "value": value}


def _end(trace: Trace) -> str:
    end, length = float(trace.time[-1]), trace.case.length
    words = f"{number(end, '.4g')} s"
    if end > length:
        words += f", over still ground from {number(length, '.4g')} s on"
    if trace.outcome == "stands" and not trace.rests:
        words += ", moving"
    if trace.followed_until > end:
        words += f", followed over still ground to {number(trace.followed_until, '.4g')} s"
    return words


def _demands(trace: Trace) -> Iterator[Row]:
    """Yield what a model asks of friction and recess, and up to when: a fall asks nothing."""
    falls = fall_of(trace)
    held = trace.assumptions_until(falls)
    if held is None:
        return
    covered = ", until it falls" if math.isfinite(falls) else ""
    if not covered and trace.followed_until > float(trace.time[-1]):
        # the swing that is followed past the end has no samples
        covered = ", up to the end of the run"
    friction = max(_friction_at_rest(trace), held.largest_friction_needed)
    demand = f"{friction:.3f}"
    if not math.isfinite(friction):
        lost = min((fact.time for fact in held.breaches if fact.code == "tension"), default=math.nan)
        demand = f"none suffices, contact is lost at {number(lost, '.4g')} s"
    yield _quantity("friction demand", f"{demand}{covered}")
    moment = held.largest_restraining_moment / trace.case.cylinder.base_radius
    if moment > 0.0:
        yield _quantity("restraining moment", f"κ = {number(moment)} weights × b{covered}")
