"""The scene files, and the models that a run compiles from them."""

from __future__ import annotations

from pathlib import Path
from types import SimpleNamespace
from typing import Any

import mujoco
import numpy as np
import pytest
from engine_samples import scene_of
from scipy.spatial.transform import Rotation

import rockwobble.models
from rockwobble.models import Cylinder, InitialState
from rockwobble.models.support import RING, SUPPORTS
from rockwobble.multibody.engines.mujoco import MujocoEngine
from rockwobble.multibody.engines.mujoco_scene import MujocoSettings, _rim_acceleration, compile_scene
from rockwobble.multibody.ring import RingSettings, take_ring, wall_feet, wall_orientations
from rockwobble.multibody.scene import scaled_body, starting_state

FOLDER = Path(next(iter(rockwobble.models.__path__))) / "scenes"
SCENES = sorted(FOLDER.glob("*.xml"))
PIER = Cylinder(semidiagonal=6.0, tan_alpha=0.2)
ROUNDING = 1e-12  # of lengths and normals of the order of 1


def test_there_is_one_scene_for_each_support() -> None:
    assert {path.stem for path in SCENES} == set(MujocoEngine().supports)


@pytest.mark.slow
@pytest.mark.parametrize("path", SCENES, ids=lambda path: path.stem)
def test_a_scene_file_opens_and_steps_without_warnings(path: Path) -> None:
    model = mujoco.MjModel.from_xml_path(str(path))
    data = mujoco.MjData(model)
    while data.time < 1.0:
        mujoco.mj_step(model, data)
    assert not any(warning.number for warning in data.warning)
    # it stands: contact yields by 1e-11 m
    np.testing.assert_allclose(data.qpos, model.qpos0, atol=1e-9)


@pytest.mark.parametrize("path", SCENES, ids=lambda path: path.stem)
def test_scene_holds_the_defaults_of_a_run(path: Path) -> None:
    # the file shows the settings of a run
    model = mujoco.MjModel.from_xml_path(str(path))
    # the file has fewer walls than a run, for readability
    ring = RingSettings(ring_inclination=PIER.alpha, ring_facets=32) if path.stem == "ring" else None
    ours = _compiled(path.stem, standing=True, components="xyz", ring=ring)
    # a run has the rim from the first tilt on, and the corners until then
    rolling = _compiled(path.stem, standing=False, components="xyz", ring=ring)
    for names, index in _pairs(model).items():
        of_run = rolling if names == ("ground", "cylinder") else ours
        at = _pairs(of_run)[names]
        for field in ("pair_solref", "pair_solimp", "pair_friction", "pair_solreffriction", "pair_dim"):
            np.testing.assert_allclose(
                getattr(model, field)[index], getattr(of_run, field)[at], err_msg=f"{field} of {names}"
            )
    for field in ("geom_size", "geom_pos", "geom_quat", "body_inertia", "body_mass", "qpos0"):
        np.testing.assert_allclose(getattr(model, field), getattr(ours, field), atol=1e-6, err_msg=field)
    for field in ("timestep", "integrator", "cone", "jacobian", "tolerance", "iterations", "solver"):
        assert getattr(model.opt, field) == getattr(ours.opt, field), field
    np.testing.assert_allclose(model.actuator_gear, ours.actuator_gear)
    # written with whole numbers
    np.testing.assert_allclose(model.actuator_biasprm, ours.actuator_biasprm, atol=1.0)


def _pairs(model: mujoco.MjModel) -> dict[tuple[str, str], int]:
    """Index of each pair by the names of its geoms."""
    return {
        (model.geom(model.pair_geom1[index]).name, model.geom(model.pair_geom2[index]).name): index
        for index in range(model.npair)
    }


@pytest.mark.parametrize(
    ("support", "guides", "walls", "sensors"), [("recess", 2, 0, 0), ("flat", 0, 0, 0), ("ring", 0, 128, 2)]
)
@pytest.mark.parametrize("components", ["", "xy", "xyz"])
@pytest.mark.parametrize(("standing", "prisms"), [(True, 12), (False, 0)])
def test_scene_has_only_what_the_case_needs(
    support: str, guides: int, walls: int, sensors: int, components: str, standing: bool, prisms: int
) -> None:
    model = _compiled(support, standing=standing, components=components)
    assert model.nu == guides + len(components)
    # ground and cylinder, and a pair for each body in contact with the ground or the cylinder: the rim where
    # it tilts
    assert (model.ngeom, model.npair) == (2 + prisms + walls, (not standing) + prisms + walls)
    assert model.nsensor == sensors
    # world and cylinder, and the ring that the sensors name
    assert model.nbody == (3 if walls else 2)
    assert (model.ntendon, model.neq, model.nv, model.nsite) == (0, 0, 6, 2)


