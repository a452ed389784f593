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

SURE_TILT = 5e-6  # of alpha; a standing cylinder leans by 1e-9 rad in MuJoCo, 1e-7 rad in Bullet
_MEMORY = 4000  # steps kept before that tilt: it takes a few hundred from the uplift
_NEAR, _BELOW = 0.90, 0.99  # range of the eccentricity, over b, that is extrapolated to the rim
_FIT = 60  # steps at most in that range: half a sample of a usual record
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
        share = np.hypot(self._eccentricity[:, 0], self._eccentricity[:, 1]) / self._body.base_radius
        inside = np.flatnonzero(share < _BELOW)
        if not len(inside):
            first = self._time[0] if len(self._time) else sure_time
            return float(first), self._direction(0)
        last = int(inside[-1])
        first = last
        while first > 0 and last - first < _FIT and share[first - 1] >= _NEAR:
            first -= 1
        fit = slice(first, last + 1)
        if last - first < 2 or share[last] < _NEAR:
            # a load that jumps over the rim within a step
            return float(self._time[last] + 0.5 * self._step), self._direction(last + 1)
        slope, offset = np.polyfit(self._time[fit] - self._time[last], share[fit], 1)
        if slope <= 0.0:
            return float(self._time[last] + 0.5 * self._step), self._direction(last + 1)
        past = float((1.0 - offset) / slope)
        at = [
            float(np.polyval(np.polyfit(self._time[fit] - self._time[last], values, 1), past))
            for values in self._eccentricity[fit].T
        ]
        return float(self._time[last]) + past, float(np.arctan2(at[1], at[0]))

    def _direction(self, index: int) -> float:
        if not len(self._eccentricity):
            return 0.0
        x, y = self._eccentricity[min(index, len(self._eccentricity) - 1)]
        return float(np.arctan2(y, x))
