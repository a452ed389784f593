"""Members of an ensemble: one problem many times over, each a little or altogether different."""

from __future__ import annotations

import dataclasses
import math

import numpy as np
from numpy.typing import NDArray

from rockwobble.models import Case, GroundMotion, p695_far_field
from rockwobble.models.number_checks import require_positive
from rockwobble.models.records import p695

from ...metrics.pair import is_release

# of the Kanai-Tajimi filter, firm soil: K. Kanai 1957, H. Tajimi 1960
_GROUND_FREQUENCY, _GROUND_DAMPING = 5.0 * math.pi, 0.6
# a second, high-pass filter (R. W. Clough, J. Penzien) takes what a ground cannot do: drift away
_CORNER_FREQUENCY, _CORNER_DAMPING = 0.5 * math.pi, 0.6
_TIME_STEP = 0.01
# of the duration: rise and strong part of the envelope, followed by an exponential decay
_RISE, _STRONG, _DECAY = 0.15, 0.4, 4.0


# a copy further off is another problem, and a factor could change its sign
_MOST = 0.1


def require_perturbation(perturbation: float) -> None:
    """Refuse a relative standard deviation of copies that is out of range."""
    if not 0.0 < perturbation <= _MOST:
        raise ValueError(f"perturbation must be above 0 and at most {_MOST:g}, got {perturbation!r}")


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
    _require_count(count)
    require_perturbation(perturbation)
    factors = 1.0 + perturbation * np.random.default_rng(seed).standard_normal((count, 2))
    return [
        dataclasses.replace(perturbed(case, *map(float, pair)), name=f"{case.name} #{index + 1}")
        for index, pair in enumerate(factors)
    ]


def perturbed(case: Case, first: float, second: float) -> Case:
    """Return a release with its tilt and rolling rate, or a motion with its two components, times factors."""
    initial, motion = case.initial, case.motion
    if initial is not None and is_release(case):
        released = dataclasses.replace(
            initial, tilt=initial.tilt * first, rolling_rate=initial.rolling_rate * second
        )
        return dataclasses.replace(case, initial=released)
    if motion is None:
        raise ValueError("an ensemble needs a release or a ground motion, got a cylinder at rest")
    acceleration = np.array(motion.acceleration)
    acceleration[:, 0] *= first
    acceleration[:, 1] *= second
    return dataclasses.replace(case, motion=GroundMotion(acceleration, motion.time_step, motion.name))


def synthetic_motions(count: int, *, peak: float, seed: int, duration: float = 20.0) -> list[GroundMotion]:
    """Return `count` made-up ground motions of two components: filtered noise with an envelope.

    White noise through the filters of Kanai-Tajimi and Clough-Penzien on firm soil, both components
    alike and independent, each motion scaled to the same peak.

    Parameters
    ----------
    count : int
    peak : float
        Largest horizontal resultant [m/s^2].
    seed : int
    duration : float, optional
        [s]

    Returns
    -------
    list of GroundMotion

    Raises
    ------
    ValueError
        If a number is out of range.

    Examples
    --------
    >>> motions = synthetic_motions(3, peak=4.0, seed=1)
    >>> [round(motion.peak, 6) for motion in motions]
    [4.0, 4.0, 4.0]
    """
    _require_count(count)
    require_positive("peak", peak, "m/s^2")
    require_positive("duration", duration, "s")
    size = round(duration / _TIME_STEP) + 1
    noise = np.random.default_rng(seed).standard_normal((count, size, 2))
    frequency = 2.0 * math.pi * np.fft.rfftfreq(2 * size, _TIME_STEP)
    spectrum = _transfer(np.asarray(frequency, dtype=np.float64))[None, :, None] * np.fft.rfft(
        noise, 2 * size, axis=1
    )
    filtered = np.fft.irfft(spectrum, axis=1)[:, :size]
    share = np.arange(size) / (size - 1)
    envelope = np.minimum(share / _RISE, 1.0) * np.exp(-_DECAY * np.maximum(share - _RISE - _STRONG, 0.0))
    shaped = filtered * envelope[None, :, None]
    shaped *= peak / np.hypot(shaped[..., 0], shaped[..., 1]).max(axis=1)[:, None, None]
    return [
        GroundMotion(samples, _TIME_STEP, f"synthetic {seed}-{index + 1}")
        for index, samples in enumerate(shaped)
    ]


def far_field_motions(*, peak: float) -> list[GroundMotion]:
    """Return the 22 far-field pairs of FEMA P-695, each scaled to the same peak.

    Parameters
    ----------
    peak : float
        Largest horizontal resultant [m/s^2].

    Returns
    -------
    list of GroundMotion

    Raises
    ------
    ValueError
        If the number is out of range, or the records of the extra `records` are not installed.
    """
    require_positive("peak", peak, "m/s^2")
    return [motion.scaled(peak / motion.peak) for motion in recorded_far_field()]


def recorded_far_field() -> list[GroundMotion]:
    """Return the 22 far-field pairs of FEMA P-695 as they were recorded.

    Raises
    ------
    ValueError
        If the records of the extra `records` are not installed.
    """
    return [p695_far_field(pair) for pair in range(1, p695.PAIRS + 1)]


def _transfer(frequency: NDArray[np.float64]) -> NDArray[np.complex128]:
    """Response of both filters to acceleration of the rock, by circular frequency [rad/s]."""
    ground = _GROUND_FREQUENCY**2 + 2j * _GROUND_DAMPING * _GROUND_FREQUENCY * frequency
    ground /= _GROUND_FREQUENCY**2 - frequency**2 + 2j * _GROUND_DAMPING * _GROUND_FREQUENCY * frequency
    corner = -(frequency**2) / (
        _CORNER_FREQUENCY**2 - frequency**2 + 2j * _CORNER_DAMPING * _CORNER_FREQUENCY * frequency
    )
    return np.asarray(ground * corner)


def with_motions(case: Case, motions: list[GroundMotion]) -> list[Case]:
    """Return one problem under each of several ground motions, as long as each of them.

    Parameters
    ----------
    case : Case
    motions : list of GroundMotion

    Returns
    -------
    list of Case

    Examples
    --------
    >>> import rockwobble as rw
    >>> pier = rw.Cylinder(semidiagonal=6.0, tan_alpha=0.2)
    >>> shaking = synthetic_motions(2, peak=4.0, seed=1, duration=10.0)
    >>> cases = with_motions(rw.Case(pier, duration=1.0), shaking)
    >>> [each.length for each in cases]
    [10.0, 10.0]
    """
    return [
        dataclasses.replace(case, name=f"{case.name}: {motion.name}", motion=motion, duration=None)
        for motion in motions
    ]


def _require_count(count: int) -> None:
    if count < 2:
        raise ValueError(f"an ensemble has at least 2 members, got {count!r}")
