"""Checks of invariance: under rotation, scale and restatement of a case, and under use of the protocol.

An engine describes itself, refuses what it does not know, steps alike however it is called, starts as stated,
keeps the time grid, repeats itself to the bit, and leaves no trace: `rockwobble.multibody.protocol`.
"""

from __future__ import annotations

import dataclasses
import json
import math
import os
import subprocess
import sys
import tempfile
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from rockwobble.models import Case, GroundMotion, InitialState, RockingBody, Run
from rockwobble.models.cylinder import PIER
from rockwobble.models.support import support_named
from rockwobble.multibody.engines.registry import find_engine
from rockwobble.multibody.protocol import Engine, Settings
from rockwobble.multibody.scene import (
    REFERENCE_GRAVITY,
    REFERENCE_TIME_STEP,
    Scene,
    froude_scale,
    scaled_body,
    starting_state,
)

from ..runs.execution import simulate, simulate_run
from .measurement import (
    GRAVITY,
    RELEASE,
    SHOCK,
    SHOCK_TIMES,
    Bound,
    Result,
    at_most,
    largest,
    lean,
    polyline,
    refined,
)
from .subject import UPLIFT, Subject

Lean = NDArray[np.complex128]
# a pulse in both components, too weak to overturn the pier, which is rocking when it begins
_PULSE = GroundMotion([[0.5, -0.3], [1.5, 0.4], [-1.0, 0.8], [0.3, -1.2], [0.0, 0.0]], 0.3)
ROCKING = Case(
    PIER, _PULSE, initial=InitialState(0.5 * PIER.alpha, 0.0, 0.3, 0.5), duration=1.3, name="rocking"
)
# without the vertical component, which only some models have
STANDING = Case(PIER, polyline(SHOCK_TIMES, SHOCK[:, :2], 0.5), duration=4.0, name="from rest")
_SAMPLE = 0.05  # [s]
_TURN = 1.234  # [rad]
_TURNED = np.exp(1j * _TURN)


def frame(subject: Subject, support: str) -> Iterator[Result]:
    """A rotated problem has the rotated motion, and its mirror image the mirrored motion."""
    for case in _cases(subject):
        motion, start = _motion(case), case.initial
        turned = mirrored = None
        if start is not None:
            turned = dataclasses.replace(start, rolling_angle=start.rolling_angle + _TURN)
            mirrored = dataclasses.replace(
                start, rolling_angle=-start.rolling_angle, rolling_rate=-start.rolling_rate
            )
        rotated = dataclasses.replace(case, motion=motion.rotated(_TURN), initial=turned)
        flipped = GroundMotion(motion.acceleration * [1.0, -1.0], motion.time_step)
        mirror = dataclasses.replace(case, motion=flipped, initial=mirrored)
        yield _same(subject, support, case, "rotated", rotated, expected=lambda lean: _TURNED * lean)
        yield _same(subject, support, case, "mirror image", mirror, expected=np.conj)


def scale(subject: Subject, support: str) -> Iterator[Result]:
    """A hundredth of the size moves ten times as fast (Froude); 0.7 of the gravity slower by sqrt(0.7)."""
    small, slower = dataclasses.replace(PIER, semidiagonal=PIER.semidiagonal / 100.0), math.sqrt(1.0 / 0.7)
    for case in _cases(subject):
        little = _slow_copy(case, 0.1, cylinder=small)
        lighter = _slow_copy(case, slower, 0.7, gravity=0.7 * GRAVITY)
        yield _same(subject, support, case, "a hundredth of the size", little, slower=0.1)
        yield _same(subject, support, case, "0.7 of the gravity", lighter, slower=slower)


def statement(subject: Subject, support: str) -> Iterator[Result]:
    """Invariance under a finer sampling of the ground motion, or still ground after it."""
    for case in _cases(subject):
        motion = _motion(case)
        still = GroundMotion(np.vstack([motion.acceleration, np.zeros((3, 2))]), motion.time_step)
        for words, other in (
            ("sampled five times as densely", refined(motion, 5)),
            ("still ground in the record", still),
        ):
            yield _same(subject, support, case, words, dataclasses.replace(case, motion=other))


def _cases(subject: Subject) -> tuple[Case, ...]:
    # the base of an engine tips on its corners, which a rotation moves
    return (ROCKING,) if "stepper" in subject.features else (ROCKING, STANDING)


