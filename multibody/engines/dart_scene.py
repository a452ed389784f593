"""The scene of DART, and its rotation vectors."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import numpy as np

from ..protocol import Array, Scene
from ..scene.friction import body_friction
from .settings.dart import DartSettings


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class DartScene:
    """A ground that may have a velocity, though it does not move, and a cylinder on it.

    Attributes
    ----------
    world : dartpy.simulation.World
    ground : dartpy.dynamics.TranslationalJoint
    cylinder : dartpy.dynamics.BodyNode
    joint : dartpy.dynamics.FreeJoint
        Its positions are a rotation vector and the position of the mass centre [m].
    use : callable
        Takes the solver of contact.
    flat_solver, rim_solver : dartpy.constraint.BoxedLcpSolver
    """

    world: Any
    ground: Any
    cylinder: Any
    joint: Any
    use: Callable[[Any], None]
    flat_solver: Any
    rim_solver: Any


def build(scene: Scene, settings: DartSettings) -> DartScene:
    """Make ground and cylinder, the mass centre at the origin."""
    import dartpy

    shape, dynamics = scene.body, dartpy.dynamics
    world = dartpy.simulation.World()
    world.setTimeStep(scene.time_step)
    world.setGravity([0.0, 0.0, -scene.gravity])
    solver = world.getConstraintSolver()
    # its own detector and FCL's find one contact under a flat base, and Bullet's rounds the rim
    solver.setCollisionDetector(dartpy.collision.OdeCollisionDetector())
    friction = body_friction(scene.friction, "pair")

    def collide(node: Any, outline: Any) -> Any:
        placed = node.createShapeNode(outline)
        placed.createCollisionAspect()
        placed.createDynamicsAspect().setFrictionCoeff(friction)
        return placed

    ground = dynamics.Skeleton("ground")
    slide, plane = ground.createTranslationalJointAndBodyNodePair()
    collide(plane, dynamics.PlaneShape([0.0, 0.0, 1.0], 0.0))
    ground.setMobile(False)
    cylinder = dynamics.Skeleton("cylinder")
    joint, body = cylinder.createFreeJointAndBodyNodePair()
    outline = collide(body, dynamics.CylinderShape(shape.base_radius, shape.height))
    place = dartpy.math.Isometry3()
    place.set_translation([0.0, 0.0, 0.5 * shape.height - shape.mass_centre_height])
    outline.setRelativeTransform(place)
    inertia = np.diag([shape.transverse_inertia, shape.transverse_inertia, shape.axial_inertia])
    body.setInertia(dynamics.Inertia(1.0, np.zeros(3), inertia))
    world.addSkeleton(ground)
    world.addSkeleton(cylinder)
    options = dartpy.constraint.NsgsFrictionSolver.Options()
    options.tolerance, options.maxSweeps = settings.tolerance, settings.iterations
    return DartScene(
        world=world,
        ground=slide,
        cylinder=body,
        joint=joint,
        use=solver.setBoxedLcpSolver,
        flat_solver=solver.getBoxedLcpSolver(),
        rim_solver=dartpy.constraint.NsgsFrictionSolver(options),
    )


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
