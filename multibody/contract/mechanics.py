"""Rules of the contract for a rim that rolls without loss: invariants that need no other model.

The problem is a pier of 6 m released at half its slenderness, which passes within 1.2 s.
"""

from __future__ import annotations

import dataclasses
import math

import numpy as np

from rockwobble.models import GroundMotion, InitialState

from ..body import scaled_body
from ..engines.registry import find_engine
from ..scene.froude import REFERENCE_GRAVITY
from ..scene.guard import energy_scale
from .interface import Check
from .problem import PIER, RELEASE, hold, refused, run, shaking, small

SYMMETRY = 1e-7  # [rad] of tilt: solvers stop at a tolerance, and a pass multiplies what is left by ten
TURNED = 1e-5  # [rad] of the rolling angle, which a pass at 0.2 alpha magnifies by some 30
ENERGY = 1e-4  # of the energy scale; a sound engine takes 1e-6 in a pass
MOMENTUM = 1e-4  # relative
SLIP = 1e-3  # of b, the creep of a rim that rolls for a second
STEADY = 1e-4  # of alpha: a steady wobble is stable, so an error does not grow
UPLIFT_TIME = 2e-3  # [s] twenty steps: contact yields before the base tips
UPLIFT_DIRECTION = 1e-3  # [rad]


def does_not_tell_left_from_right(engine: str, support: str) -> None:
    """The mirror image of a problem has the mirror image as its answer."""
    mirrored = dataclasses.replace(RELEASE, rolling_rate=-RELEASE.rolling_rate)
    first, second = run(engine, support), run(engine, support, initial=mirrored)
    small(second.tilt - first.tilt, SYMMETRY, "the tilt of the mirror image differs")
    small(second.rolling_angle + first.rolling_angle, TURNED, "the mirror image turns otherwise")
    small(second.twist + first.twist, TURNED, "the mirror image twists otherwise")


def does_not_know_the_axes(engine: str, support: str) -> None:
    """A problem turned about the vertical has the turned answer, also under excitation."""
    turned = dataclasses.replace(RELEASE, rolling_angle=1.234)
    first = run(engine, support, motion=shaking())
    second = run(engine, support, motion=shaking().rotated(1.234), initial=turned)
    small(second.tilt - first.tilt, SYMMETRY, "the tilt of the turned problem differs")
    small(second.rolling_angle - 1.234 - first.rolling_angle, TURNED, "the turned problem turns otherwise")


def keeps_its_energy(engine: str, support: str) -> None:
    """Free response neither gains nor loses energy."""
    found = run(engine, support)
    small(
        np.ptp(found.energy) / _energy_scale(), ENERGY, "energy of the free response over its scale changes"
    )


def takes_the_work_of_the_ground(engine: str, support: str) -> None:
    """Under excitation the energy changes by the work of the body force -a, and by nothing else."""
    found = run(engine, support, motion=shaking())
    small(found.energy_error / _energy_scale(), ENERGY, "energy less work over its scale changes")
    change = float(np.ptp(found.energy)) / _energy_scale()
    hold(change > 0.1, f"the excitation changes the energy by no more than {change:.1e} of its scale")


def keeps_momentum_or_rolls(engine: str, support: str) -> None:
    """In a recess L = B phi' is conserved and there is no twist; on flat ground the rim does not slip."""
    found = run(engine, support)
    if support == "recess":
        momentum = np.array([_inertia(tilt)[0] for tilt in found.tilt]) * found.rolling_rate
        small(momentum / momentum[0] - 1.0, MOMENTUM, "L = B phi' over its start is not conserved")
        small(found.twist, 1e-4, "the guide lets the cylinder twist")
    small(found.slip / PIER.base_radius, SLIP, "slip over b")


def wobbles_steadily(engine: str, support: str) -> None:
    """At the rate that balances gravity, phi'^2 = 2 g (b cos - h sin)/B', the tilt stays, on any support."""
    tilt = PIER.alpha / 2
    b, h = PIER.base_radius, PIER.mass_centre_height
    pull = 2.0 * REFERENCE_GRAVITY * (b * math.cos(tilt) - h * math.sin(tilt))
    rate = math.sqrt(pull / _inertia(tilt)[1])
    found = run(engine, support, initial=InitialState(tilt, rolling_rate=rate), duration=1.0)
    small((found.tilt - tilt) / PIER.alpha, STEADY, "the tilt of a steady wobble over alpha changes")


def overturns(engine: str, support: str) -> None:
    """A fall ends with the side on the ground, as data."""
    found = run(engine, support, initial=InitialState(3.0 * PIER.alpha, rolling_rate=0.1), duration=10.0)
    hold(found.outcome == "overturned", f"a falling cylinder ended as {found.outcome}: {found.facts}")
    hold(found.tilt[-1] == found.peak_tilt == 0.5 * math.pi, f"it ended at {found.tilt[-1]} rad")
    hold(bool((np.diff(found.time) > 0.0).all()), "time does not rise")


def uplifts_when_due(engine: str, support: str) -> None:
    """A standing cylinder waits until the ground acceleration is g tan(alpha); or the engine refuses it."""
    limit = REFERENCE_GRAVITY * PIER.tan_alpha
    if not find_engine(engine).uplifts:
        refused({"engine": engine, "support": support, "initial": None}, "at rest")
        return
    below = GroundMotion([[0.0, 0.0], [0.8 * limit, 0.0]], 0.4)
    waiting = run(engine, support, initial=None, motion=below, duration=None)
    hold(waiting.rests, "below the threshold it does not stand still")
    ramp = GroundMotion([[0.0, 0.0], [2.0 * limit, 0.0]], 0.8)
    found = run(engine, support, initial=None, motion=ramp, duration=None)
    small(found.uplift_time - 0.4, UPLIFT_TIME, "it does not uplift at 0.4 s")
    off = math.remainder(found.uplift_direction - math.pi, 2.0 * math.pi)
    small(off, UPLIFT_DIRECTION, "it does not uplift against the acceleration")
    small(
        found.rolling_angle[-1] - found.uplift_direction,
        UPLIFT_DIRECTION,
        "it leans elsewhere, or a turn away",
    )
    # which rises on with the load: what was lowest at the uplift is no turning point
    hold(len(found.extrema) == 0, f"a tilt that only rises turns at {found.extrema[:, 0]} s")


def _energy_scale() -> float:
    return energy_scale(scaled_body(PIER, 1.0), REFERENCE_GRAVITY)


def _inertia(tilt: float) -> tuple[float, float]:
    """B of the rolling angle in a recess, per unit mass, and its derivative, equations (16) and (18)."""
    body = scaled_body(PIER, 1.0)
    b, h, I1, I2 = body.base_radius, body.mass_centre_height, body.transverse_inertia, body.axial_inertia
    s, c = math.sin(tilt), math.cos(tilt)
    # horizontal arm of the mass centre about the vertical through O: D = b (1 - c) + h s
    arm, arm_rate = b * (1.0 - c) + h * s, b * s + h * c
    # turning with phi' about the vertical and -phi' about the axis; the centre keeps its height
    inertia = arm**2 + I1 * s**2 + I2 * (1.0 - c) ** 2
    return inertia, 2.0 * (arm * arm_rate + I1 * s * c + I2 * (1.0 - c) * s)


FLAT: tuple[Check, ...] = (
    does_not_tell_left_from_right,
    does_not_know_the_axes,
    keeps_its_energy,
    takes_the_work_of_the_ground,
    keeps_momentum_or_rolls,
    wobbles_steadily,
    overturns,
    uplifts_when_due,
)
"""What holds where the rim rolls without loss: recess and flat."""
