"""Residual of a computed motion in the equations of motion, from the energies alone.

Nothing that a model says of itself is used but positions at samples: rates and accelerations follow by
differences, and go into Lagrange's equations (`lagrange`). The motions are short and together show every
term: many tilts and spins, and accelerations of the ground that change from sample to sample.
"""

from __future__ import annotations

import math
from collections.abc import Iterator

import numpy as np

from rockwobble.models import Case, Cylinder, GroundMotion, InitialState, WobblingFrame

from . import lagrange
from .motion import Array, largest
from .result import Result, at_most, worst_of
from .scenes import GRAVITY
from .subject import Subject

# a slender pier, a drum as wide as high, a squat body with mass and inertias of its own, and a frame
CYLINDERS = {
    "R = 6 m, tan alpha = 0.2": Cylinder(semidiagonal=6.0, tan_alpha=0.2),
    "R = 2.5 m, tan alpha = 1": Cylinder(semidiagonal=2.5, tan_alpha=1.0),
    "own inertias, tan alpha = 0.5": Cylinder(
        semidiagonal=4.0, tan_alpha=0.5, height=5.0, transverse_inertia=3.1, axial_inertia=2.3
    ),
    "frame, tan alpha = 0.3": WobblingFrame(Cylinder(semidiagonal=3.0, tan_alpha=0.3), 1.5),
}
# in 1/p: the fastest of these motions changes in about 1/(3 p), and 0.06^12 is below rounding
_SAMPLE = 0.02
_PIECE = 16  # samples of the run in one of the record
_PIECES = 3
RUNS = 9
_SEED = 18  # of the states: any other serves
# 1e-16/0.02^2 of the angles, 1e-11 of p^2 at the worst, and what rtol 1e-13 leaves in a dozen steps
_REASON = "differences of positions that are known to rounding"
NAMES = {
    "equation of motion of the tilt": "equation (18)",
    "equation of motion of the rolling angle": "equation (19)",
    "tilt rate against the change of tilt": "tilt rate",
    "contact force against Newton's law": "contact force (reduced/forces.py)",
}


def residual(subject: Subject, support: str) -> Iterator[Result]:
    """Residuals of Lagrange's equations, of the tilt rate and of Newton's law, each over all cylinders.

    d/dt dT/dq' = d(T - V)/dq for the tilt, in g (b + h), and for the rolling angle; theta' in p; the contact
    force over the weight is the acceleration of the mass centre and that of ground and gravity.
    """
    errors: dict[str, dict[str, float]] = {name: {} for name in NAMES}
    for place, cylinder in CYLINDERS.items():
        found = _residuals(subject, support, cylinder)
        if found is None:
            yield at_most(f"short motions reach their end, {place}", math.nan, subject.within(0.0, "all do"))
            return
        for name, value in zip(NAMES, found, strict=True):
            errors[name][place] = value
    # an equation that is wrong makes every other residual wrong, too: a cause is named where it stands alone
    bound = subject.within(1.0, _REASON, "of g (b + h), p and weights")
    results = [worst_of(name, error, bound) for name, error in errors.items()]
    alone = sum(result.failed for result in results) == 1
    yield from (
        worst_of(result.name, errors[result.name], bound, NAMES[result.name] if alone else "")
        for result in results
    )


def _residuals(subject: Subject, support: str, cylinder: Cylinder) -> list[float] | None:
    shape = lagrange.shape_of(cylinder)
    p = math.sqrt(GRAVITY * cylinder.semidiagonal / (shape.I1 + shape.h**2 + shape.b**2))
    step, inner = _SAMPLE / p, slice(lagrange.REACH, -lagrange.REACH)
    errors: list[list[float]] = [[0.0] for _ in NAMES]
    for initial, motion in _starts(p, step):
        found = subject.simulate(
            Case(cylinder, motion, initial=initial), support, sample_step=step, rtol=1e-13, rest_tilt=0.0
        )
        if found.outcome == "failed":
            return None
        # one that fell down ends between two samples, and may go on falling when the motion is over
        even = len(found.time) - (found.outcome == "overturned")
        for piece in range(min((even - 1) // _PIECE, _PIECES)):
            cut = slice(piece * _PIECE, (piece + 1) * _PIECE + 1)
            angles = found.tilt[cut], found.rolling_angle[cut]
            rates, curves = (
                tuple(derivative(values, step) for values in angles)
                for derivative in (lagrange.rate, lagrange.curve)
            )
            share = np.arange(_PIECE + 1)[:, None] / _PIECE
            before, after = motion.acceleration[piece], motion.acceleration[piece + 1]
            ground: Array = ((1.0 - share) * before + share * after)[inner]
            place = angles[0][inner], angles[1][inner]
            by_tilt, by_turn = lagrange.residuals(
                shape, place, (rates[0], rates[1]), (curves[0], curves[1]), ground
            )
            # a slab goes twice as far, and the base carries both
            carried = (1.0 + 2.0 * shape.slab) / (1.0 + shape.slab)
            force = carried * lagrange.curve(found.centre_of_mass[cut], step) + ground + [0.0, 0.0, GRAVITY]
            scale = GRAVITY * (shape.b + shape.h)
            for each, value in zip(
                errors,
                (
                    largest(by_tilt) / scale,
                    largest(by_turn) / scale,
                    largest(rates[0] - found.tilt_rate[cut][inner]) / p,
                    largest(force / GRAVITY - found.contact_force[cut][inner]),
                ),
                strict=True,
            ):
                each.append(value)
    return [largest(np.array(each)) for each in errors]


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
