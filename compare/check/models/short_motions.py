"""Short motions that together show every term of the equations: many tilts, spins and accelerations.

Each is a run of a few samples of a made-up record, far from upright, whose accelerations change from
sample to sample. Positions alone are taken from it: rates and accelerations follow by differences, so
that nothing a model says of itself is believed.
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np

from rockwobble.models import Case, Cylinder, GroundMotion, InitialState

from .. import differences
from ..bench import Array, Bench, why
from ..problems import GRAVITY
from .lagrange import Shape, shape_of

# a slender pier, a drum as wide as high, and a squat body with mass and inertias of its own
CYLINDERS = {
    "R = 6 m, tan alpha = 0.2": Cylinder(semidiagonal=6.0, tan_alpha=0.2),
    "R = 2.5 m, tan alpha = 1": Cylinder(semidiagonal=2.5, tan_alpha=1.0),
    "own inertias, tan alpha = 0.5": Cylinder(
        semidiagonal=4.0, tan_alpha=0.5, height=5.0, transverse_inertia=3.1, axial_inertia=2.3
    ),
}
# in 1/p: the fastest of these motions changes in about 1/(3 p), and 0.06^12 is below rounding
_SAMPLE = 0.02
_PIECE = 16  # samples of the run in one of the record
_PIECES = 3
_RUNS = 9
_SEED = 18  # of the states: any other serves


class FailedMotionError(RuntimeError):
    """The model gave up a motion that any model of a cylinder must be able to follow."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Sampled:
    """States of computed motions, n in all: angles (n,), and vectors (n, 3)."""

    shape: Shape
    p: float  # [1/s] frequency parameter of the cylinder, the scale of rates
    theta: Array  # [rad]
    phi: Array
    theta_rate: Array  # derivatives, by differences of the angles
    phi_rate: Array
    theta_curve: Array
    phi_curve: Array
    ground: Array  # its acceleration [m/s^2]
    stated_rate: Array  # theta' as the trace states it [rad/s]
    stated_force: Array  # and the contact force [weights]
    stated_moment: Array  # and kappa of the restraining moment, over the weight [m]
    centre_curve: Array  # acceleration of the mass centre relative to O, by differences [m/s^2]


def sample(bench: Bench, cylinder: Cylinder) -> Sampled:
    """Run the recess model from many states, and return what its motions were."""
    shape = shape_of(cylinder)
    p = math.sqrt(GRAVITY * cylinder.semidiagonal / (shape.I1 + shape.h**2 + shape.b**2))
    step = _SAMPLE / p
    reach = differences.REACH
    rows: dict[str, list[Array]] = {}
    for initial, motion in _starts(p, step):
        case = Case(cylinder, motion, initial=initial)
        found = bench.solve(case, sample_step=step, rtol=1e-13, rest_tilt=0.0)
        if found.outcome == "failed":
            raise FailedMotionError(why(found))
        # one that fell down ends between two samples, and may go on falling when the motion is over
        even = len(found.time) - (found.outcome == "overturned")
        for piece in range(min((even - 1) // _PIECE, _PIECES)):
            cut = slice(piece * _PIECE, (piece + 1) * _PIECE + 1)
            theta, phi = found.tilt[cut], found.rolling_angle[cut]
            share = np.arange(_PIECE + 1)[:, None] / _PIECE
            before, after = motion.acceleration[piece], motion.acceleration[piece + 1]
            states = {
                "theta": theta[reach:-reach],
                "phi": phi[reach:-reach],
                "theta_rate": differences.first(theta, step),
                "phi_rate": differences.first(phi, step),
                "theta_curve": differences.second(theta, step),
                "phi_curve": differences.second(phi, step),
                "ground": ((1.0 - share) * before + share * after)[reach:-reach],
                "stated_rate": found.tilt_rate[cut][reach:-reach],
                "stated_force": found.contact_force[cut][reach:-reach],
                "stated_moment": found.restraining_moment[cut][reach:-reach],
                "centre_curve": differences.second(found.centre_of_mass[cut], step),
            }
            for name, values in states.items():
                rows.setdefault(name, []).append(values)
    return Sampled(shape=shape, p=p, **{name: np.concatenate(parts) for name, parts in rows.items()})


def _starts(p: float, step: float) -> Iterator[tuple[InitialState, GroundMotion]]:
    random = np.random.default_rng(_SEED)
    for _ in range(_RUNS):
        initial = InitialState(
            tilt=random.uniform(0.15, 1.1),
            tilt_rate=random.uniform(-0.3, 0.3) * p,
            rolling_angle=random.uniform(-math.pi, math.pi),
            rolling_rate=random.choice([-1.0, 1.0]) * random.uniform(0.8, 2.5) * p,
        )
        acceleration = GRAVITY * random.uniform(-0.4, 0.4, (_PIECES + 1, 3))
        yield initial, GroundMotion(acceleration, _PIECE * step)
