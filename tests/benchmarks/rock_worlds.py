"""A can in one simulator, with default or better settings: a process of `who_can_rock`.

It needs numpy and the simulator alone, so that a simulator may have an environment of its own:

    python tests/benchmarks/rock_worlds.py physx best
    python tests/benchmarks/rock_worlds.py physx best cost
    python tests/benchmarks/rock_worlds.py mujoco default impact

A simulator is a function of a step [s] and of whether its settings are the better ones; it returns a `World`.
"""

from __future__ import annotations

import functools
import json
import math
import sys
import tempfile
import time
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from importlib.metadata import version
from types import MappingProxyType
from typing import Any

import numpy as np

Array = Any  # of float64; the stubs of the simulators disagree about arrays
B, H, G = 1.0, 2.0, 9.81  # radius and half height [m], gravity [m/s^2]
TILT, SPIN = 0.5 * math.atan(0.5), 0.1  # tilt [rad] and rolling rate [rad/s] of the release
INERTIA = np.array([(3 * B**2 + 4 * H**2) / 12, (3 * B**2 + 4 * H**2) / 12, B**2 / 2])  # of 1 kg
DIRECTIONS, RAMP, LENGTH = 7, 0.02, 0.5  # of the uplift sweep; [s]
NOTHING: Array = np.zeros(3)
_DOWN = np.array([0.0, 0.0, -G])
# between two closings of a base that rocks in one plane [s]
SWINGS = ((0.30, 0.48), (0.48, 1.19), (1.19, 1.58), (1.58, 1.84))
_BURST, _STEPS = 0.5, 5000  # [s] of the processor, and steps, that time a step
# [rad] at the end of the sweep: 3.7e-3 at 0.51 g, none at 0.49 g
STANDS, LEANS = 3e-4, 1e-3


@dataclass(frozen=True, slots=True, kw_only=True)
class World:
    """A can in a simulator."""

    # puts the mass centre [m], the quaternion (scalar first), velocity [m/s] and angular velocity [rad/s]
    put: Callable[[Array, Array, Array, Array], None]
    step: Callable[[Array], None]  # takes a step under a gravity [m/s^2]
    lean: Callable[[], tuple[float, float]]  # the horizontal components of the axis
    stands: bool = True  # whether it can stand on its base
    kept: object = None  # what must live as long as the world does


def _lean(w: float, x: float, y: float, z: float) -> tuple[float, float]:
    return 2.0 * (x * z + w * y), 2.0 * (y * z - w * x)


def mujoco(step: float, best: bool) -> World:
    """MuJoCo: contact time constant 20 ms, pyramidal cone."""
    import mujoco  # type: ignore[import-untyped]

    model = mujoco.MjModel.from_xml_string(
        '<mujoco><worldbody><geom type="plane" size="9 9 1"/><body name="can"><freejoint/>'
        '<geom type="cylinder" size="1 2" mass="1"/></body></worldbody></mujoco>'
    )
    model.opt.timestep = step
    data = mujoco.MjData(model)

    def put(position: Array, quaternion: Array, velocity: Array, spin: Array) -> None:
        data.qpos[:] = [*position, *quaternion]
        data.qvel[:3] = velocity
        mujoco.mju_rotVecQuat(data.qvel[3:], spin, quaternion * [1, -1, -1, -1])

    def take(gravity: Array) -> None:
        model.opt.gravity[:] = gravity
        mujoco.mj_step(model, data)

    return World(put=put, step=take, lean=lambda: _lean(*data.qpos[3:]))


def pybullet(step: float, best: bool) -> World:
    """PyBullet: friction 1 on both bodies, margin 4 cm, damping 0.04."""
    import pybullet

    pybullet.connect(pybullet.DIRECT)
    pybullet.setTimeStep(step)
    ground = pybullet.createMultiBody(0.0, pybullet.createCollisionShape(pybullet.GEOM_PLANE))
    shape = pybullet.createCollisionShape(pybullet.GEOM_CYLINDER, radius=B, height=2 * H)
    can = pybullet.createMultiBody(1.0, shape)
    for body in (ground, can):
        pybullet.changeDynamics(body, -1, lateralFriction=1.0)

    def put(position: Array, quaternion: Array, velocity: Array, spin: Array) -> None:
        pose = np.roll(quaternion, -1).tolist()
        pybullet.resetBasePositionAndOrientation(can, position.tolist(), pose)
        pybullet.resetBaseVelocity(can, velocity.tolist(), spin.tolist())

    def take(gravity: Array) -> None:
        pybullet.setGravity(*gravity)
        pybullet.stepSimulation()

    def lean() -> tuple[float, float]:
        x, y, z, w = pybullet.getBasePositionAndOrientation(can)[1]
        return _lean(w, x, y, z)

    return World(put=put, step=take, lean=lean)


