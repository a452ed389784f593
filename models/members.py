"""Many cases from one: perturbed copies of it, or the same cylinder under several ground motions.

A perturbed copy is the same problem, off by a little. What is off is one of three:

===========  =================================================================  =========================
the inputs   tilt and rolling rate of a release, or both horizontal components  `perturbed`
             of the ground motion, each by a factor of its own, which
             `perturbed_copies` draws from one seed
strength     all components of the ground motion, or the tilt of a release      `perturbed_in_strength`
gravity      it acts all the time, as the error of a step does                  `perturbed_in_gravity`
===========  =================================================================  =========================

By how much depends on the question, and stands where that is asked. Two runs have diverged where their tilts
first differ by more than 1 % of alpha, see `agreement_of` of `compare.metrics.pair`.
"""

from __future__ import annotations

import dataclasses
from collections.abc import Sequence
from numbers import Integral

import numpy as np

from .argument_kinds import with_argument_kinds
from .case import Case
from .ground_motion import GroundMotion
from .number_checks import require_in_range

# a larger perturbation makes another problem, and a factor could change its sign
MOST_PERTURBED = 0.1


@with_argument_kinds
def perturbed_copies(case: Case, count: int, *, perturbation: float, seed: int) -> list[Case]:
    """Return one problem `count` times, each with slightly different conditions.

    From a release its tilt and its rolling rate, from rest the two horizontal components of the ground
    motion, are multiplied by 1 + perturbation * N with a standard normal N of its own for each.

    Parameters
    ----------
    case : Case
    count : int
    perturbation : float
        Relative standard deviation.
    seed : int

    Returns
    -------
    list of Case

    Raises
    ------
    ValueError
        If a number is out of range, or nothing moves the cylinder.

    Examples
    --------
    >>> import rockwobble as rw
    >>> pier = rw.Cylinder(semidiagonal=6.0, tan_alpha=0.2)
    >>> release = rw.InitialState(0.5 * pier.alpha, rolling_rate=0.5)
    >>> case = rw.Case(pier, initial=release, duration=4.0)
    >>> copies = perturbed_copies(case, 3, perturbation=1e-3, seed=1)
    >>> [round(copy.initial.tilt / release.tilt, 5) for copy in copies]
    [1.00035, 1.00033, 1.00091]
    """
    require_in_range("count", count, Integral, least=2)
    require_in_range("perturbation", perturbation, above=0.0, most=MOST_PERTURBED)
    factors = 1.0 + perturbation * np.random.default_rng(seed).standard_normal((count, 2))
    return [
        dataclasses.replace(perturbed(case, *map(float, pair)), name=f"{case.name} #{index + 1}")
        for index, pair in enumerate(factors)
    ]


def perturbed(case: Case, first: float, second: float) -> Case:
    """Release with its tilt and rolling rate, or motion with its two components, times factors."""
    initial, motion = case.initial, case.motion
    if initial is not None and initial.tilt > 0.0:
        released = dataclasses.replace(
            initial, tilt=initial.tilt * first, rolling_rate=initial.rolling_rate * second
        )
        return dataclasses.replace(case, initial=released)
    if motion is None:
        raise ValueError("a perturbed copy needs a release or a ground motion, got a cylinder at rest")
    acceleration = np.array(motion.acceleration)
    acceleration[:, 0] *= first
    acceleration[:, 1] *= second
    return dataclasses.replace(case, motion=motion.with_samples(acceleration, "perturbed"))


def perturbed_in_strength(case: Case, relative: float) -> Case:
    """Copy whose ground motion is stronger by a relative change, or whose release tilts more."""
    factor, motion, initial = 1.0 + relative, case.motion, case.initial
    if motion is not None:
        return dataclasses.replace(case, motion=motion.scaled(factor))
    if initial is None:
        return case
    return dataclasses.replace(case, initial=dataclasses.replace(initial, tilt=factor * initial.tilt))


def perturbed_in_gravity(case: Case, relative: float) -> Case:
    """Copy whose gravity differs by a relative change."""
    return dataclasses.replace(case, gravity=case.gravity * (1.0 + relative))


@with_argument_kinds
def with_motions(case: Case, motions: Sequence[GroundMotion]) -> list[Case]:
    """Return one problem under each of several ground motions, as long as each of them.

    Parameters
    ----------
    case : Case
    motions : sequence of GroundMotion

    Returns
    -------
    list of Case

    Examples
    --------
    >>> import rockwobble as rw
    >>> pier = rw.Cylinder(semidiagonal=6.0, tan_alpha=0.2)
    >>> shaking = rw.synthetic_motions(2, peak=4.0, seed=1, duration=10.0)
    >>> cases = with_motions(rw.Case(pier, duration=1.0), shaking)
    >>> [each.length for each in cases]
    [10.0, 10.0]
    """
    return [
        dataclasses.replace(case, name=f"{case.name}: {motion.name}", motion=motion, duration=None)
        for motion in motions
    ]
