"""Drake: point contact in discrete time, solved as a convex problem with a lagged friction cone.

What it needs:

* Its cylinder finds one contact on the ground, on which a flat base does not stand. So the rim of a base that
  is nearly flat has four points besides, tiny spheres. As fixed corners they would be a polygon: the scene,
  and the cylinder about its axis, are turned until one is under the load, and then under the lean. A base
  that slides and cannot open stands on 32.
* The lagged cone takes for the load of a step how deep the rim is when it starts. Stiff contact yields to the
  weight by 1e-9 m; by as much the lowest point sinks or rises in a step along the curvature of its path,
  which no velocity shows. A rim that rises would have no friction, and hop. So each step is taken in a frame
  that moves up by what the last two steps sank, and the rim starts it as deep as its load presses it.
* Friction stops the point of the rim that a step starts on, and a rim that rolls on creeps. So the frame
  moves along the ground as well, against the slip that the last step left at the rim of this pose.
* The slab of a frame is a half space that looks down, on three slides. What it is to the top the ground is to
  the base: it has a frame of its own, which moves up by twice as much, and against the slip at the top.
* A quaternion that is stepped by its rate grows, and with it the lean that it tells: it is brought back.
* Its solver stops when what it leaves over of a step is 1e-6 of all momentum, and has no other tolerance to
  choose. That is a force, and the larger the smaller the step: the next step is given it.
* Half of its time goes into what surrounds the solver. So a step asks its plant for the acceleration alone,
  not its simulator for a state, and geometry that cannot touch is in another plant.
"""

from __future__ import annotations

import contextlib
import logging
import math
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from types import MappingProxyType
from typing import TYPE_CHECKING, Annotated, Any, NamedTuple

import numpy as np

from rockwobble.models.mode import SLIDES

from ..kinematics import about_vertical
from ..protocol import EngineFacts, SceneCounts, Steps
from ..scene import Array, Body, Scene
from ..settings import EngineSettings, NotNegative, Positive, one_of, positive
from .declared import Declared, Leapfrog, contact_counts

if TYPE_CHECKING:
    from pydrake.multibody.tree import MultibodyForces
    from pydrake.systems.framework import Context, Diagram


@dataclass(frozen=True, slots=True, kw_only=True)
class DrakeSettings(EngineSettings):
    """Settings of Drake: contact in discrete time.

    Attributes
    ----------
    guide_stiffness : float
        As for MuJoCo [1/s^2].
    approximation : {"lagged", "similar", "tamsi", "sap"}
        Approximation of contact. "lagged" is Drake's default and convex; SAP loses more energy. Where the
        base slides "tamsi" is the default: where a slide stops or turns, the lagged cone of a base on many
        points opens it, which TAMSI does not, at half the cost.
    contact_stiffness : float
        For each unit of mass, at the reference size [1/s^2]; the weight sinks in by 1e-9 m. It is solved
        for implicitly, so the step does not limit it.
    dissipation : float
        Dissipation of Hunt and Crossley, at the reference size [s/m]. Contact pushes apart by 1/dissipation
        at most [m/s]: without it a base that lands, by then as deep as it fell in a step, is thrown back by
        all of that. With ten times more it holds a rim that a near pass moves up.
    stiction_tolerance : float
        Speed at which what sticks creeps at the limit of friction, at the reference size [m/s]. At Drake's
        own, 1e-4, a standing base creeps. SAP's own limit, a thousandth of what a free body would gain in a
        step, is about as small.
    friction_damping : float
        As for MuJoCo: share of the slip velocity that one step removes. Drake knows no other than 1, which is
        made up for by a velocity of the frame.
    """

    guide_stiffness: Positive
    approximation: Annotated[str, one_of("lagged", "similar", "tamsi", "sap")] = "lagged"
    contact_stiffness: Positive = 1e10
    dissipation: NotNegative = 100.0
    stiction_tolerance: Positive = 1e-6
    friction_damping: Annotated[float, positive(most=2.0)] = 1.8


