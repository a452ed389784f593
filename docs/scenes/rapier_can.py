"""A can on flat ground in Rapier, in single precision, released with some spin, until it leans most again."""

from __future__ import annotations

import math

import numpy as np
import rapier3d as rp

B, H = 1.0, 2.0  # radius and half height [m]
TILT, SPIN = 0.5 * math.atan(0.5), 0.1  # tilt [rad] and rolling rate [rad/s] of the release
STEP = 5e-5  # [s]
I1, I2 = (3 * B**2 + 4 * H**2) / 12, B**2 / 2  # per unit mass


def scene() -> tuple[rp.PhysicsWorld, rp.RigidBody]:
    """Return the world and the can, its mass centre at the origin: small numbers have small errors."""
    world = rp.PhysicsWorld(gravity=(0.0, 0.0, -9.81))
    how = world.integration_parameters
    how.dt = STEP
    how.num_solver_iterations = 1  # substeps: the step is short enough
    how.normalized_allowed_linear_error = 0.0  # no slop
    how.friction_model = rp.FrictionModel.COULOMB  # the default shares one friction among the contacts
    how.contact_recycling = False  # a rim that rolls has another contact in each step
    how.contact_softness = rp.SpringCoefficients(0.1 / STEP, 1.0)  # the default, 30 Hz, is soft
    return world, add(world)


def add(world: rp.PhysicsWorld) -> rp.RigidBody:
    """Add ground and can, and return the can."""
    ground = world.rigid_bodies.insert(rp.RigidBody.fixed().build())
    plane = rp.Collider.halfspace((0.0, 0.0, 1.0)).friction(1.0).translation((0.0, 0.0, -H))
    world.colliders.insert_with_parent(plane.build(), ground, world.rigid_bodies)
    mass = rp.MassProperties(local_com=(0.0, 0.0, 0.0), mass=1.0, principal_inertia=(I1, I1, I2))
    can = rp.RigidBody.dynamic().can_sleep(False).gyroscopic_forces(True).additional_mass_properties(mass)
    handle = world.rigid_bodies.insert(can.build())
    shape = rp.Collider.cylinder(H, B).density(0.0).friction(1.0).rotation((math.pi / 2, 0.0, 0.0))
    world.colliders.insert_with_parent(shape.build(), handle, world.rigid_bodies)  # its axis along z
    return world.rigid_bodies[handle]


def release(can: rp.RigidBody) -> None:
    """Lean it towards x, rolling without slip, with no turn about its own axis."""
    axis = np.array([math.sin(TILT), 0.0, math.cos(TILT)])
    centre = np.array([B * (1 - axis[2]), 0.0, B * axis[0]]) + H * axis
    turning = SPIN * (np.array([0.0, 0.0, 1.0]) - axis)
    can.translation = rp.Vec3(*(centre - [0.0, 0.0, H]).tolist())
    can.rotation = rp.Rotation3(w=math.cos(TILT / 2), x=0.0, y=math.sin(TILT / 2), z=0.0)
    can.linvel = rp.Vec3(*np.cross(turning, centre - [B, 0.0, 0.0]).tolist())
    can.angvel = rp.Vec3(*turning.tolist())


def next_largest_tilt(seconds: float = 2.0) -> tuple[float, float]:
    """Return the angle of turn until the next largest tilt [deg], and that tilt over the one of release."""
    world, can = scene()
    release(can)
    lean = np.empty((int(seconds / world.integration_parameters.dt), 2))
    for row in lean:
        world.step()
        x, y, z, w = can.rotation.quaternion
        row[:] = 2 * (x * z + w * y), 2 * (y * z - w * x)
    tilt = np.arcsin(np.hypot(*lean.T))
    upright = int(tilt[: len(tilt) * 3 // 5].argmin())
    top = upright + int(tilt[upright:].argmax())
    return math.degrees(np.unwrap(np.arctan2(lean[:, 1], lean[:, 0]))[top]), tilt[top] / TILT


if __name__ == "__main__":
    turn, tilt = next_largest_tilt()
    print(f"turned by {turn:.3f} deg (exact 203.910), tilted to {tilt:.5f} of the release (exact 1)")
