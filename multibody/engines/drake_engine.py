"""Drake: point contact in discrete time, solved as a convex problem with a lagged friction cone.

What it needs:

* Its cylinder finds one contact on the ground, on which a flat base does not stand. So the rim has four
  points besides, tiny spheres. As fixed corners they would be a polygon: while the base is nearly flat the
  scene, and the cylinder about its axis, are turned until one is under the load, and then under the lean.
* The lagged cone takes for the load of a step how deep the rim is when it starts. Stiff contact yields to the
  weight by 1e-9 m; by as much the lowest point sinks or rises in a step along the curvature of its path,
  which no velocity shows. A rim that rises would have no friction, and hop. So each step is taken in a frame
  that moves up by what the last two steps sank, and the rim starts it as deep as its load presses it.
* A quaternion that is stepped by its rate grows, and with it the lean that it tells: it is brought back.
* Its solver stops when what it leaves over of a step is 1e-6 of all momentum, and has no other tolerance to
  choose. That is a force, and the larger the smaller the step: the next step is given it.
"""

from __future__ import annotations

import contextlib
import logging
import math
from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np

from ..body import Body
from ..facts import EngineFacts
from ..kinematics import about_vertical, turning
from ..protocol import Array, Scene, Settings, Stepper, Steps
from .declared import Declared
from .drake_scene import POINTS, build
from .scene_counts import SceneCounts
from .settings.drake import DrakeSettings

_FLAT = 2e-3  # [rad] lean up to which a point carries the rim: the cylinder itself is not found below 1e-3
_BETWEEN = 2.0 * math.pi / POINTS  # [rad] between two points
_NEAR = 0.05  # [rad] to a point: the lowest point of the rim turns by less in a step at leans above
_LEANS = 1e-8  # [rad] from which a lean has a direction; what stands leans by 1e-9
_LOADED = 0.5  # of b, eccentricity of the load from which the scene follows it