POINTS = 4  # points of the rim that carry a flat base
SLIDING_POINTS = 32  # points of a sliding base: a polygon of 0.995 b that needs no turning
_POINT_SIZE = 1e-9  # radius over b; a sphere this small reaches out of the rim by 1e-9 theta^2/2


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class DrakeScene:
    """Ground, cylinder and slab, if there is one, with the solver of their steps.

    Vectors of the cylinder are followed by those of the slab, which has places and forces, and does not turn.

    Attributes
    ----------
    plant : pydrake.multibody.plant.MultibodyPlant
    diagram, root, context : pydrake.systems.framework.Diagram, Context, Context
        The diagram that holds the plant, its context, and that of the plant.
    applied : pydrake.systems.framework.FixedInputPortValue
        Torque and force.
    acceleration, contact : pydrake.systems.framework.OutputPort
    no_forces : pydrake.multibody.tree.MultibodyForces
    gravity : ndarray, shape (6,) or (9,)
        Torque and force.
    """

    plant: Any
    diagram: Diagram
    root: Context
    context: Context
    applied: Any
    acceleration: Any
    contact: Any
    no_forces: MultibodyForces
    gravity: Array

    def solve(self, state: Array, applied: Array) -> tuple[Array, Array]:
        """Solve a step from a state: quaternion, position, angular velocity and velocity.

        Returns
        -------
        acceleration : ndarray, shape (6,) or (9,)
            Change of the velocities over the step.
        left : ndarray, of the same shape
            Torque and force that the solver left unbalanced.
        """
        self.applied.GetMutableData().get_mutable_value().SetFromVector(applied)
        self.plant.SetPositionsAndVelocities(self.context, state)
        acceleration = self.acceleration.Eval(self.context)
        balanced = self.plant.CalcInverseDynamics(self.context, acceleration, self.no_forces)
        left = applied + self.gravity + self.contact.Eval(self.context) - balanced
        return acceleration, left

    def count_contacts(self) -> int:
        """Number of contacts that the last step solved."""
        results = self.plant.get_contact_results_output_port().Eval(self.context)
        return int(results.num_point_pair_contacts())


def make_scene(scene: Scene, settings: DrakeSettings, points: int) -> DrakeScene:
    """Make ground and cylinder, with points on its rim."""
    from pydrake.geometry import AddContactMaterial, Cylinder, HalfSpace, ProximityProperties, Sphere
    from pydrake.math import RigidTransform
    from pydrake.multibody import plant as plants
    from pydrake.multibody.tree import (
        MultibodyForces,
        QuaternionFloatingJoint,
        RotationalInertia,
        SpatialInertia,
    )
    from pydrake.systems.framework import DiagramBuilder

    shape = scene.body
    builder = DiagramBuilder()
    plant, graph = plants.AddMultibodyPlantSceneGraph(builder, scene.time_step)
    kinds = plants.DiscreteContactApproximation
    names = {"lagged": kinds.kLagged, "similar": kinds.kSimilar, "tamsi": kinds.kTamsi, "sap": kinds.kSap}
    plant.set_discrete_contact_approximation(names[settings.approximation])
    plant.set_stiction_tolerance(settings.stiction_tolerance)
    plant.SetUseSampledOutputPorts(False)  # an output then solves the next step
    transverse, axial = shape.transverse_inertia, shape.axial_inertia
    inertia = RotationalInertia(transverse, transverse, axial)
    origin: Any = np.zeros(3)
    body = plant.AddRigidBody("cylinder", SpatialInertia.MakeFromCentralInertia(1.0, origin, inertia))
    contact = ProximityProperties()
    # two bodies in series are half as stiff as each
    cone = plants.CoulombFriction(scene.friction, scene.friction)
    AddContactMaterial(settings.dissipation, 2.0 * settings.contact_stiffness, cone, contact)
    middle: Any = np.array([0.0, 0.0, 0.5 * shape.height - shape.mass_centre_height])
    size, share = _POINT_SIZE * shape.base_radius, shape.slab_mass_ratio
    with _quiet():
        plant.RegisterCollisionGeometry(plant.world_body(), RigidTransform(), HalfSpace(), "ground", contact)
        outline = Cylinder(shape.base_radius, shape.height)
        plant.RegisterCollisionGeometry(body, RigidTransform(middle), outline, "outline", contact)
        for index in range(points):
            azimuth = 2.0 * math.pi * index / points
            x, y = shape.base_radius * math.cos(azimuth), shape.base_radius * math.sin(azimuth)
            place: Any = np.array([x, y, size - shape.mass_centre_height])
            name = f"point {index}"
            plant.RegisterCollisionGeometry(body, RigidTransform(place), Sphere(size), name, contact)
            if share > 0.0:
                name = f"top {name}"
                plant.RegisterCollisionGeometry(body, RigidTransform(-place), Sphere(size), name, contact)
        if share > 0.0:
            # before the slides of the slab, whose coordinates then come last
            joint = QuaternionFloatingJoint("cylinder", plant.world_frame(), body.body_frame())
            plant.AddJoint(joint)
            _add_slab(plant, graph, contact, share)
        plant.mutable_gravity_field().set_gravity_vector([0.0, 0.0, -scene.gravity])
        plant.Finalize()
        diagram = builder.Build()
        root = diagram.CreateDefaultContext()
    context = plant.GetMyMutableContextFromRoot(root)
    model = plant.GetModelInstanceByName("DefaultModelInstance")
    weights = np.array([0.0, 0.0, 0.0, 0.0, 0.0, -scene.gravity, 0.0, 0.0, -scene.gravity * share])
    count = plant.num_velocities()
    return DrakeScene(
        plant=plant,
        diagram=diagram,
        root=root,
        context=context,
        applied=plant.get_applied_generalized_force_input_port().FixValue(context, np.zeros(count)),
        acceleration=plant.get_generalized_acceleration_output_port(),
        contact=plant.get_generalized_contact_forces_output_port(model),
        no_forces=MultibodyForces(plant),
        gravity=weights[:count],
    )


