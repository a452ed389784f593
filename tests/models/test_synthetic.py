"""Synthetic motions: pulses by their formula, and noise through the filters of a ground."""

from __future__ import annotations

import math

import numpy as np
import pytest
from scipy import signal

from rockwobble.models import pulse, synthetic_motions

ROUNDING = 1e-9  # of the peak; of transforms and sums over thousands of samples
STEP = 0.01  # [s]


def kanai_tajimi(frequency: float, damping: float) -> tuple[list[float], list[float]]:
    """Absolute acceleration of an oscillator on the ground, as polynomials of s."""
    return [2.0 * damping * frequency, frequency**2], [1.0, 2.0 * damping * frequency, frequency**2]


def high_pass(frequency: float, damping: float) -> tuple[list[float], list[float]]:
    """Relative acceleration of an oscillator, as polynomials of s (R. W. Clough, J. Penzien)."""
    return [1.0, 0.0, 0.0], [1.0, 2.0 * damping * frequency, frequency**2]


@pytest.mark.parametrize(("seed", "duration", "peak"), [(1, 5.0, 4.0), (7, 12.34, 0.3), (20, 20.0, 9.81)])
def test_synthetic_motions_are_filtered_white_noise_in_an_envelope(
    seed: int, duration: float, peak: float
) -> None:
    """Firm soil, 5 pi rad/s and 0.6, and a corner of 0.25 Hz; a rise of 15 %, a strong part of 40 %."""
    size = round(duration / STEP) + 1
    noise = np.random.default_rng(seed).standard_normal((2, size, 2))
    circular = 2.0 * np.pi * np.fft.rfftfreq(2 * size, STEP)  # zero padding against wrap-around
    transfer = math.prod(
        signal.freqs(*filtered, worN=circular)[1]
        for filtered in (kanai_tajimi(5.0 * np.pi, 0.6), high_pass(0.5 * np.pi, 0.6))
    )
    shaken = np.fft.irfft(transfer[:, None] * np.fft.rfft(noise, 2 * size, axis=1), axis=1)[:, :size]
    share = np.linspace(0.0, 1.0, size)
    shaken *= np.interp(share, [0.0, 0.15, 1.0], [0.0, 1.0, 1.0])[:, None]
    shaken *= np.where(share > 0.55, np.exp(4.0 * (0.55 - share)), 1.0)[:, None]
    for motion, due in zip(
        synthetic_motions(2, peak=peak, seed=seed, duration=duration), shaken, strict=True
    ):
        due = due * peak / np.sqrt((due**2).sum(axis=1).max())
        assert motion.time_step == STEP
        assert motion.acceleration == pytest.approx(due, abs=ROUNDING * peak)
        assert motion.source is not None
        assert motion.synthetic
        parts = motion.source.components
        assert [part.peak for part in parts] == pytest.approx(np.abs(due).max(axis=0) / 9.81)
        assert [part.mean for part in parts] == pytest.approx(due.mean(axis=0) / 9.81, abs=1e-9)
        assert (motion.source.samples, motion.source.time_step) == (size, STEP)


def shape(kind: str, phase: np.ndarray) -> np.ndarray:
    """Pulse of amplitude 1 at a phase in periods; still ground beyond."""
    within = (phase > -1e-9) & (phase < (0.5 if kind == "half-sine" else 1.0) + 1e-9)
    wave = np.cos if kind == "one-cosine" else np.sin
    return np.where(within, wave(2.0 * np.pi * phase), 0.0)


@pytest.mark.parametrize("kind", ["one-sine", "one-cosine", "half-sine"])
@pytest.mark.parametrize("seed", range(5))
def test_a_pulse_is_its_formula_along_its_azimuth(kind: str, seed: int) -> None:
    chance = np.random.default_rng(seed)
    amplitude, period = chance.uniform(0.1, 9.0), 10.0 ** chance.uniform(-1.5, 1.0)
    azimuth = chance.uniform(-4.0, 4.0)
    before = int(chance.integers(0, 900))
    motion = pulse(kind, amplitude=amplitude, period=period, azimuth=azimuth, start=period * before / 400.0)
    times = motion.time_step * np.arange(len(motion.acceleration))
    length = 0.5 * period if kind == "half-sine" else period
    assert motion.duration == pytest.approx(period * before / 400.0 + length)
    due = amplitude * shape(kind, times / period - before / 400.0)
    along = motion.acceleration @ [math.cos(azimuth), math.sin(azimuth)]
    across = motion.acceleration @ [-math.sin(azimuth), math.cos(azimuth)]
    assert along == pytest.approx(due, abs=ROUNDING * amplitude)
    assert across == pytest.approx(np.zeros(len(due)), abs=ROUNDING * amplitude)
    assert motion.peak == pytest.approx(amplitude, rel=ROUNDING)
    # still ground after the pulse, which ends at zero or as a cosine
    assert abs(along[-1]) == (pytest.approx(amplitude) if kind == "one-cosine" else 0.0)


def test_still_ground_before_a_pulse_has_a_limit() -> None:
    """Limit: ten million samples, at 400 a period."""
    for period in (0.5, 2.0):
        most = 1e7 * period / 400.0
        with pytest.raises(ValueError, match=r"start must leave at most 1e\+07 samples"):
            pulse("one-sine", amplitude=1.0, period=period, start=1.0001 * most)