_FACTS = EngineFacts(
    title="Drake", step_time=1.1e-4, release_error=8e-6, uplift_error=5e-5, smooth_uplift=True
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
        from pydrake.systems.analysis import Simulator

        self._scene, self._step = scene, scene.time_step
        # guide_stiffness is in the time of the user; of both halves of the guide, torque for each twist
        stiffness = settings.guide_stiffness * scene.unit_time**2 * scene.body.axial_inertia
        self._stiffness = stiffness if scene.support == "recess" else 0.0
        with _quiet():
            diagram, self._plant = build(scene, settings)
            root = diagram.CreateDefaultContext()
            self._context = self._plant.GetMyMutableContextFromRoot(root)
            self._simulator = Simulator(diagram, root)
            self._simulator.Initialize()
        self._input = self._plant.get_applied_generalized_force_input_port()
        model = self._plant.GetModelInstanceByName("DefaultModelInstance")
        self._contact = self._plant.get_generalized_contact_forces_output_port(model)
        self._gravity = np.array([0.0, 0.0, 0.0, 0.0, 0.0, -scene.gravity])
        self._left = np.zeros(6)  # what the solver left of the last step, torque and force
        self._count = 0
        self._warning = ""
        self._heading = 0.0  # azimuth of the x axis of the scene in the world [rad]
        self._spun = 0.0  # angle about its axis that has been taken off the cylinder [rad]
        start = scene.start
        self._depth = scene.gravity / settings.contact_stiffness
        self._position, self._quaternion = start.position, start.quaternion
        place = np.concatenate([start.quaternion, start.position - [0.0, 0.0, self._depth]])
        velocity = np.concatenate([start.angular_velocity, start.velocity])
        self._place, self._velocity = place, velocity
        self._sinks = math.nan
        self._heave = 0.0  # speed of the frame, upwards, in which the ground keeps still in a step [m/s]
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
        rows = np.array([self._caught(each) for each in acceleration])
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
        """Return what the last step solved: a normal and two directions of friction for each contact."""
        port = self._plant.get_contact_results_output_port()
        contacts = port.Eval(self._context).num_point_pair_contacts()
        return SceneCounts(degrees_of_freedom=6, contacts=contacts, constraint_rows=3 * contacts)

    def _caught(self, acceleration: Array) -> Array:
        """Take one step, if Drake can: it raises where the state is not finite or nothing converges."""
        if not self._warning:
            try:
                return self._one(acceleration)
            except RuntimeError as error:
                self._warning = str(error).partition("\n")[0]
        return np.full(9, math.nan)

    def _one(self, acceleration: Array) -> Array:
        """Take one step; return quaternion, position, heading of the scene, and what it has spun."""
        rim = self._rim()
        if rim.lean < _FLAT:
            body = self._scene.body
            push = float(np.hypot(acceleration[0], acceleration[1])) * body.mass_centre_height
            load = push / (body.base_radius * (self._scene.gravity + acceleration[2]))
            if rim.lean > _LEANS:
                self._turn(self._heading + math.atan2(rim.axis_y, rim.axis_x))
            elif load > _LOADED:
                self._turn(math.atan2(-acceleration[1], -acceleration[0]))
            rim = self._rim()
        else:
            self._keep_points_away()
        force = np.zeros(6)
        force[3:] = about_vertical(-acceleration[None], -self._heading)[0]
        if self._stiffness:
            w, x, y, z = self._place[:4]
            # along the vertical plus the axis, proportional to the twist
            twist = math.remainder(2.0 * math.atan2(z, w) + self._spun, 2.0 * math.pi)
            pair = -2.0 * self._stiffness * twist
            force[:3] = pair * np.array([x * z + w * y, y * z - w * x, 1.0 - x * x - y * y])
        self._advance_once(force)
        rise = self._step * (self._heave + rim.upwards(self._velocity))
        self._place[6] += self._step * self._heave
        after = self._rim()
        rolls = rim.lean > _LEANS and rim.depth > 0.0 and rim.goes_on_to(after)
        sinks = (after.depth - rim.depth + rise) / self._step if rolls else math.nan
        # where it sinks by next, from the last two steps
        ahead = 2.0 * sinks - self._sinks
        heave = ahead if math.isfinite(ahead) else 0.0
        self._velocity[5] += self._heave - heave
        self._heave, self._sinks = heave, sinks
        return np.array([*self._place, self._heading, self._spun])

    def _rim(self) -> _Rim:
        return _Rim.of(self._place, self._scene.body)

    def _advance_once(self, force: Array) -> None:
        applied = force + self._left
        self._input.FixValue(self._context, applied)
        self._plant.SetPositionsAndVelocities(self._context, np.concatenate([self._place, self._velocity]))
        mass, bias = self._plant.CalcMassMatrix(self._context), self._plant.CalcBiasTerm(self._context)
        self._count += 1
        self._simulator.AdvanceTo(self._count * self._step)
        state = self._plant.GetPositionsAndVelocities(self._context)
        length = math.hypot(*state[:4])
        if not math.isfinite(length):
            raise RuntimeError("the orientation is not finite")
        change = mass @ (state[7:] - self._velocity) / self._step
        self._left = applied + self._gravity + self._contact.Eval(self._context) - bias - change
        self._place, self._velocity = state[:7], state[7:]
        # Drake adds the rate times the step, which makes it longer each time
        self._place[:4] /= length

    def _keep_points_away(self) -> None:
        """Turn the cylinder, where a rim that rolls would meet a point, so that it does not."""
        w, x, y, z = self._place[:4].tolist()
        lowest = math.atan2(-y * z - w * x, w * y - x * z)  # azimuth in the cylinder
        if abs(math.remainder(lowest, _BETWEEN)) < _NEAR:
            self._take_off(0.5 * _BETWEEN)

    def _take_off(self, angle: float) -> None:
        """Turn the cylinder back about its axis [rad]."""
        self._place[:4] = _spin(self._place[None, :4], np.array([-angle]))[0]
        self._spun += angle

    def _turn(self, heading: float) -> None:
        """Turn the x axis of the scene into an azimuth [rad], and that of the cylinder, which is round.

        The vectors of the scene turn back.
        """
        angle, self._heading = self._heading - heading, heading
        place, velocity = self._place, self._velocity
        self._take_off(2.0 * math.atan2(place[3], place[0]))
        left = self._left
        turned = np.array([place[1:4], place[4:], velocity[:3], velocity[3:], left[:3], left[3:]])
        place[1:4], place[4:], velocity[:3], velocity[3:], left[:3], left[3:] = about_vertical(turned, angle)


def _spin(quaternion: Array, angle: Array) -> Array:
    """Return quaternions (n, 4), scalar first, after a turn about the axis of the cylinder (n,) [rad]."""
    w, x, y, z = quaternion.T
    c, s = np.cos(0.5 * angle), np.sin(0.5 * angle)
    return np.column_stack([w * c - z * s, x * c + y * s, y * c - x * s, z * c + w * s])


@dataclass(frozen=True, slots=True)
class _Rim:
    """The lowest point of the rim, of a pose.

    Attributes
    ----------
    axis_x, axis_y, lean : float
        Horizontal part of the axis of the cylinder, and its size.
    depth : float
        Below the ground [m].
    reach : float
        Horizontally from the mass centre along the lean, over the lean [m].
    """

    axis_x: float
    axis_y: float
    lean: float
    depth: float
    reach: float

    @classmethod
    def of(cls, place: Array, body: Body) -> _Rim:
        w, x, y, z, _, _, height = place.tolist()
        axis_x, axis_y, axis_z = 2.0 * (x * z + w * y), 2.0 * (y * z - w * x), 1.0 - 2.0 * (x * x + y * y)
        lean, b, h = math.hypot(axis_x, axis_y), body.base_radius, body.mass_centre_height
        reach = b * axis_z / lean - h if lean else 0.0
        return cls(axis_x, axis_y, lean, b * lean + h * axis_z - height, reach)

    def upwards(self, velocity: Array) -> float:
        """Return the speed of the material point there, from angular velocity and velocity (6,) [m/s]."""
        return float(velocity[5] + self.reach * (velocity[0] * self.axis_y - velocity[1] * self.axis_x))

    def goes_on_to(self, after: _Rim) -> bool:
        """Return whether it stays on its side of upright."""
        return self.axis_x * after.axis_x + self.axis_y * after.axis_y > 0.0


@contextlib.contextmanager
def _quiet() -> Iterator[None]:
    """Keep a warning that no half space touches a deformable body off the standard error."""
    logger = logging.getLogger("drake")
    level = logger.level
    logger.setLevel(logging.ERROR)
    try:
        yield
    finally:
        logger.setLevel(level)
