"""Lagrange's equations from the energies alone, their residual, and conserved quantities of a motion.

Nothing here is shared with `rockwobble.reduced`, and no equation of motion is written down. The
positions (8), (10) and the rotation (5), (6) with psi = -phi give the velocities; those give the
kinetic energy (13)-(15) and the potential energy (17) with the ground's acceleration in it. The
derivatives of the energies by tilt, rolling angle and their rates are complex steps, exact to rounding
(W. Squire and G. Trapp, SIAM Review 40 (1998) 110-112); those by time are taken along the motion.

A column of a frame has its share of the slab in both energies, which goes twice as far as its mass centre. A
tendon is stretched by the way of the base centre from O, and under a slab by as much once more.

====== ======== =============================================================== ========
symbol unit     meaning                                                         source
====== ======== =============================================================== ========
b, h   m        base radius, height of the mass centre                          Fig. 1
I1, I2 m^2      transverse and axial inertia about the mass centre              (16)
r      m        mass centre relative to O                                       (8), (10)
slab   -        mass of the slab over that of the columns, 0 without one
T, V   m^2/s^2  kinetic and potential energy per unit mass; in a frame per unit (13)-(17)
                of the mass on which gravity works at r, 1 + 2 slab columns
====== ======== =============================================================== ========

Of a computed motion nothing that a model says of itself is used but positions at samples: rates and
accelerations follow by differences, and go into the equations. The motions are short and together show every
term: many tilts and spins, and accelerations of the ground that change from sample to sample.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass, replace
from math import factorial
from typing import Any

import numpy as np
from numpy.typing import NDArray
from scipy.integrate import cumulative_simpson

from rockwobble.models import (
    Case,
    Cylinder,
    GroundMotion,
    InitialState,
    Tendon,
    WobblingFrame,
    el_centro_1940,
)
from rockwobble.models.cylinder import PIER, RockingBody
from rockwobble.models.support import SUPPORTS

from ..metrics.pair import energy_loss
from .measurement import GRAVITY, RELEASE, Result, at_most, largest, release_case, why, worst_of
from .subject import Subject

Array = NDArray[Any]  # float, or complex within a complex step

REACH = 6  # samples on either side of a difference: order 12, with an error of (step/time scale)^12
_STEP = 1e-100  # complex step: no difference of close numbers, so a step this small has no rounding
_ALONG = 1e-2  # [s] of the steps along a motion, over which only sines and cosines change


@dataclass(frozen=True, slots=True, kw_only=True)
class Shape:
    """Lengths and inertias of a cylinder or frame; symbols in the module docstring."""

    b: float
    h: float
    I1: float
    I2: float
    slab: float
    prestress: float = 0.0  # tendon force at rest, over the mass of one column [m/s^2]
    stiffness: float = 0.0  # [1/s^2]


def shape_of(cylinder: RockingBody, tendon: Tendon | None = None) -> Shape:
    """Constants of a cylinder, homogeneous unless inertias are given: (16)."""
    b, h = cylinder.base_radius, cylinder.mass_centre_height
    I1, I2 = cylinder.transverse_inertia, cylinder.axial_inertia
    height = 2.0 * cylinder.half_height
    return Shape(
        b=b,
        h=h,
        I1=b * b / 4.0 + height * height / 12.0 if I1 is None else I1,
        I2=b * b / 2.0 if I2 is None else I2,
        slab=cylinder.slab_mass_ratio,
        prestress=0.0 if tendon is None else tendon.prestress * GRAVITY,
        stiffness=0.0 if tendon is None else tendon.stiffness * GRAVITY / b,
    )


def kinetic(shape: Shape, theta: Array, phi: Array, theta_rate: Array, phi_rate: Array) -> Array:
    """Return T per unit mass [m^2/s^2] of n states, (n,) each; equations (13)-(15)."""
    s, c, sp, cp = np.sin(theta), np.cos(theta), np.sin(phi), np.cos(phi)
    one, none = np.ones_like(s), np.zeros_like(s)
    turn = _matrix([[cp, -sp, none], [sp, cp, none], [none, none, one]])  # about z by phi
    tilt = _matrix([[c, none, s], [none, one, none], [-s, none, c]])  # about y by theta
    rotation = turn @ tilt @ np.swapaxes(turn, -1, -2)  # psi = -phi
    about_z = np.array([[0.0, -1.0, 0.0], [1.0, 0.0, 0.0], [0.0, 0.0, 0.0]])
    about_y = np.array([[0.0, 0.0, 1.0], [0.0, 0.0, 0.0], [-1.0, 0.0, 0.0]])
    rate, spin = theta_rate[..., None, None], phi_rate[..., None, None]
    rotation_rate = (
        spin * (about_z @ rotation)
        + rate * (turn @ tilt @ about_y @ np.swapaxes(turn, -1, -2))
        - spin * (rotation @ about_z)
    )
    skew = np.swapaxes(rotation, -1, -2) @ rotation_rate  # angular velocity in body axes
    spin_x, spin_y, spin_z = skew[..., 2, 1], skew[..., 0, 2], skew[..., 1, 0]
    base_rate = shape.b * np.stack(
        [
            theta_rate * s * cp - phi_rate * (1.0 - c) * sp,
            theta_rate * s * sp + phi_rate * (1.0 - c) * cp,
            theta_rate * c,
        ],
        axis=-1,
    )
    velocity = base_rate + shape.h * rotation_rate[..., :, 2]
    of_slab = 2.0 * velocity
    twice: Array = (
        (velocity * velocity + shape.slab * of_slab * of_slab).sum(axis=-1)
        + shape.I1 * (spin_x * spin_x + spin_y * spin_y)
        + shape.I2 * spin_z * spin_z
    )
    return 0.5 / (1.0 + 2.0 * shape.slab) * twice


def mass_centre(shape: Shape, theta: Array, phi: Array) -> Array:
    """Return the mass centre relative to O (n, 3) [m]; equations (8), (10)."""
    s, c = np.sin(theta), np.cos(theta)
    out = shape.b * (1.0 - c) + shape.h * s
    return np.stack([out * np.cos(phi), out * np.sin(phi), shape.b * s + shape.h * c], axis=-1)


def potential(shape: Shape, theta: Array, phi: Array, ground: Array) -> Array:
    """Return V per unit mass, zero standing, with the inertia of the ground's acceleration (n, 3)."""
    pull = ground + np.array([0.0, 0.0, GRAVITY])
    standing = np.array([0.0, 0.0, shape.h])
    energies: Array = ((mass_centre(shape, theta, phi) - standing) * pull).sum(axis=-1)
    if shape.prestress or shape.stiffness:
        away = base_centre(shape, theta, phi)
        stretch = gaps(shape) * np.sqrt((away * away).sum(axis=-1))
        stored = shape.prestress * stretch + 0.5 * shape.stiffness * stretch * stretch
        energies = energies + stored / (1.0 + 2.0 * shape.slab)
    return energies


