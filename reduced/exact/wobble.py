"""Steady wobble: constant tilt, held by the rolling of the contact point around the rim.

Equation (24) without its misprints: W^2 = 2 m g (b cos theta - h sin theta)/B', where B' is the
derivative of the inertia of the rolling angle. A thin disc in a recess has W^2 = 4 g cos theta/
(b sin theta (6 - 5 cos theta)).
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import overload

import numpy as np
from numpy.typing import NDArray

from rockwobble.models import Cylinder

from ._checks import body_under, require_tilts
from ._shape import inertia_growth


@overload
def steady_wobble_rate(cylinder: Cylinder, tilt: float, *, gravity: float = ...) -> float: ...
@overload
def steady_wobble_rate(
    cylinder: Cylinder, tilt: NDArray[np.float64] | Sequence[float], *, gravity: float = ...
) -> NDArray[np.float64]: ...
def steady_wobble_rate(
    cylinder: Cylinder, tilt: float | NDArray[np.float64] | Sequence[float], *, gravity: float = 9.81
) -> float | NDArray[np.float64]:
    """Return the rolling rate W at which the recess model wobbles with constant tilt.

    Parameters
    ----------
    cylinder : Cylinder
        The body.
    tilt : float or array_like
        The constant tilt [rad], 0 < tilt < alpha.
    gravity : float, optional
        g [m/s^2].

    Returns
    -------
    float or ndarray of the shape of `tilt`
        W, the positive one of the two rates [rad/s]. Equation (24), corrected.

    Raises
    ------
    ValueError
        If a tilt is outside the open range from 0 to alpha, or gravity is not positive.

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
    body = body_under(cylinder, gravity)
    theta = require_tilts(tilt, body.alpha)
    t = np.tan(0.5 * theta)
    # 2 V'/B' with V' = g R sin(alpha - theta) and B' = 4 t K/n^2
    moment = body.g * cylinder.semidiagonal * np.sin(body.alpha - theta)
    rate = (1.0 + t * t) * np.sqrt(0.5 * moment / (t * inertia_growth(body, t)))
    return rate if np.ndim(tilt) else float(rate)


@overload
def wobbling_period(cylinder: Cylinder, tilt: float, *, gravity: float = ...) -> float: ...
@overload
def wobbling_period(
    cylinder: Cylinder, tilt: NDArray[np.float64] | Sequence[float], *, gravity: float = ...
) -> NDArray[np.float64]: ...
def wobbling_period(
    cylinder: Cylinder, tilt: float | NDArray[np.float64] | Sequence[float], *, gravity: float = 9.81
) -> float | NDArray[np.float64]:
    """Return the period of steady wobble, in which the contact point goes once around the rim.

    Parameters
    ----------
    cylinder : Cylinder
        The body.
    tilt : float or array_like
        The constant tilt [rad], 0 < tilt < alpha.
    gravity : float, optional
        g [m/s^2].

    Returns
    -------
    float or ndarray of the shape of `tilt`
        2 pi/W [s], W of `steady_wobble_rate`. Equation (24), corrected.

    Raises
    ------
    ValueError
        If a tilt is outside the open range from 0 to alpha, or gravity is not positive.

    Examples
    --------
    >>> from rockwobble.models import Cylinder
    >>> pier = Cylinder(semidiagonal=6.0, tan_alpha=0.2)
    >>> round(wobbling_period(pier, 0.5 * pier.alpha), 6)
    5.632861
    """
    period = 2.0 * np.pi / steady_wobble_rate(cylinder, np.asarray(tilt), gravity=gravity)
    return period if np.ndim(tilt) else float(period)
