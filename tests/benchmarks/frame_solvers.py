"""Columns and slab as separate bodies: by springs at the rims, by MuJoCo, by PyBullet.

One column under a slab that can only translate besides by the engines of the product.

They share the start and nothing else. The ends of columns give under a load as the springs do, as MuJoCo's
contact is told to, and not at all in PyBullet. Engines have friction of velocities, so that a rim creeps; the
springs have friction with memory: the elongation of a spring, at most friction times load.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numba
import numpy as np
from numpy.typing import NDArray

from rockwobble import reduced
from rockwobble.models import Case, Cylinder, GroundMotion, InitialState, Trace, WobblingFrame
from rockwobble.multibody import simulate
from rockwobble.multibody.scene import Body, scaled_body, starting_state

Array = NDArray[np.float64]
G, R = 9.81, 6.0
SAMPLE = 0.01  # [s]
_EDGE = 2.5  # the slab reaches this far beyond the axes of its columns, in b
_GUIDE = 2.5e5  # of each half, over the axial inertia [1/s^2]
_DAMPING = 1.8  # share of the slip that one step removes, as `MujocoSettings`
_STEP = 0.05  # of the period of a column between two springs, over 2 pi


@dataclass(frozen=True, slots=True, kw_only=True)
class Frame:
    """One problem: a frame with its imperfections."""

    columns: int  # with 1, the slab only translates
    ratio: float = 1.0
    tan_alpha: float = 0.5
    circle: float = 3.0  # radius of that on which the columns stand [b]
    support: str = "recess"
    motion: GroundMotion | None = None
    duration: float = 3.0
    tilt: float = 0.5  # of the release [alpha]
    spin: float = 0.5  # of the release [rad/s]
    friction: float = 1.0
    give: float = 1e-4  # depth by which an end sinks in under the weight at the base [b]
    longer: float = 0.0  # one column than the others [gives]
    lean: float = 0.0  # tilt of one column beyond that of the others, a share of it
    offset: float = 0.0  # mass centre of the slab from the middle of the columns [m]
    thickness: float = 1.0  # of the slab, whose mass centre is in the middle [m]
    inertia: float = 1.0  # slab inertia over that of a homogeneous slab

    @property
    def cylinder(self) -> Cylinder:
        """One of the columns."""
        return Cylinder(semidiagonal=R, tan_alpha=self.tan_alpha)

    @property
    def body(self) -> Body:
        """The column in the format of an engine."""
        return scaled_body(self.cylinder, 1.0)

    @property
    def plan(self) -> Array:
        """Places of the columns (n, 2) [m]."""
        angle = 0.3 + 2.0 * np.pi * np.arange(self.columns) / self.columns
        radius = 0.0 if self.columns == 1 else self.circle * self.body.base_radius
        return radius * np.column_stack([np.cos(angle), np.sin(angle)])

    @property
    def half_width(self) -> float:
        """Half width of the square slab [m]."""
        return (self.circle + _EDGE) * self.body.base_radius

    @property
    def slab_mass(self) -> float:
        """Mass of the slab over that of a column."""
        return self.ratio * self.columns

    @property
    def slab_inertia(self) -> Array:
        """Slab inertia about its mass centre (3,) [m^2], over the mass of a column."""
        square = (2.0 * self.half_width) ** 2
        shape = np.array([square + self.thickness**2] * 2 + [2.0 * square])
        return np.asarray(self.inertia * self.slab_mass * shape / 12.0)

    @property
    def case(self) -> Case:
        """The ideal frame, with one of its columns."""
        release = InitialState(self.tilt * self.cylinder.alpha, rolling_rate=self.spin)
        frame = WobblingFrame(self.cylinder, self.ratio, columns=1)
        return Case(frame, self.motion, initial=release, duration=self.duration)

    def reference(self) -> Trace:
        """Reduced model of the ideal frame."""
        return reduced.simulate(self.case, support=self.support, sample_step=SAMPLE, rtol=1e-10)

    def ground(self, steps: int, step: float) -> Array:
        """Ground acceleration before and after each step (steps + 1, 3) [m/s^2]."""
        accelerations, times = np.zeros((steps + 1, 3)), step * np.arange(steps + 1)
        if self.motion is not None:
            at = np.arange(len(self.motion.acceleration)) * self.motion.time_step
            for row, column in zip(accelerations.T, self.motion.acceleration.T, strict=False):
                row[:] = np.interp(times, at, column)
        return accelerations

    def start(self) -> tuple[Array, Array, Array, Array]:
        """Initial positions, quaternions, velocities and spins, each (n + 1, .), slab last."""
        body, alpha, count = self.body, self.cylinder.alpha, self.columns
        place, turn = np.zeros((count + 1, 3)), np.zeros((count + 1, 4))
        velocity, spin = np.zeros((count + 1, 3)), np.zeros((count + 1, 3))
        longer = self.longer * self.give * body.base_radius
        for i in range(count):
            tilt = self.tilt * alpha * (1.0 + (self.lean if i == 0 else 0.0))
            begin = starting_state(body, InitialState(tilt, rolling_rate=self.spin), 1.0)
            place[i], turn[i] = begin.position, begin.quaternion
            velocity[i], spin[i] = begin.velocity, begin.angular_velocity
        ideal = starting_state(body, InitialState(self.tilt * alpha, rolling_rate=self.spin), 1.0)
        axis = np.array([math.sin(self.tilt * alpha), 0.0, math.cos(self.tilt * alpha)])
        place[0] += 0.5 * longer * axis
        place[:-1, :2] += self.plan
        place[-1] = 2.0 * ideal.position + [self.offset, 0.0, 0.5 * self.thickness]
        turn[-1, 0], velocity[-1] = 1.0, 2.0 * ideal.velocity
        if count == 3 and longer:  # rests on all three
            rise = np.linalg.solve(np.column_stack([np.ones(3), self.plan]), [longer * axis[2], 0.0, 0.0])
            place[-1, 2] += rise[0]
            turn[-1, 1:3] = 0.5 * rise[2], -0.5 * rise[1]
            turn[-1] /= np.linalg.norm(turn[-1])
        return place, turn, velocity, spin


@dataclass(frozen=True, slots=True, kw_only=True)
class Motion:
    """Samples of all bodies."""

    tilt: Array  # (m, n) of the columns [rad]
    turned: Array  # (m,) turn of the slab from how it was released [rad]
    load: Array  # (m, n) normal force on the tops, over the weight of a share of the slab


def _motion(frame: Frame, axes: Array, turn: Array, load: Array) -> Motion:
    """Motion from axes (m, n, 3), quaternions of the slab (m, 4) and normal forces (m, n)."""
    return Motion(
        tilt=np.arctan2(np.hypot(axes[..., 0], axes[..., 1]), axes[..., 2]),
        turned=2.0 * np.arccos(np.clip(np.abs(turn @ turn[0]), 0.0, 1.0)),
        load=load / (frame.ratio * G),
    )


def by_mujoco(
    frame: Frame, step: float = 2e-4, *, impedance: float = 0.99, contact_steps: float = 10.0
) -> Motion:
    """Solve by MuJoCo: a box as the slab, a guide torque on each column in a recess.

    The ends sink in by g (contact_steps step)^2 (1 - impedance)/impedance, whatever `Frame.give` is.
    """
    import mujoco  # type: ignore[import-untyped]

    model = mujoco.MjModel.from_xml_string(_mjcf(frame, step, impedance, contact_steps))
    data = mujoco.MjData(model)
    place, turn, velocity, spin = frame.start()
    free = frame.columns + (frame.columns > 1)
    inward = np.zeros(3)
    for i in range(free):
        data.qpos[7 * i : 7 * i + 7] = *place[i], *turn[i]
        mujoco.mju_rotVecQuat(inward, spin[i], turn[i] * [1.0, -1.0, -1.0, -1.0])
        data.qvel[6 * i : 6 * i + 6] = *velocity[i], *inward
    if free == frame.columns:
        data.qvel[6 * free :] = velocity[-1]  # sliders start at the release
    mujoco.mj_forward(model, data)
    data.qvel[:] -= 0.5 * step * data.qacc  # leapfrog start
    every = round(SAMPLE / step)
    steps = every * round(frame.duration / SAMPLE)
    gravity = -frame.ground(steps, step) - [0.0, 0.0, G]
    axes, slab, load = [], [], []
    force = np.zeros(6)
    for count in range(steps + 1):
        model.opt.gravity[:] = gravity[count]
        if count % every == 0:
            axes.append(data.xmat[1 : frame.columns + 1, 2::3].copy())
            slab.append(data.xquat[-1].copy())
            load.append(np.zeros(frame.columns))
            for index, contact in enumerate(data.contact):
                if model.geom(contact.geom2).name == "slab" or model.geom(contact.geom1).name == "slab":
                    mujoco.mj_contactForce(model, data, index, force)
                    bodies = model.geom_bodyid[[contact.geom1, contact.geom2]]
                    load[-1][bodies.min() - 1] += force[0]
        mujoco.mj_step(model, data)
    return _motion(frame, np.array(axes), np.array(slab), np.array(load))


def _mjcf(frame: Frame, step: float, impedance: float, contact_steps: float) -> str:
    body, names = frame.body, [f"column{i}" for i in range(frame.columns)]
    b, height, width = body.base_radius, body.height, frame.half_width
    longer = frame.longer * frame.give * b
    place = frame.start()[0]
    inertia = f"{body.transverse_inertia} {body.transverse_inertia} {body.axial_inertia}"
    bodies = "".join(
        f'<body name="{name}"><freejoint/><inertial pos="0 0 0" mass="1" diaginertia="{inertia}"/>'
        f'<geom name="{name}" type="cylinder" size="{b} {0.5 * (height + (longer if i == 0 else 0.0))}" '
        f'contype="0" conaffinity="0"/><site name="{name}"/></body>'
        for i, name in enumerate(names)
    )
    slides = "".join(f'<joint type="slide" axis="{axis}"/>' for axis in ("1 0 0", "0 1 0", "0 0 1"))
    inertia = " ".join(map(str, frame.slab_inertia))
    bodies += (
        f'<body name="slab" pos="{" ".join(map(str, place[-1]))}">'
        f"{slides if frame.columns == 1 else '<freejoint/>'}"
        f'<inertial pos="0 0 0" mass="{frame.slab_mass}" diaginertia="{inertia}"/>'
        f'<geom name="slab" type="box" size="{width} {width} {0.5 * frame.thickness}" '
        f'pos="{-frame.offset} 0 0" contype="0" conaffinity="0"/></body>'
    )
    contact = (
        f'condim="3" friction="{frame.friction} {frame.friction} 0 0 0" solref="{contact_steps * step} 1" '
        f'solimp="{impedance} {impedance} 1e-3 0.5 2" solreffriction="-1 {-_DAMPING * 0.9999 / step}"'
    )
    pairs = "".join(
        f'<pair geom1="{other}" geom2="{name}" {contact}/>' for name in names for other in ("ground", "slab")
    )
    guide = f'gear="0 0 0 0 0 1" biastype="affine" gainprm="0" biasprm="0 {-_GUIDE * body.axial_inertia} 0"'
    guides = "".join(
        f'<general site="{one}" refsite="{other}" {guide}/>'
        for name in names
        for one, other in ((name, "world"), ("world", name))
    )
    # friction as hard as at an impedance of 0.9999
    hardness = (1.0 - impedance) / impedance * 9999.0
    return (
        f'<mujoco><option timestep="{step}" cone="elliptic" jacobian="dense" tolerance="1e-12" '
        f'iterations="200" impratio="{hardness}" ccd_tolerance="1e-16" ccd_iterations="200">'
        '<flag island="disable" multiccd="disable"/></option>'
        f'<worldbody><geom name="ground" type="plane" size="0 0 1" contype="0" conaffinity="0"/>'
        f'<site name="world"/>{bodies}</worldbody><contact>{pairs}</contact>'
        f"<actuator>{guides if frame.support == 'recess' else ''}</actuator></mujoco>"
    )


def by_bullet(frame: Frame, step: float = 2e-4) -> Motion:
    """Solve by PyBullet with rigid contact: a free slab, a guide torque at each step."""
    import pybullet as bullet

    client, body = bullet.connect(bullet.DIRECT), frame.body
    bullet.setPhysicsEngineParameter(
        fixedTimeStep=step, numSolverIterations=200, solverResidualThreshold=1e-16, contactSlop=0.0,
        contactERP=0.2, erp=0.2, frictionERP=0.2, contactBreakingThreshold=1e-3, enableConeFriction=1,
        physicsClientId=client,
    )  # fmt: skip
    plane = bullet.createCollisionShape(bullet.GEOM_PLANE)
    column = bullet.createCollisionShape(bullet.GEOM_CYLINDER, radius=body.base_radius, height=body.height)
    width = frame.half_width
    box = bullet.createCollisionShape(
        bullet.GEOM_BOX,
        halfExtents=[width, width, 0.5 * frame.thickness],
        collisionFramePosition=[-frame.offset, 0.0, 0.0],
    )
    inertia = [body.transverse_inertia, body.transverse_inertia, body.axial_inertia]
    kinds = [(0.0, plane, [0.0] * 3)] + [(1.0, column, inertia)] * frame.columns
    bodies = []
    for mass, shape, inertias in [*kinds, (frame.slab_mass, box, frame.slab_inertia.tolist())]:
        bodies.append(bullet.createMultiBody(mass, shape))
        bullet.changeDynamics(
            bodies[-1], -1, lateralFriction=math.sqrt(frame.friction), restitution=0.0, collisionMargin=0.0,
            localInertiaDiagonal=inertias, linearDamping=0.0, angularDamping=0.0,
            activationState=bullet.ACTIVATION_STATE_DISABLE_SLEEPING,
        )  # fmt: skip
    ground, *columns, slab = bodies
    for one in columns:
        for other in columns:
            bullet.setCollisionFilterPair(one, other, -1, -1, 0)
    bullet.setCollisionFilterPair(ground, slab, -1, -1, 0)
    for number, place, turn, velocity, spin in zip((*columns, slab), *frame.start(), strict=True):
        bullet.resetBasePositionAndOrientation(number, place.tolist(), np.roll(turn, -1).tolist())
        bullet.resetBaseVelocity(number, velocity.tolist(), spin.tolist())
    every = round(SAMPLE / step)
    steps = every * round(frame.duration / SAMPLE)
    axes, turns, load = [], [], []
    stiffness = _GUIDE * body.axial_inertia if frame.support == "recess" else 0.0
    for count, acceleration in enumerate(frame.ground(steps, step).tolist()):
        bullet.setGravity(*(-each for each in acceleration[:2]), -acceleration[2] - G)
        now = []
        for number in columns:
            x, y, z, w = bullet.getBasePositionAndOrientation(number)[1]
            now.append((2.0 * (x * z + w * y), 2.0 * (y * z - w * x), 1.0 - 2.0 * (x * x + y * y)))
            push = -2.0 * stiffness * math.atan2(z, w)
            moment = [push * now[-1][0], push * now[-1][1], push * (1.0 + now[-1][2])]
            bullet.applyExternalTorque(number, -1, moment, bullet.WORLD_FRAME)
        if count % every == 0:
            axes.append(now)
            turns.append(np.roll(bullet.getBasePositionAndOrientation(slab)[1], 1))
            touching = [bullet.getContactPoints(slab, number) for number in columns]
            load.append([sum(point[9] for point in points) for points in touching])
        bullet.stepSimulation()
    bullet.disconnect(client)
    return _motion(frame, np.array(axes), np.array(turns), np.array(load))


def by_engine(frame: Frame, name: str, step: float | None = None) -> Motion:
    """Solve by an engine of the package."""
    trace = simulate(frame.case, engine=name, support=frame.support, time_step=step, sample_step=SAMPLE)
    count = len(trace.time)
    return Motion(tilt=trace.tilt[:, None], turned=np.zeros(count), load=np.full((count, 1), np.nan))


def by_springs(frame: Frame) -> Motion:
    """Solve with critically damped springs at the lowest and highest rim point of each column."""
    body, count = frame.body, frame.columns
    place, turn, velocity, spin = frame.start()
    stiffness = (1.0 + frame.ratio) * G / (frame.give * body.base_radius)
    per_sample = math.ceil(SAMPLE * math.sqrt(4.0 * stiffness) / _STEP)
    step = SAMPLE / per_sample
    samples = round(frame.duration / SAMPLE)
    # the ends begin as deep as they stand; what is left of the loads settles within a step of the record
    place[:-1, 2] -= (1.0 + frame.ratio) * G / stiffness
    place[-1, 2] -= (1.0 + 2.0 * frame.ratio) * G / stiffness
    lengths = np.full(count, 0.5 * body.height)
    lengths[0] += 0.5 * frame.longer * frame.give * body.base_radius
    inertias = np.array([[body.transverse_inertia] * 2 + [body.axial_inertia]] * count + [frame.slab_inertia])
    if count == 1:
        inertias[-1] = np.inf
    guide = _GUIDE * body.axial_inertia if frame.support == "recess" else 0.0
    axes, slab, load = _integrate(
        (place, turn, velocity, spin), lengths, body.base_radius, 0.5 * frame.thickness,
        np.append(np.ones(count), frame.slab_mass), inertias, (stiffness, frame.friction, guide),
        step, per_sample, samples, frame.ground(per_sample * samples, step),
    )  # fmt: skip
    return _motion(frame, axes, slab, load)


_jit = numba.njit(cache=True, error_model="numpy")


@_jit
def _cross(a: Array, b: Array) -> Array:
    return np.array([a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]])


@_jit
def _matrix(turn: Array) -> Array:
    w, x, y, z = turn
    return np.array(
        [
            [1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y)],
            [2 * (x * y + w * z), 1 - 2 * (x * x + z * z), 2 * (y * z - w * x)],
            [2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y)],
        ]
    )


@_jit
def _to_rim(axis: Array, towards: Array, half: float, b: float) -> Array:
    """Point of an end's rim that is farthest in a direction, from the mass centre."""
    along = np.dot(axis, towards)
    across = towards - along * axis
    size = math.sqrt(np.dot(across, across))
    return np.asarray(math.copysign(half, along) * axis + (b / size if size > 0.0 else 0.0) * across)


