"""The scene files of MuJoCo, with the values of one run set on them."""

from __future__ import annotations

from importlib.resources import as_file, files
from typing import TYPE_CHECKING, Any

import numpy as np

from ..protocol import Scene
from ..scene.friction import body_friction
from ..scene.ring_geometry import wall_feet, wall_orientations
from ..scene.ring_settings import RingSettings
from .settings.mujoco import MujocoSettings

if TYPE_CHECKING:
    import mujoco  # type: ignore[import-untyped]

_PRISMS = 12  # in the scene file; four corners each
_SLAB_WIDTH, _SLAB_THICKNESS = 4.0, 0.5  # half of them, of the height and in m: wider than a column can fall


def compile_scene(
    scene: Scene, settings: MujocoSettings, *, standing: bool, ring: RingSettings | None = None
) -> mujoco.MjModel:
    """Return the compiled model of `scene`: its file, with what the case does not need taken out.

    The prisms that carry the cylinder are there only while it is `standing`, and then its rim is not; the
    walls only of a `ring`.
    """
    import mujoco

    with as_file(files("rockwobble.models") / "scenes") as folder:
        spec = mujoco.MjSpec.from_file(str(folder / f"{scene.support}.xml"))
    _set_options(spec, scene, settings)
    _set_body(spec, scene)
    if ring is not None:
        _set_walls(spec, ring, scene.body.base_radius)
    if scene.body.slab_mass_ratio > 0.0:
        _add_slab(spec, scene, standing and settings.standing_corners > 0)
    _set_contact(spec, scene, settings, standing, ring)
    for component in set("xyz") - set(scene.components):
        spec.delete(spec.actuator(f"push_{component}"))
    for name in ("guide_vertical", "guide_axial"):
        guide = spec.actuator(name)
        if guide is not None:
            # guide_stiffness is in the time of the user
            guide.biasprm[1] = -settings.guide_stiffness * scene.unit_time**2 * scene.body.axial_inertia
    return spec.compile()


def _set_options(spec: Any, scene: Scene, settings: MujocoSettings) -> None:
    import mujoco

    cones = {"elliptic": mujoco.mjtCone.mjCONE_ELLIPTIC, "pyramidal": mujoco.mjtCone.mjCONE_PYRAMIDAL}
    option = spec.option
    option.timestep = scene.time_step
    option.gravity = [0.0, 0.0, -scene.gravity]
    # by name: not every version has each
    option.integrator = getattr(mujoco.mjtIntegrator, f"mjINT_{settings.integrator.upper()}")
    option.cone = cones[settings.cone]
    option.tolerance = settings.tolerance
    option.iterations = settings.iterations
    # a state that is not finite must reach the guard, not be replaced by the initial one
    option.disableflags |= mujoco.mjtDisableBit.mjDSBL_AUTORESET
    # one body is one island: to look for others takes a twentieth of a step; not every version has it
    option.disableflags |= getattr(mujoco.mjtDisableBit, "mjDSBL_ISLAND", 0)
    if settings.contact_time_constant < 2.0 * scene.time_step * scene.unit_time * (1.0 - 1e-9):
        # the engine would silently lengthen what the user asked for
        option.disableflags |= mujoco.mjtDisableBit.mjDSBL_REFSAFE


def _set_body(spec: Any, scene: Scene) -> None:
    shape = scene.body
    radius, half = shape.base_radius, 0.5 * shape.height
    above = half - shape.mass_centre_height  # of the middle of the outline over the mass centre
    body = spec.body("cylinder")
    body.pos = [0.0, 0.0, shape.mass_centre_height]
    body.inertia = [shape.transverse_inertia, shape.transverse_inertia, shape.axial_inertia]
    for geom in body.geoms:
        geom.pos = [0.0, 0.0, above]
        geom.size = [radius, half, 0.0] if geom.name == "cylinder" else [radius / 2**0.5] * 2 + [half]


def _add_slab(spec: Any, scene: Scene, standing: bool) -> None:
    """Put a slab that can only translate on the top; it lies on the first prism, or on the rim."""
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
    spec.add_pair(geomname1="slab", geomname2="prism0" if standing else "cylinder")
    # two convex bodies: their point of contact is sought, to rounding, and is one: what a face and a rim next
    # to it have in common, which 4.0 looks for, is off by 4e-3 m at a tilt of 1e-4 rad
    spec.option.ccd_tolerance, spec.option.ccd_iterations = 1e-16, 200
    spec.option.disableflags |= getattr(mujoco.mjtDisableBit, "mjDSBL_MULTICCD", 0)


def _set_contact(
    spec: Any, scene: Scene, settings: MujocoSettings, standing: bool, ring: RingSettings | None
) -> None:
    count = settings.standing_corners // 4 if standing else 0
    if count:
        # the rounding of the rim's depth would make it hop
        spec.delete(next(pair for pair in spec.pairs if pair.geomname2 == "cylinder" and _bears(pair)))
        # without its pair it would meet the ground as any two geometries do, with a friction of its own
        spec.geom("cylinder").contype = spec.geom("cylinder").conaffinity = 0
    for index in range(_PRISMS):
        name = f"prism{index}"
        if index >= count:
            spec.delete(next(pair for pair in spec.pairs if pair.geomname2 == name))
            spec.delete(spec.geom(name))
        else:
            # the corners of all prisms stand evenly on the rim
            spec.geom(name).alt.euler = [0.0, 0.0, 90.0 * index / count]
    rim = settings.impedance if standing else settings.rolling_impedance
    # friction stays as hard as it is on the corners
    spec.option.impratio = _yield(rim) / _yield(settings.impedance)
    ground = body_friction(scene.friction, "pair")
    for pair in spec.pairs:
        friction = ground if ring is None or _bears(pair) else ring.ring_friction
        impedance = rim if _bears(pair) else settings.impedance
        # the cone bounds the couple and the friction together, and what grips leaves less to the couple
        rolling = scene.rolling_resistance if _bears(pair) else 0.0
        pair.friction = [friction, friction, 0.0, rolling, rolling]
        pair.condim = 6 if rolling else 3
        pair.solref = [settings.contact_time_constant / scene.unit_time, settings.contact_damping_ratio]
        pair.solimp = [impedance, impedance, 1e-3, 0.5, 2.0]
        # two negative numbers are a stiffness, which friction has none of, and a damping; the engine divides
        # the damping by the impedance
        damping = settings.friction_damping * impedance / scene.time_step
        pair.solreffriction = [-1.0, -damping]


def _set_walls(spec: Any, ring: RingSettings, base_radius: float) -> None:
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


def _bears(pair: Any) -> bool:
    return pair.geomname1 in ("ground", "slab")


def _yield(impedance: float) -> float:
    """Return the share of a load that contact leaves to its spring, over what it takes at once."""
    return (1.0 - impedance) / impedance
