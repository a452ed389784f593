"""PyBullet: one rigid body in a world of its own, stepped by a loop in Python.

Bullet finds one contact in a step and keeps four, wherever the base has leaned before: a cylinder that stands
on them leans by 1e-8 rad in a direction of chance, and uplifts at 0.98 of its load in some. So it is held
upright until friction does not hold it any more, and it slides on those four; or until the load is on its
rim. From there until it leans by 1e-7 rad it has a point of its rim for a contact, to which the scene is
turned: the lowest point runs about the rim faster than a step could follow.
"""

from __future__ import annotations

import contextlib
import functools
import math
import os
import sys
from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np

from rockwobble.models.support import SUPPORTS

from ..kinematics import about_vertical, turning
from ..protocol import Array, EngineFacts, SceneCounts, Settings, Stepper, Steps
from ..scene import Scene
from .declared import GUIDE, Declared, body_friction, build, positive, whole


@dataclass(frozen=True, slots=True, kw_only=True)
class PybulletSettings:
    """Settings of Bullet: its contact solver; its step and its cone leave no choice.

    Attributes
    ----------
    guide_stiffness : float
        As for MuJoCo [1/s^2]; from (0.05/h)^2/4 to (0.2/h)^2/4 nothing changes, stiffer ones are worse.
    friction_damping : float
        As for MuJoCo: share of the slip velocity that one step removes. Bullet knows no other than 1, which
        is made up for by a velocity of the ground, a plane that may move along itself unseen. At 1.8 the
        error of a free response is a tenth to a seventieth of that at 1, for a quarter more time a step.
    solver_residual : float
        At which an iteration stops. Bullet's own 1e-7 leaves an error fifty times that of the step.
    iterations : int
        At most. One contact takes a few; four contacts of a standing cylinder take all, and with fewer
        it creeps and uplifts early.
    contact_slop : float
        Depth that is not corrected, at the reference size [m]. Bullet's own is 1e-5.
    contact_erp : float
        Share of a depth that one step corrects. Under El Centro, turned by three azimuths, no value from
        0.02 to 0.2 is better by more than chance; 0.8 is worse.
    collision_margin : float
        Rounds the rim, at the reference size [m]. Bullet's own, 0.04, leaves a bias that no step removes.
    """

    guide_stiffness: float
    friction_damping: float = 1.8
    solver_residual: float = 1e-16
    iterations: int = 100
    contact_slop: float = 0.0
    contact_erp: float = 0.2
    collision_margin: float = 0.0

    @classmethod
    def resolve(cls, given: Mapping[str, Any], time_step: float) -> PybulletSettings:
        """Return the settings for a time step [s], with those `given` in place of the defaults.

        Raises
        ------
        ValueError
            If a setting is unknown or out of range.
        """
        settings = build(cls, "pybullet", given, {"guide_stiffness": (GUIDE / time_step) ** 2 / 4.0})
        positive(settings, "guide_stiffness")
        positive(settings, "friction_damping", most=2.0)
        positive(settings, "solver_residual")
        positive(settings, "contact_slop", most=0.1, or_zero=True)
        positive(settings, "contact_erp", most=1.0)
        positive(settings, "collision_margin", most=0.1, or_zero=True)
        whole(settings, "iterations")
        return settings


_POINT_SIZE = 1e-6  # of b
_LEAST = 1e-12  # friction of a pair, for a quotient


def make_ground(bullet: Any, client: int, scene: Scene, settings: PybulletSettings) -> int:
    """Set the parameters of the engine and make the ground; return its number."""
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
    ground = bullet.createMultiBody(0.0, plane, physicsClientId=client)
    bullet.changeDynamics(
        ground,
        -1,
        lateralFriction=body_friction(scene.friction, "product"),
        restitution=0.0,
        collisionMargin=settings.collision_margin,
        physicsClientId=client,
    )
    return int(ground)


