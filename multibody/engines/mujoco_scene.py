"""The settings of MuJoCo, its scene files with the values of one run set on them, and its start.

Times of settings are in the units of the user, like the time step. Their values stand on exact solutions, at
the reference size (semidiagonal 6 m, h = 1e-4 s): `python tests/benchmarks engine_settings`. A run starts
at the depth at which contact carries the load, and for leapfrog half a step back.
"""

from __future__ import annotations

from dataclasses import dataclass
from importlib.resources import as_file, files
from typing import TYPE_CHECKING, Annotated

import numpy as np

from ..restraint import Restraint
from ..ring import RingSettings, wall_feet, wall_orientations
from ..scene import Array, Body, Scene, Start
from ..settings import Count, EngineSettings, Positive, one_of, positive, whole

if TYPE_CHECKING:
    import mujoco  # type: ignore[import-untyped]


@dataclass(frozen=True, slots=True, kw_only=True)
class MujocoSettings(EngineSettings):
    """Settings of MuJoCo: its integrator and its contact.

    Attributes
    ----------
    contact_time_constant : float
        Time in which contact removes a normal velocity [s]. 2 h removes it in one step, the stiffest
        that the engine's own safety (refsafe) lets through; from 1.5 h to 4 h nothing changes.
    contact_damping_ratio : float
        1 is critical. Elastic contact chatters and does not converge. Above 1 a velocity is removed as fast,
        and a depth taken back the slower, by the square. A base that closes is as deep in the ground as it
        moved in its last step; taken back as fast as the velocity, that throws the rim up by a quarter of
        the speed at which it came, at every step alike: half of the peak after an impact in one plane may be
        lost. So it is 4 in one plane.
    impedance : float
        Share of a load that contact takes at once; 0.9999 is the engine's maximum. The rest sinks in, so
        that a standing cylinder has leant by the time it uplifts.
    rolling_impedance : float
        The same of the rim, once the cylinder leans; its friction stays as hard as `impedance` says. Its
        lowest point sinks and rises by a curvature of its path that no velocity shows, and where it rises by
        more than the rim has sunk in, contact is lost for a step, and with it friction: the rim slips.
    friction_damping : float
        Share of the slip velocity that one step removes, at most 2. The rim's material point moves on
        while it rolls, and friction, which has no memory, lets it creep by (1/friction_damping - 1/2) h
        times its acceleration. At 1.8 that is a ninth of what it is at 1 (the engine's default), and still
        first order in h. Where the case slides it is what stops a slip within 2 ms at the reference size.
    noslip_iterations : int
        Sweeps of a second solver, which finds friction under the loads that the first has found; 0 for
        friction and load at once. The engine's cone is convex: friction that would remove a slip velocity v
        lifts the contact by mu v times its share in a step, whatever the step, and a base that hops has lost
        its friction. Found one after the other, neither lifts the other. So it is used where the case slides.
    guide_stiffness : float
        Guide stiffness of each half of the guide, over the axial inertia [1/s^2]. (0.2/h)^2/4: stiff enough
        that the twist does not show, and a period of its own has 40 steps.
    integrator : str
        Euler: velocities and poses are a leapfrog, which keeps the energy. RK4 evaluates contact four times
        a step and gains nothing from it; "discrete" damps the guide, and is sound on flat ground.
    cone : str
        The elliptic cone is Coulomb's; the friction damping above exists for it only.
    tolerance, iterations : float, int
        Tolerance and iterations of the Newton solver. One contact needs two iterations, so a tight tolerance
        costs nothing.
    standing_corners : int
        Corners of the inscribed prisms that carry a standing cylinder, a multiple of four up to 48. They
        turn until one of them is under the load, and once the base opens under its lean: fixed ones uplift
        early by up to 1 - cos(pi/corners) of it, and roll on as a polygon, which no step removes. Neighbours
        that share the load let the base lean before it opens, which leaves a tilt rate: so where it is about
        to open four are left, which on their own would chatter under a load near the rim. Not in the scene
        of a release.
    follow_load : bool
        Whether a standing base is carried by those corners, which turn with the load and leave when it has
        uplifted. If not, nothing is steered and the scene is the same throughout: points just inside the rim,
        and the rim as a flat ellipsoid, whose lowest point runs under the load by itself. By default what
        wobbles is followed, for the last digit after its uplift; what closes in one plane or slides is not.
        `python tests/benchmarks engine_settings --uplift` compares them.
    points : int
        Points of a base that is not followed. On its rim alone it would shake from side to side.
    points_softness : float
        Contact time of these points over that of the rim: the rim carries, they calm. In the last step before
        a base closes it may be so flat that those beside the heel, no higher than the rim has sunk in, meet
        the ground and stop the base there. With the contact time of the rim that lifts the heel, and up to
        twice the peak is left; the error goes with 1/softness. From 100 on they calm too little: what is to
        rock in a plane leaves it.
    points_inset : float
        Their distance from the rim, over b.
    """

    contact_time_constant: Positive
    contact_damping_ratio: Positive = 1.0
    impedance: Annotated[float, positive(most=0.9999)] = 0.9999
    rolling_impedance: Annotated[float, positive(most=0.9999)] = 0.995
    friction_damping: Annotated[float, positive(most=2.0)] = 1.8
    guide_stiffness: Positive
    integrator: Annotated[str, one_of("Euler", "implicitfast", "implicit", "RK4", "discrete")] = "Euler"
    cone: Annotated[str, one_of("elliptic", "pyramidal")] = "elliptic"
    tolerance: Annotated[float, positive(most=1e-3, or_zero=True)] = 1e-12
    iterations: Count = 100
    standing_corners: Annotated[int, one_of(*range(0, 49, 4))] = 48
    follow_load: Annotated[bool, one_of(True, False)] = True
    noslip_iterations: Annotated[int, whole(least=0, most=1000)] = 0
    points: Annotated[int, whole(least=0, most=256)] = 16
    points_softness: Positive = 40.0
    points_inset: Annotated[float, positive(most=0.5)] = 0.01

    @staticmethod
    def defaults(time_step: float) -> dict[str, float]:
        """Defaults that depend on the time step [s]."""
        return EngineSettings.defaults(time_step) | {"contact_time_constant": 2.0 * time_step}


