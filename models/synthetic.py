"""Synthetic ground motions: single pulses, the test loads of rocking since Housner, and filtered noise."""

from __future__ import annotations

import math
from numbers import Integral

import numpy as np
from numpy.typing import NDArray

from .argument_kinds import with_argument_kinds
from .ground_motion import GroundMotion
from .number_checks import (
    require_finite,
    require_in_range,
    require_not_negative,
    require_one_of,
    require_positive,
)
from .record_source import PULSE, SYNTHETIC, source_of_samples

# name: duration in periods, after which the ground is still
_LENGTHS = {"one-sine": 1.0, "one-cosine": 1.0, "half-sine": 0.5}
PULSES = tuple(_LENGTHS)
# between samples the motion is linear: off by (2 pi/400)^2/8 = 3e-5 of the amplitude at most
SAMPLES_PER_PERIOD = 400
MOST_STILL = 1e7  # samples of still ground before a motion: a tenth of a gigabyte


@with_argument_kinds
def pulse(
    kind: str, *, amplitude: float, period: float, azimuth: float = 0.0, start: float = 0.0
) -> GroundMotion:
    """Return a pulse of the ground along one direction.

    Parameters
    ----------
    kind : {"one-sine", "one-cosine", "half-sine"}
        One whole period of a sine or a cosine, or its first half. The one-cosine begins at its amplitude.
    amplitude : float
        Largest acceleration [m/s^2].
    period : float
        [s]
    azimuth : float, optional
        Azimuth of the first acceleration, counter-clockwise from east [rad].
    start : float, optional
        Still ground before it [s].

    Returns
    -------
    GroundMotion

    Raises
    ------
    ValueError
        If the kind is unknown or a number is out of range.

    Examples
    --------
    >>> motion = pulse("one-sine", amplitude=3.0, period=0.8)
    >>> round(motion.peak, 12), motion.duration
    (3.0, 0.8)
    """
    require_one_of("pulse", kind, PULSES)
    amplitude = require_positive("amplitude", amplitude, "m/s^2")
    period = require_positive("period", period, "s")
    azimuth = require_finite("azimuth", azimuth, "rad")
    require_not_negative("start", start, "s")
    if start > MOST_STILL * period / SAMPLES_PER_PERIOD:
        raise ValueError(f"start must leave at most {MOST_STILL:g} samples of still ground, got {start!r} s")
    count = round(SAMPLES_PER_PERIOD * _LENGTHS[kind])
    step = period / SAMPLES_PER_PERIOD
    # begins at a sample, so that its beginning stays sharp
    still = round(start / step)
    phase = 2.0 * math.pi * np.arange(count + 1) / SAMPLES_PER_PERIOD
    shape = np.cos(phase) if kind == "one-cosine" else np.sin(phase)
    if kind != "one-cosine":
        shape[-1] = 0.0  # and not 1e-16
    values = amplitude * np.concatenate([np.zeros(still), shape])
    samples = np.column_stack([values * math.cos(azimuth), values * math.sin(azimuth)])
    return GroundMotion(samples, step, f"{kind} pulse", source_of_samples(PULSE, samples, step))


# Kanai-Tajimi filter, firm soil: K. Kanai 1957, H. Tajimi 1960
_GROUND_FREQUENCY, _GROUND_DAMPING = 5.0 * math.pi, 0.6
# a second, high-pass filter (R. W. Clough, J. Penzien) removes the drift that no ground has
_CORNER_FREQUENCY, _CORNER_DAMPING = 0.5 * math.pi, 0.6
_TIME_STEP = 0.01
# shares of the duration: rise and strong part of the envelope, followed by an exponential decay
_RISE, _STRONG, _DECAY = 0.15, 0.4, 4.0


@with_argument_kinds
def synthetic_motions(count: int, *, peak: float, seed: int, duration: float = 20.0) -> list[GroundMotion]:
    """Return `count` synthetic ground motions of two components: filtered noise with an envelope.

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
    require_in_range("count", count, Integral, least=1)
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
        GroundMotion(
            samples,
            _TIME_STEP,
            f"synthetic {seed}-{index + 1}",
            source_of_samples(SYNTHETIC, samples, _TIME_STEP),
        )
        for index, samples in enumerate(shaped)
    ]


def _transfer(frequency: NDArray[np.float64]) -> NDArray[np.complex128]:
    """Response of both filters to acceleration of the rock, by circular frequency [rad/s]."""
    ground = _GROUND_FREQUENCY**2 + 2j * _GROUND_DAMPING * _GROUND_FREQUENCY * frequency
    ground /= _GROUND_FREQUENCY**2 - frequency**2 + 2j * _GROUND_DAMPING * _GROUND_FREQUENCY * frequency
    corner = -(frequency**2) / (
        _CORNER_FREQUENCY**2 - frequency**2 + 2j * _CORNER_DAMPING * _CORNER_FREQUENCY * frequency
    )
    return np.asarray(ground * corner)
