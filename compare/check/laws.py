"""Checks of a single motion: exact solutions, rest and uplift, and consistency of the trace.

The exact solutions are quadratures of the energies of `lagrange` alone. Free motion in a recess conserves its
energy e and L = B phi', so that

    A theta'^2 = 2 (e - V) - L^2/B,    phi' = L/B,

and the time and the turn from one turning tilt to the other are integrals over the tilt. With
theta = mid - half cos(u) the roots at both ends cancel, and Gauss-Legendre nodes give 12 digits for
spins that are not small.
"""

from __future__ import annotations

import dataclasses
import math
from collections.abc import Iterator

import numpy as np

from rockwobble.models import Case, GroundMotion, InitialState, Tendon
from rockwobble.models.bounds import OVERTURNED_TILT
from rockwobble.models.cylinder import PIER
from rockwobble.multibody.engines.registry import engine_facts

from . import lagrange
from .lagrange import Shape, kinetic, potential, shape_of
from .measurement import (
    FRAME_RELEASE,
    GRAVITY,
    RELEASE,
    SHOCK,
    SHOCK_TIMES,
    SQUAT,
    THRESHOLD,
    Array,
    Result,
    at_most,
    largest,
    polyline,
    release_case,
    steady,
    turning_points,
)
from .subject import SLAB, Subject

_NODES = 64  # more nodes come nearer to the ends, where rounding of the energies counts
_BISECTIONS = 200
_QUADRATURE = "quadrature of the energies, good to 1e-9"
VANISHING_SPIN = 1e-8  # [rad/s]
_RELEASES = {
    "tan alpha = 0.2": RELEASE,
    "tan alpha = 1": release_case(0.5, 0.5, RELEASE.length, SQUAT),
    "frame": FRAME_RELEASE,
}


def free_response(subject: Subject, support: str) -> Iterator[Result]:
    """Period, angle of turn and regained tilt of releases in a recess: slender, squat, and of a frame.

    Time and turn between two tilt maxima are those of the quadrature; without loss the tilt comes back.
    """
    for of, case in _RELEASES.items():
        if case.cylinder.carries_slab and SLAB not in subject.features:
            continue
        yield from returns(subject, support, case, of)


def returns(subject: Subject, support: str, case: Case, of: str) -> Iterator[Result]:
    """Yield period, regained tilt and angle of turn of a release, with the tendon of its case."""
    start = case.initial
    assert start is not None
    time, turn = period_and_turn(shape_of(case.cylinder, case.tendon), start.tilt, start.rolling_rate)
    trace = subject.simulate(case, support)
    maxima = trace.extrema[(trace.extrema[:, 3] > 0.0) & (trace.extrema[:, 0] > 0.5 * time)]
    first = maxima[0] if len(maxima) else np.full(4, math.nan)
    bound = subject.tolerance_bound(3.0, _QUADRATURE)
    yield at_most(f"period of a release, {of}", abs(first[0] / time - 1.0), bound)
    yield at_most(f"tilt that a release returns to, {of}", abs(first[1] / start.tilt - 1.0), bound)
    if "rolling_angle" in subject.knows:
        off = math.remainder(first[2] - start.rolling_angle - turn, 2.0 * math.pi)
        yield at_most(f"angle of turn of a release, {of}", abs(off) / turn, bound)


def steady_wobble(subject: Subject, support: str) -> Iterator[Result]:
    """At the rate at which (18) balances, phi'^2 = 2 V'/B', the tilt is constant, on any support."""
    tilt = 0.3 * PIER.alpha  # below the energy at balance
    case = release_case(0.3, steady_rate(shape_of(PIER), tilt), 1.0)
    trace = subject.simulate(case, support)
    bound = subject.tolerance_bound(10.0, "an error of the balance makes the tilt oscillate by as much")
    yield at_most("tilt of a steady wobble", largest(trace.tilt - tilt) / tilt, bound)