def _add_slab(plant: Any, graph: Any, contact: Any, mass: float) -> None:
    """Add the slab, a body on three slides, with a half space that faces down."""
    from pydrake.geometry import CollisionFilterDeclaration, GeometrySet, HalfSpace
    from pydrake.math import RigidTransform, RotationMatrix
    from pydrake.multibody.tree import PrismaticJoint, SpatialInertia

    parent = ground = plant.world_body()
    axes: Any = np.eye(3)
    for name, axis in zip("xyz", axes, strict=True):
        inertia = SpatialInertia.SolidSphereWithMass(mass, 1.0) if name == "z" else SpatialInertia.Zero()
        body = plant.AddRigidBody(f"slab {name}", inertia)
        plant.AddJoint(PrismaticJoint(f"slab {name}", parent.body_frame(), body.body_frame(), axis))
        parent = body
    down = RigidTransform(RotationMatrix.MakeXRotation(math.pi))
    slab = GeometrySet(plant.RegisterCollisionGeometry(parent, down, HalfSpace(), "slab", contact))
    # contact of two half spaces is not known to Drake
    apart = GeometrySet(plant.GetCollisionGeometriesForBody(ground))
    graph.collision_filter_manager().Apply(CollisionFilterDeclaration().ExcludeBetween(slab, apart))


@contextlib.contextmanager
def _quiet() -> Iterator[None]:
    """Suppress a warning on standard error that no half space touches a deformable body."""
    logger = logging.getLogger("drake")
    level = logger.level
    logger.setLevel(logging.ERROR)
    try:
        yield
    finally:
        logger.setLevel(level)


_FLAT = 2e-3  # [rad] lean up to which a point carries the rim: the cylinder itself is not found below 1e-3
_LEANS = 1e-8  # [rad] tilt above which it has a direction; a standing cylinder tilts by 1e-9
_LOADED = 0.5  # eccentricity of the load over b above which the scene turns with it

_FACTS = EngineFacts(
    title="Drake",
    step_time=1.5e-4,
    release_error=4e-6,
    uplift_error=5e-6,
    smooth_uplift=True,
    carries_slab=True,
    terms=frozenset({"tendon"}),
)


