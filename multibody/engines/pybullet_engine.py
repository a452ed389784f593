"""PyBullet: one rigid body in a world of its own, stepped by a loop in Python."""

from __future__ import annotations

import contextlib
import math
import os
import sys
from collections.abc import Iterator
from typing import Any

import numpy as np

from ..facts import EngineFacts
from ..kinematics import turning
from ..protocol import Array, Scene, Settings, Stepper, Steps
from ..scene.friction import body_friction
from .scene_counts import SceneCounts
from .settings import PybulletSettings

_LEANS = 1e-7  # [rad] a cylinder that leans less has no lowest point to speak of
_RESIDUAL = 1e-10  # of an iteration, squared [m^2/s^2]; what a standing cylinder leaves is far below
_NO_SPIN = (0.0, 0.0, 0.0)

_FACTS = EngineFacts(
    title="PyBullet",
    step_time=3.6e-5,
    release_error=1.5e-5,
    uplift_error=4e-5,
    # it keeps four contacts, wherever the base has leaned before, and uplifts in a direction of chance
    finer_settings={"held_standing": True},
)


class PybulletEngine:
    """Bullet 3 in double precision: plane, cylinder shape made in code, multibody solver."""

    @property
    def supports(self) -> tuple[str, ...]:
        """Supports that it has."""
        return ("recess", "flat")

    @property
    def uplifts(self) -> bool:
        """The base is in contact as well as the rim."""
        return True

    @property
    def facts(self) -> EngineFacts:
        """Measured by halving the step."""
        return _FACTS

    def version(self) -> str:
        """Version of the package; the module itself tells only its interface number."""
        from importlib.metadata import version

        return version("pybullet")

    def settings(self, given: Settings, scene: Scene) -> dict[str, Any]:
        """Return every setting; see `PybulletSettings`."""
        resolved = PybulletSettings.resolve(given, scene.time_step * scene.unit_time)
        return {name: getattr(resolved, name) for name in PybulletSettings.__dataclass_fields__}

    @contextlib.contextmanager
    def open(self, scene: Scene, settings: Settings) -> Iterator[Stepper]:
        """Open the scene at its start, in a client that is closed whatever happens."""
        with _quiet():
            import pybullet

            client = pybullet.connect(pybullet.DIRECT)
        if client < 0:
            raise ValueError("PyBullet has no client left: close some of those that this process opened")
        try:
            yield _PybulletStepper(pybullet, client, scene, PybulletSettings(**settings))
        finally:
            with _quiet():
                pybullet.disconnect(client)