def vanishing_spin(subject: Subject, support: str) -> Iterator[Result]:
    """Angle of turn in the limit of vanishing spin: pi sqrt(A/J) (Srinivasan and Ruina)."""
    shape = shape_of(PIER)
    limit = math.pi * math.sqrt(tilt_inertia(shape) / cone_inertia(shape))
    trace = subject.simulate(release_case(0.5, VANISHING_SPIN, 4.0), support, rest_tilt=0.0)
    first = np.asarray(trace.passes["angle_of_turn"])[:1]
    bound = subject.tolerance_bound(
        1e4, "the spin that is left is 1e-8 of p, and the turn off by some 10 times that"
    )
    yield at_most("angle of turn in the limit of vanishing spin", largest(first - limit), bound)


def planar_rocking(subject: Subject, support: str) -> Iterator[Result]:
    """Time from rest to upright in one plane: a quadrature, Housner's quarter period."""
    yield from reaches_upright(subject, support, None, "planar rocking")


def reaches_upright(subject: Subject, support: str, tendon: Tendon | None, of: str) -> Iterator[Result]:
    """Yield the time from rest at half of alpha to the upright position in one plane."""
    quarter = planar_quarter(shape_of(PIER, tendon), 0.5 * PIER.alpha)
    case = Case(PIER, initial=InitialState(0.5 * PIER.alpha), duration=1.5 * quarter, tendon=tendon)
    trace = subject.simulate(case, support)
    minima = trace.extrema[trace.extrema[:, 3] < 0.0]
    off = largest(minima[:1, 0] / quarter - 1.0)
    yield at_most(f"{of}, time to upright", off, subject.tolerance_bound(30.0, _QUADRATURE))


def tilt_inertia(shape: Shape) -> float:
    """Return A, twice the kinetic energy of a unit tilt rate [m^2]."""
    at, none = np.array([0.3]), np.array([0.0])
    return float(2.0 * kinetic(shape, at, none, np.array([1.0]), none)[0])


def turn_inertia(shape: Shape, tilt: Array) -> Array:
    """Return B (n,) of tilts (n,), twice the kinetic energy of a unit rolling rate [m^2]."""
    none = np.zeros_like(tilt)
    return np.asarray(2.0 * kinetic(shape, tilt, none, none, np.ones_like(tilt)), dtype=float)


def cone_inertia(shape: Shape) -> float:
    """Return J of B = J theta^2 near upright [m^2]."""
    small = 1e-4
    near, double = turn_inertia(shape, np.array([small, 2.0 * small]))
    # the next term is of order theta^3: removed by extrapolation
    return float(2.0 * near - 0.25 * double) / small**2


def height_energy(shape: Shape, tilt: Array) -> Array:
    """Return V (n,) of tilts (n,) over still ground [m^2/s^2]."""
    still = np.zeros((len(tilt), 3))
    return np.asarray(potential(shape, tilt, np.zeros_like(tilt), still), dtype=float)


def period_and_turn(shape: Shape, tilt: float, spin: float) -> tuple[float, float]:
    """Return time [s] and turn [rad] between two tilt maxima, released at `tilt` with `spin` [rad/s]."""
    top = np.array([tilt])
    L = float(turn_inertia(shape, top)[0]) * spin
    e = float(height_energy(shape, top)[0]) + 0.5 * L * spin

    def excess(theta: Array) -> Array:
        return np.asarray(2.0 * (e - height_energy(shape, theta)) - L * L / turn_inertia(shape, theta))

    low, high = 1e-12, 0.5 * tilt
    for _ in range(_BISECTIONS):
        middle = 0.5 * (low + high)
        low, high = (middle, high) if excess(np.array([middle]))[0] < 0.0 else (low, middle)
    lowest = 0.5 * (low + high)
    nodes, weights = np.polynomial.legendre.leggauss(_NODES)
    u = 0.5 * math.pi * (nodes + 1.0)
    theta = lowest + (tilt - lowest) * np.sin(0.5 * u) ** 2
    factor = np.sqrt(tilt_inertia(shape) / excess(theta)) * 0.5 * (tilt - lowest) * np.sin(u)
    scale = 2.0 * 0.5 * math.pi  # there and back
    time = scale * float((weights * factor).sum())
    turn = scale * float((weights * factor * L / turn_inertia(shape, theta)).sum())
    return time, turn


