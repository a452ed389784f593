"""What free motion conserves, and what the work of the ground adds up to."""

from __future__ import annotations

import math
from collections.abc import Iterator

import numpy as np

from rockwobble.models import Case, GroundMotion, InitialState, el_centro_1940

from ..metrics.energy import energy_loss
from . import lagrange
from .motion import largest
from .result import Result, at_most
from .scenes import GRAVITY, PIER, RELEASE, released
from .subject import Subject

_SPINS = (1e-2, 1e-5)  # whose passes are near, and cost a model of fixed steps all of its digits
_LEAST_TILT = 1e-3  # [rad] rounding of B is as large as L below
# where the ground accelerates evenly in three directions, until its record ends in full swing
PUSHED = Case(
    PIER,
    GroundMotion(np.tile(GRAVITY * np.array([-0.05, 0.04, 0.2]), (2, 1)), 0.9),
    initial=InitialState(0.5 * PIER.alpha, rolling_angle=0.3, rolling_rate=0.4),
    duration=1.5,
)
EL_CENTRO = Case(PIER, el_centro_1940().scaled(2.0), duration=5.0)


def free_motion(subject: Subject, support: str) -> Iterator[Result]:
    """Energy of a release is constant, and in a recess L = B phi', the momentum of the rolling angle.

    Both from the energies of `lagrange` and the state where it is known; the energy also as it is stated.
    """
    cases = {"": RELEASE}
    if "rtol" in subject.options:
        cases |= {f", spin {spin:g} rad/s": released(0.5, spin, 5.0) for spin in _SPINS}
    bound = subject.within(10.0, "no loss; near passes magnify the error of a step")
    for words, case in cases.items():
        found = subject.simulate(case, support, rest_tilt=0.0)
        yield at_most(f"energy of a release{words}", np.ptp(found.energy) / found.energy[0], bound)
        if support != "recess" or not {"tilt_rate", "rolling_rate"} <= subject.knows:
            continue
        shape = lagrange.shape_of(PIER)
        state = found.tilt, found.rolling_angle, found.tilt_rate, found.rolling_rate
        stated = largest(found.energy - lagrange.energy(shape, *state)) / found.energy[0]
        yield at_most(f"stated energy of a release{words}", stated, bound, "energy of the trace")
        momentum = lagrange.momenta(shape, *state)[1][found.tilt > _LEAST_TILT]
        yield at_most(f"L = B phi' of a release{words}", np.ptp(momentum) / abs(momentum[0]), bound)


def work_of_the_ground(subject: Subject, support: str) -> Iterator[Result]:
    """The energy changes by the work of the ground, and after the end of its record by nothing.

    In the frame of the ground the force per unit mass is -a: where a is constant, its work is that of the
    displacement of the mass centre.
    """
    motion = PUSHED.motion
    assert motion is not None
    found = subject.simulate(PUSHED, support, sample_step=0.05)
    within = np.arange(round(PUSHED.length / 0.05) + 1)  # a swing or a fall that goes on is not asked for
    last = np.minimum(within, round(motion.duration / 0.05))
    work = -(found.centre_of_mass[last] - found.centre_of_mass[0]) @ motion.acceleration[0]
    energy = found.energy[within]
    left = largest(energy - energy[0] - work) / energy.max()
    bound = subject.within(10.0, "work of a constant force, from positions")
    yield at_most("energy against the work of ground that accelerates, and stops", left, bound)


def work_of_a_record(subject: Subject, support: str) -> Iterator[Result]:
    """Under El Centro the energy changes by the work of the ground, sample by sample of the record."""
    found = subject.simulate(EL_CENTRO, support)
    loss = abs(energy_loss(found, EL_CENTRO.motion)) if found.peak_tilt > 0.0 else math.nan
    bound = subject.within(2e5, "work from samples 0.01 s apart, corrected for their slope")
    yield at_most("energy against the work of El Centro doubled", loss, bound)