def _motion(case: Case) -> GroundMotion:
    assert case.motion is not None
    return case.motion


def _slow_copy(
    case: Case, slower: float, force: float = 1.0, *, cylinder: RockingBody = PIER, gravity: float = GRAVITY
) -> Case:
    """Case in slower time, under accelerations `force` times as large."""
    motion, start = _motion(case), case.initial
    if start is not None:
        start = dataclasses.replace(start, rolling_rate=start.rolling_rate / slower)
    return dataclasses.replace(
        case,
        motion=GroundMotion(force * motion.acceleration, slower * motion.time_step),
        initial=start,
        duration=slower * case.length,
        cylinder=cylinder,
        gravity=gravity,
    )


def _same(
    subject: Subject,
    support: str,
    case: Case,
    words: str,
    other: Case,
    *,
    slower: float = 1.0,
    expected: Callable[[Lean], Lean] = lambda lean: lean,
) -> Result:
    """Compare a case with its motion in another statement, `slower` and with tilt vectors as `expected`."""
    plain = subject.simulate(case, support, sample_step=_SAMPLE)
    trace = subject.simulate(other, support, sample_step=slower * _SAMPLE)
    moved = float(np.ptp(plain.tilt)) > 0.05 * PIER.alpha
    restated = _on(plain.time, trace.time / slower, lean(trace))
    off = largest(np.abs(restated - expected(lean(plain)))) if moved else math.nan
    bound = Bound(subject.repeatability, "rounding, magnified by the passes", "alpha")
    return at_most(f"{words}, {case.name}", off, bound)


def _on(time: NDArray[np.float64], times: NDArray[np.float64], values: Lean) -> Lean:
    """Values interpolated at other times: an external model chooses its samples."""
    if len(times) == len(time) and np.allclose(times, time, rtol=0.0, atol=1e-9):
        return values
    from scipy.interpolate import CubicSpline

    return np.asarray(CubicSpline(times, values)(np.clip(time, times[0], times[-1])))


_ALL = Bound(0.0, "the protocol of an engine")
_CHUNKS = Bound(1e-9, "what is carried from one call to the next, and no more", "m")
_START = Bound(1e-6, "of rates: a central difference over two steps")
_FREE_FALL = Bound(2.0, "no acceleration of the mass centre is larger", "g")
# below the energy at balance: else the run would be followed to its next maximum
_STATE = InitialState(0.12, tilt_rate=0.05, rolling_angle=-2.0, rolling_rate=0.5)
_FIELDS = ("tilt", "tilt_rate", "rolling_angle", "rolling_rate", "twist", "energy", "centre_of_mass")
_QUIET = """import json, sys, rockwobble as rw
pier = rw.Cylinder(semidiagonal=6.0, tan_alpha=0.2)
case = rw.Case(pier, initial=rw.InitialState(0.1, rolling_rate=0.5), duration=0.01)
rw.simulate(case, engine=sys.argv[1], support=sys.argv[2], **json.loads(sys.argv[3]))"""


def description(subject: Subject, support: str) -> Iterator[Result]:
    """Version, supports and settings are plain values; an unknown one is a ValueError that names it."""
    backend, scene, given = _open_stepper(subject, support)
    settings = backend.settings(given, scene)
    plain = json.loads(json.dumps(dict(settings))) == dict(settings)
    right = bool(backend.version()) and support in backend.supports and isinstance(backend.uplifts, bool)
    yield _holds("description of itself", right and plain, f"settings {settings}")
    released = Case(PIER, initial=_STATE, duration=0.01)
    refused: dict[str, tuple[Case, dict[str, Any]]] = {
        "setting": (released, {"support": support, "no_such_setting": 1.0}),
        "support": (released, {"support": "no_such_support"}),
    }
    if UPLIFT not in subject.features:
        refused["at rest"] = (Case(PIER, duration=0.01), {"support": support})
    for name, (case, options) in refused.items():
        try:
            simulate(case, engine=subject.label, **options)
            words = ""
        except ValueError as error:
            words = str(error)
        yield _holds(f"refusal, {name}", "\n" not in words and name in words, words or "it is taken")