def dart(step: float, best: bool) -> World:
    """DART: box as ground, its default collision detector."""
    import dartpy

    world = dartpy.simulation.World()
    world.setTimeStep(step)
    ground, body = dartpy.dynamics.Skeleton("ground"), dartpy.dynamics.Skeleton("can")
    plate = ground.createWeldJointAndBodyNodePair()[1]
    joint, can = body.createFreeJointAndBodyNodePair()
    slab = plate.createShapeNode(dartpy.dynamics.BoxShape([20.0, 20.0, 0.2]))
    below = dartpy.math.Isometry3()
    below.set_translation([0.0, 0.0, -0.1])
    slab.setRelativeTransform(below)
    can.setInertia(dartpy.dynamics.Inertia(1.0, [0.0, 0.0, 0.0], np.diag(INERTIA)))
    for shape in (slab, can.createShapeNode(dartpy.dynamics.CylinderShape(B, 2 * H))):
        shape.createCollisionAspect()
        shape.createDynamicsAspect()
    world.addSkeleton(ground)
    world.addSkeleton(body)

    def put(position: Array, quaternion: Array, velocity: Array, spin: Array) -> None:
        pose = dartpy.math.Isometry3()
        pose.set_quaternion(dartpy.math.Quaternion(*quaternion))
        pose.set_translation(position)
        joint.setTransform(pose)
        joint.setLinearVelocity(velocity)
        joint.setAngularVelocity(spin)

    def take(gravity: Array) -> None:
        world.setGravity(gravity)
        world.step()

    def lean() -> tuple[float, float]:
        axis = can.getTransform().rotation()[:2, 2]
        return float(axis[0]), float(axis[1])

    return World(put=put, step=take, lean=lean)


def drake(step: float, best: bool) -> World:
    """Drake: discrete contact, stiffness from a penetration of 1 mm."""
    from pydrake import geometry
    from pydrake.common.eigen_geometry import Quaternion
    from pydrake.math import RigidTransform, RotationMatrix
    from pydrake.multibody.math import SpatialVelocity
    from pydrake.multibody.plant import AddMultibodyPlantSceneGraph, CoulombFriction
    from pydrake.multibody.tree import SpatialInertia, UnitInertia
    from pydrake.systems.analysis import Simulator
    from pydrake.systems.framework import DiagramBuilder

    builder = DiagramBuilder()
    plant, _ = AddMultibodyPlantSceneGraph(builder, step)
    can = plant.AddRigidBody("can", SpatialInertia(1.0, NOTHING, UnitInertia(*INERTIA)))
    here, friction = RigidTransform(), CoulombFriction(1.0, 1.0)
    plant.RegisterCollisionGeometry(plant.world_body(), here, geometry.HalfSpace(), "ground", friction)
    plant.RegisterCollisionGeometry(can, here, geometry.Cylinder(B, 2 * H), "can", friction)
    plant.Finalize()
    simulator = Simulator(builder.Build())
    inside = plant.GetMyMutableContextFromRoot(simulator.get_mutable_context())
    steps = iter(range(1, sys.maxsize))
    field = plant.gravity_field()

    def put(position: Array, quaternion: Array, velocity: Array, spin: Array) -> None:
        pose = RigidTransform(RotationMatrix(Quaternion(*quaternion)), position)
        plant.SetFreeBodyPose(inside, can, pose)
        plant.SetFreeBodySpatialVelocity(inside, can, SpatialVelocity(spin, velocity))

    def take(gravity: Array) -> None:
        # gravity is fixed once the plant is: the rest is a force at the mass centre
        from pydrake.multibody.math import SpatialForce
        from pydrake.multibody.plant import ExternallyAppliedSpatialForce

        push = ExternallyAppliedSpatialForce()
        push.body_index, push.F_Bq_W = (
            can.index(),
            SpatialForce(NOTHING, gravity - field.gravity_vector()),
        )
        plant.get_applied_spatial_force_input_port().FixValue(inside, [push])
        simulator.AdvanceTo(next(steps) * step)

    def lean() -> tuple[float, float]:
        axis = plant.EvalBodyPoseInWorld(inside, can).rotation().matrix()[:2, 2]
        return float(axis[0]), float(axis[1])

    return World(put=put, step=take, lean=lean)


