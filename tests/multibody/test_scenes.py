"""The scene files, and what a run makes of them."""

from __future__ import annotations

from pathlib import Path

import mujoco
import numpy as np
import pytest

import rockwobble.models
from rockwobble.models import Cylinder, InitialState
from rockwobble.multibody.body import scaled_body
from rockwobble.multibody.engine import Scene
from rockwobble.multibody.mujoco_engine import MujocoEngine
from rockwobble.multibody.mujoco_scene import compile_scene
from rockwobble.multibody.settings import MujocoSettings
from rockwobble.multibody.start import starting_state

FOLDER = Path(next(iter(rockwobble.models.__path__))) / "scenes"
SCENES = sorted(FOLDER.glob("*.xml"))


def test_there_is_one_scene_for_each_support() -> None:
    assert {path.stem for path in SCENES} == set(MujocoEngine().supports)


@pytest.mark.parametrize("path", SCENES, ids=lambda path: path.stem)
def test_scene_opens_steps_a_second_and_warns_of_nothing(path: Path) -> None:
    model = mujoco.MjModel.from_xml_path(str(path))
    data = mujoco.MjData(model)
    while data.time < 1.0:
        mujoco.mj_step(model, data)
    assert not any(warning.number for warning in data.warning)
    # it stands: contact yields by 1e-11 m
    np.testing.assert_allclose(data.qpos, model.qpos0, atol=1e-9)


@pytest.mark.parametrize("path", SCENES, ids=lambda path: path.stem)
def test_scene_holds_the_defaults_of_a_run(path: Path) -> None:
    # a person who opens the file sees what a run computes with
    model = mujoco.MjModel.from_xml_path(str(path))
    ours = _compiled(path.stem, standing=True, components="xyz")
    for field in ("pair_solref", "pair_solimp", "pair_friction", "pair_solreffriction", "pair_dim"):
        np.testing.assert_allclose(getattr(model, field), getattr(ours, field), err_msg=field)
    for field in ("geom_size", "geom_pos", "geom_quat", "body_inertia", "body_mass", "qpos0"):
        np.testing.assert_allclose(getattr(model, field), getattr(ours, field), atol=1e-6, err_msg=field)
    for field in ("timestep", "integrator", "cone", "jacobian", "tolerance", "iterations", "solver"):
        assert getattr(model.opt, field) == getattr(ours.opt, field), field
    np.testing.assert_allclose(model.actuator_gear, ours.actuator_gear)
    # written with whole numbers
    np.testing.assert_allclose(model.actuator_biasprm, ours.actuator_biasprm, atol=1.0)


@pytest.mark.parametrize(
    ("support", "standing", "components", "actuators", "geoms"),
    [
        ("guided", True, "xy", 4, 14),
        ("guided", True, "xyz", 5, 14),
        ("guided", False, "", 2, 2),
        ("free", True, "xy", 2, 14),
        ("free", False, "xyz", 3, 2),
        ("free", False, "", 0, 2),
    ],
)
def test_scene_has_only_what_the_case_needs(
    support: str, standing: bool, components: str, actuators: int, geoms: int
) -> None:
    model = _compiled(support, standing=standing, components=components)
    assert (model.nu, model.ngeom, model.npair) == (actuators, geoms, geoms - 1)
    assert (model.nsensor, model.ntendon, model.neq, model.nv) == (0, 0, 0, 6)


def test_corners_stand_evenly_on_the_rim() -> None:
    model = _compiled("free", standing=True, components="", standing_corners=20)
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


def test_an_outline_off_the_mass_centre() -> None:
    cylinder = Cylinder(semidiagonal=6.0, tan_alpha=0.3, height=8.0)
    model = _compiled("free", standing=True, components="", cylinder=cylinder)
    for index in range(1, model.ngeom):
        bottom = model.geom_pos[index][2] - model.geom_size[index][1 if index == 1 else 2]
        assert bottom == pytest.approx(-cylinder.mass_centre_height)
        assert 2 * model.geom_size[index][1 if index == 1 else 2] == pytest.approx(8.0)


def _compiled(
    support: str,
    *,
    standing: bool,
    components: str,
    cylinder: Cylinder | None = None,
    standing_corners: int = 48,
) -> mujoco.MjModel:
    cylinder = cylinder or Cylinder(semidiagonal=6.0, tan_alpha=0.2)
    body = scaled_body(cylinder, 1.0)
    scene = Scene(
        body=body,
        start=starting_state(body, None if standing else InitialState(0.1), 1.0),
        support=support,
        friction=1.0,
        time_step=1e-4,
        gravity=9.81,
        components=components,
        unit_time=1.0,
    )
    settings = MujocoSettings.resolve({"standing_corners": standing_corners}, 1e-4)
    return compile_scene(scene, settings, standing=standing)