@_jit
def _contact(
    depth: float, normal: Array, slip: Array, stretch: Array, stiffness: float, friction: float, step: float
) -> tuple[Array, float]:
    """Force and normal force; `stretch` (3,): elongation of the friction spring."""
    damping = math.sqrt(2.0 * stiffness)
    closing = np.dot(slip, normal)
    load = stiffness * depth - damping * closing
    if depth <= 0.0 or load <= 0.0:
        stretch[:] = 0.0
        return np.zeros(3), 0.0
    along = slip - closing * normal
    stretch += step * along
    stretch -= np.dot(stretch, normal) * normal
    grip = -stiffness * stretch - damping * along
    size = math.sqrt(np.dot(grip, grip))
    if size > friction * load:
        grip *= friction * load / size
        stretch[:] = -(grip + damping * along) / stiffness
    return load * normal + grip, load


@_jit
def _integrate(
    start: tuple[Array, Array, Array, Array],
    lengths: Array,
    b: float,
    half_slab: float,
    masses: Array,
    inertias: Array,
    contact: tuple[float, float, float],
    step: float,
    per_sample: int,
    samples: int,
    ground: Array,
) -> tuple[Array, Array, Array]:
    """Return axes (m, n, 3), quaternions of the slab (m, 4) and normal forces at the tops (m, n)."""
    place, turn, velocity, spin = start
    stiffness, friction, guide = contact
    n = len(lengths)
    axes, slab, load = np.zeros((samples + 1, n, 3)), np.zeros((samples + 1, 4)), np.zeros((samples + 1, n))
    low, high = np.zeros((n, 3)), np.zeros((n, 3))
    force, moment = np.zeros((n + 1, 3)), np.zeros((n + 1, 3))
    up = np.array([0.0, 0.0, 1.0])
    for count in range(samples * per_sample + 1):
        force[:], moment[:] = 0.0, 0.0
        row = count // per_sample
        normal = _matrix(turn[n])[:, 2].copy()
        for i in range(n):
            axis = _matrix(turn[i])[:, 2].copy()
            arm = _to_rim(axis, -up, lengths[i], b)
            slip = velocity[i] + _cross(spin[i], arm)
            push, _ = _contact(-place[i, 2] - arm[2], up, slip, low[i], stiffness, friction, step)
            force[i] += push
            moment[i] += _cross(arm, push)
            arm = _to_rim(axis, normal, lengths[i], b)
            lever = place[i] + arm - place[n]
            slip = velocity[i] + _cross(spin[i], arm) - velocity[n] - _cross(spin[n], lever)
            depth = np.dot(lever, normal) + half_slab
            push, carried = _contact(depth, -normal, slip, high[i], stiffness, friction, step)
            force[i] += push
            moment[i] += _cross(arm, push)
            force[n] -= push
            moment[n] -= _cross(lever, push)
            twist = 2.0 * math.atan2(turn[i, 3], turn[i, 0])
            moment[i] -= guide * twist * (axis + up)
            if count % per_sample == 0:
                axes[row, i], load[row, i] = axis, carried
        if count % per_sample == 0:
            slab[row] = turn[n]
        for i in range(n + 1):
            velocity[i] += step * (force[i] / masses[i] - ground[count] - 9.81 * up)
            place[i] += step * velocity[i]
            if inertias[i, 0] == np.inf:
                continue
            matrix = _matrix(turn[i])
            w, torque, inertia = matrix.T @ spin[i], matrix.T @ moment[i], inertias[i]
            middle = w + 0.5 * step * (torque - _cross(w, inertia * w)) / inertia
            w = w + step * (torque - _cross(middle, inertia * middle)) / inertia
            angle = math.sqrt(np.dot(w, w)) * step
            part = 0.5 * step * (math.sin(0.5 * angle) / (0.5 * angle) if angle > 0.0 else 1.0)
            p, c = part * w, math.cos(0.5 * angle)
            q, v = turn[i, 0], turn[i, 1:].copy()
            turn[i, 0] = q * c - np.dot(v, p)
            turn[i, 1:] = q * p + c * v + _cross(v, p)
            turn[i] /= math.sqrt(np.dot(turn[i], turn[i]))
            spin[i] = _matrix(turn[i]) @ w
    return axes, slab, load
