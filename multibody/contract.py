"""What any engine must hold, in physics: invariants that need no other model to compare with.

Each check runs one engine with one support and raises an AssertionError that says what was found. The
problem is a pier of 6 m released at half its slenderness, which passes within 1.2 s.
"""

from __future__ import annotations

import dataclasses
import json
import math
from collections.abc import Callable
from typing import Any

import numpy as np

from rockwobble.models import Case, Cylinder, GroundMotion, InitialState, Trace

from .body import scaled_body
from .engines.registry import find_engine
from .protocol import Array, Scene
from .scene.froude import REFERENCE_GRAVITY, REFERENCE_TIME_STEP, froude_scale
from .scene.guard import energy_scale
from .simulation import simulate
from .start import starting_state

PIER = Cylinder(semidiagonal=6.0, tan_alpha=0.2)
RELEASE = InitialState(PIER.alpha / 2, rolling_rate=0.5)
PASS = 1.3  # [s] until after the first pass

FALL = 2.0 * REFERENCE_GRAVITY  # [m/s^2] more than the acceleration of the mass centre
START = 1e-6  # relative, of rates: a central difference over two steps
SYMMETRY = 1e-7  # [rad] of tilt: solvers stop at a tolerance, and a pass multiplies what is left by ten
TURNED = 1e-5  # [rad] of the rolling angle, which a pass at 0.2 alpha magnifies by some 30
SIZE = 1e-9  # relative to alpha: the scene is the same, but for rounding
ENERGY = 1e-4  # of the energy scale; a sound engine takes 1e-6 in a pass
MOMENTUM = 1e-4  # relative
SLIP = 1e-3  # of b, the creep of a rim that rolls for a second
STEADY = 1e-4  # of alpha: a steady wobble is stable, so an error does not grow
UPLIFT_TIME = 2e-3  # [s] twenty steps: contact yields before the base tips
UPLIFT_DIRECTION = 1e-3  # [rad]
CHUNKS = 1e-9  # [m], [-] what is carried from one call to the next, and no more


def run(engine: str, support: str, **changes: Any) -> Trace:
    """Run the release, or the problem that `changes` make of it."""
    given: dict[str, Any] = {"initial": RELEASE, "duration": PASS, **changes}
    names = ("initial", "duration", "gravity", "friction", "motion")
    stated = {name: given.pop(name) for name in names if name in given}
    case = Case(given.pop("cylinder", PIER), **stated)
    return simulate(case, engine=engine, support=support, **given)


def describes_itself(engine: str, support: str) -> None:
    """Version, supports and settings are plain values."""
    backend = find_engine(engine)
    hold(bool(backend.version()), "the version is empty")
    hold(support in backend.supports, f"supports are {backend.supports}")
    hold(isinstance(backend.uplifts, bool), f"uplifts is {backend.uplifts!r}, not True or False")
    settings = backend.settings({}, _scene(support))
    hold(json.loads(json.dumps(settings)) == settings, f"settings are not plain values: {settings}")


def refuses_what_it_does_not_know(engine: str, support: str) -> None:
    """An unknown setting or support is a ValueError of one line that names it."""
    for change in ({"no_such_setting": 1.0}, {"support": "no_such_support"}):
        _refused(
            {"engine": engine, "support": support, **change}, next(iter(change)).removeprefix("no_such_")
        )


def steps_one_by_one(engine: str, support: str) -> None:
    """A step is a step, however many one call takes, and two open scenes do not disturb each other."""
    backend, scene = find_engine(engine), _scene(support)
    settings = backend.settings({}, scene)
    still = np.zeros((60, 3))
    with backend.open(scene, settings) as whole, backend.open(scene, settings) as separated:
        hold(0.0 <= whole.hold_centre <= 1.0, f"hold_centre is {whole.hold_centre}")
        together = whole.advance(still)
        parts = [separated.advance(still[:1]), separated.advance(still[1:23]), separated.advance(still[23:])]
        hold(whole.warnings() == "", f"it warned of {whole.warnings()!r} in a sound run")
    for name, width in (("position", 3), ("quaternion", 4), ("velocity", 3), ("angular_velocity", 3)):
        values: Array = getattr(together, name)
        hold(values.shape == (60, width), f"{name} of 60 steps has the shape {values.shape}")
        joined = np.vstack([getattr(part, name) for part in parts])
        small(joined - values, CHUNKS, f"{name} depends on how many steps one call takes")
    small(np.linalg.norm(together.quaternion, axis=1) - 1.0, CHUNKS, "the quaternion has not the norm 1")
    moved = np.diff(together.position, axis=0) / scene.time_step
    small(together.velocity[1:] - moved, 1e-4, "the velocity of a step is not its displacement over h")


