"""The scene of PyBullet: ground and cylinder, made in code, and what it prints kept quiet."""

from __future__ import annotations

import contextlib
import os
import sys
from collections.abc import Iterator
from typing import Any

from ..protocol import Scene
from ..scene.friction import body_friction
from .settings.pybullet import PybulletSettings

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
