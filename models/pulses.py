"""Ground motions of a single pulse, the test loads of rocking since Housner."""

from __future__ import annotations

import math

import numpy as np

from .ground_motion import GroundMotion
from .number_checks import require_finite, require_one_of, require_positive

# name: periods that it lasts; the rest is still ground
_LENGTHS = {"one-sine": 1.0, "one-cosine": 1.0, "half-sine": 0.5}
PULSES = tuple(_LENGTHS)
# between samples the motion is linear: off by (2 pi/400)^2/8 = 3e-5 of the amplitude at most
SAMPLES_PER_PERIOD = 400
MOST_STILL = 1e7  # samples of still ground before a motion: a tenth of a gigabyte


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
        Of the first acceleration, counter-clockwise from east [rad].
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
    if require_finite("start", start, "s") < 0.0:
        raise ValueError(f"start must not be negative [s], got {start!r}")
    if start > MOST_STILL * period / SAMPLES_PER_PERIOD:
        raise ValueError(f"start must leave at most {MOST_STILL:g} samples of still ground, got {start!r} s")
    count = round(SAMPLES_PER_PERIOD * _LENGTHS[kind])
    step = period / SAMPLES_PER_PERIOD
    # the pulse begins at a sample, so that its beginning stays sharp
    still = round(start / step)
    phase = 2.0 * math.pi * np.arange(count + 1) / SAMPLES_PER_PERIOD
    shape = np.cos(phase) if kind == "one-cosine" else np.sin(phase)
    if kind != "one-cosine":
        shape[-1] = 0.0  # and not 1e-16
    values = amplitude * np.concatenate([np.zeros(still), shape])
    return GroundMotion(
        np.column_stack([values * math.cos(azimuth), values * math.sin(azimuth)]), step, f"{kind} pulse"
    )
