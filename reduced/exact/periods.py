"""Periods in closed form: of planar rocking without impact losses, and of steady wobble.

Planar rocking: with L = 0 the cylinder is an inverted pendulum about the rim, A theta'' = -g R sin(alpha -
theta) for theta > 0 and its mirror image for theta < 0 (equation 21 with phi' = 0). Energy gives theta'^2 = 2
p^2 [cos(alpha - tilt) - cos(alpha - theta)], and with x = sin((alpha - theta)/2) the time from upright to the
maximum is an incomplete elliptic integral of the first kind,

    p T/4 = int_k^K dx/sqrt((1 - x^2)(x^2 - k^2)),    k = sin((alpha - tilt)/2),  K = sin(alpha/2),

in Carlson's form (DLMF 19.29.4), which loses no digits at either end of 0 < tilt < alpha. With a tendon it is
the quadrature of a pass as near as can be (`quadrature`).

Steady wobble is constant tilt, held by the rolling of the contact point around the rim: equation (24) without
its misprints: W^2 = 2 V'/B', where V' = m g (b cos theta - h sin theta), with
a tendon what that adds, and B' is the derivative of the inertia of the
rolling angle. A thin disc in a recess has W^2 = 4 g cos theta/ (b sin theta (6 - 5 cos theta)).
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from functools import wraps
from typing import Protocol, cast, overload

import numpy as np
from numpy.typing import ArrayLike, NDArray

from rockwobble.models import RockingBody, Tendon
from rockwobble.models.bounds import OVERTURNED_TILT

from ..body import Body
from ..restoring import TiedBody, constants_of, couple
from ._shape import inertia_growth
from ._turning import momentum_growth
from .quadrature import half_period

Array = NDArray[np.float64]


class _OfTilts(Protocol):
    """A function of one tilt, or of each in an array."""

    @overload
    def __call__(
        self, cylinder: RockingBody, tilt: float, *, gravity: float = ..., tendon: Tendon | None = ...
    ) -> float: ...
    @overload
    def __call__(
        self,
        cylinder: RockingBody,
        tilt: Array | Sequence[float],
        *,
        gravity: float = ...,
        tendon: Tendon | None = ...,
    ) -> Array: ...


def _of_tilts(function: Callable[..., Array]) -> _OfTilts:
    """Make a function of an array accept one tilt, and refuse tilts not between 0 and the balance."""

    @wraps(function)
    def wrapper(
        cylinder: RockingBody, tilt: ArrayLike, *, gravity: float = 9.81, tendon: Tendon | None = None
    ) -> float | Array:
        theta, largest, name = np.asarray(tilt, dtype=float), cylinder.alpha, "alpha"
        if tendon is not None:
            largest = min(constants_of(cylinder, gravity, tendon=tendon).balance, OVERTURNED_TILT)
            name = "the balance tilt" if largest < OVERTURNED_TILT else "pi/2"
        outside = ~((theta > 0.0) & (theta < largest))  # NaN counts as outside
        if np.any(outside):
            first = float(np.extract(outside, theta)[0])
            raise ValueError(f"tilt must be above 0 and below {name} = {largest!r} [rad], got {first!r}")
        values = function(cylinder, theta, gravity=gravity, tendon=tendon)
        return values if np.ndim(tilt) else float(values)

    return cast("_OfTilts", wrapper)


@_of_tilts
def planar_quarter_period(
    cylinder: RockingBody, tilt: Array, *, gravity: float = 9.81, tendon: Tendon | None = None
) -> Array:
    """Return the time of planar rocking from rest at `tilt` to the upright position.

    Parameters
    ----------
    cylinder : Cylinder or WobblingFrame
        The body.
    tilt : float or array_like
        Tilt at release [rad], 0 < tilt < alpha, or below the balance tilt of a tendon.
    gravity : float, optional
        g [m/s^2].
    tendon : Tendon, optional
        Along the axis.

    Returns
    -------
    float or ndarray of the shape of `tilt`
        Quarter period [s].

    Raises
    ------
    ValueError
        If a tilt is outside that open range, or gravity is not positive.

    Notes
    -----
    Housner's acosh(1/(1 - tilt/alpha))/p is its limit for slender cylinders.

    Examples
    --------
    >>> from rockwobble.models import Cylinder
    >>> pier = Cylinder(semidiagonal=6.0, tan_alpha=0.2)
    >>> planar_quarter_period(pier, [0.2 * pier.alpha, 0.8 * pier.alpha]).round(6)
    array([0.626609, 2.068604])
    """
    body = constants_of(cylinder, gravity, tendon=tendon)
    return quarter_period(body, cylinder.semidiagonal, tilt, body.alpha - tilt)


@_of_tilts
def rocking_period(
    cylinder: RockingBody, tilt: Array, *, gravity: float = 9.81, tendon: Tendon | None = None
) -> Array:
    """Return the period of planar rocking released from rest at `tilt`.

    Parameters
    ----------
    cylinder : Cylinder or WobblingFrame
        The body.
    tilt : float or array_like
        Tilt at release [rad], 0 < tilt < alpha, or below the balance tilt of a tendon.
    gravity : float, optional
        g [m/s^2].
    tendon : Tendon, optional
        Along the axis.

    Returns
    -------
    float or ndarray of the shape of `tilt`
        Full cycle [s]: from rest at `tilt` over the opposite rim back to rest at `tilt`, four quarter
        periods, without loss at impact. The tilt itself, which has no sign in the recess model, repeats
        after half of it.

    Raises
    ------
    ValueError
        If a tilt is outside that open range, or gravity is not positive.

    Examples
    --------
    >>> from rockwobble.models import Cylinder
    >>> pier = Cylinder(semidiagonal=6.0, tan_alpha=0.2)
    >>> round(rocking_period(pier, 0.5 * pier.alpha), 6)
    4.756815
    """
    return 4.0 * planar_quarter_period(cylinder, tilt, gravity=gravity, tendon=tendon)


def quarter_period(body: Body, R: float, theta: Array, gap: Array) -> Array:
    """Return the quarter period [s] of a maximum tilt `theta`, where `gap` is alpha - theta."""
    from scipy.special import elliprf

    if isinstance(body, TiedBody):
        # limit for a narrow pass
        return np.vectorize(lambda t2, gap2: half_period(body, R, t2, gap2))(np.tan(0.5 * theta), gap)
    k, k1 = np.sin(0.5 * gap), np.cos(0.5 * gap)
    K, K1 = np.sin(0.5 * body.alpha), np.cos(0.5 * body.alpha)
    width = np.sin(body.alpha - 0.5 * theta) * np.sin(0.5 * theta)  # K^2 - k^2
    phase = np.sqrt(width) * elliprf((k * k1) ** 2, (K * k1) ** 2, (K1 * k) ** 2)
    return np.asarray(phase / np.sqrt(body.p2))


@_of_tilts
def steady_wobble_rate(
    cylinder: RockingBody, tilt: Array, *, gravity: float = 9.81, tendon: Tendon | None = None
) -> Array:
    """Return the rolling rate W at which the recess model wobbles with constant tilt.

    Parameters
    ----------
    cylinder : Cylinder or WobblingFrame
        The body.
    tilt : float or array_like
        The constant tilt [rad], 0 < tilt < alpha, or below the balance tilt of a tendon.
    gravity : float, optional
        g [m/s^2].
    tendon : Tendon, optional
        Along the axis.

    Returns
    -------
    float or ndarray of the shape of `tilt`
        W, the positive one of the two rates [rad/s]. Equation (24), corrected.

    Raises
    ------
    ValueError
        If a tilt is outside that open range, or gravity is not positive.

    Notes
    -----
    At small tilt the wobble is stable; next to alpha it is unstable, and a little more spin overturns.

    Examples
    --------
    >>> from rockwobble.models import Cylinder
    >>> pier = Cylinder(semidiagonal=6.0, tan_alpha=0.2)
    >>> round(steady_wobble_rate(pier, 0.5 * pier.alpha), 6)
    1.115452
    """
    body = constants_of(cylinder, gravity, tendon=tendon)
    t = np.tan(0.5 * tilt)
    # 2 V'/B' with B' = 4 t K/n^2
    moment = couple(body, cylinder.semidiagonal, t, body.alpha - tilt)
    return np.asarray((1.0 + t * t) * np.sqrt(0.5 * moment / (t * inertia_growth(body, t))))


@_of_tilts
def wobble_stability(
    cylinder: RockingBody, tilt: Array, *, gravity: float = 9.81, tendon: Tendon | None = None
) -> Array:
    """Return the squared frequency at which the tilt oscillates about a steady wobble.

    Parameters
    ----------
    cylinder : Cylinder or WobblingFrame
        The body.
    tilt : float or array_like
        The constant tilt [rad], 0 < tilt < alpha, or below the balance tilt of a tendon.
    gravity : float, optional
        g [m/s^2].
    tendon : Tendon, optional
        Along the axis.

    Returns
    -------
    float or ndarray of the shape of `tilt`
        Second derivative of V + L^2/2B by the tilt over A, at the momentum L of the wobble [1/s^2]. Negative
        where the wobble is unstable: the tilt then leaves it as fast as exp of the root of its size.

    Raises
    ------
    ValueError
        If a tilt is outside that open range, or gravity is not positive.

    Examples
    --------
    >>> from rockwobble.models import Cylinder, Tendon
    >>> pier = Cylinder(semidiagonal=6.0, tan_alpha=0.2)
    >>> wobble_stability(pier, [0.5 * pier.alpha, 0.9 * pier.alpha]).round(4)
    array([ 2.4674, -0.8175])
    >>> round(wobble_stability(pier, 0.9 * pier.alpha, tendon=Tendon(stiffness=5.0)), 4)
    3.9817
    """
    body = constants_of(cylinder, gravity, tendon=tendon)
    t, R = np.tan(0.5 * tilt), cylinder.semidiagonal
    return np.asarray(momentum_growth(body, R, t, body.alpha - tilt) * (1.0 + t * t) / (2.0 * t * body.A))


@_of_tilts
def wobbling_period(
    cylinder: RockingBody, tilt: Array, *, gravity: float = 9.81, tendon: Tendon | None = None
) -> Array:
    """Return the period of steady wobble, in which the contact point goes once around the rim.

    Parameters
    ----------
    cylinder : Cylinder or WobblingFrame
        The body.
    tilt : float or array_like
        The constant tilt [rad], 0 < tilt < alpha, or below the balance tilt of a tendon.
    gravity : float, optional
        g [m/s^2].
    tendon : Tendon, optional
        Along the axis.

    Returns
    -------
    float or ndarray of the shape of `tilt`
        2 pi/W [s], W of `steady_wobble_rate`. Equation (24), corrected.

    Raises
    ------
    ValueError
        If a tilt is outside that open range, or gravity is not positive.

    Examples
    --------
    >>> from rockwobble.models import Cylinder
    >>> pier = Cylinder(semidiagonal=6.0, tan_alpha=0.2)
    >>> round(wobbling_period(pier, 0.5 * pier.alpha), 6)
    5.632861
    """
    return 2.0 * np.pi / steady_wobble_rate(cylinder, tilt, gravity=gravity, tendon=tendon)
