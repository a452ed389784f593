"""Drake: point contact in discrete time, solved as a convex problem with a lagged friction cone.

What it needs:

* Its cylinder finds one contact on the ground, on which a flat base does not stand. So the rim of a base that
  is nearly flat has four points besides, tiny spheres. As fixed corners they would be a polygon: the scene,
  and the cylinder about its axis, are turned until one is under the load, and then under the lean.
* The lagged cone takes for the load of a step how deep the rim is when it starts. Stiff contact yields to the
  weight by 1e-9 m; by as much the lowest point sinks or rises in a step along the curvature of its path,
  which no velocity shows. A rim that rises would have no friction, and hop. So each step is taken in a frame
  that moves up by what the last two steps sank, and the rim starts it as deep as its load presses it.
* Friction stops the point of the rim that a step starts on, and a rim that rolls on creeps. So the frame
  moves along the ground as well, against the slip that the last step left at the rim of this pose.
* A quaternion that is stepped by its rate grows, and with it the lean that it tells: it is brought back.
* Its solver stops when what it leaves over of a step is 1e-6 of all momentum, and has no other tolerance to
  choose. That is a force, and the larger the smaller the step: the next step is given it.
* Half of its time goes into what surrounds the solver. So a step asks its plant for the acceleration alone,
  not its simulator for a state, and geometry that cannot touch is in another plant.
"""

from __future__ import annotations

import contextlib
import math
from collections.abc import Iterator, Sequence
from typing import NamedTuple

import numpy as np

from rockwobble.models.support import SUPPORTS

from ..body import Body
from ..facts import EngineFacts
from ..kinematics import about_vertical, turning
from ..protocol import Array, Scene, Settings, Stepper, Steps
from .declared import Declared
from .drake_scene import POINTS, build
from .scene_counts import SceneCounts
from .settings.drake import DrakeSettings

_FLAT = 2e-3  # [rad] lean up to which a point carries the rim: the cylinder itself is not found below 1e-3
_LEANS = 1e-8  # [rad] from which a lean has a direction; what stands leans by 1e-9
_LOADED = 0.5  # of b, eccentricity of the load from which the scene follows it

_FACTS = EngineFacts(
    title="Drake", step_time=1.5e-4, release_error=4e-6, uplift_error=5e-6, smooth_uplift=True
)


class DrakeEngine(Declared):
    """Drake: multibody plant in discrete time, half space, cylinder with points on its rim."""

    package, settings_type, facts = "drake", DrakeSettings, _FACTS  # its points of the rim carry a flat base

    @contextlib.contextmanager
    def open(self, scene: Scene, settings: Settings) -> Iterator[Stepper]:
        """Open the scene at its start; Python frees it when nothing refers to it any more."""
        yield _DrakeStepper(scene, DrakeSettings(**settings))


