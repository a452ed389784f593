"""The offset of the clock of an external trajectory, from its tilt and that of a model."""

from __future__ import annotations

import math

import numpy as np

from ...traces.motion import Motion

# windows in which the tilts are held against each other, over the time scale of rocking: the first motion
# agrees best, and may be too little to tell
_WINDOWS = (3.0, 6.0, 12.0)
# of the length of the run, the largest offset that is tried
_LARGEST = 0.5
# samples of that scale in the first search
_FINE = 40.0
# rocking repeats itself: of offsets whose misfit is not larger than this times the least, the smallest
_ALIKE = 1.5
# misfit of what is not there: more than any tilt [rad]
_WORST = 10.0


def fitted_delays(reference: Motion, motion: Motion, *, start: float, scale: float) -> list[float]:
    """Return the offsets [s] that bring the tilt of a motion closest to that of the reference.

    The smallest first, to be added to the times of the motion; the reference uplifts or is released at
    `start` [s], and `scale` is the time scale of rocking, sqrt(R/g) [s].
    """
    found: list[float] = []
    for window in _WINDOWS:
        delay = _fitted(reference, motion, start, start + window * scale, scale)
        # the windows are there because one of them may be misled
        if delay and all(abs(delay - other) > 1e-3 * scale for other in found):
            found.append(delay)
    return sorted(found, key=abs)


def _fitted(reference: Motion, motion: Motion, start: float, end: float, scale: float) -> float:
    from scipy.optimize import minimize_scalar

    within = (reference.time >= start) & (reference.time <= end)
    time, wanted = reference.time[within], reference.tilt[within]
    if len(time) < 3:
        return 0.0

    def misfit(delay: float) -> float:
        begin = int(time.searchsorted(motion.time[0] + delay))
        end = int(time.searchsorted(motion.time[-1] + delay, side="right"))
        # most of the window must be there, or a few samples that agree by chance decide
        if end - begin < 0.5 * len(time):
            return _WORST
        apart = np.interp(time[begin:end] - delay, motion.time, motion.tilt) - wanted[begin:end]
        return math.sqrt(np.add.reduce(apart * apart) / len(apart))

    largest = _LARGEST * float(reference.time[-1])
    step = min(scale / _FINE, 0.5 * largest)
    tried = np.arange(-largest, largest + 0.5 * step, step)
    misfits = np.array([misfit(float(delay)) for delay in tried])
    inner = np.flatnonzero((misfits[1:-1] <= misfits[:-2]) & (misfits[1:-1] <= misfits[2:])) + 1
    if not len(inner):
        return 0.0
    best = []
    for at in inner[misfits[inner] <= 3.0 * misfits[inner].min() + 0.02 * float(wanted.max())]:
        low, high = float(tried[at] - step), float(tried[at] + step)
        fit = minimize_scalar(misfit, bounds=(low, high), method="bounded", options={"xatol": 1e-4 * scale})
        best.append((float(fit.fun), float(fit.x)))
    least = min(value for value, _ in best)
    alike = [delay for value, delay in best if value <= _ALIKE * least + 1e-3 * float(wanted.max())]
    return min(alike, key=abs)