def rapier(step: float, best: bool) -> World:
    """Rapier: contact of 30 Hz, four substeps, friction shared by the contacts."""
    import rapier3d

    world = rapier3d.PhysicsWorld(gravity=(0.0, 0.0, -G))
    world.integration_parameters.dt = step
    ground = world.rigid_bodies.insert(rapier3d.RigidBody.fixed().build())
    plane = rapier3d.Collider.halfspace((0.0, 0.0, 1.0)).friction(1.0)
    world.colliders.insert_with_parent(plane.build(), ground, world.rigid_bodies)
    handle = world.rigid_bodies.insert(rapier3d.RigidBody.dynamic().can_sleep(False).build())
    density = 1.0 / (math.pi * B**2 * 2 * H)
    shape = rapier3d.Collider.cylinder(H, B).density(density).friction(1.0)
    upright = shape.rotation((math.pi / 2, 0.0, 0.0))
    world.colliders.insert_with_parent(upright.build(), handle, world.rigid_bodies)
    can = world.rigid_bodies[handle]

    def put(position: Array, quaternion: Array, velocity: Array, spin: Array) -> None:
        can.translation = rapier3d.Vec3(*position.tolist())
        can.rotation = rapier3d.Rotation3(**dict(zip("wxyz", quaternion.tolist(), strict=True)))
        can.linvel, can.angvel = rapier3d.Vec3(*velocity.tolist()), rapier3d.Vec3(*spin.tolist())

    def take(gravity: Array) -> None:
        world.gravity = rapier3d.Vec3(*gravity.tolist())
        world.step()

    def lean() -> tuple[float, float]:
        x, y, z, w = can.rotation.quaternion
        return _lean(w, x, y, z)

    return World(put=put, step=take, lean=lean)


def physx(step: float, best: bool, corners: int = 0) -> World:
    """PhysX: temporal Gauss-Seidel, 10 iterations, angular damping 0.05.

    Better without damping, with the 4 iterations that PhysX itself begins with, and with all contacts: the
    persistent manifold keeps four of them, on which the base stands as on a square.
    """
    import sapien
    from sapien import physx

    scene_config = physx.get_scene_config()
    scene_config.enable_pcm = not best
    physx.set_scene_config(scene_config)
    system = physx.PhysxCpuSystem()
    system.set_timestep(step)
    material, half = physx.PhysxMaterial(1.0, 1.0, 0.0), math.sqrt(0.5)
    ground, can = physx.PhysxRigidStaticComponent(), physx.PhysxRigidDynamicComponent()
    plane, shape = physx.PhysxCollisionShapePlane(material), physx.PhysxCollisionShapeCylinder(B, H, material)
    if corners:
        with tempfile.NamedTemporaryFile("w", suffix=".obj") as mesh:
            mesh.write(_prism(corners))
            mesh.flush()
            shape = physx.PhysxCollisionShapeConvexMesh(mesh.name, [1.0, 1.0, 1.0], material)
    plane.set_local_pose(sapien.Pose([0.0, 0.0, 0.0], [half, 0.0, -half, 0.0]))  # its normal along z
    shape.set_local_pose(sapien.Pose([0.0, 0.0, 0.0], [half, 0.0, half, 0.0]))  # its axis along z
    ground.attach(plane)
    can.attach(shape)
    can.set_mass(1.0)
    can.set_cmass_local_pose(sapien.Pose())
    can.set_inertia(INERTIA)
    can.sleep_threshold = 0.0
    if best:
        can.angular_damping, can.solver_position_iterations = 0.0, 4
        plane.contact_offset = shape.contact_offset = 0.002
    scene = sapien.Scene([system])
    entities = [sapien.Entity(), sapien.Entity()]
    for entity, component in zip(entities, (ground, can), strict=True):
        entity.add_component(component)
        entity.add_to_scene(scene)
    body = entities[1]

    def put(position: Array, quaternion: Array, velocity: Array, spin: Array) -> None:
        body.set_pose(sapien.Pose(position, quaternion))
        can.set_linear_velocity(velocity)
        can.set_angular_velocity(spin)

    def take(gravity: Array) -> None:
        can.add_force_at_point(gravity - [0.0, 0.0, -G], body.get_pose().p)
        system.step()

    return World(put=put, step=take, lean=lambda: _lean(*map(float, body.get_pose().q)), kept=scene)