def planar_quarter(shape: Shape, tilt: float) -> float:
    """Return the time of planar rocking from rest at `tilt` to the upright position [s]."""
    nodes, weights = np.polynomial.legendre.leggauss(_NODES)
    x = 0.5 * (nodes + 1.0)
    theta = tilt * (1.0 - x * x)
    drop = height_energy(shape, np.array([tilt])) - height_energy(shape, theta)
    speed = np.sqrt(2.0 * drop / tilt_inertia(shape))
    return float((0.5 * weights * 2.0 * tilt * x / speed).sum())


def steady_rate(shape: Shape, tilt: float) -> float:
    """Return the rolling rate at which the tilt stays [rad/s]: V' = B'/2 of its square."""
    none, still = np.array([0.0]), np.zeros((1, 3))
    by_height = lagrange.slope(lambda at: potential(shape, at, none + 0j, still), tilt)
    by_inertia = lagrange.slope(lambda at: 2.0 * kinetic(shape, at, none, none, none + 1.0), tilt)
    return math.sqrt(2.0 * by_height / by_inertia)


# two straight pieces; in the second the threshold is crossed inside a sample, as the load turns and the
# weight falls
LIFTING = GroundMotion(
    GRAVITY * np.array([[0.0, 0.0, 0.0], [0.12, 0.06, 0.1], [0.20, 0.20, -0.1], [0.20, 0.22, -0.12]]), 0.2
)
DIRECTIONS, SLENDERNESS = 24, (0.1, 0.2, 0.5, 1.0)  # directions and tan(alpha) of the static loads
# effect of random errors of velocities on the mean of a force over 65 steps: root of the sum of squares of
# the differences of the weights of its Hann window, pi/(2 33^1.5)
_MEAN = 1.0 / 120.0
_ASIDE = 0.04  # [-] offset of the sweep from symmetries of a collision detector, in its steps


def stands(subject: Subject, support: str) -> Iterator[Result]:
    """Below |a| = (g + az) tan(alpha), equation (25), the cylinder stands."""
    level = 0.99 * THRESHOLD * np.array([0.6, 0.8])
    trace = subject.simulate(Case(PIER, GroundMotion(np.outer([0.0, 1.0, 0.0], level), 0.5)), support)
    bound = subject.tolerance_bound(1.0, "it stands")
    yield at_most("tilt below the threshold of uplift", largest(trace.tilt) / PIER.alpha, bound)


def uplift(subject: Subject, support: str) -> Iterator[Result]:
    """Time and direction of uplift: the root of (25) inside a sample, against the acceleration there (26).

    At a first sample above the threshold it is at once.
    """
    time, a, _ = crossing(LIFTING)
    push = np.array([0.9, 1.2]) * THRESHOLD
    for words, motion, begin, load in (
        ("inside a sample", LIFTING, time, a),
        ("at the first sample", steady(push, 0.3), 0.0, push),
    ):
        trace = subject.simulate(Case(PIER, motion), support, sample_step=0.05)
        bound = subject.tolerance_bound(50.0, "closed form, to some steps", "s, rad")
        yield at_most(f"time of uplift {words}", abs(trace.uplift_time - begin), bound)
        away = math.remainder(trace.uplift_direction - math.atan2(-load[1], -load[0]), 2.0 * math.pi)
        yield at_most(f"direction of uplift {words}", abs(away), bound)