# friction over load in hardness, where friction is solved after the load: too soft to matter at first
_FRICTION_AFTER = 1e-6
_PRISMS = 12  # prisms in the scene file; four corners each
# sagitta of the ellipsoid, over that at which a base rolls under its load by two radians a step. With a
# flatter one, planar uplift at tan alpha 1 leaves its plane by 1e-7; above 1 no points are needed, but the
# heel yields
_CROWN = 0.1
_POINT = 1e-6  # radius of a point over b
_SLAB_WIDTH, _SLAB_THICKNESS = 4.0, 0.5  # half of them, of the height and in m: wider than a column can fall


def compile_scene(
    scene: Scene, settings: MujocoSettings, *, standing: bool, ring: RingSettings | None = None
) -> mujoco.MjModel:
    """Compiled model of `scene`, from its file without the parts that the case does not need.

    A `standing` cylinder rests on prisms, a tilted one on its rim; walls exist for the support ring only.
    """
    import mujoco

    with as_file(files("rockwobble.models") / "scenes") as folder:
        spec = mujoco.MjSpec.from_file(str(folder / f"{scene.support}.xml"))
    _set_options(spec, scene, settings)
    _set_body(spec, scene)
    if ring is not None:
        _set_walls(spec, ring, scene.body.base_radius)
    if scene.restraint.is_active:
        _add_tendon(spec, scene.body, scene.restraint)
    if scene.body.slab_mass_ratio > 0.0:
        _add_slab(spec, scene, standing and settings.follow_load and settings.standing_corners > 0)
    if not settings.follow_load:
        _add_rim(spec, scene, settings)
    _set_contact(spec, scene, settings, standing, ring)
    for component in set("xyz") - set(scene.components):
        spec.delete(spec.actuator(f"push_{component}"))
    for name in ("guide_vertical", "guide_axial"):
        guide = spec.actuator(name)
        if guide is not None:
            # guide_stiffness is in the user's unit of time
            guide.biasprm[1] = -settings.guide_stiffness * scene.unit_time**2 * scene.body.axial_inertia
    return spec.compile()


