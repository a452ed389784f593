"""Order of convergence: errors fall as the method promises, with its tolerance or its time step."""

from __future__ import annotations

import math
from collections.abc import Iterator

import numpy as np

from rockwobble.models import Case, el_centro_1940

from ..metrics.tilt import rms
from .motion import largest
from .result import Bound, Result, at_most
from .scenes import PIER, SQUAT, released
from .subject import Subject

_FREE = released(0.5, 0.05, 20.0, name="free motion")
_SHAKEN = Case(PIER, el_centro_1940(), duration=12.0, name="El Centro")
_SQUAT = released(0.5, 0.5, 2.0, SQUAT, "release, tan alpha = 1")


def tolerance(subject: Subject, support: str) -> Iterator[Result]:
    """The error is in proportion to the tolerance of each step: slope 1 of log error in log tolerance."""
    assert subject.at_step is not None
    for case in (_FREE, _SHAKEN):
        exact = subject.simulate(case, support, rtol=1e-13)
        errors = [
            largest(subject.at_step(step).simulate(case, support).tilt - exact.tilt) for step in subject.steps
        ]
        yield _slope(f"error in proportion to the tolerance, {case.name}", subject, errors)


def time_step(subject: Subject, support: str) -> Iterator[Result]:
    """The error against the independent model falls with the order of the engine in its time step."""
    assert subject.at_step is not None
    assert subject.reference is not None
    exact = subject.reference(_SQUAT, support=support, rtol=1e-11)
    errors = [
        math.nan if found.outcome == "failed" else rms(found.tilt - exact.tilt)
        for found in (subject.at_step(step).simulate(_SQUAT, support) for step in subject.steps)
    ]
    yield _slope("error by the time step", subject, errors, at_least=True)


def _slope(name: str, subject: Subject, errors: list[float], *, at_least: bool = False) -> Result:
    slope = math.nan
    if all(math.isfinite(error) and error > 0.0 for error in errors):
        slope = float(np.polyfit(np.log(subject.steps), np.log(errors), 1)[0])
    short = subject.order - slope
    bound = Bound(0.2, f"scatter of a slope over {len(errors)} points")
    return at_most(name, max(short, 0.0) if at_least else abs(short), bound, note=f"slope {slope:.2f}")
