"""Layer conserved: what free motion conserves, and what the ground's work must add up to."""

from __future__ import annotations

import math
from collections.abc import Iterator

import numpy as np

from rockwobble.models import Case, el_centro_1940

from ...metrics.energy import energy_loss
from ..bench import Bench, largest
from ..finding import Bound, Finding, at_most
from ..problems import PIER, released
from . import lagrange

SPINS = (1.0, 1e-2, 1e-5)
DURATION, RTOL = 5.0, 1e-10
LEAST_TILT = 1e-3
# the drift has mostly one sign near upright
ENERGY = Bound(1e-8, "thousands of steps of 1e-10; energies from positions (8), (10) and rates")
STATED = Bound(1e-8, "the same energy from other formulas")
PLANAR = Bound(1e-8, "steps of 1e-10, and impacts without loss")
# what is measured is B phi' from the energies
MOMENTUM = Bound(1e-9, "L' is exactly zero; rounding of B over tilts above 1e-3")
WORK = Bound(5e-6, "work from samples 0.01 s apart, corrected for their slope; 7e-7 was measured")


def check(bench: Bench) -> Iterator[Finding]:
    """Yield the findings of this layer."""
    shape = lagrange.shape_of(PIER)
    for spin in SPINS:
        found = bench.solve(released(0.5, spin, DURATION), rtol=RTOL, rest_tilt=0.0)
        state = found.tilt, found.rolling_angle, found.tilt_rate, found.rolling_rate
        energies = lagrange.energy(shape, *state)
        momentum = lagrange.momenta(shape, *state)[1][found.tilt > LEAST_TILT]
        of = f"spin {spin:g} rad/s"
        yield at_most(
            f"L = B phi' in free motion, {of}",
            np.ptp(momentum) / abs(momentum[0]),
            MOMENTUM,
            "conservation of L: equation (19)",
        )
        yield at_most(
            f"energy in free motion, {of}",
            np.ptp(energies) / energies[0],
            ENERGY,
            "equation of motion of the tilt, or step control near upright",
        )
        yield at_most(
            f"energy as the response states it, {of}",
            largest(found.energy - energies) / energies[0],
            STATED,
            "energy of the response (reduced/equations.py)",
        )
    planar = bench.solve(released(0.5, 0.0, DURATION), "planar", rtol=RTOL, rest_tilt=0.0).energy
    part = "planar equation, or the impact"
    yield at_most("energy in planar rocking", np.ptp(planar) / planar[0], PLANAR, part)
    motion = el_centro_1940().scaled(2.0)
    for model in ("recess", "flat"):
        found = bench.solve(Case(PIER, motion, duration=DURATION), model, rtol=RTOL)
        yield at_most(
            f"energy against the work of the ground, El Centro doubled, {model}, of its largest",
            abs(energy_loss(found, motion)) if found.peak_tilt > 0.0 else math.nan,
            WORK,
            "forcing: samples, components or time of the record",
        )
