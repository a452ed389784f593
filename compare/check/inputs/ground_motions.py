"""Layer records, second part: the records that ship or can be installed, pulses, and changes of a motion."""

from __future__ import annotations

import math
from collections.abc import Iterator
from importlib.resources import files

import numpy as np

from rockwobble.models import GroundMotion, el_centro_1940, p695_far_field, pulse
from rockwobble.models.records.p695 import REMEDY, missing_packages

from ..bench import Array, Bench, largest
from ..finding import Bound, Finding, at_most, not_run
from ..problems import GRAVITY as G

EL_CENTRO = "record of El Centro: its files, their components or unit"
FILES = Bound(1e-14, "x is component 270, y 180, z up; 0.01 s", "g")
PUBLISHED = Bound(5.1e-5, "four digits are published", "g, s")
PRINTED = Bound(0.006, "tables A-4A and A-4D of FEMA P-695, two digits", "g, -")
PULSES = Bound(1e-12, "sine and cosine of the time since their start", "m/s^2, s")
CHANGES = Bound(1e-14, "a product of complex numbers; rounding", "m/s^2, s")
# peaks of components 270, 180 and UP of PEER RSN6 in g, and where they are in the record [s]
PEAKS, INSTANTS = (0.2107, 0.2808, 0.1781), (11.51, 2.18, 3.37)
# FEMA P-695, tables A-4A (larger peak of the two components [g]) and A-4D (factor of normalisation)
FAR_FIELD = (
    (0.52, 0.65), (0.48, 0.83), (0.82, 0.63), (0.34, 1.09), (0.35, 1.31), (0.38, 1.01), (0.51, 1.03),
    (0.24, 1.10), (0.36, 0.69), (0.22, 1.36), (0.24, 0.99), (0.42, 1.15), (0.53, 1.09), (0.56, 0.88),
    (0.51, 0.79), (0.36, 0.87), (0.45, 1.17), (0.55, 0.82), (0.44, 0.41), (0.51, 0.96), (0.21, 2.10),
    (0.35, 1.44),
)  # fmt: skip
# time steps of the first records that have another one: pair, step [s]
STEPS = {1: 0.01, 6: 0.005, 11: 0.02, 12: 0.0025}


def check(bench: Bench) -> Iterator[Finding]:
    """Yield the findings of this part."""
    del bench
    yield from _el_centro()
    yield _far_field()
    yield _pulses()
    yield _changes()


def _el_centro() -> Iterator[Finding]:
    motion = el_centro_1940(vertical=True)
    columns = [_shipped(mark) for mark in (", 270", ", 180", ", UP")]
    count = min(map(len, columns))
    expected = G * np.column_stack([column[:count] for column in columns])
    same = motion.acceleration.shape == expected.shape and motion.time_step == 0.01
    apart = largest(motion.acceleration - expected) / G if same else math.nan
    yield at_most("El Centro against the numbers of its files", apart, FILES, EL_CENTRO)
    at = np.abs(motion.acceleration).argmax(axis=0)
    apart = largest(np.abs(motion.acceleration).max(axis=0) / G - PEAKS)
    early = largest(at * motion.time_step - INSTANTS)
    yield at_most("peaks of El Centro against those published", max(apart, early), PUBLISHED, EL_CENTRO)


def _shipped(mark: str) -> Array:
    """Numbers of the file whose second line ends with `mark`."""
    for entry in (files("rockwobble.models") / "records").iterdir():
        if entry.name.endswith(".AT2"):
            lines = entry.read_text(encoding="ascii").splitlines()
            if lines[1].strip().endswith(mark):
                return np.array(" ".join(lines[4:]).split(), dtype=float)
    raise ValueError(f"one of the files of El Centro must be the component{mark}, got none")


def _far_field() -> Finding:
    name, part = (
        "peaks and factors of the 22 far-field pairs",
        "records of FEMA P-695: pairs, unit, time step",
    )
    if missing := missing_packages():
        return not_run(name, part, f"needs {', '.join(missing)}: {REMEDY}")
    apart = []
    for pair, (peak, factor) in enumerate(FAR_FIELD, start=1):
        recorded, normalised = (p695_far_field(pair, normalised=either) for either in (False, True))
        apart += [
            abs(float(np.abs(recorded.acceleration).max()) / G - peak),
            abs(normalised.peak / recorded.peak - factor),
            0.0 if STEPS.get(pair, recorded.time_step) == recorded.time_step else math.inf,
        ]
    return at_most(name, max(apart), PRINTED, part)


def _pulses() -> Finding:
    """Each pulse at its samples, half a second after still ground, towards 0.7 rad."""
    apart = []
    for kind, shape, length in (
        ("one-sine", np.sin, 2.0),
        ("one-cosine", np.cos, 2.0),
        ("half-sine", np.sin, 1.0),
    ):
        motion = pulse(kind, amplitude=3.0, period=2.0, azimuth=0.7, start=0.5)
        at = motion.time_step * np.arange(len(motion.acceleration))
        # the last sample may round to either side of the start
        along = np.where(at > 0.5 - 0.5 * motion.time_step, 3.0 * shape(math.pi * (at - 0.5)), 0.0)
        expected = np.column_stack([along * math.cos(0.7), along * math.sin(0.7)])
        apart += [largest(motion.acceleration - expected), abs(motion.duration - 0.5 - length)]
    part = "pulses: shape, start, period or direction"
    return at_most("pulses at their samples", max(apart), PULSES, part)


def _changes() -> Finding:
    samples = np.random.default_rng(5).uniform(-4.0, 4.0, (40, 3))
    motion = GroundMotion(samples, 0.02)
    level = samples[:, 0] + 1j * samples[:, 1]
    turned = motion.rotated(0.9).acceleration
    apart = [
        largest(np.abs(turned[:, 0] + 1j * turned[:, 1] - level * np.exp(0.9j))),
        largest(turned[:, 2] - samples[:, 2]),
        largest(motion.scaled(-1.7).acceleration + 1.7 * samples),
        abs(motion.peak - np.abs(level).max()),
        abs(motion.duration - 39 * 0.02),
    ]
    part = "ground motion: rotation, scale, peak or duration"
    return at_most("motions rotated and scaled, their peak and length", max(apart), CHANGES, part)
