"""How motion begins and ends: standing, uplift, landings, falls, and forces at rest."""

from __future__ import annotations

import dataclasses
import math
from collections.abc import Iterator

import numpy as np

from rockwobble.models import Case, GroundMotion, InitialState

from . import lagrange
from .exact import tilt_inertia
from .lagrange import shape_of
from .motion import Array, largest
from .result import Result, at_most
from .scenes import GRAVITY, PIER, THRESHOLD, released, steady
from .subject import Subject

# two straight pieces; in the second the threshold is crossed inside a sample, as the load turns and the
# weight falls
LIFTING = GroundMotion(
    GRAVITY * np.array([[0.0, 0.0, 0.0], [0.12, 0.06, 0.1], [0.20, 0.20, -0.1], [0.20, 0.22, -0.12]]), 0.2
)
# ratio of the rates in a landing, and acceleration of the ground over that of gravity
GROUNDS = {
    "still ground": (0.9, (0.0, 0.0, 0.0)),
    "horizontal acceleration and more weight": (0.9, (0.02, 0.0, 0.25)),
    "less weight, no loss": (1.0, (0.01, 0.0, -0.25)),
}
DIRECTIONS, SLENDERNESS = 24, (0.1, 0.2, 0.5, 1.0)  # of the sweep of static loads
_MEAN = 1.0 / 120.0  # of differences of velocities over 60 steps, each off at random: what the weights leave
_ASIDE = 0.04  # [-] no symmetry of a collision detector, in steps of the sweep


def stands(subject: Subject, support: str) -> Iterator[Result]:
    """Below |a| = (g + az) tan(alpha), equation (25), the cylinder stands."""
    level = 0.99 * THRESHOLD * np.array([0.6, 0.8])
    found = subject.simulate(Case(PIER, GroundMotion(np.outer([0.0, 1.0, 0.0], level), 0.5)), support)
    bound = subject.within(1.0, "it stands")
    yield at_most("tilt below the threshold of uplift", largest(found.tilt) / PIER.alpha, bound)


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
        found = subject.simulate(Case(PIER, motion), support, sample_step=0.05)
        bound = subject.within(50.0, "closed form, to some steps", "s, rad")
        yield at_most(f"time of uplift {words}", abs(found.uplift_time - begin), bound)
        away = math.remainder(found.uplift_direction - math.atan2(-load[1], -load[0]), 2.0 * math.pi)
        yield at_most(f"direction of uplift {words}", abs(away), bound)


def after_uplift(subject: Subject, support: str) -> Iterator[Result]:
    """Tilt just after an uplift on a ramp: K t^3/6 + K2 t^4/24, the series of the solution at tilt zero.

    K = (h/A) (d|a|/dt - tan(alpha) daz/dt), K2 = (h/A) |a| W^2 with W the turning rate of the direction.
    """
    time, a, slope = crossing(LIFTING)
    shape, size = shape_of(PIER), math.hypot(a[0], a[1])
    growth = float(a[:2] @ slope[:2]) / size - PIER.tan_alpha * slope[2]
    turning = float(a[0] * slope[1] - a[1] * slope[0]) / size**2
    at = 2e-3 / math.sqrt(GRAVITY * PIER.semidiagonal / tilt_inertia(shape))
    found = subject.simulate(Case(PIER, LIFTING, duration=time + at), support, sample_step=1.0, rtol=1e-12)
    expected = growth * at**3 / 6.0 + size * turning**2 * at**4 / 24.0
    off = found.tilt[-1] / (shape.h / tilt_inertia(shape) * expected) - 1.0
    yield at_most("tilt just after the uplift", abs(off), subject.within(2e5, "without its third term"))


def force_at_rest(subject: Subject, support: str) -> Iterator[Result]:
    """Contact force of a cylinder that stands: Newton's law with the acceleration of the ground."""
    ground = np.array([0.5, 0.2, -0.3 * GRAVITY])
    found = subject.simulate(Case(PIER, steady(ground, 0.4)), support, sample_step=0.1)
    off = found.contact_force[1:4] - (ground + np.array([0.0, 0.0, GRAVITY])) / GRAVITY
    bound = subject.within(1.0, "Newton's law", "weights")
    if math.isfinite(found.time_step):
        # of a contact point that is known to rounding and put right in a step, in the mean of a sample
        most = subject.rounding * PIER.base_radius * _MEAN / (GRAVITY * found.time_step**2)
        bound = dataclasses.replace(bound, most=bound.most + most)
    yield at_most("contact force at rest", largest(off), bound, "contact force")