class _DrakeStepper(Leapfrog):
    def __init__(self, scene: Scene, settings: DrakeSettings) -> None:
        super().__init__(scene, settings.guide_stiffness, scene.gravity / settings.contact_stiffness)
        self._slides = scene.mode == SLIDES
        points = SLIDING_POINTS if self._slides else POINTS
        self._standing, self._rolling = make_scene(scene, settings, points), make_scene(scene, settings, 0)
        self._last = self._standing  # plant that took the last step
        self._overshoot = settings.friction_damping - 1.0
        self._warning = ""
        self._spun = 0.0  # rotation about its axis removed from the cylinder so far [rad]
        start = scene.start
        # quaternion and position: floats, since the loop over steps in Python reads each of them
        place = [*start.quaternion.tolist(), *(start.position - [0.0, 0.0, self._depth]).tolist()]
        velocity = np.concatenate([start.angular_velocity, start.velocity])
        self._share = scene.body.slab_mass_ratio
        if self._share > 0.0:
            place += [0.0, 0.0, 2.0 * place[6]]
            velocity = np.append(velocity, 2.0 * start.velocity)
        self._left = np.zeros_like(velocity)  # residual torque and force of the solver in the last step
        self._place, self._velocity = place, velocity
        self._rim = _Rim.of(place, scene.body)
        self._sinks = math.nan
        # velocity of the frame in which the ground is at rest during a step, and of that of the slab [m/s]
        self._frame = np.zeros(len(velocity) - 3)
        if not start.standing:
            # leapfrog starts half a step back: a trial step gives the acceleration
            self._advance_once(self._pull_of_tendon(np.zeros_like(velocity)))
            self._place, self._velocity = place, 1.5 * velocity - 0.5 * self._velocity

    def advance(self, acceleration: Array) -> Steps:
        """Take one step for each row of `acceleration`."""
        rows = np.array([self._caught(*each) for each in acceleration.tolist()])
        return self._steps_to(rows[:, 4:7], _spin(rows[:, :4], rows[:, -1]), rows[:, -2])

    def warnings(self) -> str:
        """Message that Drake raised where it could not go on."""
        return self._warning

    def counts(self) -> SceneCounts:
        """Return the counts of the last step."""
        return contact_counts(self._last.count_contacts())

    def _caught(self, ax: float, ay: float, az: float) -> list[float]:
        """Take one step; a state that is not finite or a solver that fails ends the run with its message."""
        if not self._warning:
            try:
                return self._one(ax, ay, az)
            except RuntimeError as error:
                self._warning = str(error).partition("\n")[0]
        return [math.nan] * (len(self._place) + 2)

    def _one(self, ax: float, ay: float, az: float) -> list[float]:
        """Take one step; return quaternion, positions, heading of the scene, and spin so far."""
        if self._rim.lean < _FLAT and not self._slides:
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
        """Velocity of the frame in the next step: up as the rim sinks, and against its slip."""
        rolls = before.lean > _LEANS and before.depth > 0.0 and before.goes_on_to(after)
        sinks = (after.depth - before.depth) / self._step + rise if rolls else math.nan
        # sink in the next step, extrapolated from the last two
        ahead, self._sinks = 2.0 * sinks - self._sinks, sinks
        heave = ahead if math.isfinite(ahead) else 0.0
        # a landing base would be set in motion by the correction
        x = y = top_x = top_y = 0.0
        if rolls:
            velocity, overshoot = self._velocity.tolist(), self._overshoot
            slip_x, slip_y = after.slip(velocity)
            x, y = -overshoot * slip_x, -overshoot * slip_y
            if self._share > 0.0:
                # the highest point has twice the velocity of the mass centre, less that of the lowest
                _, _, _, speed_x, speed_y, _, slab_x, slab_y, _ = velocity
                top_x = x - overshoot * (slab_x - 2.0 * speed_x + slip_x)
                top_y = y - overshoot * (slab_y - 2.0 * speed_y + slip_y)
        return np.array([x, y, heave, top_x, top_y, 2.0 * heave][: len(self._frame)])

    def _force(self, ax: float, ay: float, az: float) -> Array:
        """Torque and forces of a step: those of the guide, and of an acceleration of the ground."""
        c, s = math.cos(self._heading), math.sin(self._heading)
        push = [-c * ax - s * ay, s * ax - c * ay, -az]
        if self._share > 0.0:
            push += [self._share * each for each in push]
        if not self._stiffness:
            return self._pull_of_tendon(np.array([0.0, 0.0, 0.0, *push]))
        w, x, y, z = self._place[:4]
        # torque along the vertical plus the axis, proportional to the twist
        twist = math.remainder(2.0 * math.atan2(z, w) + self._spun, 2.0 * math.pi)
        pair = -4.0 * self._stiffness * twist
        couple = pair * (x * z + w * y), pair * (y * z - w * x), pair * (1.0 - x * x - y * y)
        return self._pull_of_tendon(np.array([*couple, *push]))

    def _pull_of_tendon(self, force: Array) -> Array:
        """Torque and forces of a step with those of the tendon."""
        restraint, rim = self._scene.restraint, self._rim
        if restraint.is_active:
            _, x, y, _, *place = self._place[:7]
            place[2] += self._depth
            axis = rim.axis_x, rim.axis_y, 1.0 - 2.0 * (x * x + y * y)
            pull, couple = restraint.loads(place, axis, self._scene.body.mass_centre_height)
            force[:3] += couple
            force[-3:] += pull  # force on the slab, or on the cylinder alone
        return force

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
        # the rate times the step lengthens the quaternion, which is normalised
        moved = [at + step * by for at, by in zip(position, speed, strict=True)]
        self._place = [*(each / length for each in turned), *moved]

    def _turn_point_below(self, ax: float, ay: float, az: float) -> None:
        """Rotate a point of the rim to the lowest place of a nearly flat base, or to its load."""
        rim, body = self._rim, self._scene.body
        load = _LOADED * body.base_radius * (self._scene.gravity + az)
        if rim.lean > _LEANS:
            self._turn(self._heading + math.atan2(rim.axis_y, rim.axis_x))
        elif math.hypot(ax, ay) * body.mass_centre_height > load:
            self._turn(math.atan2(-ay, -ax))

    def _turn(self, heading: float) -> None:
        """Rotate the x axes of the scene and of the cylinder, which is round, to an azimuth [rad].

        The vectors of the scene turn back.
        """
        angle, self._heading = self._heading - heading, heading
        place = np.array(self._place)
        spun = 2.0 * math.atan2(place[3], place[0])
        place[:4] = _spin(place[None, :4], np.array([-spun]))[0]
        self._spun += spun
        states = np.concatenate([place[1:], self._velocity, self._left, self._frame])
        turned = about_vertical(states.reshape(-1, 3), angle).ravel()
        ends = len(self._velocity) * np.arange(1, 4)
        back, self._velocity, self._left, self._frame = np.split(turned, ends)
        self._place = [float(place[0]), *back.tolist()]
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
        w, x, y, z, _, _, height = place[:7]
        axis_x, axis_y, axis_z = 2.0 * (x * z + w * y), 2.0 * (y * z - w * x), 1.0 - 2.0 * (x * x + y * y)
        lean, b, h = math.hypot(axis_x, axis_y), body.base_radius, body.mass_centre_height
        reach, down = b * axis_z / lean - h if lean else 0.0, b * lean + h * axis_z
        return cls(axis_x, axis_y, lean, down - height, reach, down)

    def upwards(self, velocity: Sequence[float]) -> float:
        """Return the upward speed of the contact point of the body, from its velocities (6,) [m/s]."""
        return velocity[5] + self.reach * (velocity[0] * self.axis_y - velocity[1] * self.axis_x)

    def slip(self, velocity: Sequence[float]) -> tuple[float, float]:
        """Velocity of the contact point along the ground, from the same arguments [m/s]."""
        spin_x, spin_y, spin_z, x, y = velocity[:5]
        along_x, along_y = self.reach * self.axis_x, self.reach * self.axis_y
        return x - spin_y * self.down - spin_z * along_y, y + spin_x * self.down + spin_z * along_x

    def goes_on_to(self, after: _Rim) -> bool:
        """Whether the next pose is on the same side of upright."""
        return self.axis_x * after.axis_x + self.axis_y * after.axis_y > 0.0


class DrakeEngine(Declared):
    """Drake: multibody plant in discrete time, half space, cylinder with points on its rim."""

    package, settings_type, facts = "drake", DrakeSettings, _FACTS  # points of its rim carry a flat base
    stepper_type = _DrakeStepper
    sliding = MappingProxyType({"approximation": "tamsi"})
