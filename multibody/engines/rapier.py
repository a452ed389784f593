"""Rapier: substepped soft constraints, the family of game engines, in single precision.

Velocities, forces and contact are Rapier's, in single precision; every step rounds them at 6e-8 of their
size, and finer steps round more often: below 1e-4 s the error grows again. What it needs:

* A pose in single precision is off by 5e-7 m at the reference size. Rapier takes that for a gap, through
  which the rim falls at 5e-7 m a step, or for a depth, out of which it pushes a standing base until it
  leans. So poses are summed up in double precision, from Rapier's velocities, and put back before each step
  with the centre of the base over the origin: the distances of contact are then known to 1e-8 m. The body
  is a disc, the lower part of the cylinder, on which the whole rolls until its side is on the ground.
* The rim is kept at a depth of 1e-6 m, a tenth of what Rapier lets be: deeper than the curvature of its
  path, which no velocity shows, lifts it in a step. The depth is taken off the poses.
* The slab of a frame is a half space that looks down, whose orientation is locked, on a disc at the top. It
  stays over the origin, and its height is summed up as the poses are.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from types import MappingProxyType, ModuleType
from typing import Annotated, Any, cast

import numpy as np

from ..protocol import EngineFacts, SceneCounts, Steps
from ..scene import Array, Scene
from ..settings import Count, EngineSettings, Positive, Share, Small, one_of
from .declared import Declared, Leapfrog, contact_counts

_SLOP = 10.0  # depths of the rim that Rapier does not correct; after a landing it corrects the excess
# [rad] tilt from which the guide acts in full: its torque shakes a closed base, which friction holds as well,
# and a torque that sets in at once gives energy to a twist
_OPEN = 2e-4
_FASTEST_RISE = 1e-3  # [m/s] correction of a base that has landed deeper: at once, it would be thrown back
# half length of the disc over b: its far edge is clear of the ground until the side is down
_HALF_DISC = 0.125
_GUIDE = 0.05  # 2 h sqrt(stiffness of the guide); see `settings.GUIDE`: stiffer, it acts on a rounded twist
_FACTS = EngineFacts(
    title="Rapier (single precision)",
    step_time=2e-5,
    release_error=5e-5,
    uplift_error=7e-4,
    rounding=2.0**-24,
    carries_slab=True,
    terms=frozenset({"tendon"}),
)


@dataclass(frozen=True, slots=True, kw_only=True)
class RapierSettings(EngineSettings):
    """Settings of Rapier: soft contact of its substeps.

    Attributes
    ----------
    guide_stiffness : float
        As for MuJoCo [1/s^2].
    contact_frequency : float
        Natural frequency of contact [1/s]. Rapier's own, 30 1/s, lets a base lean before it uplifts.
    contact_damping_ratio : float
        1 is critical, and lets a base that is about to uplift lean by more than 10, Rapier's own.
    depth : float
        Depth at which the rim is kept, at the reference size [m].
    depth_gain : float
        Share of a change of depth that one step takes back.
    substeps, iterations : int
        Substeps and iterations of a step. A rim needs one of each, since what is left of an iteration starts
        the next step; with four iterations the horizontal force on a standing base scatters less.
    friction_model : {"coulomb", "simplified"}
        Friction of each contact, or of all of a base together, at their middle. Each by itself, four contacts
        brake a base that slides by up to 12 % less than Coulomb's law, and turn it; together they do neither
        ("simplified" is the default where the case slides). A rim is one contact.
    """

    guide_stiffness: Positive
    contact_frequency: Positive
    contact_damping_ratio: Positive = 10.0
    depth: Small = 1e-6
    depth_gain: Share = 0.3
    substeps: Count = 1
    iterations: Count = 4
    friction_model: Annotated[str, one_of("coulomb", "simplified")] = "coulomb"

    @staticmethod
    def defaults(time_step: float) -> dict[str, float]:
        """Defaults that depend on the time step [s]."""
        return {"contact_frequency": 0.1 / time_step, "guide_stiffness": (_GUIDE / time_step) ** 2 / 4.0}


class _RapierStepper(Leapfrog):
    def __init__(self, scene: Scene, settings: RapierSettings) -> None:
        import rapier3d

        super().__init__(scene, settings.guide_stiffness, settings.depth)
        self._rapier, self._settings = rapier3d, settings
        self._world, self._cylinder, self._slab = _build(rapier3d, scene, settings)
        # position [m] and quaternion, scalar first
        self._pose: tuple[float, float, float, float, float, float, float]
        self._slab_height: float
        start = scene.start
        position, velocity, spin = start.position.copy(), start.velocity, start.angular_velocity
        position[2] -= settings.depth
        self._set_pose(position, start.quaternion, velocity, spin)
        self._put_slab(2.0 * float(position[2]), 2.0 * velocity)
        if not start.standing:
            # leapfrog starts half a step back: a trial step gives the acceleration
            after = np.array(self._loop([[0.0, 0.0, 0.0]])[0])
            if self._slab is not None:
                reached = self._slab.linvel
                slab_after = np.array([reached.x, reached.y, reached.z])
                self._put_slab(2.0 * float(position[2]), 3.0 * velocity - 0.5 * slab_after)
            velocity, spin = 1.5 * velocity - 0.5 * after[7:10], 1.5 * spin - 0.5 * after[10:]
            self._set_pose(position, start.quaternion, velocity, spin)

    def advance(self, acceleration: Array) -> Steps:
        """Take one step for each row of `acceleration`."""
        position, quaternion, velocity, spin = np.split(
            np.array(self._loop(acceleration.tolist())), (3, 7, 10), axis=1
        )
        position[:, 2] += self._settings.depth
        return Steps(position, quaternion, velocity, spin)

    def counts(self) -> SceneCounts:
        """Return the counts of the last step."""
        pairs = self._world.narrow_phase.contact_pairs()
        return contact_counts(sum(len(manifold.points) for pair in pairs for manifold in pair.manifolds))

    def _loop(self, acceleration: list[list[float]]) -> list[list[float]]:
        """Run the loop over steps; return position, quaternion, velocity and angular velocity after each."""
        # local names, because this is a loop over steps in Python
        world, body, step, rotation = self._world, self._cylinder, self._world.step, self._rapier.Rotation3
        shape, time_step, gravity = self._scene.body, self._scene.time_step, self._scene.gravity
        b, h, excited = shape.base_radius, shape.mass_centre_height, bool(self._scene.components)
        kept, gain, fastest = self._settings.depth, self._settings.depth_gain, _FASTEST_RISE * time_step
        cosine, sine, root, stiffness = math.cos, math.sin, math.sqrt, -4.0 * self._stiffness
        x, y, z, w, i, j, k = self._pose
        slab, above = self._slab, self._slab_height
        tendon, depth, carried = self._scene.restraint, self._depth, body if slab is None else slab
        tied = tendon.is_active
        rows: list[list[float]] = []
        lean = 2.0 * root((i * i + j * j) * (w * w + k * k))
        for ax, ay, az in acceleration:
            if excited:
                world.gravity = (-ax, -ay, -az - gravity)
            if stiffness:
                # torque along the vertical plus the axis, proportional to the twist
                pair = stiffness * min(1.0, lean / _OPEN) * math.atan2(k, w)
                body.add_torque(
                    (pair * (i * k + w * j), pair * (j * k - w * i), pair * (1.0 - i * i - j * j))
                )
            if tied:
                axis = 2.0 * (i * k + w * j), 2.0 * (j * k - w * i), 1.0 - 2.0 * (i * i + j * j)
                force, torque = tendon.loads((x, y, z + depth), axis, h)
                body.add_torque(torque)
                carried.add_force(force)
            step()
            body.reset_torques()
            if tied:
                carried.reset_forces()
            linear, angular = body.linvel, body.angvel
            vx, vy, vz, ox, oy, oz = linear.x, linear.y, linear.z, angular.x, angular.y, angular.z
            speed = root(ox * ox + oy * oy + oz * oz)
            half = 0.5 * time_step * speed
            part, turn = sine(half) / speed if speed else 0.0, cosine(half)
            p, q, r = part * ox, part * oy, part * oz
            w, i, j, k = (
                turn * w - p * i - q * j - r * k,
                turn * i + p * w + q * k - r * j,
                turn * j + q * w + r * i - p * k,
                turn * k + r * w + p * j - q * i,
            )
            x, y, z = x + time_step * vx, y + time_step * vy, z + time_step * vz
            axis_z, lean = 1.0 - 2.0 * (i * i + j * j), 2.0 * root((i * i + j * j) * (w * w + k * k))
            base = z - h * axis_z
            if b * lean > base:
                rise = min(gain * (b * lean - base - kept), fastest)
                z, base = z + rise, base + rise
            if slab is not None:
                above += time_step * slab.linvel.z
                top = z + h * axis_z
                if b * lean + top > above:
                    above += min(gain * (b * lean + top - above - kept), fastest)
                slab.translation = (0.0, 0.0, above)
            body.translation, body.rotation = (0.0, 0.0, base), rotation(w=w, x=i, y=j, z=k)
            rows.append([x, y, z, w, i, j, k, vx, vy, vz, ox, oy, oz])
        size = root(w * w + i * i + j * j + k * k)
        self._pose = x, y, z, w / size, i / size, j / size, k / size
        self._slab_height = above
        return rows

    def _set_pose(self, position: Array, quaternion: Array, velocity: Array, spin: Array) -> None:
        x, y, z = position.tolist()
        w, i, j, k = quaternion.tolist()
        self._pose = x, y, z, w, i, j, k
        body, height = self._cylinder, self._scene.body.mass_centre_height
        body.translation = (0.0, 0.0, z - height * (1.0 - 2.0 * (i * i + j * j)))
        body.rotation = self._rapier.Rotation3(w=w, x=i, y=j, z=k)
        body.linvel, body.angvel = tuple(velocity.tolist()), tuple(spin.tolist())

    def _put_slab(self, height: float, velocity: Array) -> None:
        self._slab_height = height
        if self._slab is not None:
            self._slab.translation, self._slab.linvel = (0.0, 0.0, height), tuple(velocity.tolist())


def _build(rapier: ModuleType, scene: Scene, settings: RapierSettings) -> tuple[Any, Any, Any]:
    """Make ground, cylinder and slab, the centre of the base at the origin; return world and bodies.

    The slab is None where there is none.
    """
    world, body = rapier.PhysicsWorld(gravity=(0.0, 0.0, -scene.gravity)), scene.body
    how = world.integration_parameters
    how.dt, how.max_ccd_substeps = scene.time_step, 0
    how.num_solver_iterations = settings.substeps  # Rapier's name for its substeps
    how.num_internal_pgs_iterations = settings.iterations
    how.normalized_allowed_linear_error = _SLOP * settings.depth
    how.friction_model = getattr(rapier.FrictionModel, settings.friction_model.upper())
    how.contact_clustering = how.contact_recycling = False
    frequency = settings.contact_frequency * scene.unit_time
    softness = rapier.SpringCoefficients(frequency, settings.contact_damping_ratio)
    how.contact_softness = how.static_contact_softness = softness
    bodies, colliders = world.rigid_bodies, world.colliders

    def add_plane(kind: object, up: float) -> object:
        handle = bodies.insert(cast("Any", kind).build())
        plane = rapier.Collider.halfspace((0.0, 0.0, up)).density(0.0).friction(scene.friction)
        colliders.insert_with_parent(plane.build(), handle, bodies)
        return bodies[handle]

    add_plane(rapier.RigidBody.fixed(), 1.0)
    inertia = body.transverse_inertia, body.transverse_inertia, body.axial_inertia
    centre = (0.0, 0.0, body.mass_centre_height)
    mass = rapier.MassProperties(local_com=centre, mass=1.0, principal_inertia=inertia)
    cylinder = rapier.RigidBody.dynamic().can_sleep(False).gyroscopic_forces(True).allow_fast_rotation(True)
    handle = bodies.insert(cylinder.additional_mass_properties(mass).build())
    half, share = _HALF_DISC * body.base_radius, body.slab_mass_ratio
    for middle in [half, body.height - half] if share > 0.0 else [half]:
        disc = rapier.Collider.cylinder(half, body.base_radius).density(0.0).friction(scene.friction)
        disc = disc.rotation((0.5 * math.pi, 0.0, 0.0)).translation((0.0, 0.0, middle))
        colliders.insert_with_parent(disc.build(), handle, bodies)
    if share == 0.0:
        return world, bodies[handle], None
    kind = rapier.RigidBody.dynamic().can_sleep(False).locked_axes(rapier.LockedAxes.ROTATION_LOCKED)
    return world, bodies[handle], add_plane(kind.additional_mass(share), -1.0)


class RapierEngine(Declared):
    """Rapier: rigid body, half space, Coulomb friction."""

    package, settings_type, facts = "rapier3d", RapierSettings, _FACTS
    stepper_type = _RapierStepper
    sliding = MappingProxyType({"friction_model": "simplified"})
