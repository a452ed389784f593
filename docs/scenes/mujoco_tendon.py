"""A can with a tendon along its axis in MuJoCo, released beyond its balance: the tendon brings it back."""

from __future__ import annotations

import math

import mujoco
from mujoco_can import SCENE, STEP, B, H

WEIGHT = 9.81  # [N] of 1 kg
PRESTRESS, STIFFNESS = 0.5 * WEIGHT, 1.0 * WEIGHT / B  # [N], [N/m]
TILT = 1.2 * math.atan(0.5)  # [rad]: a free can falls from here
DEPTH = 1e-4  # [m] of the anchor under the ground, so that the tendon has a direction at rest

# in two straight parts: from the anchor to the centre of the base, which is the elongation, and up the axis
TENDON = f"""
  <tendon>
    <spatial name="tendon" stiffness="{STIFFNESS}" springlength="{2 * H + DEPTH - PRESTRESS / STIFFNESS}">
      <site site="anchor"/>
      <site site="base"/>
      <site site="top"/>
    </spatial>
  </tendon>
</mujoco>
"""


def scene() -> str:
    """Return the can of `mujoco_can` with a tendon."""
    text = SCENE.replace("</mujoco>", TENDON)
    text = text.replace("<worldbody>", f'<worldbody><site name="anchor" pos="0 0 {-DEPTH}"/>')
    sites = f'<site name="base" pos="0 0 {-H}"/><site name="top" pos="0 0 {H}"/>'
    return text.replace("<freejoint/>", f"<freejoint/>{sites}")


def time_to_upright(text: str | None = None, seconds: float = 4.0) -> float:
    """Return when the can is upright again [s]; infinite if it falls."""
    model = mujoco.MjModel.from_xml_string(scene() if text is None else text)
    data = mujoco.MjData(model)
    s, c = math.sin(TILT), math.cos(TILT)
    data.qpos[:] = [B * (1 - c) + H * s, 0.0, B * s + H * c, math.cos(TILT / 2), 0.0, math.sin(TILT / 2), 0.0]
    for step in range(int(seconds / STEP)):
        mujoco.mj_step(model, data)
        lean = data.body("can").xmat[2]  # of the axis, towards x
        if lean <= 0.0:
            return (step + 1) * STEP
        if lean > 0.999:
            return math.inf
    return math.inf


if __name__ == "__main__":
    print(f"upright after {time_to_upright():.4f} s; without the tendon {time_to_upright(SCENE)}")
