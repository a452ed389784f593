"""Exact solutions of free motion, by quadrature of the energies of `lagrange` alone.

Free motion in a recess conserves its energy e and L = B phi', so that

    A theta'^2 = 2 (e - V) - L^2/B,    phi' = L/B,

and the time and the turn from one turning tilt to the other are integrals over the tilt. With
theta = mid - half cos(u) the roots at both ends cancel, and Gauss-Legendre nodes give 12 digits for
spins that are not small.
"""

from __future__ import annotations

import math
from collections.abc import Iterator

import numpy as np

from rockwobble.models import Case, InitialState

from . import lagrange
from .lagrange import Shape, kinetic, potential, shape_of
from .motion import Array, largest
from .result import Result, at_most
from .scenes import FRAME_RELEASE, PIER, RELEASE, SQUAT, released
from .subject import Subject

_NODES = 64  # more of them come nearer to the ends, where rounding of the energies counts
_BISECTIONS = 200
_QUADRATURE = "quadrature of the energies, good to 1e-9"
VANISHING_SPIN = 1e-8  # [rad/s]
_RELEASES = {
    "tan alpha = 0.2": RELEASE,
    "tan alpha = 1": released(0.5, 0.5, RELEASE.length, SQUAT),
    "frame": FRAME_RELEASE,
}


def free_response(subject: Subject, support: str) -> Iterator[Result]:
    """Period, angle of turn and regained tilt of releases in a recess: slender, squat, and of a frame.

    Time and turn between two tilt maxima are those of the quadrature; without loss the tilt comes back.
    """
    for of, case in _RELEASES.items():
        cylinder, start = case.cylinder, case.initial
        assert start is not None
        if cylinder.slab_mass_ratio > 0.0 and not subject.carries_slab:
            continue
        time, turn = period_and_turn(shape_of(cylinder), start.tilt, start.rolling_rate)
        found = subject.simulate(case, support)
        maxima = found.extrema[(found.extrema[:, 3] > 0.0) & (found.extrema[:, 0] > 0.5 * time)]
        first = maxima[0] if len(maxima) else np.full(4, math.nan)
        bound = subject.within(3.0, _QUADRATURE)
        yield at_most(f"period of a release, {of}", abs(first[0] / time - 1.0), bound)
        yield at_most(f"tilt that a release returns to, {of}", abs(first[1] / start.tilt - 1.0), bound)
        if "rolling_angle" in subject.knows:
            off = math.remainder(first[2] - start.rolling_angle - turn, 2.0 * math.pi)
            yield at_most(f"angle of turn of a release, {of}", abs(off) / turn, bound)


def steady_wobble(subject: Subject, support: str) -> Iterator[Result]:
    """At the rate at which (18) balances, phi'^2 = 2 V'/B', the tilt stays, on any support."""
    tilt = 0.3 * PIER.alpha  # with less energy than that of the balance
    case = released(0.3, steady_rate(shape_of(PIER), tilt), 1.0)
    found = subject.simulate(case, support)
    bound = subject.within(10.0, "an error of the balance makes the tilt oscillate by as much")
    yield at_most("tilt of a steady wobble", largest(found.tilt - tilt) / tilt, bound)


def vanishing_spin(subject: Subject, support: str) -> Iterator[Result]:
    """Angle of turn in the limit of vanishing spin: pi sqrt(A/J) (Srinivasan and Ruina)."""
    shape = shape_of(PIER)
    limit = math.pi * math.sqrt(tilt_inertia(shape) / cone_inertia(shape))
    found = subject.simulate(released(0.5, VANISHING_SPIN, 4.0), support, rest_tilt=0.0)
    first = np.asarray(found.passes["angle_of_turn"])[:1]
    bound = subject.within(1e4, "the spin that is left is 1e-8 of p, and the turn off by some 10 times that")
    yield at_most("angle of turn in the limit of vanishing spin", largest(first - limit), bound)


def planar_rocking(subject: Subject, support: str) -> Iterator[Result]:
    """Time from rest to upright in one plane: a quadrature, Housner's quarter period."""
    quarter = planar_quarter(shape_of(PIER), 0.5 * PIER.alpha)
    case = Case(PIER, initial=InitialState(0.5 * PIER.alpha), duration=1.5 * quarter)
    found = subject.simulate(case, support)
    minima = found.extrema[found.extrema[:, 3] < 0.0]
    off = largest(minima[:1, 0] / quarter - 1.0)
    yield at_most("planar rocking, time to upright", off, subject.within(30.0, _QUADRATURE))


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
    # the next term is one of theta^3: extrapolated
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