def _set_options(spec: mujoco.MjSpec, scene: Scene, settings: MujocoSettings) -> None:
    import mujoco

    option = spec.option
    option.timestep = scene.time_step
    option.gravity = [0.0, 0.0, -scene.gravity]
    # by name, as not every version has each
    option.integrator = getattr(mujoco.mjtIntegrator, f"mjINT_{settings.integrator.upper()}")
    option.cone = getattr(mujoco.mjtCone, f"mjCONE_{settings.cone.upper()}")
    option.tolerance = settings.tolerance
    option.iterations = settings.iterations
    # a state that is not finite must reach the guard, not be replaced by the initial one
    option.disableflags |= mujoco.mjtDisableBit.mjDSBL_AUTORESET
    # one body is one island: the search for others takes a twentieth of a step; not every version has it
    option.disableflags |= getattr(mujoco.mjtDisableBit, "mjDSBL_ISLAND", 0)
    if settings.contact_time_constant < 2.0 * scene.time_step * scene.unit_time * (1.0 - 1e-9):
        # the engine would silently lengthen a time constant of the user
        option.disableflags |= mujoco.mjtDisableBit.mjDSBL_REFSAFE


def _set_body(spec: mujoco.MjSpec, scene: Scene) -> None:
    shape = scene.body
    radius, half = shape.base_radius, 0.5 * shape.height
    above = half - shape.mass_centre_height  # height of the middle of the outline above the mass centre
    body = spec.body("cylinder")
    body.pos = [0.0, 0.0, shape.mass_centre_height]
    body.inertia = [shape.transverse_inertia, shape.transverse_inertia, shape.axial_inertia]
    for geom in body.geoms:
        geom.pos = [0.0, 0.0, above]
        geom.size = [radius, half, 0.0] if geom.name == "cylinder" else [radius / 2**0.5] * 2 + [half]


def _add_rim(spec: mujoco.MjSpec, scene: Scene, settings: MujocoSettings) -> None:
    """Replace the rim by a flat ellipsoid with points just inside it; under a slab at the top, too.

    On an ellipsoid of sagitta c a base of radius b rolls as on a ball of radius b^2/c, with the circular
    frequency sqrt(g b^2/(c J)), J its inertia about the ground.
    """
    import mujoco

    shape, body, b = scene.body, spec.body("cylinder"), scene.body.base_radius
    inertia = shape.transverse_inertia + shape.moved_mass * shape.mass_centre_height**2
    sagitta = _CROWN * scene.pressing_gravity * (b * scene.time_step) ** 2 / (4.0 * inertia)
    low, high = -shape.mass_centre_height, shape.height - shape.mass_centre_height
    free = {"contype": 0, "conaffinity": 0}
    ellipsoid, sphere = mujoco.mjtGeom.mjGEOM_ELLIPSOID, mujoco.mjtGeom.mjGEOM_SPHERE
    body.add_geom(name="rim", type=ellipsoid, size=[b, b, sagitta], pos=[0.0, 0.0, low + sagitta], **free)
    next(pair for pair in spec.pairs if pair.geomname2 == "cylinder" and _bears(pair)).geomname2 = "rim"
    spec.geom("cylinder").contype = spec.geom("cylinder").conaffinity = 0
    size, radius = _POINT * b, (1.0 - settings.points_inset) * b
    ends = [("ground", low + size), ("slab", high - size)][: 2 if shape.slab_mass_ratio > 0.0 else 1]
    for other, height in ends:
        for index in range(settings.points):
            azimuth, name = 2.0 * np.pi * index / settings.points, f"point_{other}{index}"
            place = [radius * np.cos(azimuth), radius * np.sin(azimuth), height]
            body.add_geom(name=name, type=sphere, size=[size, 0.0, 0.0], pos=place, **free)
            spec.add_pair(geomname1=other, geomname2=name)