class _PybulletStepper:
    def __init__(self, pybullet: Any, client: int, scene: Scene, settings: PybulletSettings) -> None:
        self._bullet, self._client, self._step = pybullet, client, scene.time_step
        self._gravity = scene.gravity
        # guide_stiffness is in the time of the user; of both halves of the guide, torque for each twist
        stiffness = settings.guide_stiffness * scene.unit_time**2 * scene.body.axial_inertia
        self._stiffness = stiffness if scene.support == "recess" else 0.0
        self._ground, self._body = _build(pybullet, client, scene, settings)
        self._lengths = scene.body.base_radius, scene.body.mass_centre_height
        self._iterations, self._unsolved = settings.iterations, False
        self._overshoot = settings.friction_damping - 1.0
        start = scene.start
        self._held = settings.held_standing and start.standing
        self._position = start.position
        self._quaternion = start.quaternion
        pose = start.position.tolist(), np.roll(start.quaternion, -1).tolist()
        velocity, spin = start.velocity, start.angular_velocity
        pybullet.resetBasePositionAndOrientation(self._body, *pose, client)
        if not start.standing:
            # leapfrog starts half a step back: a trial step shows the acceleration
            pybullet.resetBaseVelocity(self._body, velocity, spin, physicsClientId=client)
            pybullet.stepSimulation(client)
            after, spin_after = map(np.array, pybullet.getBaseVelocity(self._body, client))
            velocity, spin = 1.5 * velocity - 0.5 * after, 1.5 * spin - 0.5 * spin_after
            pybullet.resetBasePositionAndOrientation(self._body, *pose, client)
        pybullet.resetBaseVelocity(self._body, velocity, spin, physicsClientId=client)

    @property
    def hold_centre(self) -> float:
        """Bullet steps as leapfrog does."""
        return 0.0

    def advance(self, acceleration: Array) -> Steps:
        """Take one step for each row of `acceleration`."""
        before = self._position, self._quaternion
        held = self._held_steps(acceleration)
        positions: list[Any] = [before[0].tolist()] * held
        quaternions: list[Any] = [np.roll(before[1], -1).tolist()] * held
        if held < len(acceleration):
            pulls = (-acceleration[held:] - [0.0, 0.0, self._gravity]).tolist()
            for poses, more in zip((positions, quaternions), self._loop(pulls, before[1]), strict=True):
                poses += more
        position = np.array(positions)
        quaternion = np.roll(np.array(quaternions), 1, axis=1)
        self._position, self._quaternion = position[-1], quaternion[-1]
        # the new velocity moves the pose, so poses give the velocities, and the loop is spared a call
        velocity = np.diff(np.vstack([before[0], position]), axis=0) / self._step
        spin = turning(before[1], quaternion) / self._step
        return Steps(position, quaternion, velocity, spin, unsolved=self._unsolved)

    def _held_steps(self, acceleration: Array) -> int:
        """Number of steps for which the cylinder is held upright: until the load is on the rim."""
        if not self._held:
            return 0
        b, h = self._lengths
        push = np.hypot(acceleration[:, 0], acceleration[:, 1])
        over = np.flatnonzero(push * h >= b * (self._gravity + acceleration[:, 2]))
        self._held = not len(over)
        return int(over[0]) if len(over) else len(acceleration)

    def warnings(self) -> str:
        """Bullet does not warn."""
        return ""

    def counts(self) -> SceneCounts:
        """Return what the last step solved: a normal and two directions of friction for each contact."""
        contacts = len(self._bullet.getContactPoints(self._body, physicsClientId=self._client))
        return SceneCounts(degrees_of_freedom=6, contacts=contacts, constraint_rows=3 * contacts)

    def _analyse(self, wanted: bool) -> None:
        # of every step it would cost a tenth
        self._bullet.setPhysicsEngineParameter(
            reportSolverAnalytics=int(wanted), physicsClientId=self._client
        )

    def _loop(self, gravity: list[list[float]], start: Array) -> tuple[list[Any], list[Any]]:
        """Step under an apparent gravity [m/s^2] for each step: rigid ground need not move."""
        # local names, because this is the one loop over steps in Python
        bullet, client, body = self._bullet, self._client, self._body
        step, pose, pull = bullet.stepSimulation, bullet.getBasePositionAndOrientation, bullet.setGravity
        torque, world, stiffness = bullet.applyExternalTorque, bullet.WORLD_FRAME, -2.0 * self._stiffness
        velocities, move = bullet.getBaseVelocity, bullet.resetBaseVelocity
        ground, overshoot, (b, h) = self._ground, self._overshoot, self._lengths
        atan2, sqrt = math.atan2, math.sqrt
        positions: list[Any] = []
        quaternions: list[Any] = []
        add_position, add_quaternion = positions.append, quaternions.append
        report: Any = ()
        w, x, y, z = start.tolist()
        last = len(gravity) - 1
        for index, (along_x, along_y, along_z) in enumerate(gravity):
            if index == last:
                self._analyse(True)
            pull(along_x, along_y, along_z, client)
            if stiffness and z:
                # along the vertical plus the axis, proportional to the twist
                pair = 2.0 * stiffness * atan2(z, w)
                torque(
                    body,
                    -1,
                    (pair * (x * z + w * y), pair * (y * z - w * x), pair * (1.0 - x * x - y * y)),
                    world,
                    client,
                )
            ax, ay, az = 2.0 * (x * z + w * y), 2.0 * (y * z - w * x), 1.0 - 2.0 * (x * x + y * y)
            sine = sqrt(ax * ax + ay * ay)
            if overshoot and sine > _LEANS:
                # the slip velocity that the last step left at the rim of this pose; Bullet's friction
                # takes the rim to the velocity of the ground, here beyond zero by the overshoot
                (vx, vy, _), (wx, wy, wz) = velocities(body, client)
                out, down = b * az / sine - h, h * az + b * sine
                slip_x, slip_y = vx - wy * down - wz * out * ay, vy + wz * out * ax + wx * down
                move(ground, (-overshoot * slip_x, -overshoot * slip_y, 0.0), _NO_SPIN, client)
            report = step(client)
            place, (x, y, z, w) = pose(body, client)
            add_position(place)
            add_quaternion((x, y, z, w))
        self._analyse(False)
        self._unsolved = any(
            island["numIterationsUsed"] >= self._iterations and island["remainingResidual"] > _RESIDUAL
            for island in report
        )
        return positions, quaternions


def _build(bullet: Any, client: int, scene: Scene, settings: PybulletSettings) -> tuple[int, int]:
    """Make ground and cylinder; return their numbers."""
    shape = scene.body
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
    above = 0.5 * shape.height - shape.mass_centre_height
    # a shape with a frame becomes a compound, which costs time: only where the outline needs it
    frame = {"collisionFramePosition": [0.0, 0.0, above]} if above else {}
    outline = bullet.createCollisionShape(
        bullet.GEOM_CYLINDER, radius=shape.base_radius, height=shape.height, physicsClientId=client, **frame
    )
    body = bullet.createMultiBody(1.0, outline, physicsClientId=client)
    of_body, of_ground = body_friction(scene.friction, "product")
    common = {"restitution": 0.0, "collisionMargin": settings.collision_margin, "physicsClientId": client}
    bullet.changeDynamics(ground, -1, lateralFriction=of_ground, **common)
    transverse, axial = shape.transverse_inertia, shape.axial_inertia
    bullet.changeDynamics(
        body,
        -1,
        lateralFriction=of_body,
        localInertiaDiagonal=[transverse, transverse, axial],
        linearDamping=0.0,
        angularDamping=0.0,
        activationState=bullet.ACTIVATION_STATE_DISABLE_SLEEPING,
        **common,
    )
    return int(ground), int(body)


@contextlib.contextmanager
def _quiet() -> Iterator[None]:
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
