"""A motion as the lean of its axis and the path of its mass centre.

The lean sin(theta) exp(i phi) is smooth through the upright position, where the azimuth phi means nothing and
in planar motion jumps by pi.
"""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from rockwobble.models import Trace

from .file import Array

Complex = NDArray[np.complex128]


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Motion:
    """The samples of a motion.

    Attributes
    ----------
    time, tilt : ndarray, shape (n,)
        [s], [rad]
    lean : ndarray of complex, shape (n,), or None
        x + i y of the axis, a unit vector; None where no azimuth is known.
    path : ndarray, shape (n, 3), or None
        Mass centre from O [m]; None where it is not known.
    noise, path_noise : float
        Standard deviations of the noise of the axis [rad] and of each coordinate of the mass centre [m].
    """

    time: Array
    tilt: Array
    lean: Complex | None
    path: Array | None = None
    noise: float = 0.0
    path_noise: float = 0.0

    def turned(self, angle: float, *, mirrored: bool = False) -> Motion:
        """Return the motion turned by `angle` [rad] counter-clockwise, with y reversed first if mirrored."""
        turn, lean, path = np.exp(1j * angle), self.lean, self.path
        if lean is not None:
            lean = turn * (lean.conj() if mirrored else lean)
        if path is not None:
            flat = turn * (path[:, 0] + (-1j if mirrored else 1j) * path[:, 1])
            path = np.column_stack([flat.real, flat.imag, path[:, 2]])
        return replace(self, lean=lean, path=path)

    def at(self, time: Array) -> Motion:
        """Return the motion at other times [s], linear between its samples."""
        tilt = np.interp(time, self.time, self.tilt)
        lean = None if self.lean is None else np.interp(time, self.time, self.lean)
        path = self.path
        if path is not None:
            path = np.column_stack([np.interp(time, self.time, part) for part in path.T])
        return replace(self, time=time, tilt=tilt, lean=lean, path=path)

    def delayed(self, time: float) -> Motion:
        """Return the motion with `time` added to its clock [s]."""
        return replace(self, time=self.time + time)


def motion_of(
    trace: Trace, told: tuple[str, ...] = ("azimuth", "path"), *, noise: float = 0.0, path_noise: float = 0.0
) -> Motion:
    """Return the motion of a trace, as far as it is `told`."""
    return replace(
        motion_at(trace.time, trace.tilt, trace.rolling_angle if "azimuth" in told else None),
        path=trace.centre_of_mass if "path" in told else None,
        noise=noise,
        path_noise=path_noise,
    )


def motion_at(time: Array, tilt: Array, azimuth: Array | None) -> Motion:
    """Return the motion of tilts and azimuths (n,) [rad], NaN at rest; the azimuth may be unknown."""
    lean = None if azimuth is None else np.sin(tilt) * np.exp(1j * np.nan_to_num(azimuth))
    return Motion(time=time, tilt=tilt, lean=lean)


def on_samples_of(reference: Motion, motion: Motion) -> tuple[Motion, Motion]:
    """Return both at the samples of the reference, as far as the motion reaches: reference, motion."""
    finite = np.isfinite(reference.tilt)
    within = (reference.time >= motion.time[0] - 1e-9) & (reference.time <= motion.time[-1] + 1e-9) & finite
    time = reference.time[within]
    return reference.at(time), motion.at(time)
