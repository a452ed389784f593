"""Layer: exact solutions, and what is exact about an uplift."""

from __future__ import annotations

import math
from collections.abc import Iterator

import numpy as np

from rockwobble.models import Case, Cylinder, GroundMotion, InitialState

from ..bench import Bench
from ..finding import Finding, at_most
from . import quadrature
from .lagrange import Shape, shape_of

LAYER = "exact"
GRAVITY = 9.81
SLENDERNESS = (0.1, 0.2, 1.0)
# what rounding of the energies leaves in a quadrature; the solution itself is good to 1e-13
FREE = 3e-9
# the turn is off its limit by some 10 times the spin over p
VANISHING_SPIN, LIMIT = 1e-8, 1e-6
STEADY = 1e-9  # an error in the balance shows as an oscillation of its size; rtol is 1e-12
UPLIFT = 1e-12  # a root, to rounding [s]
EARLY = 2e-5  # two terms of a series in W t = 0.015, of which the third is left out


def check(bench: Bench) -> Iterator[Finding]:
    """Yield the findings of this layer."""
    yield from _uplift(bench)
    for tan_alpha in SLENDERNESS:
        cylinder = Cylinder(semidiagonal=6.0, tan_alpha=tan_alpha)
        yield from _free(bench, cylinder)
    cylinder = Cylinder(semidiagonal=6.0, tan_alpha=0.2)
    yield _limit(bench, cylinder)
    yield _steady(bench, cylinder)
    yield _planar(bench, cylinder)
    yield _stated(bench, cylinder)


def _free(bench: Bench, cylinder: Cylinder) -> Iterator[Finding]:
    shape, tilt, spin = shape_of(cylinder, GRAVITY), 0.5 * cylinder.alpha, 0.3
    time, turn = quadrature.period_and_turn(shape, tilt, spin)
    found = bench.reduced.simulate(
        Case(
            cylinder, initial=InitialState(tilt=tilt, rolling_rate=spin), duration=1.2 * time, gravity=GRAVITY
        ),
        sample_step=0.25 * time,
        rtol=1e-12,
        rest_tilt=0.0,
    )
    maxima = found.extrema[found.extrema[:, 3] > 0.0]
    second = maxima[1] if len(maxima) > 1 else np.full(4, math.nan)
    of = f"released at alpha/2 with {spin:g} rad/s, tan alpha = {cylinder.tan_alpha:g}"
    words = {"reason": "quadrature of the energies, good to 1e-9"}
    yield at_most(
        LAYER,
        f"period, {of}",
        abs(second[0] / time - 1.0),
        FREE,
        part="size R, gravity or equation (18): the time scale of the motion",
        **words,
    )
    yield at_most(
        LAYER,
        f"angle of turn, {of}",
        abs(second[2] - turn),
        FREE,
        unit="rad",
        part="equation (19), the inertia of the rolling angle",
        **words,
    )


def _limit(bench: Bench, cylinder: Cylinder) -> Finding:
    shape = shape_of(cylinder, GRAVITY)
    limit = math.pi * math.sqrt(quadrature.tilt_inertia(shape) / quadrature.cone_inertia(shape))
    found = bench.reduced.simulate(
        Case(
            cylinder,
            initial=InitialState(tilt=0.5 * cylinder.alpha, rolling_rate=VANISHING_SPIN),
            duration=4.0,
            gravity=GRAVITY,
        ),
        sample_step=1.0,
        rtol=1e-10,
        rest_tilt=0.0,
    )
    turns = np.asarray(found.passes["angle_of_turn"])
    return at_most(
        LAYER,
        f"angle of turn at {VANISHING_SPIN:g} rad/s against pi sqrt(A/J)",
        abs(turns[0] - limit) if len(turns) else math.nan,
        LIMIT,
        unit="rad",
        reason="Srinivasan and Ruina's limit; the spin that is left is 1e-8 of p",
        part="passes near upright: step control or equation (19)",
    )


def _steady(bench: Bench, cylinder: Cylinder) -> Finding:
    shape, tilt = shape_of(cylinder, GRAVITY), 0.6 * cylinder.alpha
    found = bench.reduced.simulate(
        Case(
            cylinder,
            initial=InitialState(tilt=tilt, rolling_rate=quadrature.steady_rate(shape, tilt)),
            duration=10.0,
            gravity=GRAVITY,
        ),
        sample_step=0.25,
        rtol=1e-12,
    )
    return at_most(
        LAYER,
        "steady wobble stays at its tilt",
        np.abs(found.tilt - tilt).max() / tilt,
        STEADY,
        unit="of the tilt",
        reason="an error in the balance of (18) makes the tilt oscillate by as much",
        part="equation (18): centrifugal term against weight",
    )


