"""Doubts about a record as read: improbable units, offsets, gravity, time steps and ends."""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence

import numpy as np
from numpy.typing import NDArray

from ..diagnostic import Diagnostic
from ..record_source import LARGEST_MEAN
from .component import METRES_PER_SECOND_SQUARED, USUAL_UNITS, Component

LARGEST_PEAK = 2.0  # [g]; few records of any earthquake have more, numbers in m/s^2 taken for g mostly do
LARGEST_SCALED_PEAK = (
    5.0  # [g], of a record that was scaled; the largest that was ever recorded has about 4 g
)
LARGEST_RATIO = 30.0  # ratio of the peaks of two components; gal taken for m/s^2 makes 100, for g 981
LONGEST_STEP, SHORTEST_STEP = 0.1, 1e-4  # [s]; recorders take 50 to 1000 samples in a second
_USUAL = 0.4  # [g], peak of a strong motion: among the units the one that comes next to it makes sense
# a planar motion that was turned has components in proportion, the small one by its azimuth
_PROPORTIONAL = 1e-9
_GRAVITY = (0.8, 1.2)  # [g], range of a mean that is the weight of the sensor
_END, _FEWEST_AT_END = 0.02, 3  # end of a record: share of its duration, and least number of samples
_STRONG = 0.3  # share of the peak that is improbable at the end


def likely_unit(peak: float, used: str | None = None) -> tuple[str, float]:
    """Return the unit in which a peak [g] makes sense, and the peak in it [g].

    Parameters
    ----------
    peak : float
        As it was read [g].
    used : str, optional
        Unit in which it was read, which is not the answer; without it g, or m/s^2 for what is in cm/s^2. One
        that no option gives, such as ft/s2, the file has stated in full: then no other is likely.

    Examples
    --------
    >>> [(unit, round(peak, 3)) for unit, peak in (likely_unit(3.5, "g"), likely_unit(9.5, "m/s2"))]
    [('m/s2', 0.357), ('cm/s2', 0.095)]
    """
    metre = METRES_PER_SECOND_SQUARED
    reads = [used] if used is not None else ["g", "m/s2"]
    others = [
        (unit, peak * metre[unit] / metre[read])
        for read in reads
        if read in USUAL_UNITS
        for unit in USUAL_UNITS
        if unit != read and metre[unit] < metre[read]
    ]
    return min(others, key=lambda other: abs(math.log(other[1] / _USUAL)), default=("", peak))


def doubts_as_read(
    acceleration: NDArray[np.float64], time_step: float, components: Sequence[Component], units: Sequence[str]
) -> tuple[Diagnostic, ...]:
    """Reasons why a record is improbable.

    Parameters
    ----------
    acceleration : ndarray, shape (n, 2) or (n, 3)
        [m/s^2]
    time_step : float
        [s]
    components : sequence of Component
        Components of x, y and z.
    units : sequence of str
        In which their numbers were read.

    Returns
    -------
    tuple of Diagnostic
    """
    facts = [*peak_doubts(acceleration, units), *_of_means(acceleration), *_of_step(time_step)]
    return (*facts, *_of_end(acceleration), *_of_places(components))


def peak_doubts(acceleration: NDArray[np.float64], units: Sequence[str] = ()) -> Iterator[Diagnostic]:
    """Yield doubts about peaks: "large_peak", "unlike_components"."""
    peaks = np.abs(acceleration).max(axis=0)
    resultant = float(np.hypot(acceleration[:, 0], acceleration[:, 1]).max())
    peak = max(resultant, float(peaks.max())) / METRES_PER_SECOND_SQUARED["g"]
    if peak > LARGEST_PEAK:
        used = units[int(peaks.argmax())] if units else None
        likely = likely_unit(peak, used)[0]
        detail = f"{likely} for {used}" if used and likely else likely
        yield Diagnostic(code="large_peak", size=peak, bound=LARGEST_PEAK, detail=detail)
    moving = peaks[peaks > 0.0]
    ratio = float(moving.max() / moving.min()) if len(moving) else 1.0
    if ratio >= LARGEST_RATIO and not _in_one_plane(acceleration):
        axis = "xyz"[int(peaks.argmax())]
        yield Diagnostic(code="unlike_components", size=ratio, bound=LARGEST_RATIO, detail=axis)


def _in_one_plane(acceleration: NDArray[np.float64]) -> bool:
    x, y = acceleration[:, :2].T
    across = math.sqrt(float(x @ x) * float(y @ y))
    return acceleration.shape[1] == 2 and abs(across - abs(float(x @ y))) <= _PROPORTIONAL * across


def _of_means(acceleration: NDArray[np.float64]) -> Iterator[Diagnostic]:
    peaks, means = np.abs(acceleration).max(axis=0), acceleration.mean(axis=0)
    in_g = np.abs(means) / METRES_PER_SECOND_SQUARED["g"]
    weights = (in_g > _GRAVITY[0]) & (in_g < _GRAVITY[1]) & (np.abs(means) > 0.5 * peaks)
    for place in np.flatnonzero(weights):
        yield Diagnostic(code="gravity_in_record", size=float(in_g[place]), bound=1.0, detail="xyz"[place])
    with np.errstate(divide="ignore", invalid="ignore"):
        parts = np.where(weights | (peaks == 0.0), 0.0, np.abs(means) / peaks)
    if parts.max() > LARGEST_MEAN:
        axis = int(parts.argmax())
        yield Diagnostic(code="offset", size=float(parts[axis]), bound=LARGEST_MEAN, detail="xyz"[axis])


def _of_step(time_step: float) -> Iterator[Diagnostic]:
    if time_step > LONGEST_STEP * (1.0 + 1e-9):
        yield Diagnostic(code="unlikely_step", size=time_step, bound=LONGEST_STEP)
    if time_step < SHORTEST_STEP * (1.0 - 1e-9):
        yield Diagnostic(code="unlikely_step", size=time_step, bound=SHORTEST_STEP)


def _of_end(acceleration: NDArray[np.float64]) -> Iterator[Diagnostic]:
    count = max(_FEWEST_AT_END, round(_END * len(acceleration)))
    if len(acceleration) < 4 * count:
        return
    centred = np.abs(acceleration - acceleration.mean(axis=0)).max(axis=1)
    part = float(centred[-count:].max() / centred.max()) if centred.any() else 0.0
    if part > _STRONG:
        yield Diagnostic(code="ends_in_strong_motion", size=part, bound=_STRONG)


def _of_places(components: Sequence[Component]) -> Iterator[Diagnostic]:
    for axis, part in zip("xyz", components, strict=False):
        if part.direction is not None and part.direction != axis:
            yield Diagnostic(code="other_direction", detail=f"{axis} is {part.direction}")
            return
