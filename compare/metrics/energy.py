"""Energy that a run has lost by its end.

The reduced models lose none, so what an engine loses is contact damping and numerics.
"""

from __future__ import annotations

import math

import numpy as np

from rockwobble.models import GroundMotion, Trace

from .pair import FloatArray


def energy_loss(trace: Trace, motion: GroundMotion | None) -> float:
    """Return the energy lost over the run, relative to the largest energy reached.

    In the frame of the ground the excitation is the body force -m a, so what was lost is the energy
    at the start, plus the work of that force, minus the energy at the end.

    Returns
    -------
    float
        Dimensionless, negative where energy was gained; 0 where there was never any; NaN for a
        trace with an energy that is not finite.
    """
    energy = trace.energy
    if not (len(energy) and bool(np.isfinite(energy).all())):
        return math.nan
    largest = float(energy.max())
    if largest <= 0.0:
        return 0.0
    work = 0.0 if motion is None else _work(motion, trace.time, trace.centre_of_mass)
    return (float(energy[0]) + work - float(energy[-1])) / largest


def _work(motion: GroundMotion, time: FloatArray, place: FloatArray) -> float:
    """Work of -a along the path of the centre of mass, per unit mass [m^2/s^2].

    Between two samples the mean acceleration is exact; its slope meets the change of velocity,
    which adds (a1 - a0)(v1 - v0) h/12.
    """
    if len(time) < 2:
        return 0.0
    work = 0.0
    step = np.diff(time)
    for axis, samples in enumerate(motion.acceleration.T):
        a, mean = _sampled_and_mean(samples, motion.time_step, time)
        velocity = np.gradient(place[:, axis], time)
        work -= float((mean * np.diff(place[:, axis])).sum())
        work -= float((np.diff(a) * np.diff(velocity) * step).sum()) / 12.0
    return work


def _sampled_and_mean(
    samples: FloatArray, time_step: float, time: FloatArray
) -> tuple[FloatArray, FloatArray]:
    """Acceleration at the times `time`, and its exact mean between each two of them [m/s^2]."""
    # linear between samples, zero after the last: one more knot takes the jump
    own = np.arange(len(samples)) * time_step
    own = np.append(own, np.nextafter(own[-1], math.inf))
    values = np.append(samples, 0.0)
    knots = np.union1d(own, time)
    at_knots = np.interp(knots, own, values)
    impulse = np.concatenate([[0.0], np.cumsum(0.5 * (at_knots[1:] + at_knots[:-1]) * np.diff(knots))])
    mean = np.diff(np.interp(time, knots, impulse)) / np.diff(time)
    return np.interp(time, own, values), mean