def keeps_the_time_grid(engine: str, support: str) -> None:
    """Samples are multiples of the sample step and the exact end, and every field is finite."""
    found = run(engine, support, duration=0.1037, sample_step=0.02)
    expected = np.append(0.02 * np.arange(6), 0.1037)
    hold(np.array_equal(found.time, expected), f"the samples are at {found.time}")
    for name in ("tilt", "tilt_rate", "rolling_angle", "rolling_rate", "twist", "energy", "centre_of_mass"):
        hold(bool(np.isfinite(getattr(found, name)).all()), f"{name} is not finite")
    hold(found.outcome == "completed", f"the outcome is {found.outcome}: {found.facts}")


def starts_as_stated(engine: str, support: str) -> None:
    """The first sample is the state that was asked for, and the first step goes on from it."""
    initial = InitialState(0.12, tilt_rate=0.3, rolling_angle=-2.0, rolling_rate=0.7)
    backend, scene = find_engine(engine), _scene(support, initial)
    with backend.open(scene, backend.settings({}, scene)) as stepper:
        first = stepper.advance(np.zeros((1, 3)))
    moved = scene.start.position + scene.time_step * scene.start.velocity
    small(
        first.position[0] - moved, FALL * scene.time_step**2, "the first step does not go on from the start"
    )
    found = run(engine, support, initial=initial, duration=0.02)
    for name in ("tilt", "tilt_rate", "rolling_angle", "rolling_rate"):
        stated = getattr(initial, name)
        small((getattr(found, name)[0] - stated) / stated, START, f"{name} does not start at {stated}")
    small(found.twist[0], 1e-12, "the twist does not start at 0")
    foot = PIER.base_radius * np.array([math.cos(-2.0), math.sin(-2.0)])
    small(found.contact_point[0] - foot, 1e-6 * PIER.base_radius, "it does not start on the base circle")


def repeats_bit_for_bit(engine: str, support: str) -> None:
    """The same run gives the same bits."""
    first, second = (run(engine, support, motion=_shaking(), duration=0.5) for _ in range(2))
    hold(np.array_equal(first.tilt, second.tilt), "two runs of the same differ")


def is_the_same_at_every_size(engine: str, support: str) -> None:
    """A hundredth of the length takes a tenth of the time (Froude)."""
    reduced = dataclasses.replace(PIER, semidiagonal=PIER.semidiagonal / 100.0)
    faster = dataclasses.replace(RELEASE, rolling_rate=10.0 * RELEASE.rolling_rate)
    first = run(engine, support)
    second = run(
        engine, support, cylinder=reduced, initial=faster, duration=PASS / 10.0, sample_step=0.01 / 10.0
    )
    small((second.tilt - first.tilt) / PIER.alpha, SIZE, "the tilt depends on the size")


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
    first = run(engine, support, motion=_shaking())
    second = run(engine, support, motion=_shaking().rotated(1.234), initial=turned)
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
    found = run(engine, support, motion=_shaking())
    small(found.energy_error / _energy_scale(), ENERGY, "energy less work over its scale changes")
    change = float(np.ptp(found.energy)) / _energy_scale()
    hold(change > 0.1, f"the excitation changes the energy by no more than {change:.1e} of its scale")


def keeps_momentum_or_rolls(engine: str, support: str) -> None:
    """In a recess L = B phi' is conserved and there is no twist; on open ground the rim does not slip."""
    found = run(engine, support)
    if support == "recess":
        momentum = np.array([_inertia(tilt)[0] for tilt in found.tilt]) * found.rolling_rate
        small(momentum / momentum[0] - 1.0, MOMENTUM, "L = B phi' over its start is not conserved")
        small(found.twist, 1e-4, "the guide lets the cylinder twist")
    small(found.slip / PIER.base_radius, SLIP, "slip over b")


