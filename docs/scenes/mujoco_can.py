"""A can on flat ground in MuJoCo, released with some spin, until it leans most again."""

from __future__ import annotations

import math

import mujoco
import numpy as np

B, H = 1.0, 2.0  # radius and half height [m]
TILT, SPIN = 0.5 * math.atan(0.5), 0.1  # tilt [rad] and rolling rate [rad/s] of the release
STEP = 1e-4  # [s]
I1, I2 = (3 * B**2 + 4 * H**2) / 12, B**2 / 2  # per unit mass

SCENE = f"""
<mujoco>
  <!-- elliptic: Coulomb's cone; dense and 1e-12: one body, so exactness costs nothing -->
  <option timestep="{STEP}" integrator="Euler" cone="elliptic" jacobian="dense" tolerance="1e-12"/>
  <worldbody>
    <!-- a plane, because the routine for plane and cylinder is analytic; the one for a box is not -->
    <geom name="ground" type="plane" size="9 9 1"/>
    <body name="can" pos="0 0 {H}">
      <freejoint/>
      <inertial pos="0 0 0" mass="1" diaginertia="{I1} {I1} {I2}"/>
      <geom name="can" type="cylinder" size="{B} {H}"/>
    </body>
  </worldbody>
  <contact>
    <!-- solref: contact takes two steps and does not bounce; solimp: it takes 0.9999 of the load at once;
         solreffriction: friction removes 1.8 of the slip velocity in a step, or the rim creeps -->
    <pair geom1="ground" geom2="can" condim="3" friction="1 1 0 0 0" solref="{2 * STEP} 1"
          solimp="0.9999 0.9999 0.001" solreffriction="-1 {-1.8 * 0.9999 / STEP}"/>
  </contact>
</mujoco>
"""


def released(model: mujoco.MjModel) -> mujoco.MjData:
    """Return the state of release: leaning towards x, rolling without slip, no turn about its own axis."""
    data = mujoco.MjData(model)
    axis = np.array([math.sin(TILT), 0.0, math.cos(TILT)])
    centre = np.array([B * (1 - axis[2]), 0.0, B * axis[0]]) + H * axis
    turning = SPIN * (np.array([0.0, 0.0, 1.0]) - axis)
    data.qpos[:] = [*centre, math.cos(TILT / 2), 0.0, math.sin(TILT / 2), 0.0]
    data.qvel[:3] = np.cross(turning, centre - [B, 0.0, 0.0])
    mujoco.mju_rotVecQuat(data.qvel[3:], turning, np.array([data.qpos[3], *-data.qpos[4:]]))  # body axes
    return data


def next_largest_tilt(scene: str = SCENE, seconds: float = 2.0) -> tuple[float, float]:
    """Return the angle of turn until the next largest tilt [deg], and that tilt over the one of release."""
    model = mujoco.MjModel.from_xml_string(scene)
    data, axes = released(model), []
    for _ in range(int(seconds / model.opt.timestep)):
        mujoco.mj_step(model, data)
        axes.append(data.body("can").xmat[2::3].copy())  # of the axis, in the world
    lean = np.array(axes)
    tilt = np.arccos(lean[:, 2])
    upright = int(tilt[: int(1.2 / model.opt.timestep)].argmin())
    top = upright + int(tilt[upright:].argmax())
    return math.degrees(np.unwrap(np.arctan2(lean[:, 1], lean[:, 0]))[top]), tilt[top] / TILT


if __name__ == "__main__":
    turn, tilt = next_largest_tilt()
    print(f"turned by {turn:.3f} deg (exact 203.910), tilted to {tilt:.5f} of the release (exact 1)")
