"""PyBullet: one rigid body in a world of its own, stepped by a loop in Python.

Bullet finds one contact in a step and keeps four, wherever the base has leaned before: a cylinder that stands
on them leans by 1e-8 rad in a direction of chance, and uplifts at 0.98 of its load in some. So it is held
upright until friction does not hold it any more, and it slides on those four; or until the load is on its
rim. From there until it leans by 1e-7 rad it has a point of its rim for a contact, to which the scene is
turned: the lowest point runs about the rim faster than a step could follow.
"""

from __future__ import annotations

import contextlib
import math
import os
import sys
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from types import ModuleType
from typing import Annotated

import numpy as np

from rockwobble.models.mode import SLIDES

from ..kinematics import about_vertical
from ..protocol import EngineFacts, SceneCounts, Settings, Stepper, Steps
from ..scene import Array, Scene
from ..settings import Count, EngineSettings, Positive, Share, positive
from .declared import Declared, Leapfrog, contact_counts


@dataclass(frozen=True, slots=True, kw_only=True)
class PybulletSettings(EngineSettings):
    """Settings of Bullet: its contact solver; its step and its cone leave no choice.

    Attributes
    ----------
    guide_stiffness : float
        As for MuJoCo [1/s^2].
    friction_damping : float
        As for MuJoCo: share of the slip velocity that one step removes. Bullet knows no other than 1, which
        is made up for by a velocity of the ground, a plane that may move along itself unseen.
    solver_residual : float
        Solver residual at which an iteration stops. Bullet's own, 1e-7, leaves more than the step does.
    iterations : int
        At most. One contact takes a few; four contacts of a standing cylinder take all, and with fewer
        it creeps and uplifts early.
    contact_slop : float
        Depth that is not corrected, at the reference size [m]. Bullet's own is 1e-5.
    contact_erp : float
        Share of a depth that one step corrects: little enough that what is corrected throws nothing up.
    collision_margin : float
        Rounds the rim, at the reference size [m]. Bullet's own, 0.04, leaves a bias that no step removes.
    """

    guide_stiffness: Positive
    friction_damping: Annotated[float, positive(most=2.0)] = 1.8
    solver_residual: Positive = 1e-16
    iterations: Count = 100
    contact_slop: Annotated[float, positive(most=0.1, or_zero=True)] = 0.0
    contact_erp: Share = 0.2
    collision_margin: Annotated[float, positive(most=0.1, or_zero=True)] = 0.0


_POINT_SIZE = 1e-6  # size over b
_LEAST = 1e-12  # friction of a pair that stands for zero in a quotient


def _friction_of_each(pair: float) -> float:
    """Equal coefficients of cylinder and ground whose pair has the coefficient `pair` [-].

    Bullet takes the product of both, at most 10, so that neither is the rough one. A rim that slides feels
    2 to 5 % less friction than that; one that holds is not concerned.
    """
    return math.sqrt(pair)


@contextlib.contextmanager
def quiet() -> Iterator[None]:
    """Suppress the output of Bullet's C code, such as its build time, on both standard streams."""
    sys.stdout.flush()
    sys.stderr.flush()
    kept = [os.dup(stream) for stream in (1, 2)]
    try:
        with open(os.devnull, "w") as nowhere:  # noqa: PTH123 - a descriptor is what is needed
            for stream in (1, 2):
                os.dup2(nowhere.fileno(), stream)
        yield
    finally:
        for stream, original in zip((1, 2), kept, strict=True):
            os.dup2(original, stream)
            os.close(original)


_LEANS = 1e-7  # [rad] tilt below which the lowest point is noise
_RESIDUAL = 1e-10  # squared residual of an iteration [m^2/s^2]; far above that of a standing cylinder
_RISEN = 1e-7  # [rad] tilt above which the rim carries the cylinder as well as the point does
_HAS_DIRECTION = 1e-9  # [rad]
_LOADED = 0.5  # eccentricity of the load over b above which the scene turns with it
# steps between two checks of the direction of a slide; [rad] off an axis and [m/s] from which the scene turns
# with it
_SLIDING_BLOCK, _OFF_SLIP, _SLIPS = 20, 0.02, 1e-4
_POSE = 7  # numbers of a pose: position, and quaternion with the scalar last
_NO_SPIN = (0.0, 0.0, 0.0)
_DOWNWARDS = (1.0, 0.0, 0.0, 0.0)  # half a turn about x, with the scalar last

