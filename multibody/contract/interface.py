"""Rules of the contract for any support: self-description, refusals, time grid, start, scale."""

from __future__ import annotations

import dataclasses
import json
import math
from collections.abc import Callable

import numpy as np

from rockwobble.models import InitialState

from ..engines.registry import find_engine
from ..protocol import Array
from ..scene.froude import REFERENCE_GRAVITY
from .problem import PASS, PIER, RELEASE, hold, refused, run, scene_of, shaking, small

FALL = 2.0 * REFERENCE_GRAVITY  # [m/s^2] more than the acceleration of the mass centre
START = 1e-6  # relative, of rates: a central difference over two steps
SIZE = 1e-9  # relative to alpha: the scene is the same, but for rounding
CHUNKS = 1e-9  # [m], [-] what is carried from one call to the next, and no more


def describes_itself(engine: str, support: str) -> None:
    """Version, supports and settings are plain values."""
    backend = find_engine(engine)
    hold(bool(backend.version()), "the version is empty")
    hold(support in backend.supports, f"supports are {backend.supports}")
    hold(isinstance(backend.uplifts, bool), f"uplifts is {backend.uplifts!r}, not True or False")
    settings = backend.settings({}, scene_of(support))
    hold(json.loads(json.dumps(settings)) == settings, f"settings are not plain values: {settings}")


def refuses_what_it_does_not_know(engine: str, support: str) -> None:
    """An unknown setting or support is a ValueError of one line that names it."""
    for change in ({"no_such_setting": 1.0}, {"support": "no_such_support"}):
        refused({"engine": engine, "support": support, **change}, next(iter(change)).removeprefix("no_such_"))


def steps_one_by_one(engine: str, support: str) -> None:
    """A step is a step, however many one call takes, and two open scenes do not disturb each other."""
    backend, scene = find_engine(engine), scene_of(support)
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
    fields = ("tilt", "tilt_rate", "rolling_angle", "rolling_rate", "twist", "energy", "centre_of_mass")
    for name in fields:
        hold(bool(np.isfinite(getattr(found, name)).all()), f"{name} is not finite")
    hold(found.outcome == "stands", f"the outcome is {found.outcome}: {found.facts}")


def starts_as_stated(engine: str, support: str) -> None:
    """The first sample is the state that was asked for, and the first step goes on from it."""
    # with less energy than that of its balance, or the run would go on until it turns back
    initial = InitialState(0.12, tilt_rate=0.05, rolling_angle=-2.0, rolling_rate=0.5)
    backend, scene = find_engine(engine), scene_of(support, initial)
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
    first, second = (run(engine, support, motion=shaking(), duration=0.5) for _ in range(2))
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