class _DrakeStepper:
    def __init__(self, scene: Scene, settings: DrakeSettings) -> None:
        self._scene, self._step = scene, scene.time_step
        # guide_stiffness is in the time of the user; of both halves of the guide, torque for each twist
        stiffness = settings.guide_stiffness * scene.unit_time**2 * scene.body.axial_inertia
        self._stiffness = stiffness if SUPPORTS[scene.support].guided else 0.0
        self._standing, self._rolling = build(scene, settings, POINTS), build(scene, settings, 0)
        self._last = self._standing  # what took the last step
        self._overshoot = settings.friction_damping - 1.0
        self._left = np.zeros(6)  # what the solver left of the last step, torque and force
        self._warning = ""
        self._heading = 0.0  # azimuth of the x axis of the scene in the world [rad]
        self._spun = 0.0  # angle about its axis that has been taken off the cylinder [rad]
        start = scene.start
        self._depth = scene.gravity / settings.contact_stiffness
        self._position, self._quaternion = start.position, start.quaternion
        # quaternion and position: floats, since the loop over steps in Python reads each of them
        place = [*start.quaternion.tolist(), *(start.position - [0.0, 0.0, self._depth]).tolist()]
        velocity = np.concatenate([start.angular_velocity, start.velocity])
        self._place, self._velocity = place, velocity
        self._rim = _Rim.of(place, scene.body)
        self._sinks = math.nan
        self._frame = np.zeros(3)  # velocity of the frame in which the ground keeps still in a step [m/s]
        if not start.standing:
            # leapfrog starts half a step back: a trial step shows the acceleration
            self._advance_once(np.zeros(6))
            self._place, self._velocity = place, 1.5 * velocity - 0.5 * self._velocity

    @property
    def hold_centre(self) -> float:
        """The new velocity moves the pose, as in leapfrog."""
        return 0.0

    def advance(self, acceleration: Array) -> Steps:
        """Take one step for each row of `acceleration`."""
        rows = np.array([self._caught(*each) for each in acceleration.tolist()])
        position, heading = rows[:, 4:7], rows[:, 7]
        quaternion = _spin(rows[:, :4], rows[:, 8])
        quaternion[:, 1:] = about_vertical(quaternion[:, 1:], heading)
        position = about_vertical(position, heading)
        position[:, 2] += self._depth
        velocity = np.diff(np.vstack([self._position, position]), axis=0) / self._step
        spin = turning(self._quaternion, quaternion) / self._step
        self._position, self._quaternion = position[-1], quaternion[-1]
        return Steps(position, quaternion, velocity, spin)

    def warnings(self) -> str:
        """Return what Drake raised where it could not go on."""
        return self._warning

    def counts(self) -> SceneCounts:
        """Return the counts of the last step: a normal and two directions of friction for each contact."""
        contacts = self._last.count_contacts()
        return SceneCounts(degrees_of_freedom=6, contacts=contacts, constraint_rows=3 * contacts)

    def _caught(self, ax: float, ay: float, az: float) -> list[float]:
        """Take one step, if Drake can: it raises where the state is not finite or nothing converges."""
        if not self._warning:
            try:
                return self._one(ax, ay, az)
            except RuntimeError as error:
                self._warning = str(error).partition("\n")[0]
        return [math.nan] * 9

    def _one(self, ax: float, ay: float, az: float) -> list[float]:
        """Take one step; return quaternion, position, heading of the scene, and what it has spun."""
        if self._rim.lean < _FLAT:
            self._turn_point_below(ax, ay, az)
        before, step = self._rim, self._step
        self._advance_once(self._force(ax, ay, az))
        rise = before.upwards(self._velocity.tolist()) + float(self._frame[2])
        self._velocity[3:] += self._frame
        moved = zip(self._place[4:], self._frame.tolist(), strict=True)
        self._place[4:] = [at + step * speed for at, speed in moved]
        self._rim = _Rim.of(self._place, self._scene.body)
        self._frame = self._next_frame(before, self._rim, rise)
        self._velocity[3:] -= self._frame
        return [*self._place, self._heading, self._spun]

    def _next_frame(self, before: _Rim, after: _Rim, rise: float) -> Array:
        """Return the velocity of the frame of the next step: up as the rim sinks, and against its slip."""
        rolls = before.lean > _LEANS and before.depth > 0.0 and before.goes_on_to(after)
        sinks = (after.depth - before.depth) / self._step + rise if rolls else math.nan
        # where it sinks by next, from the last two steps
        ahead, self._sinks = 2.0 * sinks - self._sinks, sinks
        heave = ahead if math.isfinite(ahead) else 0.0
        # a base that lands would be set in motion by it
        if not rolls:
            return np.array([0.0, 0.0, heave])
        slip_x, slip_y = after.slip(self._velocity.tolist())
        return np.array([-self._overshoot * slip_x, -self._overshoot * slip_y, heave])

    def _force(self, ax: float, ay: float, az: float) -> Array:
        """Return torque and force of a step: of the guide, and of an acceleration of the ground."""
        c, s = math.cos(self._heading), math.sin(self._heading)
        push = -c * ax - s * ay, s * ax - c * ay, -az
        if not self._stiffness:
            return np.array([0.0, 0.0, 0.0, *push])
        w, x, y, z = self._place[:4]
        # along the vertical plus the axis, proportional to the twist
        twist = math.remainder(2.0 * math.atan2(z, w) + self._spun, 2.0 * math.pi)
        pair = -4.0 * self._stiffness * twist
        return np.array([pair * (x * z + w * y), pair * (y * z - w * x), pair * (1.0 - x * x - y * y), *push])

    def _advance_once(self, force: Array) -> None:
        step = self._step
        self._last = self._standing if self._rim.lean < _FLAT else self._rolling
        applied = force + self._left
        acceleration, self._left = self._last.solve(np.array([*self._place, *self._velocity]), applied)
        self._velocity = self._velocity + step * acceleration
        spin_x, spin_y, spin_z, *speed = self._velocity.tolist()
        w, x, y, z, *position = self._place
        half = 0.5 * step
        turned = (
            w - half * (x * spin_x + y * spin_y + z * spin_z),
            x + half * (w * spin_x + z * spin_y - y * spin_z),
            y + half * (w * spin_y + x * spin_z - z * spin_x),
            z + half * (w * spin_z + y * spin_x - x * spin_y),
        )
        length = math.hypot(*turned)
        if not math.isfinite(length):
            raise RuntimeError("the orientation is not finite")
        # the rate times the step makes it longer each time
        moved = [at + step * by for at, by in zip(position, speed, strict=True)]
        self._place = [*(each / length for each in turned), *moved]

    def _turn_point_below(self, ax: float, ay: float, az: float) -> None:
        """Turn a point of the rim below the lean of a base that is nearly flat, or below its load."""
        rim, body = self._rim, self._scene.body
        if rim.lean > _LEANS:
            self._turn(self._heading + math.atan2(rim.axis_y, rim.axis_x))
        elif math.hypot(ax, ay) * body.mass_centre_height > _LOADED * body.base_radius * (
            self._scene.gravity + az
        ):
            self._turn(math.atan2(-ay, -ax))

    def _turn(self, heading: float) -> None:
        """Turn the x axis of the scene into an azimuth [rad], and that of the cylinder, which is round.

        The vectors of the scene turn back.
        """
        angle, self._heading = self._heading - heading, heading
        place = np.array(self._place)
        spun = 2.0 * math.atan2(place[3], place[0])
        place[:4] = _spin(place[None, :4], np.array([-spun]))[0]
        self._spun += spun
        pairs = (self._velocity, self._left)
        vectors = np.stack([place[1:4], place[4:], *np.reshape(pairs, (4, 3)), self._frame])
        turned = about_vertical(vectors, angle)
        self._place = [float(place[0]), *turned[:2].ravel().tolist()]
        self._velocity, self._left, self._frame = turned[2:4].ravel(), turned[4:6].ravel(), turned[6]
        self._rim = _Rim.of(self._place, self._scene.body)