@pytest.mark.parametrize("facets", [3, 31, 32, 100])
def test_a_ring_has_the_number_of_walls_in_its_settings(facets: int) -> None:
    ring = RingSettings(ring_inclination=0.4, ring_clearance=0.05, ring_facets=facets, ring_friction=0.3)
    model = _compiled("ring", standing=False, components="", ring=ring)
    walls = [index for index in range(model.ngeom) if model.geom(index).name.startswith("wall")]
    assert (len(walls), model.ngeom, model.npair) == (facets, 2 + facets, 1 + facets)
    np.testing.assert_allclose(model.geom_pos[walls], wall_feet(ring, PIER.base_radius), atol=ROUNDING)
    np.testing.assert_allclose(model.geom_quat[walls], wall_orientations(ring), atol=ROUNDING)
    cylinder = model.geom("cylinder").id
    for index in range(model.npair):
        pair = {int(model.pair_geom1[index]), int(model.pair_geom2[index])}
        assert cylinder in pair
        friction = 1.0 if model.geom("ground").id in pair else 0.3
        np.testing.assert_allclose(model.pair_friction[index], [friction, friction, 0.0, 0.0, 0.0])
    # no other contact of a wall: the prisms reach as far as the cylinder
    assert (model.geom_contype[walls] == 0).all()
    assert (model.geom_conaffinity[walls] == 0).all()


def test_corners_stand_evenly_on_the_rim() -> None:
    model = _compiled("flat", standing=True, components="", standing_corners=20)
    prisms = [index for index in range(model.ngeom) if model.geom(index).name.startswith("prism")]
    angles = []
    for index in prisms:
        rotation = np.zeros(9)
        mujoco.mju_quat2Mat(rotation, model.geom_quat[index])
        half = model.geom_size[index][0]
        assert np.hypot(half, half) == pytest.approx(Cylinder(semidiagonal=6.0, tan_alpha=0.2).base_radius)
        corners = [rotation.reshape(3, 3) @ [x * half, y * half, 0.0] for x in (-1, 1) for y in (-1, 1)]
        angles += [np.degrees(np.arctan2(corner[1], corner[0])) for corner in corners]
    np.testing.assert_allclose(np.diff(np.sort(angles)), 18.0, atol=1e-9)


def _compiled(
    support: str,
    *,
    standing: bool,
    components: str,
    cylinder: Cylinder | None = None,
    standing_corners: int = 48,
    ring: RingSettings | None = None,
) -> mujoco.MjModel:
    cylinder = cylinder or PIER
    initial = None if standing else InitialState(0.1)
    scene = scene_of(cylinder, initial, support=SUPPORTS[support], components=components)
    settings = MujocoSettings.resolve({"standing_corners": standing_corners}, 1e-4)
    if support == "ring" and ring is None:
        _, ring = take_ring({}, RING, cylinder.tan_alpha)
    return compile_scene(scene, settings, standing=standing, ring=ring)


def test_the_acceleration_of_the_rim_is_that_of_its_lowest_point() -> None:
    cylinder = Cylinder(semidiagonal=1.0, tan_alpha=0.4)
    body = scaled_body(cylinder, 1.0)
    start = starting_state(body, InitialState(0.2, tilt_rate=0.7, rolling_angle=0.5, rolling_rate=0.9), 1.0)
    scene: Any = SimpleNamespace(body=body, start=start)
    acceleration = np.array([0.3, -0.2, 0.6, 1.1, -0.8, 0.4])  # the last three in body axes
    turned = Rotation.from_quat(start.quaternion, scalar_first=True)

    def height(time: float) -> float:
        turn = start.angular_velocity * time + 0.5 * turned.apply(acceleration[3:]) * time**2
        axis = (Rotation.from_rotvec(turn) * turned).apply([0.0, 0.0, 1.0])
        rise = start.velocity[2] * time + 0.5 * acceleration[2] * time**2
        return float(rise - body.mass_centre_height * axis[2] - body.base_radius * np.hypot(*axis[:2]))

    step = 1e-4
    expected = (height(step) - 2.0 * height(0.0) + height(-step)) / step**2
    of_rim = _rim_acceleration(SimpleNamespace(qacc=acceleration), scene)
    assert of_rim == pytest.approx(expected, abs=1e-6)  # of second differences, of their step and rounding
