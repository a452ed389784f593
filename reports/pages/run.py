"""Values for the page of a run: its words are in the template runs/run.md.j2."""

from __future__ import annotations

import math

from rockwobble.compare.studies.advice.demands import fall_of
from rockwobble.compare.studies.single_run import SingleRun
from rockwobble.models import Diagnostic, Trace

from ..figures.trace import pictures
from .cases import describe
from .diagnostics import remarks
from .page import Page


def page_of(found: SingleRun) -> Page:
    """Return the page of a run; numbers are NaN or infinite where there is none."""
    trace, single = found.trace, found.facts.get("single_trace", {})
    cylinder, engine, falls = trace.case.cylinder, not trace.run.is_model, fall_of(trace)
    held = trace.assumptions_until(falls)  # a fall asks nothing
    part = single.get("copies_part", math.inf)  # of earlier versions nothing is known
    at_rest = 0.0 if engine or trace.peak_tilt else trace.case.friction_at_rest
    values = {
        "trace": trace,
        "at_rest": at_rest,
        "slides": at_rest > trace.case.friction,
        "label": found.facts["run"],
        "lines": describe(trace.case),
        "said": remarks(_limits(trace, falls)),
        "alpha": cylinder.alpha,
        "peak": trace.peak_tilt,
        "falls": falls,
        "side_down": float(trace.time[-1]),
        "end": float(trace.time[-1]),
        "length": trace.case.length,
        "plane": trace.run.settings.get("plane", math.nan),
        "restitution": trace.run.settings.get("restitution", ""),
        "uplift": trace.uplift_time,
        "towards": math.remainder(trace.uplift_direction, math.tau),
        "closest": float(trace.passes["minimum_tilt"].min()) / cylinder.alpha,
        "held": held,
        "friction": max(at_rest, held.largest_friction_needed) if held else math.nan,
        "lost": min((fact.time for fact in held.breaches if fact.code == "tension"), default=math.nan)
        if held
        else math.nan,
        "moment": held.largest_restraining_moment / cylinder.base_radius if held else math.nan,
        "tension": trace.peak_tendon_force,
        "engine": engine,
        "moves": engine or not trace.run.support.guided,  # out of its place
        "displacement": trace.residual_displacement / cylinder.base_radius,
        "first_touch": trace.first("wall_contact"),
        "part": part,
        "peak_later": falls > part if math.isfinite(falls) else trace.peak_time > part,
        "perturbation": single.get("perturbation", math.nan),
        "answer": single.get("answer", ""),
        "about": found.manifest,
    }
    return Page(name="run", template="runs/run", values=values, pictures=pictures(trace))


def _limits(trace: Trace, falls: float) -> list[Diagnostic]:
    """Return the diagnostics of a run up to its fall, in which contact is lost and the rim slips."""
    held = trace.assumptions_until(falls)
    return [*trace.facts, *(held.breaches if held else ())]