def _spin(quaternion: Array, angle: Array) -> Array:
    """Return quaternions (n, 4), scalar first, after a turn about the axis of the cylinder (n,) [rad]."""
    w, x, y, z = quaternion.T
    c, s = np.cos(0.5 * angle), np.sin(0.5 * angle)
    return np.column_stack([w * c - z * s, x * c + y * s, y * c - x * s, z * c + w * s])


class _Rim(NamedTuple):
    """The lowest point of the rim, of a pose.

    Attributes
    ----------
    axis_x, axis_y, lean : float
        Horizontal part of the axis of the cylinder, and its size.
    depth : float
        Below the ground [m].
    reach : float
        Horizontally from the mass centre along the lean, over the lean [m].
    down : float
        Below the mass centre [m].
    """

    axis_x: float
    axis_y: float
    lean: float
    depth: float
    reach: float
    down: float

    @classmethod
    def of(cls, place: Sequence[float], body: Body) -> _Rim:
        w, x, y, z, _, _, height = place
        axis_x, axis_y, axis_z = 2.0 * (x * z + w * y), 2.0 * (y * z - w * x), 1.0 - 2.0 * (x * x + y * y)
        lean, b, h = math.hypot(axis_x, axis_y), body.base_radius, body.mass_centre_height
        reach, down = b * axis_z / lean - h if lean else 0.0, b * lean + h * axis_z
        return cls(axis_x, axis_y, lean, down - height, reach, down)

    def upwards(self, velocity: Sequence[float]) -> float:
        """Return the speed of the material point there, from angular velocity and velocity (6,) [m/s]."""
        return velocity[5] + self.reach * (velocity[0] * self.axis_y - velocity[1] * self.axis_x)

    def slip(self, velocity: Sequence[float]) -> tuple[float, float]:
        """Return its velocity along the ground, from the same [m/s]."""
        spin_x, spin_y, spin_z, x, y, _ = velocity
        along_x, along_y = self.reach * self.axis_x, self.reach * self.axis_y
        return x - spin_y * self.down - spin_z * along_y, y + spin_x * self.down + spin_z * along_x

    def goes_on_to(self, after: _Rim) -> bool:
        """Return whether it stays on its side of upright."""
        return self.axis_x * after.axis_x + self.axis_y * after.axis_y > 0.0
