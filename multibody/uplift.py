"""When and where the base uplifts.

The base uplifts when the ground's reaction reaches its rim. Contact yields, so tilt itself has no sharp
onset: the eccentricity of the reaction, from the engine's own accelerations, has. It grows with the
excitation until it is b, and stays there while the cylinder rolls on its rim. The crossing is therefore
found backwards, from the first tilt that is motion beyond doubt.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from .body import Body
from .engine import Steps

Array = NDArray[np.float64]

SURE_TILT = 5e-6  # of alpha; a standing cylinder leans by 1e-9 rad in MuJoCo, 1e-8 rad in Bullet
_MEMORY = 4000  # steps kept before that tilt: it takes a few hundred from the uplift
# Eccentricities, over b, from which the last steps are extrapolated to the rim. Contact yields next to the
# rim, and Bullet's four contacts share the load by turns there: the highest with a straight approach counts.
_LEVELS = (0.97, 0.94, 0.9, 0.8)
_FIT = 20  # steps; a fifth of a sample of a usual record, whose kinks bend the approach
_STRAIGHT = 2e-3  # of b, largest residual of a straight approach
_SPIKE = 9  # steps; single steps that carry no or twice the load are none of the approach
_MINIMUM_LOAD = 0.1  # weights; the eccentricity of a smaller reaction is noise


class UpliftWatch:
    """Follows a standing cylinder chunk by chunk until it uplifts."""

    def __init__(self, body: Body, gravity: float, time_step: float) -> None:
        self._body, self._gravity, self._step = body, gravity, time_step
        self._sure = SURE_TILT * float(np.arctan(body.tan_alpha))
        self._time: Array = np.empty(0)
        self._eccentricity: Array = np.empty((0, 2))

    def watch(
        self, time: Array, tilt: Array, poses: Steps, after: Steps, acceleration: Array
    ) -> tuple[float, float] | None:
        """Return time [s] and direction [rad] of the uplift once it has happened, None before.

        `acceleration` (n, 3) is the ground's in the step after each pose.
        """
        eccentricity = self._reaction_eccentricity(poses, after, acceleration)
        sure = np.flatnonzero(tilt > self._sure)
        end = int(sure[0]) if len(sure) else len(tilt)
        self._time = np.concatenate([self._time, time[:end]])[-_MEMORY:]
        self._eccentricity = np.vstack([self._eccentricity, eccentricity[:end]])[-_MEMORY:]
        return self._crossing(float(time[end])) if len(sure) else None

    def _reaction_eccentricity(self, poses: Steps, after: Steps, acceleration: Array) -> Array:
        """Where the ground's reaction acts on the base, relative to its centre, shape (n, 2) [m]."""
        body = self._body
        force = (after.velocity - poses.velocity) / self._step + acceleration
        force[:, 2] += self._gravity
        # upright, the moment about the mass centre is that of the transverse inertia
        change = body.transverse_inertia * (after.angular_velocity - poses.angular_velocity) / self._step
        load = np.where(force[:, 2] > _MINIMUM_LOAD * self._gravity, force[:, 2], np.nan)
        height = body.mass_centre_height
        return np.column_stack(
            [-(change[:, 1] + height * force[:, 0]) / load, (change[:, 0] - height * force[:, 1]) / load]
        )

    def _crossing(self, sure_time: float) -> tuple[float, float]:
        from scipy.signal import medfilt

        if len(self._time) < _SPIKE:
            return (float(self._time[0]) if len(self._time) else sure_time), self._direction(0)
        smooth = np.column_stack([medfilt(values, _SPIKE) for values in self._eccentricity.T])
        share = np.hypot(smooth[:, 0], smooth[:, 1]) / self._body.base_radius
        for level in _LEVELS:
            inside = np.flatnonzero(share < level)
            if not len(inside):
                continue
            end = int(inside[-1]) + 1
            fit = slice(max(end - _FIT, 0), end)
            offset = self._time[fit] - self._time[end - 1]
            if len(offset) < _FIT:
                continue
            line = np.polyfit(offset, share[fit], 1)
            if line[0] > 0.0 and np.abs(np.polyval(line, offset) - share[fit]).max() < _STRAIGHT:
                past = float((1.0 - line[1]) / line[0])
                x, y = (np.polyval(np.polyfit(offset, values[fit], 1), past) for values in smooth.T)
                return float(self._time[end - 1]) + past, float(np.arctan2(y, x))
        # the load jumped over the rim: no approach, and no doubt about the step
        inside = np.flatnonzero(np.hypot(*self._eccentricity.T) < _LEVELS[0] * self._body.base_radius)
        step = int(inside[-1]) + 1 if len(inside) else 0
        return float(self._time[min(step, len(self._time) - 1)]), self._direction(step)

    def _direction(self, index: int) -> float:
        if not len(self._eccentricity):
            return 0.0
        x, y = self._eccentricity[min(index, len(self._eccentricity) - 1)]
        return float(np.arctan2(y, x))