def wobbles_steadily(engine: str, support: str) -> None:
    """At the rate that balances gravity, phi'^2 = 2 g (b cos - h sin)/B', the tilt stays, free or guided."""
    tilt = PIER.alpha / 2
    b, h = PIER.base_radius, PIER.mass_centre_height
    pull = 2.0 * REFERENCE_GRAVITY * (b * math.cos(tilt) - h * math.sin(tilt))
    rate = math.sqrt(pull / _inertia(tilt)[1])
    found = run(engine, support, initial=InitialState(tilt, rolling_rate=rate), duration=1.0)
    small((found.tilt - tilt) / PIER.alpha, STEADY, "the tilt of a steady wobble over alpha changes")


def overturns(engine: str, support: str) -> None:
    """A fall ends with the side on the ground, as data."""
    found = run(engine, support, initial=InitialState(1.5 * PIER.alpha, rolling_rate=0.1), duration=10.0)
    hold(found.outcome == "overturned", f"a falling cylinder ended as {found.outcome}: {found.facts}")
    hold(found.tilt[-1] == found.peak_tilt == 0.5 * math.pi, f"it ended at {found.tilt[-1]} rad")
    hold(bool((np.diff(found.time) > 0.0).all()), "time does not rise")


def uplifts_when_due(engine: str, support: str) -> None:
    """A standing cylinder waits until the ground acceleration is g tan(alpha); or the engine refuses it."""
    limit = REFERENCE_GRAVITY * PIER.tan_alpha
    if not find_engine(engine).uplifts:
        _refused({"engine": engine, "support": support, "initial": None}, "at rest")
        return
    below = GroundMotion([[0.0, 0.0], [0.8 * limit, 0.0]], 0.4)
    waiting = run(engine, support, initial=None, motion=below, duration=None)
    hold(waiting.outcome == "rest", f"below the threshold the outcome is {waiting.outcome}")
    ramp = GroundMotion([[0.0, 0.0], [2.0 * limit, 0.0]], 0.8)
    found = run(engine, support, initial=None, motion=ramp, duration=None)
    small(found.uplift_time - 0.4, UPLIFT_TIME, "it does not uplift at 0.4 s")
    off = math.remainder(found.uplift_direction - math.pi, 2.0 * math.pi)
    small(off, UPLIFT_DIRECTION, "it does not uplift against the acceleration")


Check = Callable[[str, str], None]

GENERAL: tuple[Check, ...] = (
    describes_itself,
    refuses_what_it_does_not_know,
    steps_one_by_one,
    keeps_the_time_grid,
    starts_as_stated,
    repeats_bit_for_bit,
    is_the_same_at_every_size,
)
"""What holds with any support."""

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


def hold(condition: bool, otherwise: str) -> None:
    """Raise an AssertionError that says `otherwise`."""
    # not by the statement, which python -O leaves out
    if not condition:
        raise AssertionError(otherwise)


def small(values: Any, limit: float, otherwise: str) -> None:
    """Raise an AssertionError with the largest of `values`, where it exceeds the limit."""
    largest = float(np.max(np.abs(values)))
    hold(largest <= limit, f"{otherwise}: by {largest:.2e}, allowed is {limit:.0e}")


def _refused(arguments: dict[str, Any], named: str) -> None:
    try:
        run(**{"initial": RELEASE, "duration": 0.01, **arguments})
    except ValueError as error:
        text = str(error)
        hold("\n" not in text and named in text, f"it is refused in other words than one line: {text!r}")
    else:
        raise AssertionError(f"it is not refused: {arguments}")


def _shaking() -> GroundMotion:
    """A pulse in both components, weak enough not to overturn the pier."""
    return GroundMotion([[0.5, -0.3], [1.5, 0.4], [-1.0, 0.8], [0.3, -1.2], [0.0, 0.0]], 0.3)


def _scene(support: str, initial: InitialState = RELEASE) -> Scene:
    """A release as a stepper meets it."""
    scale = froude_scale(PIER.semidiagonal, REFERENCE_GRAVITY)
    body = scaled_body(PIER, scale.length)
    case = Case(PIER, initial=initial, duration=PASS, name="contract")
    return Scene(
        body=body,
        start=starting_state(body, case.initial, scale.time),
        support=support,
        friction=case.friction,
        time_step=REFERENCE_TIME_STEP,
        gravity=REFERENCE_GRAVITY,
        components="",
        unit_time=scale.time,
    )


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
