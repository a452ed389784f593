"""Layer rest: how motion begins and ends: uplift from the first sample on, rest, and forces at rest.

What is expected follows in closed form from (19) and (25), with the inertias of `lagrange`.
"""

from __future__ import annotations

import math
from collections.abc import Iterator

import numpy as np

from rockwobble.models import Case, GroundMotion, InitialState, Trace

from ..bench import Bench, largest
from ..finding import Bound, Finding, at_most, none_wrong
from ..problems import GRAVITY, PIER, THRESHOLD, steady
from . import quadrature
from .lagrange import shape_of

UPLIFT = "uplift: criterion (25) with a vertical component"
START = "start after an uplift at a first sample above the threshold"
AT_ONCE = Bound(1e-12, "at once, against the ground's acceleration (26)", "s + rad")
ROOT = Bound(1e-12, "the root of (g + az) tan(alpha) = |a| in closed form", "s + rad")
# p t = 2e-3 after the uplift: what is left out of the tilt is of the order of its square and of the lag
EARLY = Bound(1e-4, "two terms of its series: K0 t^2/2 and the slope of the record")
EARLY_TURN = Bound(1e-2, "first term of its series; 1e-3 was measured")
STANDING = Bound(1e-14, "Newton's law; rounding", "weights")
BELOW = Bound(0.0, "exactly zero where |a| < (g + az) tan(alpha)", "rad")
REST = 1e-2  # rest threshold over alpha: its energy is that of a standstill at this tilt
SHARES = (0.9, 1.1)  # of that tilt, from which a release comes to rest and from which it does not


def check(bench: Bench) -> Iterator[Finding]:
    """Yield the findings of this part."""
    yield from _first_sample(bench)
    # |a| stays at 0.8 of its threshold while the weight falls to half: f = 0 where it is 0.8
    level = 0.8 * THRESHOLD * np.array([0.6, 0.8])
    falling = GroundMotion([[*level, 0.0], [*level, -0.5 * GRAVITY]], 0.5)
    off = _off(bench.solve(Case(PIER, falling)), 0.2, [0.6, 0.8])
    yield at_most("instant of uplift as the weight falls", off, ROOT, UPLIFT)
    ground = np.array([0.5, 0.2, -0.3 * GRAVITY])
    force = bench.solve(Case(PIER, steady(ground, 1.0)), sample_step=0.25).contact_force[:4]
    apart = largest(force - (ground + np.array([0.0, 0.0, GRAVITY])) / GRAVITY)
    yield at_most("contact force at rest", apart, STANDING, "contact force at rest (reduced/forces.py)")
    heavier = bench.solve(Case(PIER, steady([1.1 * THRESHOLD, 0.0, 0.2 * GRAVITY], 1.0)))
    name = "tilt below the threshold of a greater weight"
    yield at_most(name, largest(heavier.tilt), BELOW, UPLIFT)
    yield _threshold(bench)


def _off(found: Trace, time: float, ground: list[float]) -> float:
    """How far an uplift is from its time and from the direction against the ground's acceleration."""
    direction = math.atan2(-ground[1], -ground[0])
    return abs(found.uplift_time - time) + abs(
        math.remainder(found.uplift_direction - direction, 2.0 * math.pi)
    )


def _first_sample(bench: Bench) -> Iterator[Finding]:
    """The record begins above the threshold, turns, and has a vertical component."""
    samples = np.array([[1.5, 0.7, 0.5], [1.2, 1.4, -0.5]]) * THRESHOLD
    step = 0.1
    shape = shape_of(PIER)
    A = quadrature.tilt_inertia(shape)
    p = math.sqrt(GRAVITY * PIER.semidiagonal / A)
    # at the end of the first steps, and where a series still gives the state
    time, at_once = 2e-3 / p, 5e-7 / p
    found, first = (
        bench.solve(
            Case(PIER, GroundMotion(samples, step), duration=end), sample_step=sample_step, rtol=1e-12
        )
        for end, sample_step in ((time, time), (1e-5 / p, at_once))
    )
    name = "uplift at a first sample above the threshold"
    yield at_most(name, _off(found, 0.0, [1.5, 0.7]), AT_ONCE, "uplift: a first sample above the threshold")
    a, slope = samples[0], (samples[1] - samples[0]) / step
    size = math.hypot(a[0], a[1])
    # theta'' = F + F' t with F = (h/A) (|a| - (g + az) tan(alpha))
    jump = shape.h / A * (size - (GRAVITY + a[2]) * PIER.tan_alpha)
    rise = shape.h / A * (float(a[:2] @ slope[:2]) / size - slope[2] * PIER.tan_alpha)
    # (19) near upright: phi' = W/(1 + 2 J K0/(h |a|))
    turning = float(a[0] * slope[1] - a[1] * slope[0]) / size**2
    rate = turning / (1.0 + 2.0 * quadrature.cone_inertia(shape) * jump / (shape.h * size))
    tilts, turns = [], []
    for trace, index, at in ((found, -1, time), (first, 1, at_once)):
        tilts.append(trace.tilt[index] / (0.5 * jump * at**2 + rise * at**3 / 6.0) - 1.0)
        turns.append((trace.rolling_angle[index] - trace.uplift_direction) / (rate * at) - 1.0)
    yield at_most("tilt just after it", largest(np.array(tilts)), EARLY, START)
    yield at_most("turn just after it", largest(np.array(turns)), EARLY_TURN, START)


def _threshold(bench: Bench) -> Finding:
    """Releases from either side of the rest threshold: still ground, half the weight, and a push upright.

    A push of half the threshold takes half off the restoring moment where the cylinder leans the other way:
    the bound is halved, and with the weight both the bound and what is held against it.
    """
    wrong = []
    tried = 0
    for scale, ground, spin in (
        (1.0, [0.0, 0.0, 0.0], 0.01),
        (1.0, [0.0, 0.0, -0.5 * GRAVITY], 0.01),
        (0.5, [0.5 * THRESHOLD, 0.0, 0.0], 0.0),
    ):
        for share in SHARES:
            for model, rate in (("recess", spin), ("planar", 0.0)):
                tried += 1
                initial = InitialState(tilt=share * scale * REST * PIER.alpha, rolling_rate=rate)
                case = Case(PIER, steady(ground, 10.0), initial=initial, duration=2.0)
                found = bench.solve(case, model, sample_step=0.1, rest_tilt=REST)
                if not _ended(found, at_rest=share < 1.0):
                    wrong.append(f"{model}, {share:g} of it, ground {ground}: {found.outcome}")
    return none_wrong(
        f"wrong endings of {tried} releases near the rest threshold",
        wrong,
        "the energy of a standstill at the threshold, times the weight of the moment",
        "rest threshold: energy against its bound, or the vertical acceleration in it",
    )


def _ended(found: Trace, *, at_rest: bool) -> bool:
    still = found.tilt[-1] == found.tilt_rate[-1] == 0.0 and np.isnan(found.rolling_angle[-1])
    as_it_was = still if at_rest else np.isfinite(found.rolling_angle).all()
    return bool(found.outcome == "stands" and found.rests == at_rest and as_it_was)
