"""MuJoCo: stepped in C by rollouts, with the ground acceleration as an array of controls."""

from __future__ import annotations

import contextlib
import ctypes
from collections.abc import Iterator, Mapping
from dataclasses import asdict
from typing import TYPE_CHECKING

import numpy as np

from rockwobble.models.mode import ROCKS_IN_PLANE, SLIDES
from rockwobble.models.support import FLAT, RECESS, RING

from ..protocol import EngineFacts, SceneCounts, Settings, Stepper, Steps, Wall
from ..ring import RingSettings, check_start, take_ring
from ..scene import Array, Scene
from .declared import Declared
from .mujoco_scene import MujocoSettings, compile_scene, set_start, to_world

if TYPE_CHECKING:
    import mujoco  # type: ignore[import-untyped]
    from mujoco import rollout

_STANDING_BLOCK = 20  # steps between two looks at whether a standing cylinder has uplifted
# Tilt up to which a corner, turned under it at each step, carries a cylinder better than its rim [rad]: the
# rim's depth is rounded by 1e-16 b/tilt, which makes the rim hop where it is a share of the depth itself, and
# each hop slips. Fixed corners would be a polygon.
_RISEN = 1e-4
# the same over the depth of a single corner under the weight, over b: a standing cylinder tilts by up to a
# sixteenth of it
_RISEN_DEPTHS = 1000.0
_LEANS = 1e-8  # [rad] tilt above which a corner follows its direction instead of the load
# eccentricities of the load over b: from the first a corner follows it, from the second at every step, and on
# the four corners of the first prism alone, early enough for the change to die away before the base opens
_LOADED, _OPENING = 0.5, 0.98
_LAST_PRISMS, _OUT_OF_REACH = 1, 1e-3  # [-], [m]
_FREE = 7  # coordinates of a free body
# damping ratios of a rim without a corner that follows it, and of one in a plane
_ROLLING, _CLOSING = 2.0, 4.0
_STOPPING = 500.0  # [1/s] rate at which friction stops a base that slides, at the reference size
_SLIDING: Settings = {
    "follow_load": False,
    "points": 8,
    "noslip_iterations": 20,
    "points_softness": 1.0,
    "contact_damping_ratio": 3.0,
}
# A standing cylinder also tilts where it runs into a wall, or hops while it slides: a tilt means uplift only
# under a load on its rim, or where it is far larger.
_ON_RIM, _RISEN_ANYHOW = 0.9, 1e-3  # eccentricity over b, and tilt [rad]

_INTEGRATORS = ("implicitfast", "implicit", "RK4", "discrete")  # besides the default
_FACTS = EngineFacts(
    title="MuJoCo",
    step_time=8e-6,
    release_error=2e-6,
    uplift_error=5e-6,
    smooth_uplift=True,  # its corners turn under the load
    carries_slab=True,
    terms=frozenset({"tendon", "rolling_resistance"}),
    contact_time="contact_time_constant",
    alternatives={f"integrator {name}": {"integrator": name} for name in _INTEGRATORS}
    | {"pyramidal cone": {"cone": "pyramidal"}},
    standing_alternatives={"standing without prisms": {"standing_corners": 0}}
    | {f"standing on {corners} corners": {"standing_corners": corners} for corners in (4, 12, 24, 48)}
    | {"nothing steered": {"follow_load": False}},
)


def _chosen(scene: Scene, given: Settings) -> Settings:
    """Settings that depend on the expected mode, and on whether corners follow the load."""
    in_plane = scene.mode == ROCKS_IN_PLANE and not scene.support.walls
    if scene.start.standing and scene.mode == SLIDES:
        return {**_SLIDING, "friction_damping": min(_STOPPING * scene.time_step, 1.0)}
    follow = given.get("follow_load", not in_plane)
    ratio = 1.0 if follow else _CLOSING if in_plane else _ROLLING
    return {"follow_load": follow, "contact_damping_ratio": ratio}


class MujocoEngine(Declared):
    """MuJoCo 4: free joint, ground plane, analytic plane-cylinder contact."""

    package, settings_type, facts = "mujoco", MujocoSettings, _FACTS
    supports = (RECESS, FLAT, RING)

    def settings(self, given: Settings, scene: Scene) -> Mapping[str, object]:
        """Return every setting; see `MujocoSettings` and, for the support "ring", `RingSettings`."""
        others, ring = take_ring(given, scene.support, scene.body.tan_alpha)
        if ring is not None:
            check_start(ring, scene)
        chosen = {**_chosen(scene, others), **others}
        return {**super().settings(chosen, scene), **({} if ring is None else asdict(ring))}

    @contextlib.contextmanager
    def open(self, scene: Scene, settings: Settings) -> Iterator[Stepper]:
        """Open the scene at its start."""
        from mujoco import rollout

        with _quiet(), rollout.Rollout(nthread=0) as runner:
            others, ring = take_ring(settings, scene.support, scene.body.tan_alpha)
            yield _MujocoStepper(scene, MujocoSettings(**others), ring, runner)


