"""Layer: how motion begins and ends: uplift from the first sample on, rest, and forces at rest.

What is expected follows in closed form from (19) and (25), with the inertias of `lagrange`.
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from typing import Any

import numpy as np

from rockwobble.models import Case, Cylinder, GroundMotion, InitialState

from ..bench import Bench
from ..finding import Finding, at_most
from ..polyline import steady
from . import quadrature
from .lagrange import shape_of

LAYER = "rest"
GRAVITY = 9.81
CYLINDER = Cylinder(semidiagonal=6.0, tan_alpha=0.2)
THRESHOLD = GRAVITY * CYLINDER.tan_alpha
UPLIFT = "uplift: criterion (25) with a vertical component"
# p t = 2e-3 after the uplift: what is left out of the tilt is of the order of its square and of the lag
EARLY, EARLY_TURN = 1e-4, 1e-2
ROOT = 1e-12
REST = 1e-2  # rest threshold over alpha: its energy is that of a standstill at this tilt
SHARES = (0.9, 1.1)  # of that tilt, from which a release comes to rest and from which it does not


def check(bench: Bench) -> Iterator[Finding]:
    """Yield the findings of this part."""
    yield from _first_sample(bench)
    yield _uplift_by_vertical(bench)
    yield from _stands(bench)
    yield _threshold(bench)


def _first_sample(bench: Bench) -> Iterator[Finding]:
    """The record begins above the threshold, turns, and has a vertical component."""
    samples = np.array([[1.5, 0.7, 0.5], [1.2, 1.4, -0.5]]) * THRESHOLD
    step = 0.1
    shape = shape_of(CYLINDER, GRAVITY)
    A = quadrature.tilt_inertia(shape)
    p = math.sqrt(GRAVITY * CYLINDER.semidiagonal / A)

    def until(end: float, sample_step: float) -> Any:
        return bench.reduced.simulate(
            Case(CYLINDER, GroundMotion(samples, step), duration=end, gravity=GRAVITY),
            sample_step=sample_step,
            rtol=1e-12,
        )

    # at the end of the first steps, and where a series still gives the state
    time, at_once = 2e-3 / p, 5e-7 / p
    found = until(time, time)
    first = until(1e-5 / p, at_once)
    yield at_most(
        LAYER,
        "uplift at a first sample above the threshold",
        abs(found.uplift_time)
        + abs(math.remainder(found.uplift_direction - math.atan2(-0.7, -1.5), 2.0 * math.pi)),
        ROOT,
        unit="s + rad",
        reason="at once, against the ground's acceleration (26)",
        part="uplift: a first sample above the threshold",
    )
    a, slope = samples[0], (samples[1] - samples[0]) / step
    size = math.hypot(a[0], a[1])
    # theta'' = F + F' t with F = (h/A) (|a| - (g + az) tan(alpha))
    jump = shape.h / A * (size - (GRAVITY + a[2]) * CYLINDER.tan_alpha)
    rise = shape.h / A * (float(a[:2] @ slope[:2]) / size - slope[2] * CYLINDER.tan_alpha)

    def expected(time: float) -> float:
        return float(0.5 * jump * time**2 + rise * time**3 / 6.0)

    part = "start after an uplift at a first sample above the threshold"
    yield at_most(
        LAYER,
        "tilt just after it",
        max(abs(found.tilt[-1] / expected(time) - 1.0), abs(first.tilt[1] / expected(at_once) - 1.0)),
        EARLY,
        reason="two terms of its series: K0 t^2/2 and the slope of the record",
        part=part,
    )
    # (19) near upright: phi' = W/(1 + 2 J K0/(h |a|))
    turning = float(a[0] * slope[1] - a[1] * slope[0]) / size**2
    rate = turning / (1.0 + 2.0 * quadrature.cone_inertia(shape) * jump / (shape.h * size))
    yield at_most(
        LAYER,
        "turn just after it",
        max(
            abs((found.rolling_angle[-1] - found.uplift_direction) / (rate * time) - 1.0),
            abs((first.rolling_angle[1] - first.uplift_direction) / (rate * at_once) - 1.0),
        ),
        EARLY_TURN,
        reason="first term of its series; 1e-3 was measured",
        part=part,
    )


def _uplift_by_vertical(bench: Bench) -> Finding:
    """|a| stays at 0.8 of its threshold while the weight falls to half: f = 0 where it is 0.8."""
    level = 0.8 * THRESHOLD * np.array([0.6, 0.8])
    record = GroundMotion([[*level, 0.0], [*level, -0.5 * GRAVITY]], 0.5)
    found = bench.reduced.simulate(Case(CYLINDER, record, gravity=GRAVITY))
    return at_most(
        LAYER,
        "instant of uplift as the weight falls",
        abs(found.uplift_time - 0.2)
        + abs(math.remainder(found.uplift_direction - math.atan2(-0.8, -0.6), 2.0 * math.pi)),
        ROOT,
        unit="s + rad",
        reason="the root of (g + az) tan(alpha) = |a| in closed form",
        part=UPLIFT,
    )


def _stands(bench: Bench) -> Iterator[Finding]:
    ground = np.array([0.5, 0.2, -0.3 * GRAVITY])
    found = bench.reduced.simulate(Case(CYLINDER, steady(ground, 1.0), gravity=GRAVITY), sample_step=0.25)
    weight = np.array([0.0, 0.0, GRAVITY])
    yield at_most(
        LAYER,
        "contact force at rest",
        np.abs(found.contact_force[:4] - (ground + weight) / GRAVITY).max(),
        1e-14,
        unit="weights",
        reason="Newton's law; rounding",
        part="contact force at rest (reduced/forces.py)",
    )
    heavier = GroundMotion([[1.1 * THRESHOLD, 0.0, 0.2 * GRAVITY]] * 2, 1.0)
    found = bench.reduced.simulate(Case(CYLINDER, heavier, gravity=GRAVITY))
    yield at_most(
        LAYER,
        "tilt below the threshold of a greater weight",
        float(found.tilt.max()),
        0.0,
        unit="rad",
        reason="exactly zero where |a| < (g + az) tan(alpha)",
        part=UPLIFT,
    )


def _threshold(bench: Bench) -> Finding:
    """Releases from either side of the rest threshold: still ground, half the weight, and a push upright.

    A push of half the threshold takes half off the restoring moment where the cylinder leans the other way.
    """
    wrong = []
    tried = 0
    for moment, ground, spin in (
        (1.0, [0.0, 0.0, 0.0], 0.01),
        (0.5, [0.0, 0.0, -0.5 * GRAVITY], 0.01),
        (0.5, [0.5 * THRESHOLD, 0.0, 0.0], 0.0),
    ):
        # with the push the bound is halved, and with the weight both the bound and what is held against it
        scale = moment if ground[0] else 1.0
        for share in SHARES:
            for model, rate in (("recess", spin), ("planar", 0.0)):
                tried += 1
                found = bench.reduced.simulate(
                    Case(
                        CYLINDER,
                        steady(ground, 10.0),
                        initial=InitialState(tilt=share * scale * REST * CYLINDER.alpha, rolling_rate=rate),
                        duration=2.0,
                        gravity=GRAVITY,
                    ),
                    sample_step=0.1,
                    rest_tilt=REST,
                    **bench.reduced.MODELS[model],
                )
                if not _ended(found, "rest" if share < 1.0 else "completed"):
                    wrong.append(f"{model}, {share:g} of it, ground {ground}: {found.outcome}")
    return at_most(
        LAYER,
        f"wrong endings of {tried} releases near the rest threshold",
        len(wrong),
        0.0,
        reason="the energy of a standstill at the threshold, times the weight of the moment",
        part="rest threshold: energy against its bound, or the vertical acceleration in it",
        note="; ".join(wrong),
    )


def _ended(found: Any, outcome: str) -> bool:
    if outcome == "rest":
        still = found.tilt[-1] == found.tilt_rate[-1] == 0.0
        return bool(found.outcome == "rest" and still and np.isnan(found.rolling_angle[-1]))
    return bool(found.outcome == outcome and np.isfinite(found.rolling_angle).all())
