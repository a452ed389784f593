"""Difference of a motion and a reference: in tilt, azimuth and path, from when, and how large.

Two good traces of one problem diverge at some time, and near upright no azimuth means anything. So azimuth
and path are compared while the tilts agree, and the azimuth where both lean by more than a share of the
largest tilt there.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from .motion import SAME_TIME, Motion, on_samples_of
from .table import Array, Mask

# of the length of the agreement, where the tilts diverge: towards its end the azimuths do already
BEFORE_DIVERGENCE = 0.8
# of the azimuth [rad]
AZIMUTH_BOUND = math.radians(3.0)
# of the path, over b, besides what that makes of it: R times 1 % of alpha is about as much
PATH_BOUND = 0.01
# of a difference, in standard deviations of the noise
ABOVE_NOISE = 5.0
# noise along the lean against that across it: that of a mass centre is larger across, by R/h at tan alpha 1
BOTH_DIRECTIONS = 1.4
# samples without which azimuth and path are not compared
FEWEST_COMPARED = 5
# what is left of a difference that is explained, of the difference
LEFT_OVER = 1.0 / 3.0


@dataclass(frozen=True, slots=True, kw_only=True)
class Part:
    """One quantity, compared.

    Attributes
    ----------
    first_time : float
        The first difference above the bound, in the time of the run [s]; NaN where it does not differ.
    size : float
        Root mean square of the difference; alpha for the tilt, rad for the azimuth, b for the path.
    bound : float
        What the size may be, in its unit; of the tilt, what each difference may be.
    """

    first_time: float
    size: float
    bound: float

    @property
    def differs(self) -> bool:
        """Whether there is a difference above the bound."""
        return math.isfinite(self.first_time)


@dataclass(frozen=True, slots=True, kw_only=True)
class Difference:
    """A motion compared with a reference.

    Attributes
    ----------
    start, end, covered : float
        Of the agreement of the tilts, and up to when azimuth and path are compared, in the time of the
        run [s].
    compared : float
        End of what both have in common [s].
    agreed_motion, agreed_peak : float
        Integral [rad s] and largest value [rad] of the tilt of the reference over the agreement.
    tilt, azimuth, path : Part or None
        None where they are not known, or the cylinder does not lean enough while the tilts agree.
    """

    start: float
    end: float
    covered: float
    compared: float
    agreed_motion: float
    agreed_peak: float
    tilt: Part
    azimuth: Part | None = None
    path: Part | None = None

    @property
    def differs_in(self) -> tuple[str, ...]:
        """What differs, of "tilt", "azimuth" and "path"."""
        parts = (("tilt", self.tilt), ("azimuth", self.azimuth), ("path", self.path))
        return tuple(name for name, part in parts if part is not None and part.differs)

    @property
    def length(self) -> float:
        """Length of the agreement of the tilts [s]."""
        return max(0.0, self.end - self.start)


@dataclass(frozen=True, slots=True, kw_only=True)
class Reference:
    """What a trajectory is compared with.

    Attributes
    ----------
    motion : Motion
    alpha, base_radius : float
        [rad], [m]
    time_scale : float
        sqrt(R/g) [s].
    start : float
        Its uplift or release [s].
    is_free : bool
        Whether it is a release on ground that stands still.
    tilt_bound : float
        Tilt difference that ends the agreement [alpha].
    least_lean : float
        Share of the largest tilt above which an azimuth is compared.
    azimuth_bound : float
        Azimuth difference, weighted by the tilt [rad].
    """

    motion: Motion
    alpha: float
    base_radius: float
    time_scale: float
    start: float
    is_free: bool
    tilt_bound: float
    least_lean: float
    azimuth_bound: float = AZIMUTH_BOUND

    def difference(self, motion: Motion) -> Difference:
        """Compare a motion with the reference."""
        model, trial = on_samples_of(self.motion, motion)
        if not len(model.time):
            none = Part(first_time=self.start, size=math.inf, bound=self.tilt_bound)
            at = self.start
            return Difference(
                start=at, end=at, covered=at, compared=at, agreed_motion=0.0, agreed_peak=0.0, tilt=none
            )
        start = max(self.start, float(model.time[0]))
        tilt, end = self._tilt(model, trial)
        covered = start + BEFORE_DIVERGENCE * (end - start) if tilt.differs else end
        # to the sample: rounding must not take the last one away
        within, agreed = model.time <= covered + SAME_TIME, model.time <= end + SAME_TIME
        return Difference(
            start=start,
            end=end,
            covered=covered,
            compared=float(model.time[-1]),
            agreed_motion=float(
                np.diff(model.time[agreed]) @ (model.tilt[agreed][1:] + model.tilt[agreed][:-1])
            )
            / 2.0,
            agreed_peak=float(model.tilt[agreed].max(initial=0.0)),
            tilt=tilt,
            azimuth=self._azimuth(model, trial, within),
            path=self._path(model, trial, within),
        )

    def leaning(self, model: Motion, trial: Motion, within: Mask) -> Mask:
        """Return the samples at which an azimuth is compared: both lean far enough."""
        least = max(self.least_lean * float(model.tilt[within].max(initial=0.0)), ABOVE_NOISE * trial.noise)
        counts: Mask = within & (model.tilt > least) & (trial.tilt > least)
        return counts

    def noise_allowance(self, noise: float) -> float:
        """Return what noise [rad] adds to the bound of the tilt [alpha]; none where it is a tenth of that."""
        added = ABOVE_NOISE * noise / self.alpha
        return added if added > 0.1 * self.tilt_bound else 0.0

    def _tilt(self, model: Motion, trial: Motion) -> tuple[Part, float]:
        apart = np.abs(trial.tilt - model.tilt) / self.alpha
        bound = self.tilt_bound + self.noise_allowance(trial.noise)
        beyond = model.time[apart > bound]
        first, size = float(beyond[0]) if len(beyond) else math.nan, float(np.sqrt(np.mean(apart**2)))
        end = first if len(beyond) else float(model.time[-1])
        return Part(first_time=first, size=size, bound=bound), end

    def _azimuth(self, model: Motion, trial: Motion, within: Mask) -> Part | None:
        if model.lean is None or trial.lean is None:
            return None
        counts = self.leaning(model, trial, within)
        if np.count_nonzero(counts) < FEWEST_COMPARED:
            return None
        product = trial.lean[counts] * model.lean[counts].conj()
        apart, weight = np.abs(np.angle(product)), np.abs(product)
        size = math.sqrt(float(np.sum(weight * apart**2) / np.sum(weight)))
        # the mean of few samples scatters itself, and noise is not the same in both directions
        few = 1.0 + 3.0 / math.sqrt(2.0 * len(apart))
        blurred = BOTH_DIRECTIONS * trial.noise / math.sqrt(float(np.mean(weight))) * few
        beyond = apart > self.azimuth_bound + ABOVE_NOISE * trial.noise / np.sqrt(weight)
        return _part(model.time[counts], size, math.hypot(self.azimuth_bound, blurred), beyond)

    def _path(self, model: Motion, trial: Motion, within: Mask) -> Part | None:
        if model.path is None or trial.path is None or np.count_nonzero(within) < FEWEST_COMPARED:
            return None
        apart = np.linalg.norm(trial.path[within] - model.path[within], axis=1) / self.base_radius
        size = float(np.sqrt(np.mean(apart**2)))
        beside = float(np.sqrt(np.mean(np.sum(model.path[within, :2] ** 2, axis=1)))) / self.base_radius
        # of three coordinates, and of samples that are few
        few = 1.0 + 3.0 / math.sqrt(6.0 * len(apart))
        noise = trial.path_noise / self.base_radius
        bound = math.hypot(PATH_BOUND, self.azimuth_bound * beside, math.sqrt(3.0) * noise * few)
        return _part(model.time[within], size, bound, apart > bound + ABOVE_NOISE * noise)


def explains(before: Part, after: Part | None) -> bool:
    """Whether a difference is gone, and not only just."""
    return after is not None and not after.differs and after.size <= LEFT_OVER * before.size


def _part(time: Array, size: float, bound: float, beyond: Mask) -> Part:
    """A mean that is above its bound differs from the first sample that is beyond its own, if one is."""
    first = float(time[np.argmax(beyond)]) if size > bound else math.nan
    return Part(first_time=first, size=size, bound=bound)