def _prism(corners: int) -> str:
    """Prism inscribed in the can, its axis along x, as an OBJ file."""
    turns = math.tau * np.arange(corners) / corners
    points = [f"v {x} {B * math.cos(turn)} {B * math.sin(turn)}" for x in (-H, H) for turn in turns]
    faces = []
    for one in range(1, corners + 1):
        other = one % corners + 1
        faces += [f"f {one} {corners + one} {corners + other}", f"f {one} {corners + other} {other}"]
    for one in range(2, corners):
        faces += [f"f 1 {one} {one + 1}", f"f {corners + 1} {corners + one + 1} {corners + one}"]
    return "\n".join([*points, *faces])


def prism(step: float, best: bool, corners: int) -> World:
    """Ideal prism, pivoting from corner to corner without bounce and slip: the loss of a polygon."""
    turns = math.tau * np.arange(corners) / corners
    rim = np.column_stack([B * np.cos(turns), B * np.sin(turns), np.full(corners, -H)])
    pose, spin, pivot = np.array([1.0, 0.0, 0.0, 0.0]), np.zeros(3), 0  # spin about body axes

    def about(corner: int) -> Array:
        arm = rim[corner]
        return np.diag(INERTIA) + arm @ arm * np.eye(3) - np.outer(arm, arm)

    def rates(pose: Array, spin: Array, gravity: Array) -> tuple[Array, Array]:
        inertia, torque = about(pivot), np.cross(-rim[pivot], _matrix(pose).T @ gravity)
        (w, *xyz), change = pose, np.linalg.solve(inertia, torque - np.cross(spin, inertia @ spin))
        return 0.5 * np.array([-np.dot(xyz, spin), *(w * spin + np.cross(xyz, spin))]), change

    def put(position: Array, quaternion: Array, velocity: Array, angular: Array) -> None:
        nonlocal pose, spin, pivot
        pose, spin = quaternion, _matrix(quaternion).T @ angular
        pivot = int((rim @ _matrix(pose)[2]).argmin())

    def take(gravity: Array) -> None:
        nonlocal pose, spin, pivot
        turning, change = rates(pose, spin, gravity)
        turning, change = rates(pose + 0.5 * step * turning, spin + 0.5 * step * change, gravity)
        pose, spin = pose + step * turning, spin + step * change
        pose /= np.linalg.norm(pose)
        up = _matrix(pose)[2]
        lowest = int((rim @ up).argmin())
        if lowest == pivot:
            return
        # the angular momentum about the corner that lands is kept
        momentum = INERTIA * spin + np.cross(rim[lowest], np.cross(spin, rim[pivot]))
        edge, inertia = rim[pivot] - rim[lowest], about(lowest)
        spin = np.linalg.solve(inertia, momentum)
        if up @ np.cross(spin, edge) < 0.0:  # the corner before it cannot sink: both stay, as a hinge
            spin = edge * (edge @ momentum) / (edge @ inertia @ edge)
        pivot = lowest

    def lean() -> tuple[float, float]:
        return _lean(*pose)

    return World(put=put, step=take, lean=lean, stands=False)


def _matrix(quaternion: Array) -> Array:
    w, x, y, z = quaternion
    return np.array(
        [
            [1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y)],
            [2 * (x * y + w * z), 1 - 2 * (x * x + z * z), 2 * (y * z - w * x)],
            [2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y)],
        ]
    )


