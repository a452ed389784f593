"""Intensity measures of a ground motion of two components.

Each is one number that grows in proportion with the motion, so a motion has a given intensity after one
scaling. The resultant is the horizontal vector, whose size no turn of the axes changes; a geometric mean is
of the two components as they are recorded.
"""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from functools import cache

import numpy as np
from numpy.typing import NDArray

from rockwobble.models import GroundMotion, RockingBody, Tendon
from rockwobble.models.number_checks import require_one_of, require_positive

Array = NDArray[np.float64]

DAMPING = 0.05  # damping ratio of response spectra
# samples of a period: between two of them a sine is at most 0.5 % above the larger
_FINE = 32


@dataclass(frozen=True, slots=True, kw_only=True)
class Measure:
    """A kind of intensity.

    Attributes
    ----------
    title : str
        With its symbols, for axes and tables.
    unit : str
        "-" for a number.
    """

    title: str
    unit: str


# peak acceleration in the unit of sliding: equally efficient, and only on request
OVER_FRICTION = "peak_over_friction"
MEASURES: Mapping[str, Measure] = {
    "peak_acceleration": Measure(title="peak acceleration / g tan α", unit="-"),
    OVER_FRICTION: Measure(title="peak acceleration / g μ", unit="-"),
    "peak_velocity": Measure(title="p × peak velocity / g tan α", unit="-"),
    "pga": Measure(title="PGA", unit="g"),
    "pgv": Measure(title="PGV", unit="m/s"),
    "sa": Measure(title="Sa", unit="g"),
    "sa_mean": Measure(title="Sa, geometric mean", unit="g"),
}


def intensity(
    name: str,
    motion: GroundMotion,
    cylinder: RockingBody,
    *,
    gravity: float = 9.81,
    period: float = 1.0,
    friction: float = 1.0,
) -> float:
    """Intensity of a ground motion for a cylinder.

    Parameters
    ----------
    name : str
        One of `MEASURES`.
    motion : GroundMotion
        Its vertical component, if there is one, has no part in it.
    cylinder : Cylinder or WobblingFrame
    gravity : float, optional
        g [m/s^2].
    period : float, optional
        Period of the oscillator of "sa" and "sa_mean" [s].
    friction : float, optional
        Coefficient of cylinder and ground, of "peak_over_friction".

    Raises
    ------
    ValueError
        If the name is unknown, a number is not positive, or the motion has no such intensity because a
        component is zero throughout.

    Examples
    --------
    >>> from rockwobble.models import el_centro_1940
    >>> from rockwobble.models import Cylinder
    >>> pier = Cylinder(semidiagonal=6.0, tan_alpha=0.2)
    >>> round(intensity("peak_acceleration", el_centro_1940(), pier), 3)
    1.432
    """
    require_one_of("an intensity", name, MEASURES)
    require_positive("gravity", gravity, "m/s^2")
    require_positive("period", period, "s")
    if name == OVER_FRICTION:
        require_positive("friction of peak_over_friction", friction)
        return motion.peak / (gravity * friction)
    value = _value(name, motion, cylinder, gravity, period)
    if not value > 0.0:
        raise ValueError(f"the motion {motion.name!r} has no {name}: a component is zero throughout")
    return value


def velocity(motion: GroundMotion, *, centred: bool = False) -> Array:
    """Horizontal velocity of the ground (n, 2) [m/s], from rest at the first sample.

    Of the acceleration as it is, or `centred`: without its mean, so that the velocity does not drift.
    """
    a = motion.acceleration[:, :2]
    if centred:
        a = a - a.mean(axis=0)
    steps = 0.5 * motion.time_step * (a[1:] + a[:-1])
    return np.vstack([np.zeros(2), np.cumsum(steps, axis=0)])


