"""Layer: changes of frame and scale that must not change the response."""

from __future__ import annotations

import math
from collections.abc import Iterator
from typing import Any

import numpy as np
from numpy.typing import NDArray

from rockwobble.models import Case, Cylinder, GroundMotion, el_centro_1940

from ..bench import Bench
from ..finding import Finding, at_most

LAYER = "invariance"
CYLINDER = Cylinder(semidiagonal=6.0, tan_alpha=0.2)
SCALE, DURATION = 2.0, 6.0
RTOL = 1e-10
# rounding at every step, magnified by the passes of 6 s, as is one rounding of the record: 1e-12 was measured
ROUNDING = 1e-9


def check(bench: Bench) -> Iterator[Finding]:
    """Yield the findings of this layer."""
    motion = el_centro_1940().scaled(SCALE)
    plain = _run(bench, motion)
    for name, difference, bound, part in _changes(bench, motion, plain):
        yield at_most(
            LAYER,
            name,
            difference / CYLINDER.alpha,
            bound,
            unit="alpha",
            reason="exact in binary arithmetic"
            if bound == 0.0
            else "rounding, magnified by the passes of 6 s",
            part=part,
        )


def _changes(bench: Bench, motion: GroundMotion, plain: Any) -> Iterator[tuple[str, float, float, str]]:
    a, step = motion.acceleration, motion.time_step
    mirrored = _run(bench, GroundMotion(a * [1.0, -1.0], step))
    yield "mirror image", _apart(plain, mirrored), 0.0, "equations: a term that prefers one side"

    large = _run(
        bench,
        GroundMotion(a, 2.0 * step),
        Cylinder(semidiagonal=24.0, tan_alpha=0.2),
        duration=2.0 * DURATION,
        sample_step=0.02,
    )
    yield (
        "four times the size in twice the time",
        _apart(plain, large),
        0.0,
        "a length or time that is absolute",
    )

    turned = _run(bench, motion.rotated(2.0))
    yield (
        "record rotated by 2 rad",
        _apart(plain, turned),
        ROUNDING,
        "components of the record, or their signs",
    )
    angle = np.nanmax(np.abs(turned.rolling_angle - plain.rolling_angle - 2.0) % (2.0 * math.pi))
    angle = min(angle, abs(2.0 * math.pi - angle))
    yield (
        "rolling angle with the record rotated",
        angle * CYLINDER.alpha,
        100.0 * ROUNDING,
        "components of the record, or their signs",
    )

    delayed = _run(
        bench, GroundMotion(np.vstack([np.zeros((32, 2)), a]), step), duration=DURATION + 32.0 * step
    )
    late = delayed.tilt[round(32.0 * step / 0.01) :]
    yield "record that begins later", _apart(plain, late), ROUNDING, "time of the record's samples"

    strong = _run(
        bench, GroundMotion(a * 0.7, step / math.sqrt(0.7)), gravity=9.81 * 0.7, factor=1.0 / math.sqrt(0.7)
    )
    yield (
        "weaker gravity in slower time",
        _apart(plain, strong),
        ROUNDING,
        "gravity, or a time that is absolute",
    )

    halved = _halved(motion)
    between = _run(bench, halved)
    yield "record with samples halfway between", _apart(plain, between), ROUNDING, "samples of the record"

    fine = _run(bench, motion, sample_step=0.005)
    yield (
        "output twice as often",
        _apart(plain, fine.tilt[::2]),
        0.0,
        "output that influences the steps",
    )


def _run(
    bench: Bench,
    motion: GroundMotion,
    cylinder: Cylinder = CYLINDER,
    *,
    duration: float = DURATION,
    sample_step: float = 0.01,
    gravity: float = 9.81,
    factor: float = 1.0,
) -> Any:
    return bench.reduced.simulate(
        Case(cylinder, motion, duration=duration * factor, gravity=gravity),
        sample_step=sample_step * factor,
        rtol=RTOL,
    )


def _halved(motion: GroundMotion) -> GroundMotion:
    a = motion.acceleration
    times = np.arange(2 * len(a) - 1) / 2.0
    between = np.column_stack([np.interp(times, np.arange(len(a)), column) for column in a.T])
    return GroundMotion(between, 0.5 * motion.time_step)


def _apart(plain: Any, other: Any) -> float:
    tilt: NDArray[np.float64] = other if isinstance(other, np.ndarray) else other.tilt
    count = min(len(plain.tilt), len(tilt)) - 1  # the last sample is the end, wherever it is
    return float(np.abs(plain.tilt[:count] - tilt[:count]).max())