def _stated(bench: Bench, cylinder: Cylinder) -> Finding:
    """The exact solutions of the package against quadratures that share nothing with them."""
    shape, tilt, spin = shape_of(cylinder, GRAVITY), 0.5 * cylinder.alpha, 0.3
    time, turn = quadrature.period_and_turn(shape, tilt, spin)
    quarter = quadrature.planar_quarter(shape, tilt)
    release = InitialState(tilt=tilt, rolling_rate=spin)
    stated = bench.reduced.free_response(cylinder, release, gravity=GRAVITY)
    model = bench.reduced.simulate(
        Case(cylinder, initial=release, duration=0.1, gravity=GRAVITY), rest_tilt=0.0
    )
    errors = {
        "period": stated.period / time - 1.0,
        "half period": stated.half_period / (0.5 * time) - 1.0,
        "angle of turn": stated.angle_of_turn - turn,
        "the same on its own": bench.reduced.angle_of_turn(cylinder, release, gravity=GRAVITY) - turn,
        "largest tilt": stated.maximum_tilt / tilt - 1.0,
        "energy": stated.energy / model.energy[0] - 1.0,
        "rocking period": bench.reduced.rocking_period(cylinder, tilt, gravity=GRAVITY) / (4.0 * quarter)
        - 1.0,
    }
    worst = max(errors, key=lambda name: abs(errors[name]))
    return at_most(
        LAYER,
        f"exact solutions, tan alpha = {cylinder.tan_alpha:g}",
        abs(errors[worst]),
        FREE,
        reason="quadrature of the energies, good to 1e-9",
        part=f"exact solutions (reduced/exact): {worst}",
        note=f"worst: {worst}",
    )


def _planar(bench: Bench, cylinder: Cylinder) -> Finding:
    shape, tilt = shape_of(cylinder, GRAVITY), 0.5 * cylinder.alpha
    quarter = quadrature.planar_quarter(shape, tilt)
    found = bench.reduced.simulate(
        Case(cylinder, initial=InitialState(tilt=tilt), duration=1.5 * quarter, gravity=GRAVITY),
        sample_step=quarter,
        rtol=1e-12,
        rest_tilt=0.0,
        plane=0.0,
    )
    minima = found.extrema[found.extrema[:, 3] < 0.0]
    return at_most(
        LAYER,
        "planar rocking, time from rest to upright",
        abs(minima[0, 0] / quarter - 1.0) if len(minima) else math.nan,
        FREE,
        reason="quadrature of the energies, good to 1e-9",
        part="planar equation, or the impact",
    )


def _uplift(bench: Bench) -> Iterator[Finding]:
    """A record of two straight pieces, the second of which crosses the threshold inside a sample."""
    cylinder = Cylinder(semidiagonal=6.0, tan_alpha=0.2)
    samples = GRAVITY * np.array([[0.02, 0.01], [0.10, 0.06], [0.22, 0.16], [0.24, 0.20]])
    step = 0.02
    time, a, slope = _crossing(samples, step, GRAVITY * cylinder.tan_alpha)
    after = 2e-3 / math.sqrt(GRAVITY * 6.0 / quadrature.tilt_inertia(shape_of(cylinder, GRAVITY)))
    found = bench.reduced.simulate(
        Case(cylinder, GroundMotion(samples, step), duration=time + after, gravity=GRAVITY),
        sample_step=time + 0.25 * after,
        rtol=1e-12,
    )
    part = "uplift: criterion (25) and where it is located in a sample"
    yield at_most(
        LAYER,
        "instant of uplift inside a sample",
        abs(found.uplift_time - time),
        UPLIFT,
        unit="s",
        reason="the root of |a| = g tan(alpha) in closed form",
        part=part,
    )
    direction = math.atan2(-a[1], -a[0])
    yield at_most(
        LAYER,
        "direction of uplift",
        abs(math.remainder(found.uplift_direction - direction, 2.0 * math.pi)),
        1e-11,
        unit="rad",
        reason="against the ground's acceleration there (26), to the rounding of the instant",
        part="uplift: direction (26), or the components of the record",
    )
    # where a series still gives the state, and after the first steps
    early = [
        found.tilt[index] / _early_tilt(shape_of(cylinder, GRAVITY), cylinder, a, slope, share * after)
        for index, share in ((1, 0.25), (-1, 1.0))
    ]
    yield at_most(
        LAYER,
        "tilt just after the uplift",
        max(abs(ratio - 1.0) for ratio in early),
        EARLY,
        reason="two terms of its series, without the third",
        part="start after the uplift",
    )
    still = bench.reduced.simulate(
        Case(cylinder, GroundMotion(samples * 0.999 * 0.2 / math.hypot(0.24, 0.2), step), gravity=GRAVITY)
    )
    yield at_most(
        LAYER,
        "tilt just below the threshold of uplift",
        float(still.tilt.max()),
        0.0,
        unit="rad",
        reason="exactly zero below |a| = g tan(alpha)",
        part=part,
    )


def _crossing(samples: np.ndarray, step: float, threshold: float) -> tuple[float, np.ndarray, np.ndarray]:
    """Return when |a| first reaches the threshold [s], a there and its slope: the root of a quadratic."""
    for index in range(len(samples) - 1):
        a, slope = samples[index], (samples[index + 1] - samples[index]) / step
        roots = np.roots([slope @ slope, 2.0 * (a @ slope), a @ a - threshold**2])
        inside = [float(r.real) for r in roots if abs(r.imag) == 0.0 and 0.0 <= r.real < step]
        if inside:
            time = min(inside)
            return index * step + time, a + slope * time, slope
    raise AssertionError("the record of this check uplifts the cylinder")


def _early_tilt(shape: Shape, cylinder: Cylinder, a: np.ndarray, slope: np.ndarray, time: float) -> float:
    """Return K t^3/6 + K2 t^4/24 with K = p^2 cos(alpha) d|a|/dt/g and K2 = p^2 cos(alpha) |a| W^2/g."""
    size = math.hypot(*a)
    factor = shape.h / quadrature.tilt_inertia(shape)  # p^2 cos(alpha)/g
    growth = float(a @ slope) / size
    turning = float(a[0] * slope[1] - a[1] * slope[0]) / size**2
    return factor * (growth * time**3 / 6.0 + size * turning**2 * time**4 / 24.0)
