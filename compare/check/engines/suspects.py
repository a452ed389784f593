"""Suspect part where an engine and a model differ by more than they may: another engine decides."""

from __future__ import annotations

import math

from rockwobble.models import Run, Trace
from rockwobble.multibody.engines.registry import find_engine

from ...metrics.pair import make_pair
from ...metrics.tilt import tilt_rms
from ...runs.execution import Job
from ..bench import Bench, engines_here

SIDES = 0.3  # who is nearer to the referee than this share of what the two differ by stands with it


def suspect(
    bench: Bench, job: Job, model: Trace, trace: Trace, *, until: float | None = None
) -> tuple[str, str]:
    """Return which part is suspect, and why or what to do.

    A second engine runs the same case. If it stands with the model the first engine is wrong, and if it
    stands with the first engine the model is.
    """
    engine, support = job.run.engine, job.run.support
    others = [name for name in engines_here() if name != engine and support in find_engine(name).supports]
    both = f"{engine} ({support}) or the {model.run}"
    if not others:
        return both, "a second engine would tell which: add one to the runs of the suite"
    (referee,) = bench.traces([Job(case=job.case, run=bench.adjust(Run(others[0], support)))])
    if referee.outcome == "failed":
        return both, f"{others[0]} fails on this case, and tells nothing"

    def rms(one: Trace, other: Trace) -> float:
        value = tilt_rms(make_pair(job.case.cylinder, one, other, until=until))
        return value if math.isfinite(value) else math.inf

    apart, from_model, from_engine = rms(model, trace), rms(model, referee), rms(trace, referee)
    if from_model < SIDES * apart:
        settings = "its settings" if job.run.settings else "its contact"
        return (
            f"{engine} ({support}): {settings}",
            f"{referee.run.engine} follows the model to {from_model:.1e} alpha; run the case in it, or with "
            f"the default settings of {engine}",
        )
    if from_engine < SIDES * apart:
        return (
            f"the {model.run}",
            f"{engine} and {referee.run.engine} agree to {from_engine:.1e} alpha and the model with neither: "
            "`rockwobble check` tells which equation",
        )
    return both, f"{referee.run.engine} stands with neither: {from_model:.1e} alpha from the model"