def _add_tendon(spec: mujoco.MjSpec, shape: Body, tendon: Restraint) -> None:
    """Add a tendon from its anchor to the base, and up the axis to the slab where there is one.

    The actuator that is its prestress takes no control.
    """
    import mujoco

    body, base = spec.body("cylinder"), -shape.mass_centre_height
    spec.worldbody.add_site(name="tendon_anchor", pos=[0.0, 0.0, -tendon.depth])
    body.add_site(name="tendon_base", pos=[0.0, 0.0, base])
    sites, rest = ["tendon_anchor", "tendon_base"], tendon.depth
    if tendon.gaps > 1:
        body.add_site(name="tendon_top", pos=[0.0, 0.0, base + shape.height])
        sites, rest = [*sites, "tendon_top", "tendon_slab"], 2.0 * tendon.depth + shape.height
    cable = spec.add_tendon(name="tendon", stiffness=[tendon.stiffness, 0.0, 0.0], springlength=[rest, rest])
    for site in sites:
        cable.wrap_site(site)
    force = spec.add_actuator(name="prestress", target="tendon", trntype=mujoco.mjtTrn.mjTRN_TENDON)
    force.gaintype, force.biastype = mujoco.mjtGain.mjGAIN_FIXED, mujoco.mjtBias.mjBIAS_AFFINE
    force.gainprm[0], force.biasprm[0] = 0.0, -tendon.prestress


def _add_slab(spec: mujoco.MjSpec, scene: Scene, standing: bool) -> None:
    """Add a slab that can only translate on the top, in contact with the first prism, or with the rim."""
    import mujoco

    shape = scene.body
    slab = spec.worldbody.add_body(name="slab", pos=[0.0, 0.0, shape.height + _SLAB_THICKNESS])
    slab.mass, slab.inertia, slab.explicitinertial = shape.slab_mass_ratio, [1.0, 1.0, 1.0], True
    width = _SLAB_WIDTH * shape.height
    slab.add_geom(
        name="slab",
        type=mujoco.mjtGeom.mjGEOM_BOX,
        size=[width, width, _SLAB_THICKNESS],
        contype=0,
        conaffinity=0,
    )
    for name, axis in zip("xyz", np.eye(3), strict=True):
        slab.add_joint(name=f"slab_{name}", type=mujoco.mjtJoint.mjJNT_SLIDE, axis=axis)
        if name in scene.components:
            push = spec.add_actuator(name=f"push_slab_{name}", target=f"slab_{name}")
            push.trntype = mujoco.mjtTrn.mjTRN_JOINT
            push.gear[0] = shape.slab_mass_ratio
    if scene.restraint.is_active:
        slab.add_site(name="tendon_slab", pos=[0.0, 0.0, scene.restraint.depth - _SLAB_THICKNESS])
    spec.add_pair(geomname1="slab", geomname2="prism0" if standing else "cylinder")
    # two convex bodies: their one contact point is found by iteration, to rounding; the shared edge of a face
    # and a rim, for which 4.0 searches, is off by 4e-3 m at a tilt of 1e-4 rad
    spec.option.ccd_tolerance, spec.option.ccd_iterations = 1e-16, 200
    spec.option.disableflags |= getattr(mujoco.mjtDisableBit, "mjDSBL_MULTICCD", 0)