def base_centre(shape: Shape, theta: Array, phi: Array) -> Array:
    """Return the centre of the base relative to O (n, 3) [m]; equation (10)."""
    s, c = np.sin(theta), np.cos(theta)
    return shape.b * np.stack([(1.0 - c) * np.cos(phi), (1.0 - c) * np.sin(phi), s], axis=-1)


def gaps(shape: Shape) -> int:
    """Number of gaps that a tendon crosses: one at the base, one more under a slab."""
    return 2 if shape.slab > 0.0 else 1


def energy(shape: Shape, theta: Array, phi: Array, theta_rate: Array, phi_rate: Array) -> Array:
    """Return T + V over still ground (n,) [m^2/s^2]."""
    still = np.zeros((*np.shape(theta), 3))
    total = kinetic(shape, theta, phi, theta_rate, phi_rate) + potential(shape, theta, phi, still)
    return np.asarray(total, dtype=float)


def momenta(
    shape: Shape, theta: Array, phi: Array, theta_rate: Array, phi_rate: Array
) -> tuple[Array, Array]:
    """Return dT/dtheta' and dT/dphi' (n,) [m^2/s]; the second is L of (19)."""
    step = 1j * _STEP
    by_tilt = kinetic(shape, theta + 0j, phi + 0j, theta_rate + step, phi_rate + 0j).imag / _STEP
    by_turn = kinetic(shape, theta + 0j, phi + 0j, theta_rate + 0j, phi_rate + step).imag / _STEP
    return by_tilt, by_turn


def forces(
    shape: Shape, theta: Array, phi: Array, theta_rate: Array, phi_rate: Array, ground: Array
) -> tuple[Array, Array]:
    """Return d(T - V)/dtheta and d(T - V)/dphi (n,) [m^2/s^2]."""

    def by(tilt_step: complex, turn_step: complex) -> Array:
        tilt, turn = theta + tilt_step, phi + turn_step
        rates = (theta_rate + 0j, phi_rate + 0j)
        found = kinetic(shape, tilt, turn, *rates) - potential(shape, tilt, turn, ground)
        return np.asarray(found.imag / _STEP)

    return by(1j * _STEP, 0j), by(0j, 1j * _STEP)