def pseudo_acceleration(motion: GroundMotion, period: float) -> Array:
    """Return omega^2 times the displacement (n, 2) [m/s^2] of a damped oscillator during the motion.

    Exact for a ground acceleration that is linear between samples (N. C. Nigam and P. C. Jennings, Bull.
    Seismol. Soc. Am. 59, 909-922, 1969). Coarse motions are sampled finer first: no peak is missed.
    """
    from scipy.signal import lfilter

    parts = max(1, math.ceil(_FINE * motion.time_step / period))
    count = len(motion.acceleration)
    places = np.arange((count - 1) * parts + 1) / parts
    a = np.column_stack([np.interp(places, np.arange(count), motion.acceleration[:, i]) for i in (0, 1)])
    numerator, denominator = _oscillator(period, motion.time_step / parts)
    return np.asarray(lfilter(numerator, denominator, -a, axis=0), dtype=np.float64)


@cache  # the transfer function takes longer than the motion, and most motions have equal steps
def _oscillator(period: float, step: float) -> tuple[Array, Array]:
    """Transfer function from -a to omega^2 x with first-order hold: numerator, denominator."""
    from scipy.signal import cont2discrete

    omega = 2.0 * math.pi / period
    transfer = np.array([omega**2]), np.array([1.0, 2.0 * DAMPING * omega, omega**2])
    numerator, denominator, _ = cont2discrete(transfer, step, method="foh")
    return np.ravel(numerator), denominator


def _value(name: str, motion: GroundMotion, cylinder: RockingBody, gravity: float, period: float) -> float:
    uplift = gravity * cylinder.tan_alpha
    if name == "peak_acceleration":
        return motion.peak / uplift
    if name == "peak_velocity":
        return largest_resultant(velocity(motion)) / velocity_unit(cylinder, gravity)
    if name == "pgv":
        return _mean_of_peaks(velocity(motion))
    if name == "pga":
        return _mean_of_peaks(motion.acceleration[:, :2]) / gravity
    response = pseudo_acceleration(motion, period)
    return (largest_resultant(response) if name == "sa" else _mean_of_peaks(response)) / gravity


def velocity_unit(cylinder: RockingBody, gravity: float = 9.81) -> float:
    """Return g tan(alpha)/p, the unit of peak velocities of a cylinder [m/s]."""
    from rockwobble.reduced.body import body_of  # late import, as the package loads a compiler

    return gravity * cylinder.tan_alpha / body_of(cylinder, gravity).p


def uplift_scale(
    motion: GroundMotion, cylinder: RockingBody, gravity: float = 9.81, tendon: Tendon | None = None
) -> float:
    """Least factor on a motion that uplifts a cylinder; infinite if none does.

    From (25), |a| = (g + az) tan(alpha): |a| - az tan(alpha) is convex between two samples, so that it is
    largest at one. A tendon adds its prestress to g; rolling resistance, which raises the threshold, too, is
    left out.
    """
    held = 1.0 if tendon is None else tendon.uplift_factor(cylinder)
    a = motion.acceleration
    needed = np.hypot(a[:, 0], a[:, 1])
    if a.shape[1] > 2:
        needed = needed - a[:, 2] * cylinder.tan_alpha
    largest = float(needed.max())
    return gravity * cylinder.tan_alpha * held / largest if largest > 0.0 else math.inf


def measures_of(
    motions: Sequence[GroundMotion], cylinder: RockingBody, *, gravity: float = 9.81, period: float = 1.0
) -> dict[str, list[float]]:
    """Every intensity of every motion except `OVER_FRICTION`; NaN where undefined."""
    names = [name for name in MEASURES if name != OVER_FRICTION]
    values = {name: [_value(name, motion, cylinder, gravity, period) for motion in motions] for name in names}
    return {name: [each if each > 0.0 else math.nan for each in of] for name, of in values.items()}


def largest_resultant(components: Array) -> float:
    """Largest length of horizontal vectors (n, 2)."""
    return float(np.hypot(components[:, 0], components[:, 1]).max())


def _mean_of_peaks(components: Array) -> float:
    return float(np.sqrt(np.prod(np.abs(components).max(axis=0))))
