"""Layer exact: exact solutions, and what is exact about an uplift."""

from __future__ import annotations

import math
from collections.abc import Iterator

import numpy as np

from rockwobble.models import Case, Cylinder, GroundMotion, InitialState

from ..bench import Array, Bench, largest
from ..finding import Bound, Finding, at_most, worst_of
from ..problems import GRAVITY, PIER, THRESHOLD, released
from . import quadrature
from .lagrange import Shape, shape_of

SPIN, VANISHING_SPIN = 0.3, 1e-8  # [rad/s]
# what rounding of the energies leaves in a quadrature; the solution itself is good to 1e-13
FREE = Bound(3e-9, "quadrature of the energies, good to 1e-9")
TURN = Bound(3e-9, "quadrature of the energies, good to 1e-9", "rad")
# the turn is off its limit by some 10 times the spin over p
LIMIT = Bound(1e-6, "Srinivasan and Ruina's limit; the spin that is left is 1e-8 of p", "rad")
# rtol is 1e-12
STEADY = Bound(1e-9, "an error in the balance of (18) makes the tilt oscillate by as much", "of the tilt")
INSTANT = Bound(1e-12, "the root of |a| = g tan(alpha) in closed form", "s")
DIRECTION = Bound(
    1e-11, "against the ground's acceleration there (26), to the rounding of the instant", "rad"
)
EARLY = Bound(2e-5, "two terms of its series in W t = 0.015, without the third")
BELOW = Bound(0.0, "exactly zero below |a| = g tan(alpha)", "rad")
# a record of two straight pieces, the second of which crosses the threshold inside a sample
RECORD = GroundMotion(GRAVITY * np.array([[0.02, 0.01], [0.10, 0.06], [0.22, 0.16], [0.24, 0.20]]), 0.02)


def check(bench: Bench) -> Iterator[Finding]:
    """Yield the findings of this layer."""
    yield from _uplift(bench)
    for tan_alpha in (0.1, 0.2, 1.0):
        yield from _free(bench, Cylinder(semidiagonal=6.0, tan_alpha=tan_alpha))
    yield _limit(bench)
    yield _steady(bench)
    yield _planar(bench)
    yield _stated(bench)


def _free(bench: Bench, cylinder: Cylinder) -> Iterator[Finding]:
    time, turn = quadrature.period_and_turn(shape_of(cylinder), 0.5 * cylinder.alpha, SPIN)
    case = released(0.5, SPIN, 1.2 * time, cylinder)
    found = bench.solve(case, sample_step=0.25 * time, rtol=1e-12, rest_tilt=0.0)
    maxima = found.extrema[found.extrema[:, 3] > 0.0]
    second = maxima[1] if len(maxima) > 1 else np.full(4, math.nan)
    of = f"released at alpha/2 with {SPIN:g} rad/s, tan alpha = {cylinder.tan_alpha:g}"
    part = "size R, gravity or equation (18): the time scale of the motion"
    yield at_most(f"period, {of}", abs(second[0] / time - 1.0), FREE, part)
    part = "equation (19), the inertia of the rolling angle"
    yield at_most(f"angle of turn, {of}", abs(second[2] - turn), TURN, part)


def _limit(bench: Bench) -> Finding:
    shape = shape_of(PIER)
    limit = math.pi * math.sqrt(quadrature.tilt_inertia(shape) / quadrature.cone_inertia(shape))
    case = released(0.5, VANISHING_SPIN, 4.0)
    found = bench.solve(case, sample_step=1.0, rtol=1e-10, rest_tilt=0.0)
    return at_most(
        f"angle of turn at {VANISHING_SPIN:g} rad/s against pi sqrt(A/J)",
        largest(np.asarray(found.passes["angle_of_turn"])[:1] - limit),
        LIMIT,
        "passes near upright: step control or equation (19)",
    )


def _steady(bench: Bench) -> Finding:
    tilt = 0.6 * PIER.alpha
    case = released(0.6, quadrature.steady_rate(shape_of(PIER), tilt), 10.0)
    found = bench.solve(case, sample_step=0.25, rtol=1e-12)
    part = "equation (18): centrifugal term against weight"
    return at_most("steady wobble stays at its tilt", largest(found.tilt - tilt) / tilt, STEADY, part)


