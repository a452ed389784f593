"""Contact with walls: the closed form against points of a cylinder, and against the engine."""

from __future__ import annotations

import math

import mujoco
import numpy as np
import pytest
from engine_samples import scene_of

from rockwobble.models import Cylinder, InitialState
from rockwobble.models.support import RING
from rockwobble.multibody.engines.mujoco_scene import MujocoSettings, compile_scene
from rockwobble.multibody.kinematics import axis_of
from rockwobble.multibody.ring import (
    RingSettings,
    clearance_needed,
    rim_overhang,
    wall_feet,
    wall_orientations,
)
from rockwobble.multibody.scene import Array, scaled_body, starting_state

ROUNDING = 1e-12  # of quantities of the order of b or of 1
# clearance margin on both sides in the engine; a pose is accurate to 1e-15 m
MARGIN = 1e-9

SLENDERNESS = (0.1, 0.2, 1.0, 3.0)
# neighbours, or a wall steeper by little and by much; the last rows reach the stationary branch
ANGLES = ((0.05, 0.0), (0.2, 0.1), (0.2, 0.3), (0.5, 0.5), (0.7, 0.1), (1.2, 0.0), (1.5, 0.05))


def test_walls_stand_where_the_settings_say() -> None:
    ring = RingSettings(ring_clearance=0.02, ring_inclination=0.3, ring_facets=12)
    feet, turns = wall_feet(ring, 2.0), wall_orientations(ring)
    normals = axis_of(turns)
    assert feet.shape == normals.shape == (12, 3)
    np.testing.assert_allclose(np.linalg.norm(turns, axis=1), 1.0, atol=ROUNDING)
    np.testing.assert_allclose(np.hypot(feet[:, 0], feet[:, 1]), 2.04, atol=ROUNDING)
    # each faces the middle, and the wall rises outward by tan(0.3) for each metre of height
    upward = np.column_stack([feet[:, :2] / 2.04 * math.tan(0.3), np.ones(12)])
    np.testing.assert_allclose(np.einsum("ij,ij->i", normals, upward), 0.0, atol=ROUNDING)
    assert (np.einsum("ij,ij->i", normals[:, :2], feet[:, :2]) < 0.0).all()


@pytest.mark.parametrize("tan_alpha", SLENDERNESS)
@pytest.mark.parametrize(("tilt", "inclination"), ANGLES)
def test_clearance_is_the_largest_reach_of_the_cylinders_points(
    tan_alpha: float, tilt: float, inclination: float
) -> None:
    cylinder = Cylinder(semidiagonal=6.0, tan_alpha=tan_alpha)
    b = cylinder.base_radius
    points = _rims(cylinder, tilt, 1440)
    # how far out of the original circle each point lies along the ground, in the direction of each wall
    azimuth = np.linspace(0.0, math.pi, 721)
    radial = np.outer(points[:, 0], np.cos(azimuth)) + np.outer(points[:, 1], np.sin(azimuth))
    out = (radial - points[:, 2:] * math.tan(inclination)).max() / b - 1.0
    # walls and points 0.25 deg apart: (half a step)^2/2 is 2e-6, of a body up to 20 b high; the wall ahead is
    # among them
    assert clearance_needed(cylinder, tilt, inclination) == pytest.approx(max(out, 0.0), abs=2e-5)


@pytest.mark.parametrize("tilt", [0.01, 0.3, 1.2])
def test_overhang_of_the_rim_is_the_largest_of_its_points(tilt: float) -> None:
    cylinder = Cylinder(semidiagonal=6.0, tan_alpha=0.2)
    base = _rims(cylinder, tilt, 7200)[:7200]
    reach = np.hypot(base[:, 0], base[:, 1])
    furthest = int(np.argmax(reach))
    overhang, height = rim_overhang(tilt)
    b = cylinder.base_radius
    # the largest of 7200 points misses the top of a parabola by the square of half a step
    assert overhang == pytest.approx(reach[furthest] / b - 1.0, abs=1e-6)
    assert height == pytest.approx(base[furthest, 2] / b, abs=1e-3)
    c = math.cos(tilt)
    design = math.sqrt(1.0 + (1.0 - c) * ((1.0 - c) + c * c / (1.0 + c))) - 1.0
    assert overhang == pytest.approx(design, abs=ROUNDING)


