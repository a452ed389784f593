"""A cylinder in an ideal recess under El Centro: plain MuJoCo beside the recess equations by scipy."""

import math
from pathlib import Path

import mujoco
import numpy as np
from scipy.integrate import solve_ivp

R, SLENDERNESS, G = 10.0, 0.1, 9.81  # rim to mass centre [m], b/h, [m/s^2]
STEP, DT, END = 2e-4, 0.01, 15.0  # of the engine, of the record, of the comparison [s]
B, H = R * math.sin(ALPHA := math.atan(SLENDERNESS)), R * math.cos(ALPHA)  # radius, half height [m]
I1, I2 = (3 * B**2 + 4 * H**2) / 12, B**2 / 2  # per unit mass
GUIDE = I2 * (0.1 / STEP) ** 2  # stiffness of each half, as stiff as the step allows
FOLDER = Path(__file__).parents[2] / "models" / "records"
FILES = "RSN6_IMPVALL.I_I-ELC270-hor2.AT2", "RSN6_IMPVALL.I_I-ELC180-hor1.AT2"  # to the west, to the south
TEXTS = [" ".join((FOLDER / name).read_text().splitlines()[4:]).split()[:1600] for name in FILES]
GROUND = -G * np.array(TEXTS, dtype=float).T  # to the east and the north [m/s^2]
# Nothing is steered: points just inside the rim carry the cylinder while it stands, its rim once it leans.
POINTS = [0.999 * B * np.array([math.cos(q), math.sin(q)]) for q in np.arange(64) * math.pi / 32]
RIM = "".join(f'<geom type="sphere" size="1e-3" pos="{x} {y} {1e-3 - H}"/>' for x, y in POINTS)
# The recess is a guide: -k times the twist, no work on the ideal motion.
SCENE = f"""<mujoco><option timestep="{STEP}" cone="elliptic" impratio="100" tolerance="1e-12"/>
  <default><geom solref="{2 * STEP} 1" solimp="0.9999 0.9999 0.001" friction="1 0 0"/>
    <general gear="0 0 0 0 0 1" biastype="affine" gainprm="0" biasprm="0 -{GUIDE} 0"/></default>
  <worldbody><geom type="plane" size="50 50 1"/><site name="world"/><body pos="0 0 {H}"><freejoint/>
    <inertial pos="0 0 0" mass="1" diaginertia="{I1} {I1} {I2}"/><geom type="cylinder" size="{B} {H}"/>
    {RIM}<site name="axis"/></body></worldbody>
  <actuator><general site="axis" refsite="world"/><general site="world" refsite="axis"/></actuator>
</mujoco>"""


def engine():
    """Rows of tilt, azimuth of the contact point [rad] and its place [m], DT apart."""
    model = mujoco.MjModel.from_xml_string(SCENE)
    data, rows, times = mujoco.MjData(model), [], np.arange(round(END / STEP) + 1) * STEP
    shaking = np.column_stack([np.interp(times, np.arange(len(GROUND)) * DT, a) for a in GROUND.T])
    for step, (ax, ay) in enumerate(shaking):
        if step % round(DT / STEP) == 0:
            mujoco.mj_kinematics(model, data)
            (x, y), z = data.xmat[1][2:6:3], data.xmat[1][8]  # the axis
            lean = max(math.hypot(x, y), 1e-12)
            foot = data.qpos[:2] + (B * z / lean - H) * np.array([x, y])
            rows.append([math.atan2(lean, z), math.atan2(y, x), *foot])
        model.opt.gravity[:] = -ax, -ay, -G  # on rigid ground a body force -m a
        mujoco.mj_step(model, data)
    return np.array(rows)


def rates(time, state, a, jerk):
    """Equations (18), (19): rates of tilt, tilt rate, azimuth phi and L = B phi', under a + jerk time."""
    (theta, rate, phi, momentum), (x, y) = state, a + jerk * time
    t, s, c = math.tan(theta / 2), math.sin(theta), math.cos(theta)
    along, across = x * math.cos(phi) + y * math.sin(phi), y * math.cos(phi) - x * math.sin(phi)
    inertia = I1 + H**2 + 2 * H * B * t + (I2 + B**2) * t**2
    growth = 2 * s * c * inertia + s**2 * (H * B + (I2 + B**2) * t) * (1 + t**2)
    turning = momentum / (s**2 * inertia)
    back = R * (G * math.sin(ALPHA - theta) + along * math.cos(ALPHA - theta))
    return [rate, (growth / 2 * turning**2 - back) / (I1 + R**2), turning, -s * (H + B * t) * across]


def differences():
    """Largest differences of tilt [alpha], contact point [b] and angle of turn [deg], from uplift on."""
    first, rows = int(np.argmax(np.hypot(*GROUND.T) > G * SLENDERNESS)) - 1, []
    for sample in range(first, round(END / DT)):
        a, jerk, lift = GROUND[sample], (GROUND[sample + 1] - GROUND[sample]) / DT, 0.0
        if not rows:  # uplift: |a| = g tan alpha, and the base opens against the acceleration
            lift = max(np.roots([jerk @ jerk, 2 * a @ jerk, a @ a - (G * SLENDERNESS) ** 2]).real)
            state = [1e-9, 0.0, math.atan2(*-(a + jerk * lift)[::-1]), 0.0]
        state = solve_ivp(rates, (lift, DT), state, "DOP853", rtol=1e-9, atol=1e-13, args=(a, jerk)).y[:, -1]
        rows.append([state[0], state[2], B * math.cos(state[2]), B * math.sin(state[2])])
    model, trial = np.array(rows), engine()[-len(rows) :]
    tilted = model[:, 0] > 0.05 * model[:, 0].max()  # nearer to upright the whole rim is at the ground
    trial[:, 1] = np.unwrap(trial[:, 1])
    tilt, turn, *place = np.abs(trial - model).T
    return tilt.max() / ALPHA, np.hypot(*place)[tilted].max() / B, np.degrees(turn[tilted].max())


if __name__ == "__main__":
    print("tilt {:.1e} alpha, contact point {:.1e} b, angle of turn {:.2g} deg".format(*differences()))