def _planar(bench: Bench) -> Finding:
    quarter = quadrature.planar_quarter(shape_of(PIER), 0.5 * PIER.alpha)
    case = released(0.5, 0.0, 1.5 * quarter)
    found = bench.solve(case, "planar", sample_step=quarter, rtol=1e-12, rest_tilt=0.0)
    minima = found.extrema[found.extrema[:, 3] < 0.0]
    off = largest(minima[:1, 0] / quarter - 1.0)
    return at_most("planar rocking, time from rest to upright", off, FREE, "planar equation, or the impact")


def _stated(bench: Bench) -> Finding:
    """The exact solutions of the package against quadratures that share nothing with them."""
    shape, tilt = shape_of(PIER), 0.5 * PIER.alpha
    time, turn = quadrature.period_and_turn(shape, tilt, SPIN)
    quarter = quadrature.planar_quarter(shape, tilt)
    release = InitialState(tilt=tilt, rolling_rate=SPIN)
    stated = bench.reduced.free_response(PIER, release)
    model = bench.solve(Case(PIER, initial=release, duration=0.1), rest_tilt=0.0)
    errors = {
        "period": stated.period / time - 1.0,
        "half period": stated.half_period / (0.5 * time) - 1.0,
        "angle of turn": stated.angle_of_turn - turn,
        "the same on its own": bench.reduced.angle_of_turn(PIER, release) - turn,
        "largest tilt": stated.maximum_tilt / tilt - 1.0,
        "energy": stated.energy / model.energy[0] - 1.0,
        "rocking period": bench.reduced.rocking_period(PIER, tilt) / (4.0 * quarter) - 1.0,
    }
    return worst_of("exact solutions, tan alpha = 0.2", errors, FREE, "exact solutions (reduced/exact)")


def _uplift(bench: Bench) -> Iterator[Finding]:
    time, a, slope = _crossing(RECORD, THRESHOLD)
    shape = shape_of(PIER)
    after = 2e-3 / math.sqrt(GRAVITY * 6.0 / quadrature.tilt_inertia(shape))
    case = Case(PIER, RECORD, duration=time + after)
    # next to the uplift, where a series gives the state, and after the first steps
    shares = 1e-3, 0.25, 1.0
    traces = [bench.solve(case, sample_step=time + share * after, rtol=1e-12) for share in shares[:2]]
    found = traces[0]
    part = "uplift: criterion (25) and where it is located in a sample"
    yield at_most("instant of uplift inside a sample", abs(found.uplift_time - time), INSTANT, part)
    yield at_most(
        "direction of uplift",
        abs(math.remainder(found.uplift_direction - math.atan2(-a[1], -a[0]), 2.0 * math.pi)),
        DIRECTION,
        "uplift: direction (26), or the components of the record",
    )
    tilts = [trace.tilt[1] for trace in traces] + [found.tilt[-1]]
    early = [
        tilt / _early_tilt(shape, a, slope, share * after) - 1.0
        for tilt, share in zip(tilts, shares, strict=True)
    ]
    yield at_most("tilt just after the uplift", largest(np.array(early)), EARLY, "start after the uplift")
    still = bench.solve(Case(PIER, RECORD.scaled(0.999 * 0.2 / math.hypot(0.24, 0.2))))
    yield at_most("tilt just below the threshold of uplift", largest(still.tilt), BELOW, part)


def _crossing(motion: GroundMotion, threshold: float) -> tuple[float, Array, Array]:
    """Return when |a| first reaches the threshold [s], a there and its slope: the root of a quadratic."""
    samples, step = motion.acceleration, motion.time_step
    for index in range(len(samples) - 1):
        a, slope = samples[index], (samples[index + 1] - samples[index]) / step
        roots = np.roots([slope @ slope, 2.0 * (a @ slope), a @ a - threshold**2])
        inside = [float(r.real) for r in roots if abs(r.imag) == 0.0 and 0.0 <= r.real < step]
        if inside:
            time = min(inside)
            return index * step + time, a + slope * time, slope
    raise AssertionError("the record of this check uplifts the cylinder")


def _early_tilt(shape: Shape, a: Array, slope: Array, time: float) -> float:
    """Return K t^3/6 + K2 t^4/24 with K = p^2 cos(alpha) d|a|/dt/g and K2 = p^2 cos(alpha) |a| W^2/g."""
    size = math.hypot(*a)
    factor = shape.h / quadrature.tilt_inertia(shape)  # p^2 cos(alpha)/g
    growth = float(a @ slope) / size
    turning = float(a[0] * slope[1] - a[1] * slope[0]) / size**2
    return factor * (growth * time**3 / 6.0 + size * turning**2 * time**4 / 24.0)