@pytest.mark.slow
@pytest.mark.parametrize("tan_alpha", [SLENDERNESS[0], SLENDERNESS[-1]])
@pytest.mark.parametrize(("tilt", "inclination"), [angles for angles in ANGLES if angles[0] > angles[1]])
def test_engine_touches_a_wall_exactly_at_the_computed_clearance(
    tan_alpha: float, tilt: float, inclination: float
) -> None:
    cylinder = Cylinder(semidiagonal=6.0, tan_alpha=tan_alpha)
    needed = clearance_needed(cylinder, tilt, inclination)
    assert needed > 0.0
    # the ring has eight walls: the tilt azimuth is such that the cylinder reaches furthest at one of them
    off = _off_the_lean(cylinder, tilt, inclination)
    poses = [(tilt, off), (tilt, 0.5 * math.pi + off)]
    assert (_wall_contacts(cylinder, needed - MARGIN, inclination, poses) > 0).all()
    assert (_wall_contacts(cylinder, needed + MARGIN, inclination, poses) == 0).all()


@pytest.mark.parametrize(
    "change", [{"tilt": -0.1}, {"tilt": 2.0}, {"inclination": -0.1}, {"inclination": 1.6}]
)
def test_angles_out_of_range_are_refused(change: dict[str, float]) -> None:
    cylinder = Cylinder(semidiagonal=6.0, tan_alpha=0.2)
    with pytest.raises(ValueError, match=r"must be from 0 to .*, got"):
        clearance_needed(cylinder, **{"tilt": 0.1, "inclination": 0.1, **change})


def _rims(cylinder: Cylinder, tilt: float, count: int) -> Array:
    """Points of the rim of the base, then of the top, tilted along x on the first circle, (2 count, 3)."""
    b, s, c = cylinder.base_radius, math.sin(tilt), math.cos(tilt)
    around = 2.0 * math.pi * np.arange(count) / count
    # the lowest point is that at which `around` is zero
    base = np.column_stack(
        [b * (1.0 - c) + b * c * np.cos(around), b * np.sin(around), b * s * (1.0 - np.cos(around))]
    )
    axis = 2.0 * cylinder.half_height * np.array([s, 0.0, c])
    return np.vstack([base, base + axis])


def _off_the_lean(cylinder: Cylinder, tilt: float, inclination: float) -> float:
    """Azimuth between the lean and the wall that the cylinder reaches first [rad]."""
    slope = 2.0 * cylinder.half_height / cylinder.base_radius + math.tan(0.5 * tilt)
    along = min(math.sin(tilt - inclination), slope / math.hypot(1.0, slope))
    cosine = (along + math.cos(tilt) * math.sin(inclination)) / (math.sin(tilt) * math.cos(inclination))
    return math.acos(min(cosine, 1.0))


def _wall_contacts(
    cylinder: Cylinder, clearance: float, inclination: float, poses: list[tuple[float, float]]
) -> Array:
    """Number of contacts with walls that the engine finds, at tilts and azimuths."""
    body = scaled_body(cylinder, 1.0)
    starts = [starting_state(body, InitialState(tilt, rolling_angle=azimuth), 1.0) for tilt, azimuth in poses]
    scene = scene_of(cylinder, start=starts[0], support=RING, components="")
    ring = RingSettings(ring_clearance=clearance, ring_inclination=inclination, ring_facets=8)
    model = compile_scene(scene, MujocoSettings.resolve({}, 1e-4), standing=False, ring=ring)
    data = mujoco.MjData(model)
    contacts = []
    for start in starts:
        data.qpos[:3], data.qpos[3:] = start.position, start.quaternion
        mujoco.mj_forward(model, data)
        contacts.append(data.sensordata[0])
    return np.array(contacts)