def falls(subject: Subject, support: str) -> Iterator[Result]:
    """A release beyond the balance ends with the side on the ground, as an outcome."""
    start = InitialState(1.5 * PIER.alpha, rolling_rate=0.1)
    found = subject.simulate(Case(PIER, initial=start, duration=4.0, friction=5.0), support)
    ends = found.outcome == "overturned" and found.tilt[-1] == found.peak_tilt == 0.5 * math.pi
    right = ends and bool((np.diff(found.time) > 0.0).all())
    yield at_most(
        "end of a fall", float(not right), subject.within(0.0, "at pi/2", ""), "", f"{found.outcome}"
    )


def landing(subject: Subject, support: str) -> Iterator[Result]:
    """Energy after a planar landing is r^2 of that before it, and constant in between.

    On ground that accelerates evenly the energy holds its inertia force; upright, all of it is kinetic.
    """
    shape = shape_of(PIER)
    for words, (ratio, share) in GROUNDS.items():
        ground = tuple(GRAVITY * each for each in share)
        case = dataclasses.replace(released(0.25, 0.0, 5.0), motion=steady(ground, 10.0))
        case = dataclasses.replace(case, initial=InitialState(0.25 * PIER.alpha))
        found = subject.simulate(case, support, sample_step=0.05, rest_tilt=0.0, restitution=ratio)
        force = np.tile(np.array(ground), (len(found.time), 1))
        energy = 0.5 * tilt_inertia(shape) * found.tilt_rate**2
        energy += lagrange.potential(shape, found.tilt, found.rolling_angle, force)
        landed = found.extrema[(found.extrema[:, 3] < 0.0) & (found.extrema[:, 1] == 0.0), 0]
        kept = ratio ** (2.0 * np.searchsorted(landed, found.time, side="right"))
        off = largest(energy / (energy[0] * kept) - 1.0) if len(landed) > 1 else math.nan
        bound = subject.within(1.0, "r^2 of what it was")
        yield at_most(f"energy after each landing, {words}", off, bound, note=f"{len(landed)} landings")


def static_loads(subject: Subject, support: str) -> Iterator[Result]:
    """A cylinder stands at 0.98 and uplifts at 1.02 of g tan(alpha), against the load, in any direction."""
    off, wrong = 0.0, list[str]()
    for tan_alpha in SLENDERNESS:
        cylinder = dataclasses.replace(PIER, tan_alpha=tan_alpha)
        for azimuth in 2.0 * math.pi * (np.arange(DIRECTIONS) + _ASIDE) / DIRECTIONS:
            for share in (0.98, 1.02):
                push = share * GRAVITY * tan_alpha * np.array([math.cos(azimuth), math.sin(azimuth)])
                motion = GroundMotion([0.0 * push, *[push] * 6], 0.02)
                found = subject.simulate(Case(cylinder, motion, friction=2.0), support)
                # after 0.1 s of a load 2 % over the threshold it is 1.2e-4 alpha
                lifted = found.tilt[-1] > 1e-4 * cylinder.alpha and math.isfinite(found.uplift_time)
                if lifted != (share > 1.0) or (share < 1.0 and math.isfinite(found.uplift_time)):
                    wrong.append(f"{share:g} g tan(alpha) = {tan_alpha:g}, {math.degrees(azimuth):.1f} deg")
                elif lifted:
                    angles = found.uplift_direction, found.rolling_angle[-1]
                    off = max(off, *(abs(math.remainder(a - azimuth - math.pi, math.tau)) for a in angles))
    bound = dataclasses.replace(subject.within(0.0, "equation (25)"), unit="loads")
    yield at_most("static loads that do not lift it, or do", len(wrong), bound, note="; ".join(wrong[:3]))
    yield at_most("direction of its lean", off, subject.within(2e3, "1 deg, however it stands", "rad"))


def crossing(motion: GroundMotion) -> tuple[float, Array, Array]:
    """Return when |a| first reaches (g + az) tan(alpha) [s], a there and its slope: root of a quadratic."""
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