def _set_contact(
    spec: mujoco.MjSpec, scene: Scene, settings: MujocoSettings, standing: bool, ring: RingSettings | None
) -> None:
    followed = settings.follow_load
    count = settings.standing_corners // 4 if standing and followed else 0
    if count:
        # the rounding of the rim's depth would make it hop
        spec.delete(next(pair for pair in spec.pairs if pair.geomname2 == "cylinder" and _bears(pair)))
        # a geometry without its pair would meet the ground with a friction of its own
        spec.geom("cylinder").contype = spec.geom("cylinder").conaffinity = 0
    for index in range(_PRISMS):
        name = f"prism{index}"
        if index >= count:
            spec.delete(next(pair for pair in spec.pairs if pair.geomname2 == name))
            spec.delete(spec.geom(name))
        else:
            # the corners of all prisms stand evenly on the rim
            spec.geom(name).alt.euler = [0.0, 0.0, 90.0 * index / count]
    rim = settings.impedance if standing or not followed else settings.rolling_impedance
    # friction is as hard as on the corners
    later = settings.noslip_iterations > 0
    spec.option.impratio = _FRICTION_AFTER if later else _yield(rim) / _yield(settings.impedance)
    spec.option.noslip_iterations, spec.option.noslip_tolerance = settings.noslip_iterations, 0.0
    for pair in spec.pairs:
        friction = scene.friction if ring is None or _bears(pair) else ring.ring_friction
        impedance = rim if _bears(pair) else settings.impedance
        # the cone bounds couple and friction together, so a friction in use leaves less to the couple
        rolling = scene.rolling_resistance if _bears(pair) else 0.0
        pair.friction = [friction, friction, 0.0, rolling, rolling]
        pair.condim = 6 if rolling else 3
        softness = settings.points_softness if pair.geomname2.startswith("point") else 1.0
        contact_time = softness * settings.contact_time_constant / scene.unit_time
        pair.solref = [contact_time, settings.contact_damping_ratio]
        pair.solimp = [impedance, impedance, 1e-3, 0.5, 2.0]
        # a negative pair is a stiffness, which friction lacks, and a damping, which the engine divides by the
        # impedance
        damping = settings.friction_damping * impedance / scene.time_step
        pair.solreffriction = [-1.0, -damping]


def _set_walls(spec: mujoco.MjSpec, ring: RingSettings, base_radius: float) -> None:
    """Replace the walls of the scene file by those of `ring`, which may be more, fewer or elsewhere.

    They are planes, in contact with the cylinder through pairs of their own.
    """
    body, wall = spec.body("ring"), spec.find_default("wall")
    for pair in [pair for pair in spec.pairs if pair.geomname1.startswith("wall")]:
        spec.delete(pair)
    for geom in list(body.geoms):
        spec.delete(geom)
    feet, turns = wall_feet(ring, base_radius), wall_orientations(ring)
    for index, (foot, turn) in enumerate(zip(feet, turns, strict=True)):
        name = f"wall{index:02d}"
        body.add_geom(wall, name=name, pos=foot, quat=turn)
        spec.add_pair(wall, geomname1=name, geomname2="cylinder")


def _bears(pair: mujoco.MjsPair) -> bool:
    return pair.geomname1 in ("ground", "slab")


def _yield(impedance: float) -> float:
    """Ratio of the load that contact leaves to its spring to the load it takes at once."""
    return (1.0 - impedance) / impedance


_SECANT_STEPS = 30
_STILL = 1e-9  # [m/s^2] remaining acceleration of the rim at the start
# a rim that comes down rebounds at any depth: the acceleration jumps where contact begins, and a secant
# across the jump may end anywhere. A step much worse than all before it is rejected, as is a height [m] at
# which a tendon would replace the ground
_LEAP, _HIGHEST = 2.0, 1e-5