def residuals(
    shape: Shape,
    place: tuple[Array, Array],
    rates: tuple[Array, Array],
    curves: tuple[Array, Array],
    ground: Array,
) -> tuple[Array, Array]:
    """Return the residuals of Lagrange's equations (12) for tilt and rolling angle (n,) [m^2/s^2].

    `place`, `rates` and `curves` are tilt and rolling angle (n,), their rates and their second derivatives;
    `ground` (n, 3) is the acceleration of the ground.
    """
    # momenta along the parabola with this position, these rates and these second derivatives
    time = (np.arange(2 * REACH + 1) - REACH)[:, None] * _ALONG
    tilt, turn = (x + v * time + 0.5 * w * time**2 for x, v, w in zip(place, rates, curves, strict=True))
    tilt_rate, turn_rate = (v + w * time for v, w in zip(rates, curves, strict=True))
    inertial = momenta(shape, tilt, turn, tilt_rate, turn_rate)
    needed = forces(shape, *place, *rates, ground)
    by_tilt, by_turn = (
        rate(momentum, _ALONG)[0] - force for momentum, force in zip(inertial, needed, strict=True)
    )
    return by_tilt, by_turn


def rate(values: Array, step: float) -> Array:
    """Return the rate (n - 2 REACH, ...) of samples (n, ...) that are `step` [s] apart."""
    weights = [_weight(k) / k for k in range(1, REACH + 1)]
    pairs = (weight * (_shift(values, k) - _shift(values, -k)) for k, weight in enumerate(weights, 1))
    return np.asarray(sum(pairs) / step)


def curve(values: Array, step: float) -> Array:
    """Return the second derivative (n - 2 REACH, ...) of samples (n, ...)."""
    centre = _shift(values, 0)
    pairs = (
        2.0 * _weight(k) / k**2 * ((_shift(values, k) - centre) + (_shift(values, -k) - centre))
        for k in range(1, REACH + 1)
    )
    return np.asarray(sum(pairs) / step**2)


def _weight(k: int) -> float:
    return float((-1) ** (k + 1) * factorial(REACH) ** 2 / (factorial(REACH - k) * factorial(REACH + k)))


def _shift(values: Array, by: int) -> Array:
    return values[REACH + by : len(values) - REACH + by]


def slope(function: Callable[[Array], Array], at: float) -> float:
    """Derivative of a function of one angle, by a complex step."""
    return float(function(np.array([at + 1j * _STEP])).imag[0] / _STEP)


def _matrix(rows: list[list[Array]]) -> Array:
    return np.stack([np.stack(row, axis=-1) for row in rows], axis=-2)


# a slender pier, a drum as wide as high, a squat body with given mass centre and inertias, and a frame
CYLINDERS = {
    "R = 6 m, tan alpha = 0.2": PIER,
    "R = 2.5 m, tan alpha = 1": Cylinder(semidiagonal=2.5, tan_alpha=1.0),
    "own inertias, tan alpha = 0.5": Cylinder(
        semidiagonal=4.0, tan_alpha=0.5, height=5.0, transverse_inertia=3.1, axial_inertia=2.3
    ),
    "frame, tan alpha = 0.3": WobblingFrame(Cylinder(semidiagonal=3.0, tan_alpha=0.3), 1.5),
}
TENDON = Tendon(prestress=0.4, stiffness=2.0)
# terms of a case, each small enough that the motion is no faster than without, see _SAMPLE
_TERMS: Mapping[str, Mapping[str, Any]] = {
    "": {},
    ", with a tendon": {"tendon": Tendon(prestress=0.1, stiffness=0.5)},
}
# step in units of 1/p: the fastest of these motions changes in about 1/(3 p), and 0.06^12 is below rounding
_SAMPLE = 0.02
_PIECE = 16  # samples of the run per sample of the record
_PIECES = 3
RUNS = 9
_SEED = 18  # seed of the random states (arbitrary)
# 1e-16/0.02^2 of the angles, 1e-11 of p^2 at most, and the error of rtol 1e-13 over a dozen steps
_REASON = "differences of positions that are known to rounding"
NAMES = (
    "equation of motion of the tilt",
    "equation of motion of the rolling angle",
    "tilt rate against the change of tilt",
    "contact force against Newton's law",
    "contact force on a slab against Newton's law",
)