_FACTS = EngineFacts(
    title="PyBullet",
    step_time=1.2e-5,
    release_error=1.5e-5,
    uplift_error=5e-6,
    smooth_uplift=True,
    carries_slab=True,
    terms=frozenset({"tendon", "rolling_resistance"}),
)


class PybulletEngine(Declared):
    """Bullet 3 in double precision: plane, cylinder shape made in code, multibody solver."""

    package, settings_type, facts = "pybullet", PybulletSettings, _FACTS

    @contextlib.contextmanager
    def open(self, scene: Scene, settings: Settings) -> Iterator[Stepper]:
        """Open the scene at its start, in a client that is closed also after an exception."""
        with quiet():
            import pybullet

            client = pybullet.connect(pybullet.DIRECT)
        if client < 0:
            raise ValueError("PyBullet has no client left: close some of those that this process opened")
        try:
            yield _PybulletStepper(pybullet, client, scene, PybulletSettings(**settings))
        finally:
            with quiet():
                pybullet.disconnect(client)


class _PybulletStepper(Leapfrog):
    def __init__(self, pybullet: ModuleType, client: int, scene: Scene, settings: PybulletSettings) -> None:
        super().__init__(scene, settings.guide_stiffness)
        self._bullet, self._client, self._settings = pybullet, client, settings
        self._standing = self._held = scene.start.standing
        self._ground, self._body = self._add_ground(), self._add_cylinder()
        self._slab = self._add_slab() if scene.body.slab_mass_ratio else None
        self._slab_velocity = 2.0 * scene.start.velocity  # slab velocity in the axes of the scene [m/s]
        self._lengths = scene.body.base_radius, scene.body.mass_centre_height
        self._unsolved = False
        start = scene.start
        quaternion = np.roll(start.quaternion, -1)
        velocity, spin = start.velocity, start.angular_velocity
        self._set_pose(start.position, quaternion, velocity, spin)
        if not start.standing:
            # leapfrog starts half a step back: a trial step gives the acceleration
            self._pull_tendon(start.position.tolist(), quaternion.tolist())
            pybullet.stepSimulation(client)
            after, spin_after = map(np.array, pybullet.getBaseVelocity(self._body, client))
            velocity, spin = 1.5 * velocity - 0.5 * after, 1.5 * spin - 0.5 * spin_after
            if self._slab is not None:
                slab_after = np.array(pybullet.getBaseVelocity(self._slab, client)[0])
                self._slab_velocity = 1.5 * self._slab_velocity - 0.5 * slab_after
                self._put_slab(self._slab)
            self._set_pose(start.position, quaternion, velocity, spin)

    def _add_ground(self) -> int:
        """Set the parameters of the engine and make the ground; return its number."""
        bullet, client, scene, settings = self._bullet, self._client, self._scene, self._settings
        bullet.setPhysicsEngineParameter(
            fixedTimeStep=scene.time_step,
            numSubSteps=0,
            numSolverIterations=settings.iterations,
            solverResidualThreshold=settings.solver_residual,
            contactSlop=settings.contact_slop,
            contactERP=settings.contact_erp,
            physicsClientId=client,
        )
        bullet.setGravity(0.0, 0.0, -scene.gravity, client)
        plane = bullet.createCollisionShape(bullet.GEOM_PLANE, physicsClientId=client)
        return self._add_body(0.0, plane)

    def _add_cylinder(self) -> int:
        """Make the cylinder, or while it stands the point of its rim for the uplift; return its number.

        Under a slab it rises between two points, the other being the mirror of the first.
        """
        bullet, client, scene = self._bullet, self._client, self._scene
        shape, friction = scene.body, max(scene.friction, _LEAST)
        if self._standing:
            size = _POINT_SIZE * shape.base_radius
            point = [shape.base_radius, 0.0, size - shape.mass_centre_height]
            points = [point, [-x for x in point]] if shape.slab_mass_ratio > 0.0 else [point]
            outline = bullet.createCollisionShapeArray(
                [bullet.GEOM_SPHERE] * len(points),
                radii=[size] * len(points),
                collisionFramePositions=points,
                physicsClientId=client,
            )
        else:
            above = 0.5 * shape.height - shape.mass_centre_height
            # a shape with a frame becomes a compound, which costs time: only where the outline needs it
            frame = {"collisionFramePosition": [0.0, 0.0, above]} if above else {}
            outline = bullet.createCollisionShape(
                bullet.GEOM_CYLINDER,
                radius=shape.base_radius,
                height=shape.height,
                physicsClientId=client,
                **frame,
            )
        return self._add_body(
            1.0,
            outline,
            # that of a pair is that of each body times the sliding friction of the other
            rollingFriction=scene.rolling_resistance / _friction_of_each(friction),
            localInertiaDiagonal=[shape.transverse_inertia, shape.transverse_inertia, shape.axial_inertia],
        )

    def _add_slab(self) -> int:
        """Make a slab that can only translate, a plane that looks down; return its number."""
        plane = self._bullet.createCollisionShape(self._bullet.GEOM_PLANE, physicsClientId=self._client)
        # Bullet takes a zero inertia for infinite
        slab = self._add_body(self._scene.body.slab_mass_ratio, plane, localInertiaDiagonal=[0.0, 0.0, 0.0])
        self._put_slab(slab)
        return slab

    def _add_body(self, mass: float, shape: int, **dynamics: object) -> int:
        """Make a body without damping, restitution and sleep; return its number."""
        bullet, client = self._bullet, self._client
        body = bullet.createMultiBody(mass, shape, physicsClientId=client)
        bullet.changeDynamics(
            body,
            -1,
            lateralFriction=_friction_of_each(self._scene.friction),
            restitution=0.0,
            linearDamping=0.0,
            angularDamping=0.0,
            collisionMargin=self._settings.collision_margin,
            activationState=bullet.ACTIVATION_STATE_DISABLE_SLEEPING,
            physicsClientId=client,
            **dynamics,
        )
        return int(body)

    def _put_slab(self, slab: int) -> None:
        """Put the slab on the top of the cylinder at its start, looking down."""
        place = [0.0, 0.0, 2.0 * float(self._scene.start.position[2])]
        self._bullet.resetBasePositionAndOrientation(slab, place, _DOWNWARDS, self._client)

    def advance(self, acceleration: Array) -> Steps:
        """Take one step for each row of `acceleration`."""
        poses: list[float] = []
        headings: list[float] = []
        while self._standing and len(headings) < len(acceleration):
            now = acceleration[len(headings)]
            if self._held and self._slides(now):
                self._release_rim()
                still = np.zeros(3)
                self._set_pose(self._position, np.roll(self._quaternion, -1), still, still)
                break
            poses += self._stand(now)
            headings.append(self._heading)
        block = _SLIDING_BLOCK if self._scene.mode == SLIDES else len(acceleration)
        while (done := len(headings)) < len(acceleration):
            if self._scene.mode == SLIDES:
                self._turn_to_slip()
            now = acceleration[done : done + block]
            poses += self._loop(about_vertical(-now - [0.0, 0.0, self._scene.gravity], -self._heading))
            headings += [self._heading] * len(now)
        heading = np.array(headings)
        rows = np.fromiter(poses, dtype=np.float64, count=len(poses)).reshape(-1, _POSE)
        return self._steps_to(rows[:, :3], np.roll(rows[:, 3:], 1, axis=1), heading, unsolved=self._unsolved)

    def _stand(self, acceleration: Array) -> tuple[float, ...]:
        """Take one step of a cylinder that stands, or uplifts from a point of its rim; return the pose."""
        bullet, client, (b, h) = self._bullet, self._client, self._lengths
        place, (x, y, z, w) = bullet.getBasePositionAndOrientation(self._body, client)
        axis_x, axis_y = 2.0 * (x * z + w * y), 2.0 * (y * z - w * x)
        lean = math.hypot(axis_x, axis_y)
        push = math.hypot(acceleration[0], acceleration[1]) * h
        load = push / (b * (self._scene.tipping_gravity + acceleration[2]))
        if self._held and load < 1.0:
            return (*place, x, y, z, w)
        self._held = False
        towards = self._heading
        if lean > _HAS_DIRECTION:
            towards += math.atan2(axis_y, axis_x)
        elif load > _LOADED:
            towards = math.atan2(-acceleration[1], -acceleration[0])
        velocities = bullet.getBaseVelocity(self._body, client)
        vectors = np.array([place, (x, y, z), *velocities, self._slab_velocity])
        vectors = about_vertical(vectors, self._heading - towards)
        self._heading = towards
        if lean > _RISEN:
            self._release_rim()
        self._slab_velocity = vectors[4]
        self._set_pose(vectors[0], np.append(vectors[1], w), vectors[2], vectors[3])
        pull = about_vertical(-acceleration[None] - [0.0, 0.0, self._scene.gravity], -towards)[0]
        bullet.setGravity(*pull.tolist(), client)
        self._pull_tendon(vectors[0].tolist(), [*vectors[1].tolist(), w])
        bullet.stepSimulation(client)
        if self._slab is not None:
            self._slab_velocity = np.array(bullet.getBaseVelocity(self._slab, client)[0])
        place, turn = bullet.getBasePositionAndOrientation(self._body, client)
        return (*place, *turn)

    def _turn_to_slip(self) -> None:
        """Rotate the scene until the base slides along one of its axes, along which friction is Coulomb's."""
        bullet, client = self._bullet, self._client
        place, (x, y, z, w) = bullet.getBasePositionAndOrientation(self._body, client)
        velocity, spin = bullet.getBaseVelocity(self._body, client)
        off = math.atan2(velocity[1], velocity[0])
        if abs(math.remainder(off, 0.5 * math.pi)) < _OFF_SLIP or math.hypot(*velocity[:2]) < _SLIPS:
            return
        vectors = about_vertical(np.array([place, (x, y, z), velocity, spin]), -off)
        self._heading += off
        self._set_pose(vectors[0], np.append(vectors[1], w), vectors[2], vectors[3])

    def _slides(self, acceleration: Array) -> bool:
        """Whether friction does not hold a cylinder that stands."""
        push = math.hypot(acceleration[0], acceleration[1])
        return push > self._scene.friction * float(self._scene.pressing_gravity + acceleration[2])

    def _pull_tendon(self, place: Sequence[float], turn: Sequence[float]) -> None:
        """Apply the forces of the tendon in the next step, at a place and a quaternion, scalar last."""
        restraint = self._scene.restraint
        if not restraint.is_active:
            return
        x, y, z, w = turn
        axis = 2.0 * (x * z + w * y), 2.0 * (y * z - w * x), 1.0 - 2.0 * (x * x + y * y)
        force, torque = restraint.loads(place, axis, self._lengths[1])
        bullet, client, world = self._bullet, self._client, self._bullet.WORLD_FRAME
        bullet.applyExternalTorque(self._body, -1, torque, world, client)
        body, at = self._body, place
        if self._slab is not None:
            body, at = self._slab, bullet.getBasePositionAndOrientation(self._slab, client)[0]
        bullet.applyExternalForce(body, -1, force, at, world, client)

    def _release_rim(self) -> None:
        """Replace the point of the rim by the cylinder; its pose is still to be set."""
        self._bullet.removeBody(self._body, self._client)
        self._standing = False
        self._body = self._add_cylinder()

    def _set_pose(self, position: Array, quaternion: Array, velocity: Array, spin: Array) -> None:
        """Give the body a pose, with the scalar last as Bullet has it, and velocities."""
        pose = position.tolist(), quaternion.tolist()
        self._bullet.resetBasePositionAndOrientation(self._body, *pose, self._client)
        self._bullet.resetBaseVelocity(self._body, velocity, spin, physicsClientId=self._client)
        if self._slab is not None:
            self._bullet.resetBaseVelocity(self._slab, self._slab_velocity, physicsClientId=self._client)

    def counts(self) -> SceneCounts:
        """Return the counts of the last step."""
        return contact_counts(len(self._bullet.getContactPoints(self._body, physicsClientId=self._client)))

    def _analyse(self, wanted: bool) -> None:
        # checked in every step it would cost a tenth
        self._bullet.setPhysicsEngineParameter(
            reportSolverAnalytics=int(wanted), physicsClientId=self._client
        )

    def _loop(self, gravity: Array) -> list[float]:
        """Return the poses, all in a row, of steps under an apparent gravity (n, 3) [m/s^2]."""
        poses, _ = self._steps(gravity[:-1])
        self._analyse(True)
        last, report = self._steps(gravity[-1:])
        self._analyse(False)
        self._unsolved = any(
            island["numIterationsUsed"] >= self._settings.iterations
            and island["remainingResidual"] > _RESIDUAL
            for island in report
        )
        return poses + last

    def _steps(self, gravity: Array) -> tuple[list[float], Sequence[Mapping[str, float]]]:
        """Poses in one row, and the report of the last step.

        Gravity is apparent, because rigid ground need not move.
        """
        # local names, because this is the one loop over steps in Python
        bullet, client, body = self._bullet, self._client, self._body
        step, pose, pull = bullet.stepSimulation, bullet.getBasePositionAndOrientation, bullet.setGravity
        torque, world, stiffness = bullet.applyExternalTorque, bullet.WORLD_FRAME, -2.0 * self._stiffness
        velocities, move = bullet.getBaseVelocity, bullet.resetBaseVelocity
        ground, overshoot, (b, h) = self._ground, self._settings.friction_damping - 1.0, self._lengths
        slab, (slab_x, slab_y, slab_z) = self._slab, self._slab_velocity.tolist()
        atan2, sqrt, pull_tendon = math.atan2, math.sqrt, self._pull_tendon
        tied = self._scene.restraint.is_active
        # one list of numbers: the garbage collector would traverse a list of tuples again and again
        poses: list[float] = []
        beyond_x = beyond_y = 0.0
        report: Sequence[Mapping[str, float]] = ()
        place, (x, y, z, w) = pose(body, client)
        for along_x, along_y, along_z in zip(*gravity.T.tolist(), strict=True):
            pull(along_x, along_y, along_z, client)
            across_x, across_y, xy = x * z + w * y, y * z - w * x, x * x + y * y
            if stiffness and z:
                # torque along the vertical plus the axis, proportional to the twist
                pair = 2.0 * stiffness * atan2(z, w)
                moment = pair * across_x, pair * across_y, pair * (1.0 - x * x - y * y)
                torque(body, -1, moment, world, client)
            if tied:
                pull_tendon(place, (x, y, z, w))
            ax, ay, az = 2.0 * across_x, 2.0 * across_y, 1.0 - 2.0 * xy
            sine = sqrt(ax * ax + ay * ay)
            if overshoot and sine > _LEANS:
                # slip velocity at the rim of this pose after the last step; Bullet's friction takes the rim
                # to the velocity of the ground, here beyond zero by the overshoot
                (vx, vy, _), (wx, wy, wz) = velocities(body, client)
                out, down = b * az / sine - h, h * az + b * sine
                turn_x, turn_y = wy * down + wz * out * ay, wz * out * ax + wx * down
                slip_x, slip_y = vx - turn_x, vy + turn_y
                move(ground, (-overshoot * slip_x, -overshoot * slip_y, 0.0), _NO_SPIN, client)
                if slab is not None:
                    # the same on the slab, whose added velocity is for this step alone
                    beyond_x = overshoot * (slab_x - vx - turn_x)
                    beyond_y = overshoot * (slab_y - vy + turn_y)
                    move(slab, (slab_x + beyond_x, slab_y + beyond_y, slab_z), _NO_SPIN, client)
            report = step(client)
            if slab is not None:
                (slab_x, slab_y, slab_z), _ = velocities(slab, client)
                slab_x, slab_y = slab_x - beyond_x, slab_y - beyond_y
            place, turn = pose(body, client)
            x, y, z, w = turn
            poses += place
            poses += turn
        self._slab_velocity = np.array((slab_x, slab_y, slab_z))
        return poses, report