def make_cylinder(
    bullet: Any, client: int, scene: Scene, settings: PybulletSettings, *, standing: bool
) -> int:
    """Make the cylinder, or the point on its rim from which it rises; return its number."""
    shape = scene.body
    if standing:
        size = _POINT_SIZE * shape.base_radius
        outline = bullet.createCollisionShape(
            bullet.GEOM_SPHERE,
            radius=size,
            collisionFramePosition=[shape.base_radius, 0.0, size - shape.mass_centre_height],
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
    body = bullet.createMultiBody(1.0, outline, physicsClientId=client)
    transverse, axial = shape.transverse_inertia, shape.axial_inertia
    bullet.changeDynamics(
        body,
        -1,
        lateralFriction=body_friction(scene.friction, "product"),
        # the pair has that of each body times the friction of the other
        rollingFriction=scene.rolling_resistance / body_friction(max(scene.friction, _LEAST), "product"),
        restitution=0.0,
        collisionMargin=settings.collision_margin,
        localInertiaDiagonal=[transverse, transverse, axial],
        linearDamping=0.0,
        angularDamping=0.0,
        activationState=bullet.ACTIVATION_STATE_DISABLE_SLEEPING,
        physicsClientId=client,
    )
    return int(body)


@contextlib.contextmanager
def quiet() -> Iterator[None]:
    """Keep what Bullet prints from C, its build time and the like, off both standard streams."""
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


_LEANS = 1e-7  # [rad] a cylinder that leans less has no lowest point to speak of
_RESIDUAL = 1e-10  # of an iteration, squared [m^2/s^2]; what a standing cylinder leaves is far below
_RISEN = 1e-7  # [rad] lean from which the rim carries the cylinder as well as the point does
_HAS_DIRECTION = 1e-9  # [rad]
_LOADED = 0.5  # of b, eccentricity of the load from which the scene follows it
_POSE = 7  # numbers of a pose: position, and quaternion with the scalar last
_NO_SPIN = (0.0, 0.0, 0.0)

_FACTS = EngineFacts(
    title="PyBullet",
    step_time=1.2e-5,
    release_error=1.5e-5,
    uplift_error=5e-6,
    smooth_uplift=True,
    rolling_friction=True,
)


class PybulletEngine(Declared):
    """Bullet 3 in double precision: plane, cylinder shape made in code, multibody solver."""

    package, settings_type, facts = "pybullet", PybulletSettings, _FACTS

    @contextlib.contextmanager
    def open(self, scene: Scene, settings: Settings) -> Iterator[Stepper]:
        """Open the scene at its start, in a client that is closed whatever happens."""
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


class _PybulletStepper:
    def __init__(self, pybullet: Any, client: int, scene: Scene, settings: PybulletSettings) -> None:
        self._bullet, self._client, self._step = pybullet, client, scene.time_step
        self._gravity = scene.gravity
        # guide_stiffness is in the time of the user; of both halves of the guide, torque for each twist
        stiffness = settings.guide_stiffness * scene.unit_time**2 * scene.body.axial_inertia
        self._stiffness = stiffness if SUPPORTS[scene.support].guided else 0.0
        self._standing = scene.start.standing
        self._ground = make_ground(pybullet, client, scene, settings)
        self._make = functools.partial(make_cylinder, pybullet, client, scene, settings)
        self._body = self._make(standing=self._standing)
        self._lengths = scene.body.base_radius, scene.body.mass_centre_height
        self._iterations, self._unsolved = settings.iterations, False
        self._overshoot = settings.friction_damping - 1.0
        self._heading = 0.0  # azimuth of the x axis of the scene in the world [rad]
        self._held = self._standing
        self._friction = scene.friction
        start = scene.start
        self._position = start.position
        self._quaternion = start.quaternion
        quaternion = np.roll(start.quaternion, -1)
        velocity, spin = start.velocity, start.angular_velocity
        self._put(start.position, quaternion, velocity, spin)
        if not start.standing:
            # leapfrog starts half a step back: a trial step shows the acceleration
            pybullet.stepSimulation(client)
            after, spin_after = map(np.array, pybullet.getBaseVelocity(self._body, client))
            velocity, spin = 1.5 * velocity - 0.5 * after, 1.5 * spin - 0.5 * spin_after
            self._put(start.position, quaternion, velocity, spin)

    @property
    def hold_centre(self) -> float:
        """Bullet steps as leapfrog does."""
        return 0.0

    def advance(self, acceleration: Array) -> Steps:
        """Take one step for each row of `acceleration`."""
        before = self._position, self._quaternion
        poses: list[float] = []
        headings: list[float] = []
        while self._standing and len(headings) < len(acceleration):
            now = acceleration[len(headings)]
            if self._held and self._slides(now):
                self._let_go()
                still = np.zeros(3)
                self._put(self._position, np.roll(self._quaternion, -1), still, still)
                break
            poses += self._stand(now)
            headings.append(self._heading)
        done = len(headings)
        if done < len(acceleration):
            pulls = about_vertical(-acceleration[done:] - [0.0, 0.0, self._gravity], -self._heading)
            poses += self._loop(pulls)
        heading = np.array(headings + [self._heading] * (len(acceleration) - done))
        rows = np.fromiter(poses, dtype=np.float64, count=len(poses)).reshape(-1, _POSE)
        position = about_vertical(rows[:, :3], heading)
        quaternion = np.roll(rows[:, 3:], 1, axis=1)
        quaternion[:, 1:] = about_vertical(quaternion[:, 1:], heading)
        self._position, self._quaternion = position[-1], quaternion[-1]
        # the new velocity moves the pose, so poses give the velocities, and the loop is spared a call
        velocity = np.diff(np.vstack([before[0], position]), axis=0) / self._step
        spin = turning(before[1], quaternion) / self._step
        return Steps(position, quaternion, velocity, spin, unsolved=self._unsolved)

    def _stand(self, acceleration: Array) -> tuple[float, ...]:
        """Take one step of a cylinder that stands, or rises from a point of its rim; return the pose."""
        bullet, client, (b, h) = self._bullet, self._client, self._lengths
        place, (x, y, z, w) = bullet.getBasePositionAndOrientation(self._body, client)
        axis_x, axis_y = 2.0 * (x * z + w * y), 2.0 * (y * z - w * x)
        lean = math.hypot(axis_x, axis_y)
        load = math.hypot(acceleration[0], acceleration[1]) * h / (b * (self._gravity + acceleration[2]))
        if self._held and load < 1.0:
            return (*place, x, y, z, w)
        self._held = False
        towards = self._heading
        if lean > _HAS_DIRECTION:
            towards += math.atan2(axis_y, axis_x)
        elif load > _LOADED:
            towards = math.atan2(-acceleration[1], -acceleration[0])
        velocities = bullet.getBaseVelocity(self._body, client)
        vectors = about_vertical(np.array([place, (x, y, z), *velocities]), self._heading - towards)
        self._heading = towards
        if lean > _RISEN:
            self._let_go()
        self._put(vectors[0], np.append(vectors[1], w), vectors[2], vectors[3])
        pull = about_vertical(-acceleration[None] - [0.0, 0.0, self._gravity], -towards)[0]
        bullet.setGravity(*pull.tolist(), client)
        bullet.stepSimulation(client)
        place, turn = bullet.getBasePositionAndOrientation(self._body, client)
        return (*place, *turn)

    def _slides(self, acceleration: Array) -> bool:
        """Whether friction does not hold a cylinder that stands."""
        push = math.hypot(acceleration[0], acceleration[1])
        return push > self._friction * float(self._gravity + acceleration[2])

    def _let_go(self) -> None:
        """Go on with the cylinder in place of the point of its rim; its pose is still to be set."""
        self._bullet.removeBody(self._body, self._client)
        self._body = self._make(standing=False)
        self._standing = False

    def _put(self, position: Array, quaternion: Array, velocity: Array, spin: Array) -> None:
        """Give the body a pose, with the scalar last as Bullet has it, and velocities."""
        pose = position.tolist(), quaternion.tolist()
        self._bullet.resetBasePositionAndOrientation(self._body, *pose, self._client)
        self._bullet.resetBaseVelocity(self._body, velocity, spin, physicsClientId=self._client)

    def warnings(self) -> str:
        """Bullet does not warn."""
        return ""

    def counts(self) -> SceneCounts:
        """Return the counts of the last step: a normal and two directions of friction for each contact."""
        contacts = len(self._bullet.getContactPoints(self._body, physicsClientId=self._client))
        return SceneCounts(degrees_of_freedom=6, contacts=contacts, constraint_rows=3 * contacts)

    def _analyse(self, wanted: bool) -> None:
        # of every step it would cost a tenth
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
            island["numIterationsUsed"] >= self._iterations and island["remainingResidual"] > _RESIDUAL
            for island in report
        )
        return poses + last

    def _steps(self, gravity: Array) -> tuple[list[float], Any]:
        """Return the poses, all in a row, and what the last step reported.

        Gravity is apparent, because rigid ground need not move.
        """
        # local names, because this is the one loop over steps in Python
        bullet, client, body = self._bullet, self._client, self._body
        step, pose, pull = bullet.stepSimulation, bullet.getBasePositionAndOrientation, bullet.setGravity
        torque, world, stiffness = bullet.applyExternalTorque, bullet.WORLD_FRAME, -2.0 * self._stiffness
        velocities, move = bullet.getBaseVelocity, bullet.resetBaseVelocity
        ground, overshoot, (b, h) = self._ground, self._overshoot, self._lengths
        atan2, sqrt = math.atan2, math.sqrt
        # numbers in one list, not tuples in one: those the garbage collector would go through again and again
        poses: list[float] = []
        report: Any = ()
        _, (x, y, z, w) = pose(body, client)
        for along_x, along_y, along_z in zip(*gravity.T.tolist(), strict=True):
            pull(along_x, along_y, along_z, client)
            across_x, across_y, xy = x * z + w * y, y * z - w * x, x * x + y * y
            if stiffness and z:
                # along the vertical plus the axis, proportional to the twist
                pair = 2.0 * stiffness * atan2(z, w)
                moment = pair * across_x, pair * across_y, pair * (1.0 - x * x - y * y)
                torque(body, -1, moment, world, client)
            ax, ay, az = 2.0 * across_x, 2.0 * across_y, 1.0 - 2.0 * xy
            sine = sqrt(ax * ax + ay * ay)
            if overshoot and sine > _LEANS:
                # the slip velocity that the last step left at the rim of this pose; Bullet's friction
                # takes the rim to the velocity of the ground, here beyond zero by the overshoot
                (vx, vy, _), (wx, wy, wz) = velocities(body, client)
                out, down = b * az / sine - h, h * az + b * sine
                slip_x, slip_y = vx - wy * down - wz * out * ay, vy + wz * out * ax + wx * down
                move(ground, (-overshoot * slip_x, -overshoot * slip_y, 0.0), _NO_SPIN, client)
            report = step(client)
            place, turn = pose(body, client)
            x, y, z, w = turn
            poses += place
            poses += turn
        return poses, report