def force_at_rest(subject: Subject, support: str) -> Iterator[Result]:
    """Contact force of a cylinder that stands: Newton's law with the acceleration of the ground."""
    ground = np.array([0.5, 0.2, -0.3 * GRAVITY])
    trace = subject.simulate(Case(PIER, steady(ground, 0.4)), support, sample_step=0.1)
    off = trace.contact_force[1:4] - (ground + np.array([0.0, 0.0, GRAVITY])) / GRAVITY
    bound = subject.tolerance_bound(1.0, "Newton's law", "weights")
    if subject.run is not None and math.isfinite(trace.time_step):
        rounding = engine_facts(subject.label).rounding
        # error, in the mean of a sample, of a contact point known to rounding and corrected within a step
        most = rounding * PIER.base_radius * _MEAN / (GRAVITY * trace.time_step**2)
        bound = dataclasses.replace(bound, most=bound.most + most)
    yield at_most("contact force at rest", largest(off), bound)


def falls(subject: Subject, support: str) -> Iterator[Result]:
    """A release beyond the balance overturns, as an outcome."""
    start = InitialState(1.5 * PIER.alpha, rolling_rate=0.1)
    trace = subject.simulate(Case(PIER, initial=start, duration=4.0, friction=5.0), support)
    ends = trace.outcome == "overturned" and trace.tilt[-1] == trace.peak_tilt == OVERTURNED_TILT
    right = ends and bool((np.diff(trace.time) > 0.0).all())
    yield at_most(
        "end of a fall", float(not right), subject.tolerance_bound(0.0, "at pi/2"), note=trace.outcome
    )


def static_loads(subject: Subject, support: str) -> Iterator[Result]:
    """A cylinder stands at 0.98 and uplifts at 1.02 of g tan(alpha), against the load, in any direction."""
    off, wrong = 0.0, list[str]()
    for tan_alpha in SLENDERNESS:
        cylinder = dataclasses.replace(PIER, tan_alpha=tan_alpha)
        for azimuth in 2.0 * math.pi * (np.arange(DIRECTIONS) + _ASIDE) / DIRECTIONS:
            for share in (0.98, 1.02):
                push = share * GRAVITY * tan_alpha * np.array([math.cos(azimuth), math.sin(azimuth)])
                motion = GroundMotion([0.0 * push, *[push] * 6], 0.02)
                trace = subject.simulate(Case(cylinder, motion, friction=2.0), support)
                # after 0.1 s of a load 2 % over the threshold the tilt is 1.2e-4 alpha
                lifted = trace.tilt[-1] > 1e-4 * cylinder.alpha and math.isfinite(trace.uplift_time)
                if lifted != (share > 1.0) or (share < 1.0 and math.isfinite(trace.uplift_time)):
                    wrong.append(f"{share:g} g tan(alpha) = {tan_alpha:g}, {math.degrees(azimuth):.1f} deg")
                elif lifted:
                    angles = trace.uplift_direction, trace.rolling_angle[-1]
                    off = max(off, *(abs(math.remainder(a - azimuth - math.pi, math.tau)) for a in angles))
    bound = dataclasses.replace(subject.tolerance_bound(0.0, "equation (25)"), unit="loads")
    yield at_most("static loads that do not lift it, or do", len(wrong), bound, note="; ".join(wrong[:3]))
    yield at_most(
        "direction of its lean", off, subject.tolerance_bound(2e3, "1 deg, however it stands", "rad")
    )


def crossing(motion: GroundMotion) -> tuple[float, Array, Array]:
    """First time at which |a| reaches (g + az) tan(alpha) [s], a there and its slope: root of a quadratic."""
    steep = PIER.tan_alpha**2 * np.array([0.0, 0.0, 1.0]) - np.array([1.0, 1.0, 0.0])
    samples, step = motion.acceleration, motion.time_step
    for index in range(len(samples) - 1):
        a, slope = samples[index], (samples[index + 1] - samples[index]) / step
        total = a + np.array([0.0, 0.0, GRAVITY])
        roots = np.roots([steep @ slope**2, 2.0 * steep @ (total * slope), steep @ total**2])
        inside = [float(r.real) for r in roots if abs(r.imag) == 0.0 and 0.0 <= r.real < step]
        if inside:
            return index * step + min(inside), a + slope * min(inside), slope
    raise AssertionError("the record of this check uplifts the cylinder")