@contextlib.contextmanager
def _quiet() -> Iterator[None]:
    """Keep the engine from writing its warnings to a file where the user works, and from reading clocks."""
    import mujoco

    reporter, clock = mujoco.get_mju_user_warning(), mujoco.get_mjcb_time()
    mujoco.set_mju_user_warning(lambda message: None)  # warnings are counted in the data
    mujoco.set_mjcb_time(_stopped_clock())
    try:
        yield
    finally:
        mujoco.set_mju_user_warning(reporter)
        mujoco.set_mjcb_time(clock)


class _MujocoStepper:
    def __init__(
        self, scene: Scene, settings: MujocoSettings, ring: RingSettings | None, runner: rollout.Rollout
    ) -> None:
        import mujoco

        self._scene, self._settings, self._ring, self._runner = scene, settings, ring, runner
        self._columns = ["xyz".index(component) for component in scene.components]
        self._staggered = settings.integrator != "RK4"
        self._standing = scene.start.standing and settings.follow_load and settings.standing_corners > 0
        self._risen = max(_RISEN, _RISEN_DEPTHS * _depth(scene, settings) / scene.body.base_radius)
        self._model = compile_scene(scene, settings, standing=self._standing, ring=ring)
        self._data = mujoco.MjData(self._model)
        names = [self._model.geom(index).name for index in range(self._model.ngeom)]
        self._prisms = np.array([index for index, name in enumerate(names) if name.startswith("prism")], int)
        # angle of a prism from the first [rad]
        self._turns = 0.5 * np.pi / max(len(self._prisms), 1) * np.arange(len(self._prisms))
        self._model.geom_sameframe[self._prisms] = mujoco.mjtSameFrame.mjSAMEFRAME_NONE  # they will turn
        # height of the middle of the outline [m]
        self._middle = 0.5 * scene.body.height - scene.body.mass_centre_height
        self._warned: list[str] = []
        set_start(self._model, self._data, scene, self._staggered)
        kind = mujoco.mjtState.mjSTATE_FULLPHYSICS
        self._state = np.empty(mujoco.mj_stateSize(self._model, kind))
        mujoco.mj_getState(self._model, self._data, self._state, kind)

    @property
    def hold_centre(self) -> float:
        """Leapfrog takes the mean force about the pose, RK4 that over the next step."""
        return 0.0 if self._staggered else 0.5

    def advance(self, acceleration: Array) -> Steps:
        """Take one step for each row of `acceleration`."""
        steps = len(acceleration)
        states, sensors = np.empty((steps + 1, len(self._state))), np.empty((steps, self._model.nsensordata))
        states[0] = self._state
        control = np.zeros((steps, self._model.nu))
        push = -acceleration[:, self._columns]
        control[:, : len(self._columns)] = push
        if self._model.nq > _FREE and self._columns:  # the last forces act on the slab
            control[:, -len(self._columns) :] = push
        eccentricity = self._eccentricity(acceleration) if self._standing else None
        done = 0
        while done < steps:
            end = steps
            if eccentricity is not None and self._standing:
                block = slice(done, done + _STANDING_BLOCK)
                held = self._follow_load(acceleration[block], eccentricity[block])
                end = done + held if self._standing else steps
            self._roll(control[done:end], states[done + 1 : end + 1], sensors[done:end])
            done = end
        # time, position, quaternion, place of the slab; velocity in world, angular velocity in body axes
        # stored by component, which the recorder takes one by one
        rows = np.ascontiguousarray(states.T).T
        quaternion = rows[:, 4:8]
        moving = rows[:, 1 + self._model.nq :]
        velocity, spin = moving[:, :3], to_world(quaternion, moving[:, 3:6])
        touch = None if self._ring is None else _wall(sensors)
        if self._staggered:
            return Steps(rows[1:, 1:4], quaternion[1:], velocity[1:], spin[1:], touch, self._solver_failed())
        mean = 0.5 * (velocity[:-1] + velocity[1:]), 0.5 * (spin[:-1] + spin[1:])
        return Steps(rows[1:, 1:4], quaternion[1:], *mean, touch, self._solver_failed())

    def warnings(self) -> str:
        """Warnings of the engine."""
        return ", ".join(dict.fromkeys(self._warned + _warnings(self._data)))

    def counts(self) -> SceneCounts:
        """Counts of the last step."""
        data = self._data
        return SceneCounts(
            degrees_of_freedom=self._model.nv, contacts=int(data.ncon), constraint_rows=int(data.nefc)
        )

    def _solver_failed(self) -> bool:
        # the rollout stores the counts of the last step; an empty island has no iteration
        used = int(self._data.solver_niter.max())
        return used >= self._settings.iterations and self._settings.tolerance > 0.0

    def _roll(self, control: Array, rows: Array, sensors: Array) -> None:
        """Step in C; fill in the states (n, 14) after each step, and the sensors at its start."""
        self._runner.rollout(
            [self._model],
            [self._data],
            self._state[None],
            control[None] if self._model.nu else None,
            nstep=len(control),
            initial_warmstart=self._data.qacc_warmstart[None].copy(),
            state=rows[None],
            sensordata=sensors[None],
            skip_checks=True,  # they take as long as four steps, and what stands takes single ones
        )
        if self._data.warning.number.any():
            # after a failure the engine repeats its last valid state
            frozen = (np.diff(rows[:, 1:8], axis=0, prepend=self._state[None, 1:8]) == 0.0).all(axis=1)
            rows[frozen & (np.cumsum(~frozen[::-1])[::-1] == 0), 1:] = np.nan
        self._state = rows[-1].copy()

    def _eccentricity(self, acceleration: Array) -> Array:
        """Eccentricity of the load over b in each step (n,)."""
        body = self._scene.body
        push = np.hypot(acceleration[:, 0], acceleration[:, 1]) * body.mass_centre_height
        load: Array = push / (body.base_radius * (self._scene.tipping_gravity + acceleration[:, 2]))
        return load

    def _follow_load(self, acceleration: Array, eccentricity: Array) -> int:
        """Rotate the prisms about the axis until a corner is under the load; stop after the uplift.

        Return for how many steps they stay so: for one where the base opens.
        """
        w, x, y, z = self._state[4:8].tolist()
        axis = 2.0 * (x * z + w * y), 2.0 * (y * z - w * x)  # horizontal part of the axis
        lean, largest = float(np.hypot(*axis)), float(eccentricity.max())
        opens = largest > _OPENING or lean > _LEANS
        if lean > (self._risen if eccentricity[0] > _ON_RIM else max(self._risen, _RISEN_ANYHOW)):
            self._leave_prisms()
        if not self._standing or (largest < _LOADED and lean <= _LEANS):
            return len(acceleration)
        load = -acceleration[0] if opens else -acceleration.mean(axis=0)
        # the first corner of a prism is an eighth of a turn from its x axis
        at = axis if lean > _LEANS else load
        half = 0.5 * (np.arctan2(at[1], at[0]) - 0.25 * np.pi + self._turns)
        turned = self._model.geom_quat  # rotated about the vertical, so its other two components are zero
        turned[self._prisms, 0], turned[self._prisms, 3] = np.cos(half), np.sin(half)
        # neighbours that share the load of the last corner would let the base tilt before it opens
        self._model.geom_pos[self._prisms[_LAST_PRISMS:], 2] = self._middle + (
            _OUT_OF_REACH if opens else 0.0
        )
        return 1 if opens else len(acceleration)

    def _leave_prisms(self) -> None:
        """Remove the contacts of a standing cylinder: its corners cost time and touch the ground."""
        import mujoco

        self._warned += _warnings(self._data)
        self._standing = False
        self._model = compile_scene(self._scene, self._settings, standing=False, ring=self._ring)
        self._data = mujoco.MjData(self._model)


def _stopped_clock() -> ctypes._CFunctionType:
    """C function of a constant clock: reading a clock takes a fifth of a step."""
    return ctypes.CFUNCTYPE(ctypes.c_double)(("PyFloat_GetMax", ctypes.pythonapi))


def _warnings(data: mujoco.MjData) -> list[str]:
    import mujoco

    # one array: single numbers cost as much as a hundred steps
    return [
        mujoco.mjtWarning(int(index)).name.removeprefix("mjWARN_").lower()
        for index in np.flatnonzero(data.warning.number)
    ]


def _depth(scene: Scene, settings: MujocoSettings) -> float:
    """Depth of one contact under weight and prestress [m], by the impedance of its spring."""
    time = settings.contact_time_constant / scene.unit_time
    return scene.pressing_gravity * time**2 * (1.0 - settings.impedance) / settings.impedance


def _wall(sensors: Array) -> Wall:
    """From the sensors (n, 5) of the scene: number of contacts, net force of the mass of 1 kg, distance."""
    return Wall(sensors[:, 0] > 0.0, np.linalg.norm(sensors[:, 1:4], axis=1), -sensors[:, 4])