def set_start(model: mujoco.MjModel, data: mujoco.MjData, scene: Scene, staggered: bool) -> None:
    """Put the cylinder at its loaded penetration, and its velocity half a step back if it is `staggered`."""
    import mujoco

    start = scene.start
    inverse = start.quaternion * np.array([1.0, -1.0, -1.0, -1.0])
    data.qpos[:3], data.qpos[3:7] = start.position, start.quaternion
    data.qvel[:3] = start.velocity
    data.qvel[3:6] = to_world(inverse[None], start.angular_velocity[None])[0]
    # the slab has the velocity of the highest point of the top, also before the start
    data.qpos[7:] = 2.0 * (start.position - [0.0, 0.0, scene.body.mass_centre_height])[: model.nq - 7]
    data.qvel[6:] = 2.0 * start.velocity[: model.nv - 6]
    slab_height = data.qpos[9:].copy()
    share = scene.body.slab_mass_ratio

    def rim_acceleration(depth: float) -> float:
        data.qpos[2] = start.position[2] - depth
        # the top sinks in by the share of the load that it carries
        data.qpos[9:] = slab_height - depth * (1.0 + share / (1.0 + share))
        data.qacc_warmstart[:] = 0.0
        mujoco.mj_forward(model, data)
        return _rim_acceleration(data, scene)

    # contact is a spring under a given load, so the secant is nearly exact
    before, depth = 1e-7, 2e-7
    value_before, value = rim_acceleration(before), rim_acceleration(depth)
    tried = {before: abs(value_before), depth: abs(value)}
    for _ in range(_SECANT_STEPS):
        if abs(value) < _STILL or value == value_before:
            break
        before, depth = depth, depth - value * (depth - before) / (value - value_before)
        value_before, value = value, rim_acceleration(depth)
        tried[depth] = abs(value)
    last = tried.pop(depth)
    if not (last <= _LEAP * max(tried.values()) and depth > -_HIGHEST):
        rim_acceleration(min((each for each in tried if each > -_HIGHEST), key=tried.__getitem__))
    if staggered and not start.standing:
        data.qvel[:] -= 0.5 * model.opt.timestep * data.qacc


def _rim_acceleration(data: mujoco.MjData, scene: Scene) -> float:
    """Second derivative of the height of the lowest point of the base [m/s^2]."""
    start: Start = scene.start
    rise = float(data.qacc[2])
    if start.standing:
        return rise
    b, h = scene.body.base_radius, scene.body.mass_centre_height
    axis = to_world(start.quaternion[None], np.array([[0.0, 0.0, 1.0]]))[0]
    angular = to_world(start.quaternion[None], np.asarray(data.qacc[3:6])[None])[0]
    rate = np.cross(start.angular_velocity, axis)
    curve = np.cross(angular, axis) + np.cross(start.angular_velocity, rate)
    # height = z - h cos(theta) - b sin(theta), with cos(theta) the third component of the axis
    sine, cosine = float(np.hypot(axis[0], axis[1])), float(axis[2])
    tilt_rate = -rate[2] / sine
    tilt_curve = -(curve[2] + cosine * tilt_rate**2) / sine
    return float(rise - h * curve[2] - b * (cosine * tilt_curve - sine * tilt_rate**2))


def to_world(quaternion: Array, vector: Array) -> Array:
    """Turn vectors (n, 3) from body to world axes by quaternions (n, 4), scalar first."""
    w, x, y, z = quaternion.T
    a, b, c = vector.T
    # v + w t + q x t with t = 2 q x v
    along_x, along_y, along_z = 2.0 * (y * c - z * b), 2.0 * (z * a - x * c), 2.0 * (x * b - y * a)
    turned = np.empty((3, len(vector)))
    turned[0] = a + w * along_x + (y * along_z - z * along_y)
    turned[1] = b + w * along_y + (z * along_x - x * along_z)
    turned[2] = c + w * along_z + (x * along_y - y * along_x)
    return turned.T
