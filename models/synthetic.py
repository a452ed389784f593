"""Synthetic ground motions: filtered noise with an envelope."""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from .ground_motion import GroundMotion
from .number_checks import require_positive

# of the Kanai-Tajimi filter, firm soil: K. Kanai 1957, H. Tajimi 1960
_GROUND_FREQUENCY, _GROUND_DAMPING = 5.0 * math.pi, 0.6
# a second, high-pass filter (R. W. Clough, J. Penzien) takes what a ground cannot do: drift away
_CORNER_FREQUENCY, _CORNER_DAMPING = 0.5 * math.pi, 0.6
_TIME_STEP = 0.01
# of the duration: rise and strong part of the envelope, followed by an exponential decay
_RISE, _STRONG, _DECAY = 0.15, 0.4, 4.0


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
    if count < 1:
        raise ValueError(f"count must be at least 1, got {count!r}")
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


def _transfer(frequency: NDArray[np.float64]) -> NDArray[np.complex128]:
    """Response of both filters to acceleration of the rock, by circular frequency [rad/s]."""
    ground = _GROUND_FREQUENCY**2 + 2j * _GROUND_DAMPING * _GROUND_FREQUENCY * frequency
    ground /= _GROUND_FREQUENCY**2 - frequency**2 + 2j * _GROUND_DAMPING * _GROUND_FREQUENCY * frequency
    corner = -(frequency**2) / (
        _CORNER_FREQUENCY**2 - frequency**2 + 2j * _CORNER_DAMPING * _CORNER_FREQUENCY * frequency
    )
    return np.asarray(ground * corner)