_SAMPLE = 0.002  # [s] 1/400 of 1/p, and 1/20 of the shortest pass
_SHAKEN = Case(PIER, polyline(SHOCK_TIMES, SHOCK, 0.5), duration=8.0)


def place(subject: Subject, support: str) -> Iterator[Result]:
    """No twist and no roll-out in a recess: psi = -phi (14), and the contact stays on its circle.

    The base centre is off its place by b (1 - cos theta), (10), and the mass centre h further along the axis.
    """
    trace = subject.simulate(RELEASE, support)
    b, h = PIER.base_radius, PIER.mass_centre_height
    yield at_most(
        "twist phi + psi", largest(trace.twist), subject.tolerance_bound(10.0, "none in a recess", "rad")
    )
    moving = np.isfinite(trace.rolling_angle) & (trace.tilt > 0.0)
    off = np.hypot(*trace.contact_point[moving].T) / b - 1.0
    bound = subject.tolerance_bound(10.0, "it stays in its place", "b")
    yield at_most("contact point on the original circle", largest(off), bound)
    s, c = np.sin(trace.tilt)[:, None], np.cos(trace.tilt)
    ahead = np.column_stack([np.cos(trace.rolling_angle), np.sin(trace.rolling_angle)])
    base = np.hypot(*(trace.centre_of_mass[:, :2] - h * s * ahead).T)
    yield at_most("base centre in its place", largest(base - b * (1.0 - c)) / b, bound)


def slip(subject: Subject, support: str) -> Iterator[Result]:
    """The rim rolls without slip, in a recess and on flat ground; in an engine it creeps."""
    trace = subject.simulate(RELEASE, support)
    bound = subject.tolerance_bound(100.0, "creep of a rim that rolls for 3 s", "b")
    yield at_most("slip", largest(trace.slip) / PIER.base_radius, bound)


def turning(subject: Subject, support: str) -> Iterator[Result]:
    """Turning points, passes and peak equal those of the sampled tilt: vertices of polynomials through it."""
    case = RELEASE if "stepper" in subject.features else _SHAKEN
    trace = subject.simulate(case, support, sample_step=_SAMPLE, rest_tilt=0.0)
    moving = np.flatnonzero(np.isfinite(trace.rolling_angle))
    turns = turning_points(*(values[moving] for values in (trace.time, trace.tilt, trace.rolling_angle)))
    rows, bound = trace.extrema, subject.tolerance_bound(100.0, "vertex of samples 0.002 s apart", "s, rad")
    if case.initial is not None and len(rows) == len(turns) + 1:
        rows = rows[1:]  # a release from rest begins with a turning point
    yield at_most("turning points", _difference(rows, turns), bound)
    tops = [*turns[turns[:, 3] > 0.0, 1], trace.tilt[0], trace.tilt[-1]]
    peak = subject.tolerance_bound(1.0, "the highest turning point of the samples", "rad")
    yield at_most("peak of the continuous motion", abs(trace.peak_tilt - max(tops)), peak)
    starts = np.vstack([[trace.time[0], trace.tilt[0], trace.rolling_angle[0], 1.0], turns])
    listed = starts if case.initial is not None else turns
    passes = [
        [low[0], low[1], after[2] - before[2]]
        for before, low, after in zip(listed, listed[1:], listed[2:], strict=False)
        if low[3] < 0.0
    ]
    stated = trace.passes[["time", "minimum_tilt", "angle_of_turn"]].to_numpy(dtype=float)
    yield at_most(
        "passes", _difference(stated, np.array(passes).reshape(-1, 3)), bound, note=f"{len(passes)}"
    )


def _difference(stated: Array, sampled: Array) -> float:
    return largest(stated - sampled) if len(sampled) and stated.shape == sampled.shape else np.nan
