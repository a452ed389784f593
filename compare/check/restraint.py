"""Checks of a tendon: energy, couple by exact solutions, uplift, load and balance.

All follow from the energies of `lagrange`, in which the tendon is stretched by places: from O to the centre
of the base, and under a slab by as much once more. In a recess both depend on the tilt alone, so that B, L
and the quadratures of `laws` stay, with another V.
"""

from __future__ import annotations

import dataclasses
from collections.abc import Iterator

import numpy as np

from rockwobble.models import Case, GroundMotion, InitialState
from rockwobble.models.bounds import OVERTURNED_TILT
from rockwobble.models.cylinder import PIER

from .lagrange import TENDON, Shape, energy, potential, shape_of, slope
from .laws import reaches_upright, returns
from .measurement import (
    FRAME_RELEASE,
    RELEASE,
    Bound,
    Result,
    at_most,
    largest,
    steady,
)
from .subject import SLAB, Subject

_HELD = dataclasses.replace(RELEASE, tendon=TENDON)
_HELD_FRAME = dataclasses.replace(FRAME_RELEASE, tendon=TENDON)
_NEAR = 0.005  # relative distance of the releases from the balance, on both sides


def _releases(subject: Subject) -> dict[str, Case]:
    """Releases of a column, and of a frame where the subject supports one."""
    return {"column": _HELD} | ({"frame": _HELD_FRAME} if SLAB in subject.features else {})


def releases(subject: Subject, support: str) -> Iterator[Result]:
    """Period, regained tilt and angle of turn of a release equal the quadrature with its energy."""
    for of, case in _releases(subject).items():
        yield from returns(subject, support, case, f"{of} with a tendon")


def rocking(subject: Subject, support: str) -> Iterator[Result]:
    """Time from rest to upright in one plane with a tendon: a quadrature."""
    yield from reaches_upright(subject, support, TENDON, "planar rocking with a tendon")


def stored_energy(subject: Subject, support: str) -> Iterator[Result]:
    """Energy of a release is constant and includes that of the tendon, P0 e + kt e^2/2."""
    for of, case in _releases(subject).items():
        trace = subject.simulate(case, support)
        bound = subject.tolerance_bound(10.0, "no loss; near passes magnify the error of a step")
        yield at_most(
            f"energy of a release with a tendon, {of}", np.ptp(trace.energy) / trace.energy[0], bound
        )
        if not {"tilt_rate", "rolling_rate"} <= subject.knows:
            continue
        state = trace.tilt, trace.rolling_angle, trace.tilt_rate, trace.rolling_rate
        stated = energy(shape_of(case.cylinder, TENDON), *state)
        off = largest(trace.energy - stated) / trace.energy[0]
        yield at_most(f"stated energy of a release with a tendon, {of}", off, bound)


def load_at_rest(subject: Subject, support: str) -> Iterator[Result]:
    """The contact force of a column at rest is its weight and the prestress.

    Under a slab that is over the weight with the share gamma of the slab, and at the top over that share.
    """
    bound = subject.tolerance_bound(1.0, "Newton's law", "weights")
    for of, release in _releases(subject).items():
        body = release.cylinder
        trace = subject.simulate(Case(body, steady([0.0, 0.0], 0.4), tendon=TENDON), support, sample_step=0.1)
        base = [0.0, 0.0, 1.0 + TENDON.prestress / (1.0 + body.slab_mass_ratio)]
        name = "contact force at rest with a tendon" + ("" if of == "column" else f", {of}")
        yield at_most(name, largest(trace.contact_force[1:4] - base), bound)
        if body.slab_mass_ratio and not np.isnan(trace.top_contact_force).all():
            top = [0.0, 0.0, 1.0 + TENDON.prestress / body.slab_mass_ratio]
            off = largest(trace.top_contact_force[1:4] - top)
            yield at_most("contact force on a slab at rest with a tendon", off, bound)


def raised_uplift(subject: Subject, support: str) -> Iterator[Result]:
    """Uplift at g tan(alpha) (1 + n P0/(w m g)), w = 1 + 2 gamma: the rate of the static couple upright."""
    upright = 1e-9  # [rad]
    for of, case in _releases(subject).items():
        shape = shape_of(case.cylinder, TENDON)
        threshold = _couple(shape, upright) / shape.h
        motion = GroundMotion(np.outer([0.0, 1.5], [threshold, 0.0]), 1.5)
        trace = subject.simulate(Case(case.cylinder, motion, tendon=TENDON), support, sample_step=0.05)
        bound = subject.tolerance_bound(50.0, "closed form, to some steps", "s")
        yield at_most(f"time of uplift with a tendon, {of}", abs(trace.uplift_time - 1.0), bound)


def _couple(shape: Shape, tilt: float) -> float:
    """Return the static couple V' at a tilt [m^2/s^2]."""
    return slope(lambda at: potential(shape, at, 0.0 * at, np.zeros((1, 3))), tilt)


def balance(subject: Subject, support: str) -> Iterator[Result]:
    """A release below the balance tilt returns, one above it falls."""
    shape = shape_of(PIER, TENDON)
    low, high = PIER.alpha, OVERTURNED_TILT
    for _ in range(60):
        middle = 0.5 * (low + high)
        low, high = (middle, high) if _couple(shape, middle) > 0.0 else (low, middle)
    for word, factor, expected in (("within", 1.0 - _NEAR, False), ("beyond", 1.0 + _NEAR, True)):
        start = InitialState(factor * low)
        trace = subject.simulate(Case(PIER, initial=start, duration=10.0, tendon=TENDON), support)
        wrong = float((trace.outcome == "overturned") is not expected)
        bound = Bound(0.0, "where the couple of weight and tendon changes its sign")
        yield at_most(f"end of a release 0.5 % {word} the balance", wrong, bound, note=trace.outcome)
