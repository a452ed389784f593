"""The constants of the equations of motion, per unit mass.

A column of a frame carries the share gamma m of a slab, which moves with twice the velocity of its mass
centre S. Its translation then has the inertia of k m, k = 1 + 4 gamma, while gravity and the ground move
w m, w = 1 + 2 gamma. Per unit of the latter mass its equations are those of a cylinder, k = w = 1, with
other constants.

====== ======== =============================================================== ========
symbol unit     meaning                                                         source
====== ======== =============================================================== ========
b      m        base radius                                                     Fig. 1
h      m        height of the mass centre S above the base                      Fig. 1
I1     m^2      transverse inertia about S, over w                              (16)
I2     m^2      axial inertia, over w                                           (16)
mu     -        k/w, 1 without a slab
A      m^2      J + mu b^2, transverse inertia about a point of the rim         (23)
J      m^2      I1 + mu h^2, transverse inertia about the centre of the base    (18)
C      m^2      I2 + mu b^2                                                     (18)
E      m^2      mu h b                                                          (18)
nu     -        w/(1 + gamma), force at the base for an acceleration of S over
                that for the same acceleration of the ground
g      m/s^2    gravity                                                         (17)
p      1/s      sqrt(g R/A), frequency parameter; p2 is its square              (23)
delta  m        length of rolling resistance; 0 in the paper
        rad      `balance`, tilt beyond which the body falls if nothing moves it: alpha
        1/s      `fastest` rate of the couple near upright: p
====== ======== =============================================================== ========
"""

from __future__ import annotations

import math
from typing import NamedTuple

from rockwobble.models import RockingBody


class Body(NamedTuple):
    """Constants of a cylinder or frame in one field of gravity; symbols in the module docstring."""

    b: float
    h: float
    I1: float
    I2: float
    A: float
    J: float
    C: float
    E: float
    g: float
    p2: float
    sin_alpha: float
    cos_alpha: float
    alpha: float
    p: float
    mu: float
    nu: float
    delta: float
    balance: float
    fastest: float


def body_of(cylinder: RockingBody, gravity: float, rolling_resistance: float = 0.0) -> Body:
    """Return the constants of `cylinder` under `gravity` [m/s^2] with a length of rolling resistance [m]."""
    b, h = cylinder.base_radius, cylinder.mass_centre_height
    height = 2.0 * cylinder.half_height
    I1 = cylinder.transverse_inertia
    I2 = cylinder.axial_inertia
    if I1 is None:
        I1 = (3.0 * b * b + height * height) / 12.0
    if I2 is None:
        I2 = 0.5 * b * b
    gamma = cylinder.slab_mass_ratio
    w = 1.0 + 2.0 * gamma
    mu = (1.0 + 4.0 * gamma) / w
    I1, I2 = I1 / w, I2 / w
    A = I1 + mu * h * h + mu * b * b
    R = cylinder.semidiagonal
    p2 = gravity * R / A
    alpha = math.atan(cylinder.tan_alpha)
    return Body(
        b=b,
        h=h,
        I1=I1,
        I2=I2,
        A=A,
        J=I1 + mu * h * h,
        C=I2 + mu * b * b,
        E=mu * h * b,
        g=gravity,
        p2=p2,
        sin_alpha=b / R,
        cos_alpha=h / R,
        alpha=alpha,
        p=p2**0.5,
        mu=mu,
        nu=w / (1.0 + gamma),
        delta=rolling_resistance,
        balance=alpha,
        fastest=p2**0.5,
    )


def restitution_from_momentum(cylinder: RockingBody) -> float:
    """Return the ratio of tilt rates at an impact that conserves the moment of momentum.

    About the new pivot, r = (J - mu b^2)/A; (16 - 25 sin^2 alpha)/(16 - sin^2 alpha) for the
    homogeneous cylinder. Bodies too squat to rock (tan alpha > 4/3) get 0: they stop. In a frame the
    impulses at the new contacts of base and top do no work in the motion after the impact.

    Parameters
    ----------
    cylinder : Cylinder or WobblingFrame
        Alone or in a frame.

    Returns
    -------
    float
        r, rate after over rate before [-].

    Examples
    --------
    >>> from rockwobble.models import Cylinder
    >>> round(restitution_from_momentum(Cylinder(semidiagonal=6.0, tan_alpha=0.2)), 5)
    0.94217
    """
    body = body_of(cylinder, 1.0)
    return max(0.0, (body.J - body.mu * body.b * body.b) / body.A)