def residual(subject: Subject, support: str) -> Iterator[Result]:
    """Residuals of Lagrange's equations, of the tilt rate and of Newton's law, each over all cylinders.

    d/dt dT/dq' = d(T - V)/dq for the tilt, in g (b + h), and for the rolling angle; theta' in p; the contact
    forces over the weight are the acceleration of mass centre or slab and that of ground and gravity. Then
    the same with each term that the subject knows: with a tendon its energy by places, and in the force its
    pull from the base centre towards O.
    """
    bound = subject.tolerance_bound(1.0, _REASON, "of g (b + h), p and weights")
    for words, terms in _TERMS.items():
        if not subject.features.issuperset(terms):
            continue
        errors = {place: _residuals(subject, support, body, terms) for place, body in CYLINDERS.items()}
        for at, name in enumerate(NAMES):
            worst = {place: each[at] for place, each in errors.items()}
            yield worst_of(f"{name}{words}", worst, bound)


def _residuals(
    subject: Subject, support: str, cylinder: RockingBody, terms: Mapping[str, Any]
) -> list[float]:
    shape = shape_of(cylinder, **terms)
    p = math.sqrt(GRAVITY * cylinder.semidiagonal / (shape.I1 + shape.h**2 + shape.b**2))
    step, inner = _SAMPLE / p, slice(REACH, -REACH)
    errors = []
    for initial, motion in _starts(p, step):
        trace = subject.simulate(
            Case(cylinder, motion, initial=initial, **terms),
            support,
            sample_step=step,
            rtol=1e-13,
            rest_tilt=0.0,
        )
        if trace.outcome == "failed":
            raise RuntimeError(f"a short motion failed: {why(trace)}")
        # a fall ends between two samples, and may continue after the end of the case
        even = len(trace.time) - (trace.outcome == "overturned")
        for piece in range(min((even - 1) // _PIECE, _PIECES)):
            cut = slice(piece * _PIECE, (piece + 1) * _PIECE + 1)
            angles = trace.tilt[cut], trace.rolling_angle[cut]
            rates, curves = (
                tuple(derivative(values, step) for values in angles) for derivative in (rate, curve)
            )
            share = np.arange(_PIECE + 1)[:, None] / _PIECE
            before, after = motion.acceleration[piece], motion.acceleration[piece + 1]
            ground: Array = ((1.0 - share) * before + share * after)[inner]
            place = angles[0][inner], angles[1][inner]
            by_tilt, by_turn = residuals(shape, place, (rates[0], rates[1]), (curves[0], curves[1]), ground)
            # a slab moves twice as far, and the base carries both
            carried = (1.0 + 2.0 * shape.slab) / (1.0 + shape.slab)
            force = carried * curve(trace.centre_of_mass[cut], step) + ground + [0.0, 0.0, GRAVITY]
            # force of the column on its share of the slab
            on_slab = 2.0 * curve(trace.centre_of_mass[cut], step) + ground + [0.0, 0.0, GRAVITY]
            if "tendon" in terms:
                away = base_centre(shape, *place)
                opening = np.sqrt((away * away).sum(axis=-1))[:, None]
                pull = shape.prestress + shape.stiffness * gaps(shape) * opening
                force = force + pull * away / opening / (1.0 + shape.slab)
                on_slab = on_slab + pull * away / opening / (shape.slab or math.inf)
            scale = GRAVITY * (shape.b + shape.h)
            errors.append(
                [
                    largest(by_tilt) / scale,
                    largest(by_turn) / scale,
                    largest(rates[0] - trace.tilt_rate[cut][inner]) / p,
                    largest(force / GRAVITY - trace.contact_force[cut][inner]),
                    largest(on_slab / GRAVITY - trace.top_contact_force[cut][inner]) if shape.slab else 0.0,
                ]
            )
    return [largest(each) for each in np.array(errors).T]


def _starts(p: float, step: float) -> Iterator[tuple[InitialState, GroundMotion]]:
    random = np.random.default_rng(_SEED)
    for _ in range(RUNS):
        initial = InitialState(
            tilt=random.uniform(0.15, 1.1),
            tilt_rate=random.uniform(-0.3, 0.3) * p,
            rolling_angle=random.uniform(-math.pi, math.pi),
            rolling_rate=random.choice([-1.0, 1.0]) * random.uniform(0.8, 2.5) * p,
        )
        acceleration = GRAVITY * random.uniform(-0.4, 0.4, (_PIECES + 1, 3))
        yield initial, GroundMotion(acceleration, _PIECE * step)


_SPINS = (1e-2, 1e-5)  # spins with near passes, where a model of fixed steps loses all of its digits
_LEAST_TILT = 1e-3  # [rad] below it rounding of B is as large as L
# ground that accelerates evenly in three directions, with a record that ends in full swing
PUSHED = Case(
    PIER,
    GroundMotion(np.tile(GRAVITY * np.array([-0.05, 0.04, 0.2]), (2, 1)), 0.9),
    initial=InitialState(0.5 * PIER.alpha, rolling_angle=0.3, rolling_rate=0.4),
    duration=1.5,
)
ROLLING = replace(RELEASE, friction=20.0, rolling_resistance=0.01 * PIER.base_radius)
_ROLLING_SAMPLE = 2e-3  # [s] with an error of Simpson's rule below that of the models
EL_CENTRO = Case(PIER, el_centro_1940().scaled(2.0), duration=5.0)


def free_motion(subject: Subject, support: str) -> Iterator[Result]:
    """Energy of a release is constant, and in a recess L = B phi', the momentum of the rolling angle.

    Both from the energies of `lagrange` and the state where it is known; the energy also as it is stated.
    """
    cases = {"": RELEASE}
    if "rtol" in subject.features:
        cases |= {f", spin {spin:g} rad/s": release_case(0.5, spin, 5.0) for spin in _SPINS}
    bound = subject.tolerance_bound(10.0, "no loss; near passes magnify the error of a step")
    for words, case in cases.items():
        trace = subject.simulate(case, support, rest_tilt=0.0)
        yield at_most(f"energy of a release{words}", np.ptp(trace.energy) / trace.energy[0], bound)
        if not (SUPPORTS[support].guided and {"tilt_rate", "rolling_rate"} <= subject.knows):
            continue
        shape = shape_of(PIER)
        state = trace.tilt, trace.rolling_angle, trace.tilt_rate, trace.rolling_rate
        stated = largest(trace.energy - energy(shape, *state)) / trace.energy[0]
        yield at_most(f"stated energy of a release{words}", stated, bound)
        momentum = momenta(shape, *state)[1][trace.tilt > _LEAST_TILT]
        yield at_most(f"L = B phi' of a release{words}", np.ptp(momentum) / abs(momentum[0]), bound)


def rolling_loss(subject: Subject, support: str) -> Iterator[Result]:
    """With rolling resistance a release loses the integral of delta N w, and states this loss.

    w is the horizontal part of the angular velocity, theta' across the lean and phi' sin(theta) along it in
    a recess; N is the contact force of the trace. The friction is plenty: an engine may take from the
    couple what the rim needs for grip.
    """
    trace = subject.simulate(ROLLING, support, sample_step=_ROLLING_SAMPLE)
    w = np.hypot(trace.tilt_rate, np.sin(trace.tilt) * trace.rolling_rate)
    power = ROLLING.rolling_resistance * GRAVITY * trace.contact_force[:, 2] * w
    lost, start = cumulative_simpson(power, x=trace.time, initial=0.0), trace.energy[0]
    bound = subject.tolerance_bound(10.0, "power from samples; near passes magnify the error of a step")
    left = largest(start - trace.energy - lost) / start
    yield at_most("energy of a release against the power of rolling resistance", left, bound)
    stated = largest(trace.energy_lost - lost) / start
    yield at_most("stated energy lost of a release", stated, bound)


def work_of_the_ground(subject: Subject, support: str) -> Iterator[Result]:
    """The energy changes by the work of the ground, and after the end of its record by nothing.

    In the frame of the ground the force per unit mass is -a: where a is constant, its work is that of the
    displacement of the mass centre.
    """
    motion = PUSHED.motion
    assert motion is not None
    trace = subject.simulate(PUSHED, support, sample_step=0.05)
    within = np.arange(round(PUSHED.length / 0.05) + 1)  # without motion after the end
    last = np.minimum(within, round(motion.duration / 0.05))
    work = -(trace.centre_of_mass[last] - trace.centre_of_mass[0]) @ motion.acceleration[0]
    energy = trace.energy[within]
    left = largest(energy - energy[0] - work) / energy.max()
    bound = subject.tolerance_bound(10.0, "work of a constant force, from positions")
    yield at_most("energy against the work of ground that accelerates, and stops", left, bound)


def work_of_a_record(subject: Subject, support: str) -> Iterator[Result]:
    """Under El Centro the energy changes by the work of the ground, sample by sample of the record."""
    trace = subject.simulate(EL_CENTRO, support)
    loss = abs(energy_loss(trace, EL_CENTRO.motion)) if trace.peak_tilt > 0.0 else math.nan
    bound = subject.tolerance_bound(2e5, "work from samples 0.01 s apart, corrected for their slope")
    yield at_most("energy against the work of El Centro doubled", loss, bound)
