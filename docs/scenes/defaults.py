"""What the same can does with the settings that the engines start from: `python docs/scenes/defaults.py`."""

from __future__ import annotations

import importlib.util
from collections.abc import Callable
from unittest import mock

Result = tuple[float, float]  # angle of turn [deg], next largest tilt over that of release

PLAIN = """
<mujoco>
  <worldbody>
    <geom type="plane" size="9 9 1"/>
    <body name="can" pos="0 0 2"><freejoint/><geom type="cylinder" size="1 2" mass="1"/></body>
  </worldbody>
</mujoco>
"""


def mujoco() -> Result:
    """Contact of 20 ms, pyramidal cone, 2 ms steps."""
    import mujoco_can

    return mujoco_can.next_largest_tilt(PLAIN)


def bullet(friction: float = 0.5) -> Result:
    """Friction of 0.5 on both, 1/240 s steps."""
    import bullet_can
    import pybullet

    def scene() -> int:
        pybullet.setGravity(0.0, 0.0, -9.81)
        ground = pybullet.createMultiBody(0.0, pybullet.createCollisionShape(pybullet.GEOM_PLANE))
        shape = pybullet.createCollisionShape(pybullet.GEOM_CYLINDER, radius=1.0, height=4.0)
        can = pybullet.createMultiBody(1.0, shape)
        for body in (ground, can):
            pybullet.changeDynamics(body, -1, lateralFriction=friction)
        return int(can)

    with mock.patch.multiple(bullet_can, scene=scene, STEP=1 / 240):
        return bullet_can.next_largest_tilt()


def dart() -> Result:
    """A box as the ground, 1 ms steps."""
    import dart_can
    import dartpy

    def box(normal: object, offset: float) -> object:
        return dartpy.dynamics.BoxShape([20.0, 20.0, 1e-3])

    plane = mock.patch.object(dartpy.dynamics, "PlaneShape", box)
    with mock.patch.object(dart_can, "STEP", 1e-3), plane:
        return dart_can.next_largest_tilt()


def drake() -> Result:
    """Stiffness from an allowed penetration of 1 mm, 1 ms steps."""
    import drake_can

    add = drake_can.AddContactMaterial

    def softer(**given: object) -> None:
        add(**{**given, "point_stiffness": None})

    with mock.patch.multiple(drake_can, STEP=1e-3, AddContactMaterial=softer):
        return drake_can.next_largest_tilt()


def rapier() -> Result:
    """Contact of 30 Hz, four substeps, friction shared by the contacts, 1/60 s steps."""
    import rapier3d
    import rapier_can

    def scene() -> tuple[rapier3d.PhysicsWorld, rapier3d.RigidBody]:
        world = rapier3d.PhysicsWorld(gravity=(0.0, 0.0, -9.81))
        return world, rapier_can.add(world)

    with mock.patch.object(rapier_can, "scene", scene):
        return rapier_can.next_largest_tilt()


ENGINES: dict[str, Callable[[], Result]] = {
    "mujoco": mujoco,
    "pybullet": bullet,
    "dartpy": dart,
    "pydrake": drake,
    "rapier3d": rapier,
}

if __name__ == "__main__":
    print(f"{'engine':10}{'turn [deg]':>12}{'next tilt':>12}\n{'exact':10}{203.9098:12.4f}{1.0:12.5f}")
    for module, run in ENGINES.items():
        if importlib.util.find_spec(module) is not None:
            turn, tilt = run()
            print(f"{module:10}{turn:12.4f}{tilt:12.5f}")