def _newton(
    solver: str, contact: Mapping[str, float] = MappingProxyType({}), cloth: bool = False, **better: Any
) -> Callable[[float, bool], World]:
    def made(step: float, best: bool) -> World:
        import newton
        import warp

        warp.config.quiet = True
        kind = getattr(newton.solvers, f"Solver{solver}")
        builder = newton.ModelBuilder()
        for each in {kind, newton.solvers.SolverStyle3D} if cloth else {kind}:
            each.register_custom_attributes(builder)
        given: dict[str, Any] = {"mu": 1.0, **(contact if best else {})}
        builder.add_ground_plane(cfg=newton.ModelBuilder.ShapeConfig(**given))
        config = newton.ModelBuilder.ShapeConfig(density=1.0 / (math.pi * B**2 * 2 * H), **given)
        body = builder.add_body()
        builder.add_shape_cylinder(body, radius=B, half_height=H, cfg=config)
        if cloth:  # without particles such a solver is not made at all
            newton.solvers.style3d.add_cloth_grid(
                builder, pos=(0.0, 0.0, 99.0), rot=warp.quat_identity(), vel=(0.0, 0.0, 0.0),
                dim_x=2, dim_y=2, cell_x=0.1, cell_y=0.1, mass=0.1
            )  # fmt: skip
        builder.color()
        model = builder.finalize(device="cpu")
        states, contacts, control = [model.state(), model.state()], model.contacts(), model.control()
        settings = {"config": kind.Config()} if solver == "ImplicitMPM" else better if best else {}
        engine, load = kind(model, **settings), _DOWN

        def put(position: Array, quaternion: Array, velocity: Array, spin: Array) -> None:
            pose, rates = [*position, *np.roll(quaternion, -1)], [*velocity, *spin]
            for state in states:
                state.body_q.assign(np.array([pose], dtype=np.float32))
                state.body_qd.assign(np.array([rates], dtype=np.float32))
                state.joint_q.assign(np.array(pose, dtype=np.float32))
                state.joint_qd.assign(np.array(rates, dtype=np.float32))

        def take(gravity: Array) -> None:
            nonlocal load
            if not np.array_equal(gravity, load):
                load = gravity
                model.set_gravity(tuple(gravity.tolist()))
                engine.notify_model_changed(newton.ModelFlags.MODEL_PROPERTIES)
            states[0].clear_forces()
            model.collide(states[0], contacts)
            engine.step(states[0], states[1], control, contacts, step)
            states.reverse()

        def lean() -> tuple[float, float]:
            x, y, z, w = map(float, states[0].body_q.numpy()[0, 3:])
            return _lean(w, x, y, z)

        return World(put=put, step=take, lean=lean)

    made.__doc__ = f"Newton's {solver}, on a processor."
    return made


# springs and dampers of the contacts of a can of 1 kg: 1e-5 m under its weight
_STIFF = MappingProxyType({"ke": 2.5e5, "kd": 100.0, "kf": 1e4})
# package, step [s] of the settings it starts from and of the better ones, and the simulator
WORLDS: Mapping[str, tuple[str, float, float, Callable[[float, bool], World]]] = {
    "mujoco": ("mujoco", 0.002, math.nan, mujoco),
    "pybullet": ("pybullet", 1 / 240, math.nan, pybullet),
    "dart": ("dartpy", 0.001, math.nan, dart),
    "drake": ("drake", 0.001, math.nan, drake),
    "rapier": ("rapier3d", 1 / 60, math.nan, rapier),
    "physx": ("sapien", 1 / 100, 1e-4, physx),
    "physx-32": ("sapien", 1 / 100, 1e-4, functools.partial(physx, corners=32)),
    "physx-64": ("sapien", 1 / 100, 1e-4, functools.partial(physx, corners=64)),
    "prism-32": ("", 1e-4, math.nan, functools.partial(prism, corners=32)),
    "prism-64": ("", 1e-4, math.nan, functools.partial(prism, corners=64)),
    "prism-128": ("", 1e-4, math.nan, functools.partial(prism, corners=128)),
    **{
        f"newton-{name}": ("newton[sim]", 1 / 500, better, world)
        for name, better, world in (
            ("xpbd", 1 / 1000, _newton("XPBD", iterations=20, rigid_contact_relaxation=1.0)),
            ("mujoco", 1 / 1000, _newton("MuJoCo")),
            ("semi-implicit", 1 / 2000, _newton("SemiImplicit", _STIFF, angular_damping=0.0)),
            ("featherstone", 1 / 2000, _newton("Featherstone", _STIFF, angular_damping=0.0)),
            ("vbd", 1 / 1000, _newton("VBD", iterations=20)),
            ("steel", 1 / 1000, _newton("Steel", iterations=30)),
            ("kamino", math.nan, _newton("Kamino")),
            ("style3d", math.nan, _newton("Style3D", cloth=True)),
            ("mpm", math.nan, _newton("ImplicitMPM", cloth=True)),
        )
    },
}


def _released(world: World) -> None:
    axis = np.array([math.sin(TILT), 0.0, math.cos(TILT)])
    centre = np.array([B * (1 - axis[2]), 0.0, B * axis[0]]) + H * axis
    spin = SPIN * (np.array([0.0, 0.0, 1.0]) - axis)
    quaternion = np.array([math.cos(TILT / 2), 0.0, math.sin(TILT / 2), 0.0])
    world.put(centre, quaternion, np.cross(spin, centre - [B, 0.0, 0.0]), spin)


