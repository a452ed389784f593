"""Values for the page of a run: its words are in the template runs/run.md.j2."""

from __future__ import annotations

import math
from collections.abc import Mapping
from typing import Any

from rockwobble.compare.comparison.prediction import NUDGE
from rockwobble.compare.storage.manifest import Manifest, Results
from rockwobble.models import Trace

from ...figures.runs.trace import pictures
from ..page import Page
from ..words.cases import describe
from ..words.diagnostics import remarks


def run_page(trace: Trace, manifest: Manifest) -> Page:
    """Return the page of a run."""
    values = {
        "trace": trace,
        "label": manifest.about["run"],
        "lines": describe(trace.case),
        "said": remarks(trace.diagnostics),
        **_numbers(trace),
        **_reproducible(trace, manifest.about.get("single_trace", {})),
        "about": manifest,
    }
    return Page(name="run", template="runs/run", values=values, pictures=pictures(trace))


def stored_page(results: Results) -> Page:
    """Return the page of the run that is stored."""
    return run_page(Trace.load(results.folder / "run.parquet"), results.manifest)


def _reproducible(trace: Trace, single: Mapping[str, Any]) -> dict[str, object]:
    """Return until when one trace is reproducible, whether the peak comes later, and what answers then."""
    until = single.get("until", math.inf)  # of earlier versions nothing is known
    return {
        "until": until,
        "peak_later": float(trace.time[int(trace.tilt.argmax())]) > until,
        "nudge": NUDGE,
        "answer": single.get("answer", ""),
    }


def _numbers(trace: Trace) -> dict[str, object]:
    """Return the main numbers, NaN or infinite where there is none."""
    cylinder, held, engine = trace.case.cylinder, trace.assumptions, trace.run.engine is not None
    return {
        "alpha": cylinder.alpha,
        "peak": trace.peak_tilt,
        "end": float(trace.time[-1]),
        "length": trace.case.length,
        "plane": trace.run.settings.get("plane", math.nan),
        "restitution": trace.run.settings.get("restitution", ""),
        "uplift": trace.uplift_time,
        "towards": math.remainder(trace.uplift_direction, math.tau),
        "closest": float(trace.passes["minimum_tilt"].min()) / cylinder.alpha,
        "held": held,
        "friction": held.largest_friction_needed if held else math.nan,
        "moment": held.largest_restraining_moment if held else math.nan,
        "engine": engine,
        "moves": engine or trace.run.support != "recess",  # out of its place
        "displacement": trace.residual_displacement / cylinder.base_radius,
        "first_touch": trace.first("wall_contact"),
    }
