"""Scene of a run, as every engine gets it: body, start, gravity and friction at one size, and its scale.

b     base radius                              [m]
h     height of the mass centre above the base [m]
I1    transverse inertia about the mass centre [m^2], per unit mass, equation (16)
I2    axial inertia                            [m^2], per unit mass, equation (16)

A column of a frame carries its share of a slab, whose mass is `slab_mass_ratio` times its own. Where neither
end slips, the slab has the velocity of the highest point of the top, twice that of the mass centre.

The start: a body of revolution in a recess turns with psi = -phi, so its quaternion has no z component, and
its velocity is a pure turning about the contact point: v = omega x (S - T).

Froude scaling: every scene runs at one size and one gravity, and the result is scaled back. With all lengths
times F, times go with sqrt(F/g): the mechanics does not change, but tolerances of an engine are absolute. At
one reference size only tan(alpha) changes the scene, and a cylinder of 1 cm is computed as accurately as one
of 100 m.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from rockwobble.models import InitialState, RockingBody
from rockwobble.models.bounds import OVERTURNED_TILT
from rockwobble.models.mode import ROCKS
from rockwobble.models.support import Support

from .restraint import WEIGHT_ALONE, Restraint

Array = NDArray[np.float64]


@dataclass(frozen=True, slots=True, kw_only=True)
class Body:
    """A body of revolution on a circular base; everything per unit mass."""

    base_radius: float
    mass_centre_height: float
    height: float
    transverse_inertia: float
    axial_inertia: float
    slab_mass_ratio: float = 0.0

    @property
    def effective_mass(self) -> float:
        """Mass at the mass centre with the work of gravity on column and slab, moved twice as far [-]."""
        return 1.0 + 2.0 * self.slab_mass_ratio

    @property
    def moved_mass(self) -> float:
        """Mass at the mass centre with the kinetic energy of column and slab [-]."""
        return 1.0 + 4.0 * self.slab_mass_ratio

    @property
    def velocity_ratios(self) -> tuple[float, ...]:
        """Velocity of each carried mass, at the base first, over that of the mass centre [-]."""
        slab = self.slab_mass_ratio
        return (1.0,) if slab == 0.0 else (self.effective_mass / (1.0 + slab), 2.0)

    @property
    def tan_alpha(self) -> float:
        """b/h [-]."""
        return self.base_radius / self.mass_centre_height


def scaled_body(cylinder: RockingBody, length: float) -> Body:
    """Return the body of `cylinder` with every length divided by `length`.

    Inertias that the cylinder leaves out are those of a homogeneous solid cylinder of its outline,
    I1 = (3 b^2 + height^2)/12 and I2 = b^2/2.
    """
    radius = cylinder.base_radius / length
    height = 2.0 * cylinder.half_height / length
    transverse, axial = cylinder.transverse_inertia, cylinder.axial_inertia
    return Body(
        base_radius=radius,
        mass_centre_height=cylinder.mass_centre_height / length,
        height=height,
        transverse_inertia=(3.0 * radius**2 + height**2) / 12.0
        if transverse is None
        else transverse / length**2,
        axial_inertia=0.5 * radius**2 if axial is None else axial / length**2,
        slab_mass_ratio=cylinder.slab_mass_ratio,
    )


@dataclass(frozen=True, slots=True, eq=False)
class Start:
    """Pose and velocity of the mass centre, in a frame with its origin at O.

    Attributes
    ----------
    standing : bool
        Upright at rest; otherwise the cylinder leans on its rim.
    position, velocity : ndarray, shape (3,)
        Position and velocity of the mass centre [m], [m/s].
    quaternion : ndarray, shape (4,)
        Orientation, scalar first.
    angular_velocity : ndarray, shape (3,)
        In world axes [rad/s].
    """

    standing: bool
    position: Array
    quaternion: Array
    velocity: Array
    angular_velocity: Array


def starting_state(body: Body, initial: InitialState | None, time: float) -> Start:
    """Return the start of a run, with psi' = -phi' and no slip; `time` scales the rates to the scene.

    Equations (8) and (10) give the pose.
    """
    if initial is None or initial.tilt == 0.0:
        # with the x axis of the cylinder along that of the world its matrix is exactly the unit matrix; any
        # other heading leaves rounding, which plane-cylinder contact magnifies
        upright = np.array([0.0, 0.0, body.mass_centre_height])
        return Start(True, upright, np.array([1.0, 0.0, 0.0, 0.0]), np.zeros(3), np.zeros(3))
    theta, phi = initial.tilt, initial.rolling_angle
    theta_rate, phi_rate = initial.tilt_rate * time, initial.rolling_rate * time
    sine, cosine = math.sin(theta), math.cos(theta)
    versine = 2.0 * math.sin(0.5 * theta) ** 2
    outward = np.array([math.cos(phi), math.sin(phi), 0.0])
    forward = np.array([-math.sin(phi), math.cos(phi), 0.0])
    up = np.array([0.0, 0.0, 1.0])
    axis = sine * outward + cosine * up
    base_centre = body.base_radius * (versine * outward + sine * up)
    position = base_centre + body.mass_centre_height * axis
    half = 0.5 * theta
    quaternion = np.array(
        [math.cos(half), -math.sin(half) * math.sin(phi), math.sin(half) * math.cos(phi), 0.0]
    )
    angular_velocity = phi_rate * (up - axis) + theta_rate * forward
    velocity = np.cross(angular_velocity, position - body.base_radius * outward)
    return Start(False, position, quaternion, velocity, angular_velocity)


REFERENCE_SEMIDIAGONAL = 6.0  # [m] size of the examples, at which contact settings were measured
REFERENCE_GRAVITY = 9.81  # [m/s^2]
REFERENCE_TIME_STEP = 1e-4  # [s] at the reference size


@dataclass(frozen=True, slots=True)
class Scale:
    """Units of the reference scene in metres and seconds of the user.

    Attributes
    ----------
    length : float
        User metres for each reference metre.
    time : float
        User seconds for each reference second.
    """

    length: float
    time: float

    @property
    def acceleration(self) -> float:
        """User accelerations for each reference acceleration."""
        return self.length / self.time**2

    @property
    def energy(self) -> float:
        """User energies per unit mass for each reference one."""
        return (self.length / self.time) ** 2


def froude_scale(semidiagonal: float, gravity: float) -> Scale:
    """Scale from the reference scene to a semidiagonal [m] and a gravity [m/s^2]."""
    length = semidiagonal / REFERENCE_SEMIDIAGONAL
    return Scale(length, math.sqrt(length * REFERENCE_GRAVITY / gravity))


def default_step(semidiagonal: float, gravity: float) -> float:
    """Default time step [s], for a semidiagonal [m] and a gravity [m/s^2]."""
    return REFERENCE_TIME_STEP * froude_scale(semidiagonal, gravity).time


# least slope of the restoring couple, over that of the weight alone: bounds the waiting time at a balance
# where a restraint cancels nearly all of it to ten times
_LEAST_GROWTH = 0.01


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class Scene:
    """One run in engine-independent terms, at the reference size and gravity.

    Attributes
    ----------
    body : Body
    start : Start
    support : Support
        What holds the cylinder in its place.
    friction : float
        Coefficient of the pair cylinder and ground [-].
    rolling_resistance : float
        Length of the couple of the ground against rolling [m]; 0 for an engine without rolling friction.
    time_step : float
        h [s].
    gravity : float
        [m/s^2].
    components : str
        Components of the ground acceleration that are not absent, such as "xy" or "".
    unit_time : float
        User seconds in one second of the scene: settings that are times are in user seconds.
    restraint : Restraint, optional
        What holds the body down besides its weight; nothing that is not among the terms of the engine.
    mode : str
        Mode of motion to expect, by which an engine chooses its contact.
    """

    body: Body
    start: Start
    support: Support
    friction: float
    time_step: float
    gravity: float
    components: str
    unit_time: float
    rolling_resistance: float = 0.0
    restraint: Restraint = WEIGHT_ALONE
    mode: str = ROCKS

    @property
    def tipping_gravity(self) -> float:
        """Gravity whose weight alone holds the base down as weight and restraint do [m/s^2].

        Without vertical motion the base opens at b/h of it; what tips a frame are twice the forces of its
        slab.
        """
        return self.gravity + self.restraint.gaps * self.restraint.prestress / self.body.effective_mass

    @property
    def pressing_gravity(self) -> float:
        """Gravity whose weight alone presses a closed base as weight and restraint do [m/s^2]."""
        return self.gravity + self.restraint.prestress / (1.0 + self.body.slab_mass_ratio)

    @property
    def balance_tilt(self) -> float:
        """Tilt beyond which the base does not close by itself [rad]; infinite without one up to pi/2."""
        alpha = math.atan(self.body.tan_alpha)
        if not self.restraint.is_active:
            return alpha
        low, high = alpha, OVERTURNED_TILT
        if self._couple(high) >= 0.0:
            return math.inf
        while low < (middle := 0.5 * (low + high)) < high:
            low, high = (middle, high) if self._couple(middle) > 0.0 else (low, middle)
        return low

    @property
    def growth_time(self) -> float:
        """Time in which a small distance from the balance grows by e [s]; 1/p without a balance."""
        body, b, h = self.body, self.body.base_radius, self.body.mass_centre_height
        inertia = (body.transverse_inertia + body.moved_mass * (h * h + b * b)) / body.effective_mass
        weight = growth = self.gravity * math.hypot(b, h)
        tilt = self.balance_tilt
        if self.restraint.is_active and math.isfinite(tilt):
            # absolute slope of the couple there
            growth = self.gravity * (b * math.sin(tilt) + h * math.cos(tilt))
            growth -= self.restraint.couple_slope(tilt, b) / body.effective_mass
        return math.sqrt(inertia / max(growth, _LEAST_GROWTH * weight))

    def _couple(self, tilt: float) -> float:
        """Couple of weight and restraint at a tilt [rad], towards upright, in a plane [m^2/s^2]."""
        body = self.body
        b, h = body.base_radius, body.mass_centre_height
        weight = body.effective_mass * self.gravity * (b * math.cos(tilt) - h * math.sin(tilt))
        return weight + self.restraint.couple(tilt, b)
