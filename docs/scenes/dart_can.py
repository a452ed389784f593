"""A can on flat ground in DART, released with some spin, until it leans most again."""

from __future__ import annotations

import math

import dartpy as dart
import numpy as np

B, H = 1.0, 2.0  # radius and half height [m]
TILT, SPIN = 0.5 * math.atan(0.5), 0.1  # tilt [rad] and rolling rate [rad/s] of the release
STEP = 2e-5  # [s]
I1, I2 = (3 * B**2 + 4 * H**2) / 12, B**2 / 2  # per unit mass


def scene() -> tuple[dart.simulation.World, dart.dynamics.FreeJoint]:
    """Build ground and can; return the world and the joint of the can."""
    world = dart.simulation.World()
    world.setTimeStep(STEP)
    world.setGravity([0.0, 0.0, -9.81])
    # ODE's detector: the default ones give a base that stands a single contact, Bullet's keeps a bias
    world.getConstraintSolver().setCollisionDetector(dart.collision.OdeCollisionDetector())

    ground = dart.dynamics.Skeleton("ground")
    _, plate = ground.createWeldJointAndBodyNodePair()
    # a plane: on a box the same detector tilts the can to a third of the release
    slab = plate.createShapeNode(dart.dynamics.PlaneShape([0.0, 0.0, 1.0], 0.0))

    can = dart.dynamics.Skeleton("can")
    joint, body = can.createFreeJointAndBodyNodePair()
    outline = body.createShapeNode(dart.dynamics.CylinderShape(B, 2 * H))
    body.setInertia(dart.dynamics.Inertia(1.0, [0.0, 0.0, 0.0], np.diag([I1, I1, I2])))
    for shape in (slab, outline):
        shape.createCollisionAspect()
        shape.createDynamicsAspect().setFrictionCoeff(1.0)
    world.addSkeleton(ground)
    world.addSkeleton(can)
    return world, joint


def release(joint: dart.dynamics.FreeJoint) -> None:
    """Lean the can towards x, rolling without slip and without a turn about its own axis."""
    axis = np.array([math.sin(TILT), 0.0, math.cos(TILT)])
    centre = np.array([B * (1 - axis[2]), 0.0, B * axis[0]]) + H * axis
    turning = SPIN * (np.array([0.0, 0.0, 1.0]) - axis)
    pose = dart.math.Isometry3()
    pose.set_rotation(dart.math.AngleAxis(TILT, [0.0, 1.0, 0.0]).to_rotation_matrix())
    pose.set_translation(centre)
    joint.setTransform(pose)
    joint.setLinearVelocity(np.cross(turning, centre - [B, 0.0, 0.0]))
    joint.setAngularVelocity(turning)


def next_largest_tilt(seconds: float = 2.0) -> tuple[float, float]:
    """Return the angle of turn until the next largest tilt [deg], and that tilt over the one of release."""
    world, joint = scene()
    release(joint)
    can, axes = joint.getChildBodyNode(), []
    for _ in range(int(seconds / STEP)):
        world.step()
        axes.append(can.getWorldTransform().rotation()[:, 2])
    lean = np.array(axes)
    tilt = np.arccos(lean[:, 2])
    upright = int(tilt[: int(1.2 / STEP)].argmin())
    top = upright + int(tilt[upright:].argmax())
    return math.degrees(np.unwrap(np.arctan2(lean[:, 1], lean[:, 0]))[top]), tilt[top] / TILT


if __name__ == "__main__":
    turn, tilt = next_largest_tilt()
    print(f"turned by {turn:.3f} deg (exact 203.910), tilted to {tilt:.5f} of the release (exact 1)")
