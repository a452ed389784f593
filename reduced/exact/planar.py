"""Planar rocking without impact losses: its period in closed form.

With L = 0 the cylinder is an inverted pendulum about the rim, A theta'' = -g R sin(alpha - theta) for
theta > 0 and its mirror image for theta < 0 (equation 21 with phi' = 0). Energy gives
theta'^2 = 2 p^2 [cos(alpha - tilt) - cos(alpha - theta)], and with x = sin((alpha - theta)/2) the time
from upright to the maximum is an incomplete elliptic integral of the first kind,

    p T/4 = int_k^K dx/sqrt((1 - x^2)(x^2 - k^2)),    k = sin((alpha - tilt)/2),  K = sin(alpha/2),

in Carlson's form (DLMF 19.29.4), which loses no digits at either end of 0 < tilt < alpha.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import overload

import numpy as np
from numpy.typing import NDArray

from rockwobble.models import Cylinder

from ..body import Body
from ._checks import body_under, require_tilts


@overload
def planar_quarter_period(cylinder: Cylinder, tilt: float, *, gravity: float = ...) -> float: ...
@overload
def planar_quarter_period(
    cylinder: Cylinder, tilt: NDArray[np.float64] | Sequence[float], *, gravity: float = ...
) -> NDArray[np.float64]: ...
def planar_quarter_period(
    cylinder: Cylinder, tilt: float | NDArray[np.float64] | Sequence[float], *, gravity: float = 9.81
) -> float | NDArray[np.float64]:
    """Return the time of planar rocking from rest at `tilt` to the upright position.

    Parameters
    ----------
    cylinder : Cylinder
        The body.
    tilt : float or array_like
        Tilt at release [rad], 0 < tilt < alpha.
    gravity : float, optional
        g [m/s^2].

    Returns
    -------
    float or ndarray of the shape of `tilt`
        Quarter period [s].

    Raises
    ------
    ValueError
        If a tilt is outside the open range from 0 to alpha, or gravity is not positive.

    Notes
    -----
    Housner's acosh(1/(1 - tilt/alpha))/p is its limit for slender cylinders.

    Examples
    --------
    >>> pier = Cylinder(semidiagonal=6.0, tan_alpha=0.2)
    >>> planar_quarter_period(pier, [0.2 * pier.alpha, 0.8 * pier.alpha]).round(6)
    array([0.626609, 2.068604])
    """
    body = body_under(cylinder, gravity)
    theta = require_tilts(tilt, body.alpha)
    quarter = quarter_period(body, theta, body.alpha - theta)
    return quarter if np.ndim(tilt) else float(quarter)


@overload
def rocking_period(cylinder: Cylinder, tilt: float, *, gravity: float = ...) -> float: ...
@overload
def rocking_period(
    cylinder: Cylinder, tilt: NDArray[np.float64] | Sequence[float], *, gravity: float = ...
) -> NDArray[np.float64]: ...
def rocking_period(
    cylinder: Cylinder, tilt: float | NDArray[np.float64] | Sequence[float], *, gravity: float = 9.81
) -> float | NDArray[np.float64]:
    """Return the period of planar rocking released from rest at `tilt`.

    Parameters
    ----------
    cylinder : Cylinder
        The body.
    tilt : float or array_like
        Tilt at release [rad], 0 < tilt < alpha.
    gravity : float, optional
        g [m/s^2].

    Returns
    -------
    float or ndarray of the shape of `tilt`
        Full cycle [s]: from rest at `tilt` over the opposite rim back to rest at `tilt`, four quarter
        periods, without loss at impact. The tilt itself, which has no sign in the recess model, repeats
        after half of it.

    Raises
    ------
    ValueError
        If a tilt is outside the open range from 0 to alpha, or gravity is not positive.

    Examples
    --------
    >>> from rockwobble.models import Cylinder
    >>> pier = Cylinder(semidiagonal=6.0, tan_alpha=0.2)
    >>> round(rocking_period(pier, 0.5 * pier.alpha), 6)
    4.756815
    """
    body = body_under(cylinder, gravity)
    theta = require_tilts(tilt, body.alpha)
    period = 4.0 * quarter_period(body, theta, body.alpha - theta)
    return period if np.ndim(tilt) else float(period)


def quarter_period(body: Body, theta: NDArray[np.float64], gap: NDArray[np.float64]) -> NDArray[np.float64]:
    """Return the quarter period [s] of a maximum tilt `theta`, where `gap` is alpha - theta."""
    from scipy.special import elliprf

    k, k1 = np.sin(0.5 * gap), np.cos(0.5 * gap)
    K, K1 = np.sin(0.5 * body.alpha), np.cos(0.5 * body.alpha)
    width = np.sin(body.alpha - 0.5 * theta) * np.sin(0.5 * theta)  # K^2 - k^2
    phase = np.sqrt(width) * elliprf((k * k1) ** 2, (K * k1) ** 2, (K1 * k) ** 2)
    return np.asarray(phase / np.sqrt(body.p2))
