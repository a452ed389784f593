"""DART: hard contact, a complementarity problem of velocities, stepped by a loop in Python.

Contact has no stiffness to choose: after a step the rim's lowest point rests or moves away. What it needs:

* That point sinks and rises by a curvature of its path that no velocity shows, second order in the step. The
  ground takes it back by a velocity of its own, so that the rim stays as deep as it was: without it the rim
  would hop through a gap for a fifth of the steps. Where a base lands, the other side of its rim is in the
  ground by what a step has moved it. Taken back in one step that would throw the cylinder as high as it fell
  from; so the ground takes it back at a speed that falls by a tenth of gravity, which leaves it its load.
* Where the centre of the base is below the ground, ODE's detector finds four corners along the axes of the
  scene; where it is above, the lowest point, whose radius is off by 1e-16/lean^2. So the rim is kept at a
  depth of 1e-6 m, and where there are corners the scene is turned about the vertical until one of them is
  under the load, and then under the lean: ground that is the same in every direction knows no difference.
* Dantzig's method bounds friction by what the load would be without it, and lets a squat rim slip; the
  nonsmooth Gauss-Seidel method does not, and is exact for one contact. With four it takes hundreds of sweeps,
  so it has the rim, and Dantzig's method what stands. There its friction is a box, which is turned into the
  load. A box stops what slides across it, or is 41 % too strong: a base that slides, and cannot open, has the
  cone of Gauss and Seidel, whose four contacts need no more than a tolerance of 1e-5 to slide.
* Friction stops the point of the rim that a step starts on, and a rim that rolls on creeps. So the ground
  moves along itself, against the slip that the last step left at the rim of this pose.
* The slab of a frame is a plane that looks down. What the ground does to the base it does to the top: it goes
  beyond its own velocity in a step, and keeps what the step changed.
* Rotation vectors below 1e-3 rad lose a sixth of their cube in each step. So the cylinder, which is round, is
  turned about its axis by one radian.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Annotated

import numpy as np

from rockwobble.models.mode import SLIDES

from ..kinematics import about_vertical, axis_of
from ..protocol import EngineFacts, SceneCounts, Steps
from ..scene import Array, Scene
from ..settings import Count, EngineSettings, Positive, Share, Small, positive
from .declared import Declared, Leapfrog, contact_counts

if TYPE_CHECKING:
    from dartpy.dynamics import BodyNode, Shape, ShapeNode, TranslationalJoint


@dataclass(frozen=True, slots=True, kw_only=True)
class DartSettings(EngineSettings):
    """Settings of DART: hard contact has neither stiffness nor damping.

    Attributes
    ----------
    guide_stiffness : float
        As for MuJoCo [1/s^2].
    depth : float
        Depth at which the rim is kept, at the reference size [m]: so much that where the detector finds the
        rim instead of corners, from a lean of depth/b on, its radius is off by 1e-4 b only. It is taken off
        the poses.
    depth_gain : float
        Share of a change of depth that one step takes back. With little of it the rim is late by many steps,
        and two steps do not extrapolate.
    friction_damping : float
        As for MuJoCo: share of the slip velocity that one step removes. DART knows no other than 1, which is
        made up for by a velocity of the ground.
    tolerance, iterations : float, int
        Tolerance and iterations of the Gauss-Seidel method; one contact takes a single sweep, the four of a
        base that is about to open some hundreds, and fewer leave it a velocity.
    """

    guide_stiffness: Positive
    depth: Small = 1e-6
    depth_gain: Share = 0.3
    friction_damping: Annotated[float, positive(most=2.0)] = 1.8
    tolerance: Small = 1e-12
    iterations: Count = 1000


def rotation_vector(quaternion: Array, spin: float) -> Array:
    """Return the rotation vector (3,) of a quaternion (4,), scalar first, and a turn about the axis."""
    w, x, y, z = quaternion
    c, s = math.cos(0.5 * spin), math.sin(0.5 * spin)
    imaginary = np.array([x * c + y * s, y * c - x * s, z * c + w * s])
    size = float(np.linalg.norm(imaginary))
    return np.asarray(imaginary * (2.0 * math.atan2(size, w * c - z * s) / size))


def quaternions(vectors: Array, spin: float) -> Array:
    """Return the quaternions (n, 4), scalar first, of rotation vectors (n, 3) less a turn about the axis."""
    angle = np.linalg.norm(vectors, axis=1)
    x, y, z = 0.5 * np.sinc(0.5 * angle / np.pi) * vectors.T
    w = np.cos(0.5 * angle)
    c, s = math.cos(0.5 * spin), math.sin(0.5 * spin)
    return np.column_stack([w * c + z * s, x * c - y * s, y * c + x * s, z * c - w * s])


_LEANS = 1e-8  # [rad] tilt above which its direction is that of a motion, not noise of standing
_OPEN = 5e-8  # [rad] tilt at which the base is open; standing it stays below 5e-9, landed below 3e-8
# eccentricities of the load: the scene turns with it from the first, of b, or of the friction, and the base
# may open from the second, of b
_LOADED, _OPENING = 0.5, 0.999
# [rad] between the scene and the load of a base that slides: to turn the scene costs more than a step
_OFF_LOAD = 0.02
_SLIDING_TOLERANCE, _SLIDING_SWEEPS = 1e-5, 100  # tolerance 1e-8 gives the same slide at four times the cost
_REDUCTION, _FASTEST_REDUCTION = 0.01, 1e-3  # [-], [m/s] by which DART itself reduces a depth
_SLOWING = 0.1  # deceleration over gravity of the ground that takes a landed base back
_LANDED = 2.0  # depths of the rim by which a closed base is deeper than it was kept where it has landed
_FAR = 1e3  # distance over the height: ODE ends the process where something is too far away
_SIDE = 1e-3  # cosine of the tilt up to which the cylinder lies on its side
_SPIN = 1.0  # [rad] about the axis of the cylinder

_FACTS = EngineFacts(
    title="DART",
    step_time=2.5e-5,
    release_error=2e-6,
    uplift_error=5e-6,
    smooth_uplift=True,
    carries_slab=True,
    terms=frozenset({"tendon"}),
)


class _DartStepper(Leapfrog):
    def __init__(self, scene: Scene, settings: DartSettings) -> None:
        super().__init__(scene, settings.guide_stiffness, settings.depth)
        self._settings = settings
        self._build(scene, settings)
        self._kept = settings.depth  # depth at which the rim is kept just now [m]
        self._open = False
        self._lost = False
        start = scene.start
        position = start.position - [0.0, 0.0, settings.depth]
        velocity, spin = start.velocity, start.angular_velocity
        self._slab_height, self._slab_velocity = 2.0 * float(position[2]), 2.0 * velocity
        self._set_pose(start.quaternion, position, velocity, spin)
        if not start.standing:
            # leapfrog starts half a step back: a trial step gives the acceleration
            axis = axis_of(start.quaternion[None])[0]
            self._pull_tendon(position.tolist(), axis.tolist())
            self._step_on([0.0, 0.0, 0.0])
            after, spin_after = self._rates()
            self._slab_height = 2.0 * float(position[2])
            self._slab_velocity = 3.0 * velocity - 0.5 * self._slab_velocity
            self._set_pose(
                start.quaternion, position, 1.5 * velocity - 0.5 * after, 1.5 * spin - 0.5 * spin_after
            )

    def _build(self, scene: Scene, settings: DartSettings) -> None:
        """Make ground, cylinder and slab: the mass centre at the origin, planes that may have a velocity."""
        import dartpy

        shape, dynamics = scene.body, dartpy.dynamics
        self._world = world = dartpy.simulation.World()
        world.setTimeStep(scene.time_step)
        world.setGravity([0.0, 0.0, -scene.gravity])
        solver = world.getConstraintSolver()
        # its own detector and FCL's find one contact under a flat base, and Bullet's rounds the rim
        solver.setCollisionDetector(dartpy.collision.OdeCollisionDetector())

        def collide(node: BodyNode, outline: Shape) -> ShapeNode:
            placed = node.createShapeNode(outline)
            placed.createCollisionAspect()
            placed.createDynamicsAspect().setFrictionCoeff(scene.friction)
            return placed

        def add_plane(name: str, up: float, mass: float) -> TranslationalJoint:
            skeleton = dynamics.Skeleton(name)
            slide, plane = skeleton.createTranslationalJointAndBodyNodePair()
            collide(plane, dynamics.PlaneShape([0.0, 0.0, up], 0.0))
            skeleton.setMobile(mass > 0.0)
            if mass > 0.0:
                plane.setMass(mass)
            world.addSkeleton(skeleton)
            return slide

        self._ground = add_plane("ground", 1.0, 0.0)
        cylinder = dynamics.Skeleton("cylinder")
        # the positions of the joint are a rotation vector and the position of the mass centre [m]
        self._joint, self._cylinder = cylinder.createFreeJointAndBodyNodePair()
        outline = collide(self._cylinder, dynamics.CylinderShape(shape.base_radius, shape.height))
        place = dartpy.math.Isometry3()
        place.set_translation([0.0, 0.0, 0.5 * shape.height - shape.mass_centre_height])
        outline.setRelativeTransform(place)
        inertia = np.diag([shape.transverse_inertia, shape.transverse_inertia, shape.axial_inertia])
        self._cylinder.setInertia(dynamics.Inertia(1.0, np.zeros(3), inertia))
        world.addSkeleton(cylinder)
        share = shape.slab_mass_ratio
        self._slab = add_plane("slab", -1.0, share) if share > 0.0 else None
        options = dartpy.constraint.NsgsFrictionSolver.Options()
        options.tolerance, options.maxSweeps = settings.tolerance, settings.iterations
        self._use = solver.setBoxedLcpSolver
        self._rim_solver = dartpy.constraint.NsgsFrictionSolver(options)
        self._flat_solver = solver.getBoxedLcpSolver()
        if scene.mode == SLIDES:
            sliding = dartpy.constraint.NsgsFrictionSolver.Options()
            sliding.tolerance, sliding.maxSweeps = _SLIDING_TOLERANCE, _SLIDING_SWEEPS
            self._flat_solver = dartpy.constraint.NsgsFrictionSolver(sliding)
        self._use(self._flat_solver)

    def advance(self, acceleration: Array) -> Steps:
        """Take one step for each row of `acceleration`."""
        rows = np.array(self._loop(acceleration.tolist()))
        return self._steps_to(rows[:, 3:6], quaternions(rows[:, :3], _SPIN), rows[:, 6])

    def warnings(self) -> str:
        """Return a warning of a cylinder out of reach, where DART would end the process."""
        return "the cylinder is out of reach" if self._lost else ""

    def counts(self) -> SceneCounts:
        """Return the counts of the last step."""
        return contact_counts(self._world.getLastCollisionResult().getNumContacts())

    def _loop(self, acceleration: list[list[float]]) -> list[list[float]]:
        """Step in a loop; return rotation vector, position and heading of the scene after each."""
        # local names, because this is a loop over steps in Python
        body = self._scene.body
        get, pull, slab = self._joint.getPositions, self._world.setGravity, self._slab
        torque, move_ground = self._cylinder.addExtTorque, self._ground.setVelocities
        stiffness = -4.0 * self._stiffness
        rates, overshoot = self._joint.getVelocities, self._settings.friction_damping - 1.0
        cosine, sine, root = math.cos, math.sin, math.sqrt
        b, h, arm = body.base_radius, body.mass_centre_height, body.mass_centre_height / body.base_radius
        excited, gravity, heading = bool(self._scene.components), self._scene.gravity, self._heading
        # prestress holds the base down as weight does
        tipping, tied = self._scene.tipping_gravity, self._scene.restraint.is_active
        friction = self._scene.friction * self._scene.pressing_gravity / tipping
        followed = _LOADED * min(1.0, friction * arm)
        # a base whose friction is exceeded before it opens slides on four contacts: with those of the rim the
        # solver takes hundreds of sweeps in every step, for no gain
        opens = friction * arm > _OPENING
        turn_x, turn_y = cosine(heading), sine(heading)
        spin_x, spin_y = cosine(0.5 * _SPIN), sine(0.5 * _SPIN)
        target, gain = self._settings.depth, self._settings.depth_gain / self._step
        reduction, fastest = _REDUCTION / self._step, _FASTEST_REDUCTION
        kept, landed, time_step, slowing = self._kept, _LANDED * target, self._step, 2.0 * _SLOWING * gravity
        far = _FAR * body.height
        rows: list[list[float]] = []
        beyond = [0.0, 0.0, 0.0]
        row = get().tolist()
        for ax, ay, az in acceleration:
            x, y, z, away_x, away_y, height = row
            angle = root(x * x + y * y + z * z)
            # NaN fails the comparison, too
            if not angle + abs(away_x) + abs(away_y) + abs(height) < far:
                self._lost = True
                return rows + [[math.nan] * 7] * (len(acceleration) - len(rows))
            part, whole = sine(0.5 * angle) / angle, cosine(0.5 * angle)
            # the quaternion without the turn of the cylinder about its axis
            w, k = whole * spin_x + part * z * spin_y, part * z * spin_x - whole * spin_y
            i, j = part * (x * spin_x - y * spin_y), part * (y * spin_x + x * spin_y)
            axis_x, axis_y = 2.0 * (i * k + w * j), 2.0 * (j * k - w * i)
            lean = root(axis_x * axis_x + axis_y * axis_y)
            depth = b * lean + h * (1.0 - 2.0 * (i * i + j * j)) - height
            closed, lies = b * lean < depth, kept > landed
            if closed and depth > kept + landed:
                kept = depth
            back = min(root(slowing * (kept - target)), (kept - target) / time_step)
            rise = gain * (depth - kept) + back - min(reduction * max(depth, 0.0), fastest)
            if slab is not None:
                top = depth + 2.0 * height - self._slab_height  # its depth in the slab
                fall = gain * (top - kept) + back - min(reduction * max(top, 0.0), fastest)
                beyond = [0.0, 0.0, -fall]
            kept = max(kept - back * time_step, target)
            slip_x = slip_y = 0.0
            if closed:
                # friction is the whole load of a sliding base
                load = min(math.hypot(ax, ay) / (tipping + az), friction) * arm
                # a landed base tilts by its penetration, and does not open
                self._use_for(opening=opens and (load > _OPENING or (lean > _OPEN and not lies)))
                # a load pushes against the acceleration
                along = math.atan2(axis_y, axis_x) + heading if lean > _LEANS else math.atan2(-ay, -ax)
                off = opens or abs(math.remainder(along - heading, 0.5 * math.pi)) > _OFF_LOAD
                if off and (lean > _LEANS or load > followed):
                    self._turn(along)
                    heading, turn_x, turn_y = along, cosine(along), sine(along)
                    x, y, z, away_x, away_y, height = get().tolist()
                    i, j = part * (x * spin_x - y * spin_y), part * (y * spin_x + x * spin_y)
                    axis_x, axis_y = 2.0 * (i * k + w * j), 2.0 * (j * k - w * i)
            else:
                axis_z = 1.0 - 2.0 * (i * i + j * j)
                # a cylinder on its side is supported at two points
                if self._open != (axis_z > _SIDE):
                    self._use_for(opening=axis_z > _SIDE)
                # friction takes the rim to the velocity of the ground, here beyond zero by the overshoot
                rate_x, rate_y, rate_z, speed_x, speed_y, _ = rates().tolist()
                out, down = b * axis_z / lean - h, h * axis_z + b * lean
                roll_x = rate_y * down + rate_z * out * axis_y
                roll_y = rate_x * down + rate_z * out * axis_x
                slip_x, slip_y = speed_x - roll_x, speed_y + roll_y
                if slab is not None:
                    slab_x, slab_y, _ = self._slab_velocity.tolist()
                    beyond[0] = overshoot * (slab_x - speed_x - roll_x)
                    beyond[1] = overshoot * (slab_y - speed_y + roll_y)
            move_ground([-overshoot * slip_x, -overshoot * slip_y, rise])
            if excited:
                pull([-ax * turn_x - ay * turn_y, ax * turn_y - ay * turn_x, -az - gravity])
            if stiffness and k:
                # torque along the vertical plus the axis, proportional to the twist
                pair = 0.5 * stiffness * math.atan2(k, w)
                torque([pair * axis_x, pair * axis_y, pair * (2.0 - 2.0 * (i * i + j * j))])
            if tied:
                axis = axis_x, axis_y, 1.0 - 2.0 * (i * i + j * j)
                self._pull_tendon((away_x, away_y, height), axis)
            self._step_on(beyond)
            row = get().tolist()
            rows.append([*row, heading])
        self._kept = kept
        return rows

    def _pull_tendon(self, place: Sequence[float], axis: Sequence[float]) -> None:
        """Apply the forces of the tendon in the next step, at a place of the mass centre and an axis."""
        restraint, depth = self._scene.restraint, self._depth
        if not restraint.is_active:
            return
        x, y, z = place
        force, torque = restraint.loads((x, y, z + depth), axis, self._scene.body.mass_centre_height)
        self._cylinder.addExtTorque(torque)
        body = self._cylinder if self._slab is None else self._slab.getChildBodyNode()
        body.addExtForce(force)

    def _step_on(self, beyond: list[float]) -> None:
        """Take a step with an added velocity of the slab, and subtract it again."""
        slab = self._slab
        if slab is None:
            self._world.step()
            return
        slab.setPositions([0.0, 0.0, self._slab_height])
        slab.setVelocities(self._slab_velocity + beyond)
        self._world.step()
        self._slab_velocity = slab.getVelocities() - beyond
        self._slab_height += self._step * float(self._slab_velocity[2])

    def _use_for(self, *, opening: bool) -> None:
        """Choose the solver for a base that is open or about to open, or for a standing one."""
        if opening != self._open:
            self._open = opening
            self._use(self._rim_solver if opening else self._flat_solver)

    def _turn(self, heading: float) -> None:
        """Rotate the x axis of the scene to an azimuth [rad], and its vectors back."""
        angle, self._heading = self._heading - heading, heading
        row = self._joint.getPositions()
        quaternion = quaternions(row[None, :3], _SPIN)[0]
        vectors = np.stack([row[3:], *self._rates(), quaternion[1:], self._slab_velocity])
        position, velocity, spin, quaternion[1:], self._slab_velocity = about_vertical(vectors, angle)
        self._set_pose(quaternion, position, velocity, spin)

    def _rates(self) -> tuple[Array, Array]:
        return self._cylinder.getLinearVelocity(), self._cylinder.getAngularVelocity()

    def _set_pose(self, quaternion: Array, position: Array, velocity: Array, spin: Array) -> None:
        self._joint.setPositions(np.concatenate([rotation_vector(quaternion, _SPIN), position]))
        self._joint.setLinearVelocity(velocity)
        self._joint.setAngularVelocity(spin)


class DartEngine(Declared):
    """DART 6: free joint, ground plane, contact found by ODE."""

    package, settings_type, facts = "dartpy", DartSettings, _FACTS
    stepper_type = _DartStepper
