"""Likely cause of a failed subject: the one change of a problem with which the model reproduces its motions.

Each candidate scales one number that somebody may have wrong. The scale that fits best is found in a release
and in a ramp of the ground together, since some cannot be told apart by one of them: gravity and size both
change the rate of a release, and only gravity the threshold of uplift. What fits about as well is named, too.
"""

from __future__ import annotations

import dataclasses
import math
from collections.abc import Callable, Mapping, Sequence

import numpy as np

from rockwobble.models import Case, Trace

from ..metrics.pair import rms
from .lagrange import shape_of
from .measurement import lean_difference
from .subject import Subject

_WIDEST = 0.3  # largest logarithm of a scale
_EXPLAINED = 0.1  # largest share of the difference that an accepted cause may leave
# ratio to the best remainder, or share of the difference, within which a cause is as likely as the best
_ALIKE, _SAME = 3.0, 0.01
_LEAST = 0.05  # share of the tolerance of a subject: a smaller difference may be due to its method
_RTOL = 1e-10
_LARGEST_LOSS = 0.2  # largest rolling resistance, over the base radius
Change = Callable[[Case, float], Case]


def _of_body(name: str) -> Change:
    """Change that scales a field of the body."""

    def change(case: Case, scale: float) -> Case:
        body, shape = case.cylinder, shape_of(case.cylinder)
        inertias = {"transverse_inertia": shape.I1, "axial_inertia": shape.I2}
        other = {name: scale * inertias.get(name, getattr(body, name))}
        return dataclasses.replace(case, cylinder=dataclasses.replace(body, **other))

    return change


def _with_loss(case: Case, share: float) -> Case:
    return dataclasses.replace(case, rolling_resistance=share * case.cylinder.base_radius)


def _with_motion(case: Case, scale: float) -> Case:
    return case if case.motion is None else dataclasses.replace(case, motion=case.motion.scaled(scale))


CANDIDATES: Mapping[str, Change] = {
    "gravity": lambda case, scale: dataclasses.replace(case, gravity=scale * case.gravity),
    "size": _of_body("semidiagonal"),
    "slenderness tan alpha": _of_body("tan_alpha"),
    "transverse inertia": _of_body("transverse_inertia"),
    "axial inertia": _of_body("axial_inertia"),
    "ground acceleration": _with_motion,
}


def likely_cause(subject: Subject, support: str, cases: Sequence[Case]) -> str:
    """Number that is likely wrong, and its error, in words; empty where none explains the difference.

    Parameters
    ----------
    subject : Subject
        With an independent model as its reference.
    support : str
    cases : sequence of Case
        A release, and motions from rest.
    """
    traces, reference = [subject.simulate(case, support) for case in cases], subject.reference
    if reference is None or any(not len(trace.time) or trace.outcome == "failed" for trace in traces):
        return ""

    def models(changed: Sequence[Case]) -> list[Trace]:
        return [reference(case, support=support, rtol=_RTOL) for case in changed]

    def left_by(change: Change, at: float) -> float:
        try:
            return _difference(traces, models([change(case, at) for case in cases]))
        except ValueError:  # no body has such an inertia
            return math.inf

    as_stated = models(cases)
    whole = _difference(traces, as_stated)
    if not _LEAST * subject.tolerance < whole < math.inf:
        return ""
    lefts: dict[str, Callable[[float], float]] = {
        name: lambda exponent, change=change: left_by(change, math.exp(exponent))  # type: ignore[misc]
        for name, change in CANDIDATES.items()
    }
    lefts["clock"] = lambda exponent: _difference(traces, as_stated, clock=math.exp(exponent))
    fits = {name: _lowest(left, -_WIDEST, _WIDEST) for name, left in lefts.items()}
    rests = {f"{name} {100.0 * math.expm1(at):+.2g} %": rest for name, (at, rest) in fits.items()}
    share, rest = _lowest(lambda share: left_by(_with_loss, share), 0.0, _LARGEST_LOSS)
    rests[f"a loss as of a rolling resistance of {share:.2g} b"] = rest
    best = min(rests.values())
    alike = max(_ALIKE * best, _SAME * whole) if best <= _EXPLAINED * whole else -math.inf
    return ", or ".join(words for words in sorted(rests, key=rests.__getitem__) if rests[words] <= alike)


def _lowest(function: Callable[[float], float], low: float, high: float) -> tuple[float, float]:
    """Place and value of the minimum of a function: on a grid, then about its best point."""
    from scipy.optimize import minimize_scalar

    grid = np.linspace(low, high, 13)
    best = int(np.argmin([function(float(at)) for at in grid]))
    around = float(grid[max(best - 1, 0)]), float(grid[min(best + 1, len(grid) - 1)])
    minimum = minimize_scalar(function, bounds=around, method="bounded", options={"xatol": 1e-6})
    return float(minimum.x), float(minimum.fun)


def _difference(traces: Sequence[Trace], models: Sequence[Trace], *, clock: float = 1.0) -> float:
    """Root mean square difference of the tilt vectors of all cases, over sin(alpha)."""
    parts = [
        lean_difference(one, other, other.case.length, clock=clock)
        for one, other in zip(traces, models, strict=True)
    ]
    apart = rms(np.concatenate(parts)) if all(len(part) > 1 for part in parts) else math.nan
    return apart if math.isfinite(apart) else math.inf
