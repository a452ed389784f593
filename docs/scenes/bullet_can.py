"""A can on flat ground in Bullet, released with some spin, until it leans most again."""

from __future__ import annotations

import math

import numpy as np
import pybullet

B, H = 1.0, 2.0  # radius and half height [m]
TILT, SPIN = 0.5 * math.atan(0.5), 0.1  # tilt [rad] and rolling rate [rad/s] of the release
STEP = 1e-4  # [s]
I1, I2 = (3 * B**2 + 4 * H**2) / 12, B**2 / 2  # per unit mass


def scene() -> int:
    """Build ground and can; return the number of the can."""
    # the default residual stops the solver at fifty times the error of the step; slop holds the can up
    pybullet.setPhysicsEngineParameter(
        fixedTimeStep=STEP, numSolverIterations=100, solverResidualThreshold=1e-16, contactSlop=0.0
    )
    pybullet.setGravity(0.0, 0.0, -9.81)
    ground = pybullet.createMultiBody(0.0, pybullet.createCollisionShape(pybullet.GEOM_PLANE))
    # from a URDF file a cylinder becomes a mesh, unless URDF_USE_IMPLICIT_CYLINDER is given
    shape = pybullet.createCollisionShape(pybullet.GEOM_CYLINDER, radius=B, height=2 * H)
    can = pybullet.createMultiBody(1.0, shape)
    # the margin rounds the rim by 4 cm if it is left at its default; damping of 0.04 is on by default
    exact = {"lateralFriction": 1.0, "restitution": 0.0, "collisionMargin": 0.0}
    pybullet.changeDynamics(ground, -1, **exact)
    pybullet.changeDynamics(
        can,
        -1,
        localInertiaDiagonal=[I1, I1, I2],
        linearDamping=0.0,
        angularDamping=0.0,
        activationState=pybullet.ACTIVATION_STATE_DISABLE_SLEEPING,
        **exact,
    )
    return int(can)


def release(can: int) -> None:
    """Lean the can towards x, rolling without slip and without a turn about its own axis."""
    axis = np.array([math.sin(TILT), 0.0, math.cos(TILT)])
    centre = np.array([B * (1 - axis[2]), 0.0, B * axis[0]]) + H * axis
    turning = SPIN * (np.array([0.0, 0.0, 1.0]) - axis)
    pose = centre.tolist(), [0.0, math.sin(TILT / 2), 0.0, math.cos(TILT / 2)]
    pybullet.resetBasePositionAndOrientation(can, *pose)
    pybullet.resetBaseVelocity(can, np.cross(turning, centre - [B, 0.0, 0.0]).tolist(), turning.tolist())


def next_largest_tilt(seconds: float = 2.0) -> tuple[float, float]:
    """Return the angle of turn until the next largest tilt [deg], and that tilt over the one of release."""
    pybullet.connect(pybullet.DIRECT)
    can, axes = scene(), []
    release(can)
    for _ in range(int(seconds / STEP)):
        pybullet.stepSimulation()
        x, y, z, w = pybullet.getBasePositionAndOrientation(can)[1]
        axes.append((2 * (x * z + w * y), 2 * (y * z - w * x), 1 - 2 * (x * x + y * y)))
    pybullet.disconnect()
    lean = np.array(axes)
    tilt = np.arccos(lean[:, 2])
    upright = int(tilt[: int(1.2 / STEP)].argmin())
    top = upright + int(tilt[upright:].argmax())
    return math.degrees(np.unwrap(np.arctan2(lean[:, 1], lean[:, 0]))[top]), tilt[top] / TILT


if __name__ == "__main__":
    turn, tilt = next_largest_tilt()
    print(f"turned by {turn:.3f} deg (exact 203.910), tilted to {tilt:.5f} of the release (exact 1)")
