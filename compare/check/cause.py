"""Likely cause of a subject that fails: the one change of a problem by which the model does what it does.

Each candidate scales one number that somebody may have wrong. The scale that fits best is found in a release
and in a ramp of the ground together, since some cannot be told apart by one of them: gravity and size both
change the rate of a release, and only gravity the threshold of uplift. What fits about as well is named, too.
"""

from __future__ import annotations

import dataclasses
import math
from collections.abc import Callable, Mapping, Sequence

import numpy as np
from numpy.typing import NDArray

from rockwobble.models import Case, Cylinder, Trace

from ..metrics.pair import rms
from .measurement import lean
from .subject import Subject

_WIDEST = 0.3  # logarithm of a scale
_EXPLAINED = 0.1  # of the difference that a cause leaves, at most
# times as much as the best leaves, or so much of the difference: cannot be told from it
_ALIKE, _SAME = 3.0, 0.01
_LEAST = 0.05  # of the tolerance of a subject: a smaller difference may be its method's
_RTOL = 1e-10
_LARGEST_LOSS = 0.2  # of the base radius


def _scaled_gravity(case: Case, scale: float) -> Case:
    return dataclasses.replace(case, gravity=scale * case.gravity)


def _with_body(change: Callable[[Cylinder, float], Cylinder]) -> Callable[[Case, float], Case]:
    return lambda case, scale: dataclasses.replace(case, cylinder=change(case.cylinder, scale))


def _inertias(body: Cylinder) -> tuple[float, float]:
    """Return I1/m and I2/m about the mass centre [m^2] of a body; homogeneous where it states none."""
    b, half = body.base_radius, body.half_height
    transverse, axial = body.transverse_inertia, body.axial_inertia
    return (
        b * b / 4.0 + half * half / 3.0 if transverse is None else transverse,
        b * b / 2.0 if axial is None else axial,
    )


CANDIDATES: Mapping[str, Callable[[Case, float], Case]] = {
    "gravity": _scaled_gravity,
    "size": _with_body(lambda body, scale: dataclasses.replace(body, semidiagonal=scale * body.semidiagonal)),
    "slenderness tan alpha": _with_body(
        lambda body, scale: dataclasses.replace(body, tan_alpha=scale * body.tan_alpha)
    ),
    "transverse inertia": _with_body(
        lambda body, scale: dataclasses.replace(body, transverse_inertia=scale * _inertias(body)[0])
    ),
    "axial inertia": _with_body(
        lambda body, scale: dataclasses.replace(body, axial_inertia=scale * _inertias(body)[1])
    ),
    "ground acceleration": lambda case, scale: dataclasses.replace(
        case, motion=None if case.motion is None else case.motion.scaled(scale)
    ),
}
_CLOCK = "clock"


def likely_cause(subject: Subject, support: str, cases: Sequence[Case]) -> str:
    """Return the number that is likely wrong, and by how much, in words; empty where none explains it.

    Parameters
    ----------
    subject : Subject
        With an independent model as its reference.
    support : str
    cases : sequence of Case
        A release, and motions from rest.
    """
    found = [subject.simulate(case, support) for case in cases]
    if any(not len(trace.time) or trace.outcome == "failed" for trace in found):
        return ""
    whole = _difference(found, [_model(subject, case, support) for case in cases])
    if not _LEAST * subject.tolerance < whole < math.inf:
        return ""
    fits = {name: _fit(subject, support, cases, found, name) for name in (*CANDIDATES, _CLOCK)}
    loss, left = _fitted_loss(subject, support, cases, found)
    words = {name: f"{name} {100.0 * (scale - 1.0):+.2g} %" for name, (scale, _) in fits.items()}
    rests = {name: rest for name, (_, rest) in fits.items()}
    words["loss"], rests["loss"] = f"a loss as of a rolling resistance of {loss:.2g} b", left
    best = min(rests.values())
    if best > _EXPLAINED * whole:
        return ""
    alike = max(_ALIKE * best, _SAME * whole)
    return ", or ".join(words[name] for name in sorted(rests, key=rests.__getitem__) if rests[name] <= alike)


def _model(subject: Subject, case: Case, support: str) -> Trace:
    assert subject.reference is not None
    return subject.reference(case, support=support, rtol=_RTOL)


def _fit(
    subject: Subject, support: str, cases: Sequence[Case], found: Sequence[Trace], name: str
) -> tuple[float, float]:
    """Return the scale of a candidate that fits best, and the difference that it leaves."""
    unscaled = [_model(subject, case, support) for case in cases] if name == _CLOCK else []

    def difference(exponent: float) -> float:
        scale = math.exp(exponent)
        if name == _CLOCK:
            return _difference(found, unscaled, clock=scale)
        try:
            changed = [CANDIDATES[name](case, scale) for case in cases]
        except ValueError:  # no body has such an inertia
            return math.inf
        return _difference(found, [_model(subject, case, support) for case in changed])

    exponent, least = _lowest(difference, -_WIDEST, _WIDEST)
    return math.exp(exponent), least


def _fitted_loss(
    subject: Subject, support: str, cases: Sequence[Case], found: Sequence[Trace]
) -> tuple[float, float]:
    """Return the rolling resistance over b that fits best, and the difference that it leaves."""

    def difference(share: float) -> float:
        lossy = [
            dataclasses.replace(case, rolling_resistance=share * case.cylinder.base_radius) for case in cases
        ]
        return _difference(found, [_model(subject, case, support) for case in lossy])

    return _lowest(difference, 0.0, _LARGEST_LOSS)


def _lowest(function: Callable[[float], float], low: float, high: float) -> tuple[float, float]:
    """Return where a function is lowest, and how low: on a grid, then about its best point."""
    from scipy.optimize import minimize_scalar

    grid = np.linspace(low, high, 13)
    best = int(np.argmin([function(float(at)) for at in grid]))
    around = float(grid[max(best - 1, 0)]), float(grid[min(best + 1, len(grid) - 1)])
    found = minimize_scalar(function, bounds=around, method="bounded", options={"xatol": 1e-6})
    return float(found.x), float(found.fun)


def _difference(found: Sequence[Trace], models: Sequence[Trace], *, clock: float = 1.0) -> float:
    """Return the root mean square difference of the leans of all cases, over sin(alpha)."""
    from scipy.interpolate import CubicSpline

    parts: list[NDArray[np.float64]] = []
    for one, other in zip(found, models, strict=True):
        at = one.time * clock
        at = at[at <= min(float(other.time[-1]), other.case.length)]
        own, model = lean(one)[: len(at)], lean(other)
        if not np.isfinite(one.rolling_angle).any():
            own, model = np.abs(own), np.abs(model)
        # a model of another slenderness leans by another share of it
        model = model * (math.sin(other.case.cylinder.alpha) / math.sin(one.case.cylinder.alpha))
        parts.append(np.abs(own - CubicSpline(other.time, model)(at)))
    apart = rms(np.concatenate(parts)) if all(len(part) > 1 for part in parts) else math.nan
    return apart if math.isfinite(apart) else math.inf