def stepping(subject: Subject, support: str) -> Iterator[Result]:
    """Poses are independent of the number of steps in a call, and of another open scene."""
    backend, scene, given = _open_stepper(subject, support)
    settings, still = backend.settings(given, scene), np.zeros((60, 3))
    with backend.open(scene, settings) as whole, backend.open(scene, settings) as separated:
        together = whole.advance(still)
        parts = [separated.advance(still[:1]), separated.advance(still[1:23]), separated.advance(still[23:])]
        sound = 0.0 <= whole.hold_centre <= 1.0 and whole.warnings() == ""
    widths = {"position": 3, "quaternion": 4, "velocity": 3, "angular_velocity": 3}
    shaped = all(getattr(together, name).shape == (60, width) for name, width in widths.items())
    yield _holds("shapes, centre of the force and warnings of a step", sound and shaped, "")
    joined = {name: np.vstack([getattr(part, name) for part in parts]) for name in widths}
    apart = max(largest(joined[name] - getattr(together, name)) for name in widths)
    yield at_most("steps of one call and of three", apart, _CHUNKS)
    norm = largest(np.linalg.norm(together.quaternion, axis=1) - 1.0)
    yield at_most("norm of the quaternion", norm, _CHUNKS)
    moved = np.diff(together.position, axis=0) / scene.time_step
    velocity = Bound(1e-4, "the displacement over the step", "m/s")
    yield at_most("velocity of a step", largest(together.velocity[1:] - moved), velocity)
    first = largest(together.position[0] - scene.start.position - scene.time_step * scene.start.velocity)
    yield at_most("first step", first / (REFERENCE_GRAVITY * scene.time_step**2), _FREE_FALL)


def time_grid(subject: Subject, support: str) -> Iterator[Result]:
    """Samples at multiples of the sample step and the exact end; all fields finite; the start as stated."""
    case = Case(PIER, initial=_STATE, duration=0.1037)
    trace = subject.simulate(case, support, sample_step=0.02)
    right = np.array_equal(trace.time, np.append(0.02 * np.arange(6), 0.1037)) and trace.outcome != "failed"
    yield _holds("samples", right, f"{trace.outcome}, at {trace.time}")
    yield _holds("finite fields", all(bool(np.isfinite(getattr(trace, name)).all()) for name in _FIELDS), "")
    stated = ("tilt", "tilt_rate", "rolling_angle", "rolling_rate")
    off = max(abs(getattr(trace, name)[0] / getattr(_STATE, name) - 1.0) for name in stated)
    yield at_most("stated start", max(off, abs(trace.twist[0])), _START)


def repetition(subject: Subject, support: str) -> Iterator[Result]:
    """Repeated runs give the same bits, print nothing and write nothing to the working folder."""
    assert subject.run is not None
    run = Run(subject.label, support, subject.run.time_step, **subject.run.settings)
    first, second = (simulate_run(ROCKING, run).tilt for _ in range(2))
    yield _holds("two runs of the same", np.array_equal(first, second), "")
    options = {"time_step": run.time_step, **run.settings}
    environment = {**os.environ, "PYTHONPATH": os.pathsep.join(path for path in sys.path if path)}
    with tempfile.TemporaryDirectory() as folder:
        shown = subprocess.run(
            [sys.executable, "-c", _QUIET, subject.label, support, json.dumps(options)],
            cwd=folder,
            env=environment,
            stdout=subprocess.PIPE,
            stderr=subprocess.STDOUT,
            text=True,
            check=False,
        )
        left = sorted(path.name for path in Path(folder).iterdir())
    said = f"{shown.stdout[-500:]!r} {left}"
    yield _holds("nothing printed or written", not (shown.returncode or shown.stdout or left), said)


def _holds(name: str, right: bool, note: str) -> Result:
    return at_most(name, float(not right), _ALL, note="" if right else note)


def _open_stepper(subject: Subject, support: str) -> tuple[Engine, Scene, Settings]:
    """Engine, release in the scene of its stepper, and settings as given."""
    assert subject.run is not None
    unit = froude_scale(PIER.semidiagonal, REFERENCE_GRAVITY)
    body = scaled_body(PIER, unit.length)
    scene = Scene(
        body=body,
        start=starting_state(body, RELEASE.initial, unit.time),
        support=support_named(support),
        friction=RELEASE.friction,
        time_step=REFERENCE_TIME_STEP,
        gravity=REFERENCE_GRAVITY,
        components="",
        unit_time=unit.time,
    )
    return find_engine(subject.label), scene, subject.run.settings
