"""Ground acceleration as a piecewise linear function of time."""

from __future__ import annotations

import math
from collections.abc import Iterable
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike, NDArray

from .diagnostic import Diagnostic
from .number_checks import quoted, require_finite, require_numbers, require_positive
from .record_source import RecordSource
from .shown import brief, line

_FULL_TURN = 2.0 * math.pi * (1.0 + 1e-9)  # [rad]; 360 deg may round to more than 2 pi


@dataclass(frozen=True, slots=True, eq=False, repr=False)
class GroundMotion:
    """Ground acceleration of two or three components, linear between samples and zero outside.

    Parameters
    ----------
    acceleration : array_like, shape (n, 2) or (n, 3)
        Samples [m/s^2]; x is east-west, y north-south, z (optional) up. Kept as a read-only copy.
    time_step : float
        Spacing of the samples [s].
    name : str, optional
        For tables and figures.
    source : RecordSource, optional
        Files, columns and units that it was read from, and what was done to it since. Of no account when
        motions are compared.

    Raises
    ------
    ValueError
        If there are fewer than two samples, a column too many or too few, a value that is not
        finite, or a time step that is not positive.

    Examples
    --------
    >>> pulse = GroundMotion([[0.0, 0.0], [3.0, 4.0], [0.0, 0.0]], 0.5)
    >>> pulse.duration, pulse.peak
    (1.0, 5.0)
    >>> pulse.scaled(2.0).peak
    10.0
    """

    acceleration: NDArray[np.float64]
    time_step: float
    name: str = ""
    source: RecordSource | None = None

    def __init__(
        self, acceleration: ArrayLike, time_step: float, name: str = "", source: RecordSource | None = None
    ) -> None:
        samples = np.ascontiguousarray(require_numbers("acceleration", acceleration))
        if samples.ndim != 2 or samples.shape[1] not in (2, 3) or samples.shape[0] < 2:
            raise ValueError(
                f"acceleration must have shape (n, 2) or (n, 3) with n >= 2, got {samples.shape}"
            )
        bad = np.argwhere(~np.isfinite(samples))
        if len(bad):
            row, column = bad[0]
            raise ValueError(
                f"acceleration must be finite, got {samples[row, column]} "
                f"in sample {row} of component {'xyz'[column]}"
            )
        samples.flags.writeable = False
        object.__setattr__(self, "acceleration", samples)
        object.__setattr__(self, "time_step", require_positive("time_step", time_step, "s"))
        object.__setattr__(self, "name", str(name))
        object.__setattr__(self, "source", source)

    def __repr__(self) -> str:
        count, components = self.acceleration.shape
        samples, peak = f"{count} samples of {self.time_step:g} s", f"peak {self.peak:.4g} m/s^2"
        return line("GroundMotion", [brief(self.name), samples, f"{components} components", peak])

    def __eq__(self, other: object) -> bool:
        if not isinstance(other, GroundMotion):
            return NotImplemented
        facts, others = (self.time_step, self.name), (other.time_step, other.name)
        return facts == others and np.array_equal(self.acceleration, other.acceleration)

    def __hash__(self) -> int:
        # hash of some hundred samples: a run asks for it several times, and a hash of all took a tenth of its
        # time
        some = self.acceleration[:: 1 + len(self.acceleration) // 100]
        return hash((self.time_step, self.name, self.acceleration.shape, some.tobytes()))

    def __reduce__(self) -> tuple[object, ...]:
        # a copy or a worker process must not get a writable array
        return GroundMotion, (self.acceleration, self.time_step, self.name, self.source)

    @property
    def diagnostics(self) -> tuple[Diagnostic, ...]:
        """Doubts about a record as read, see `RecordSource.doubts`; none without a source."""
        return self.source.doubts if self.source else ()

    @property
    def synthetic(self) -> bool:
        """Whether the motion is synthetic or a pulse, not recorded."""
        return self.source is not None and self.source.synthetic

    @property
    def duration(self) -> float:
        """Time from the first to the last sample, (n - 1) time_step [s]."""
        return (len(self.acceleration) - 1) * self.time_step

    @property
    def peak(self) -> float:
        """Largest horizontal resultant [m/s^2]; exact, because its size is convex between samples."""
        return float(np.hypot(self.acceleration[:, 0], self.acceleration[:, 1]).max())

    @property
    def has_vertical(self) -> bool:
        """Whether there is a vertical component."""
        return int(self.acceleration.shape[1]) == 3

    def until(self, end: float) -> NDArray[np.float64]:
        """Return the accelerations of its samples up to a time, and at that time [m/s^2], shape (n, 2 or 3).

        Parameters
        ----------
        end : float
            [s]
        """
        times = np.arange(len(self.acceleration)) * self.time_step
        if end >= self.duration:
            return self.acceleration
        last = [np.interp(end, times, column) for column in self.acceleration.T]
        return np.vstack([self.acceleration[times <= end], last])

    def scaled(self, factor: float) -> GroundMotion:
        """Return the motion with all components multiplied by `factor` [-].

        Parameters
        ----------
        factor : float
            Factor of all components [-].

        Returns
        -------
        GroundMotion
        """
        factor = require_finite("factor", factor, "")
        with np.errstate(over="ignore"):  # the constructor refuses infinite samples
            scaled = self.acceleration * factor
        return self if factor == 1.0 else self.with_samples(scaled, f"scaled by {factor:.6g}")

    def rotated(self, angle: float) -> GroundMotion:
        """Return the motion turned by `angle` [rad] about the vertical, counter-clockwise from above.

        Parameters
        ----------
        angle : float
            Counter-clockwise as seen from above [rad], from -2 pi to 2 pi.

        Returns
        -------
        GroundMotion

        Raises
        ------
        ValueError
            If the angle is no finite number or is beyond a full turn, as one in degrees is.
        """
        angle = require_finite("angle", angle, "rad")
        if abs(angle) > _FULL_TURN:
            raise ValueError(
                f"angle must be from -2 pi to 2 pi [rad], got {quoted(angle)}: if that is in degrees, "
                f"give math.radians({angle:g})"
            )
        turned = np.array(self.acceleration)
        x, y = self.acceleration[:, 0], self.acceleration[:, 1]
        turned[:, 0] = x * math.cos(angle) - y * math.sin(angle)
        turned[:, 1] = x * math.sin(angle) + y * math.cos(angle)
        return self.with_samples(turned, f"rotated by {math.degrees(angle):.6g} deg")

    def with_samples(self, acceleration: ArrayLike, change: str) -> GroundMotion:
        """Return a motion of the same name, time step and source with other samples.

        Parameters
        ----------
        acceleration : array_like, shape (n, 2) or (n, 3)
            [m/s^2]
        change : str
            What was done to it, for its source: "cut to 10 s".

        Returns
        -------
        GroundMotion
        """
        source = self.source and self.source.with_change(change)
        return GroundMotion(acceleration, self.time_step, self.name, source)


def sources_of(motions: Iterable[GroundMotion | None]) -> list[str]:
    """Source of each ground motion in a line, without repeats and without motions that have no file."""
    lines = (
        f"{motion.name or 'record'}: {motion.source.line}"
        for motion in motions
        if motion and motion.source and motion.source.from_files
    )
    return list(dict.fromkeys(lines))