def turned(world: World, step: float) -> dict[str, float]:
    """Angle of turn [deg], and the next tilt maximum over the release tilt.

    Raises
    ------
    RuntimeError
        If the body stays where it is put.
    """
    _released(world)
    leans = []
    for _ in range(int(2.0 / step)):
        world.step(_DOWN)
        leans.append(world.lean())
    lean = np.array(leans)
    if not np.ptp(lean, axis=0).any():
        raise RuntimeError("moves no rigid body")
    tilt = np.arcsin(np.minimum(np.hypot(*lean.T), 1.0))
    upright = int(tilt[: int(1.2 / step)].argmin())
    top = upright + int(tilt[upright:].argmax())
    azimuth = np.unwrap(np.arctan2(lean[:, 1], lean[:, 0]))
    return {"turn": math.degrees(azimuth[top]), "tilt": tilt[top] / TILT}


def cost(world: World) -> float:
    """Return microseconds of the processor a step, in the first steps after the release."""
    _released(world)
    world.step(_DOWN)  # which may compile
    started, steps = time.process_time(), 0
    while (spent := time.process_time() - started) < _BURST and steps < _STEPS:
        world.step(_DOWN)
        steps += 1
    return 1e6 * spent / steps


def misses(tilt: float, aside: float, share: float) -> list[str]:
    """Error of a tilt [rad] and its direction relative to the load [rad], under a share of g."""
    if share < 0.5:
        return ["leans at 0.49 g"] if tilt > STANDS else []
    if tilt < LEANS:
        return ["stands at 0.51 g"]
    return ["aside at 0.51 g"] if abs(aside) > math.radians(1.0) else []


def uplifts(made: Callable[[], World], step: float) -> list[str]:
    """Errors in the uplift sweep; empty if all seven directions are right."""
    wrong: list[str] = []
    for azimuth in math.tau * np.arange(DIRECTIONS) / DIRECTIONS:
        for share in (0.49, 0.51):
            world = made()
            world.put(np.array([0.0, 0.0, H]), np.array([1.0, 0.0, 0.0, 0.0]), np.zeros(3), np.zeros(3))
            for number in range(int(LENGTH / step)):
                push = share * G * min(1.0, (number + 0.5) * step / RAMP)
                world.step(np.array([-push * math.cos(azimuth), -push * math.sin(azimuth), -G]))
            x, y = world.lean()
            tilt, aside = math.hypot(x, y), math.remainder(math.atan2(y, x) - azimuth - math.pi, math.tau)
            wrong += misses(tilt, aside, share)
    return wrong


def impacts(world: World, step: float) -> list[float]:
    """Largest tilts [alpha] between impacts under one sine of 0.65 g in 0.8 s."""
    world.put(np.array([0.0, 0.0, H]), np.array([1.0, 0.0, 0.0, 0.0]), np.zeros(3), np.zeros(3))
    leans = []
    times = (np.arange(int(SWINGS[-1][1] / step)) + 0.5) * step
    for time_ in times:
        push = 0.65 * G * math.sin(math.tau * time_ / 0.8) if time_ < 0.8 else 0.0
        world.step(np.array([-push, 0.0, -G]))
        leans.append(world.lean())
    tilt = np.arcsin(np.minimum(np.hypot(*np.array(leans).T), 1.0)) / math.atan(B / H)
    return [round(float(tilt[(times > low) & (times < high)].max()), 4) for low, high in SWINGS]


def printed(name: str, variant: str, what: str = "motion") -> None:
    """Print the results of a simulator, or the cost of a step, as JSON in the last line."""
    package, default, better, simulator = WORLDS[name]
    best = variant == "best"
    step = better if best else default
    world = simulator(step, best)
    if what == "impact":
        print(json.dumps(impacts(world, step)))
        return
    if what == "cost":
        print(json.dumps(cost(world)))
        return
    answer: dict[str, Any] = {"version": package and version(package.partition("[")[0]), "time_step": step}
    answer |= turned(world, step)
    answer["wrong"] = uplifts(lambda: simulator(step, best), step) if world.stands else None
    print(json.dumps(answer))


if __name__ == "__main__":
    printed(*sys.argv[1:])
