"""Layer: what free motion conserves, and what the ground's work must add up to."""

from __future__ import annotations

import math
from collections.abc import Iterator

import numpy as np

from rockwobble.models import Case, Cylinder, InitialState, el_centro_1940

from ...metrics.energy import energy_loss
from ..bench import Bench
from ..finding import Finding, at_most
from . import lagrange

LAYER = "conserved"
CYLINDER = Cylinder(semidiagonal=6.0, tan_alpha=0.2)
SPINS = (1.0, 1e-2, 1e-5)
DURATION = 5.0
RTOL = 1e-10
# some thousand steps of 1e-10, mostly of one sign near upright, as the drift is in 20 s of vanishing spin
ENERGY = 1e-8
# L is constant to rounding; what is measured here is B phi' from the energies, with rounding over the tilt
MOMENTUM, LEAST_TILT = 1e-9, 1e-3
WORK = 5e-6  # samples 0.01 s apart, corrected for their slope: 7e-7 was measured


def check(bench: Bench) -> Iterator[Finding]:
    """Yield the findings of this layer."""
    shape = lagrange.shape_of(CYLINDER)
    for spin in SPINS:
        found = bench.reduced.simulate(
            Case(
                CYLINDER,
                initial=InitialState(tilt=0.5 * CYLINDER.alpha, rolling_rate=spin),
                duration=DURATION,
            ),
            rtol=RTOL,
            rest_tilt=0.0,
        )
        state = found.tilt, found.rolling_angle, found.tilt_rate, found.rolling_rate
        energies = lagrange.energy(shape, *state)
        _, momentum = lagrange.momenta(shape, *state)
        momentum = momentum[found.tilt > LEAST_TILT]
        yield at_most(
            LAYER,
            f"L = B phi' in free motion, spin {spin:g} rad/s",
            np.ptp(momentum) / abs(momentum[0]),
            MOMENTUM,
            reason="L' is exactly zero; rounding of B over tilts above 1e-3",
            part="conservation of L: equation (19)",
        )
        yield at_most(
            LAYER,
            f"energy in free motion, spin {spin:g} rad/s",
            np.ptp(energies) / energies[0],
            ENERGY,
            reason=f"thousands of steps of {RTOL:g}; energies from positions (8), (10) and rates",
            part="equation of motion of the tilt, or step control near upright",
        )
        yield at_most(
            LAYER,
            f"energy as the response states it, spin {spin:g} rad/s",
            np.abs(found.energy - energies).max() / energies[0],
            ENERGY,
            reason="the same energy from other formulas",
            part="energy of the response (reduced/equations.py)",
        )
    yield _planar(bench)
    yield from _work(bench)


def _planar(bench: Bench) -> Finding:
    found = bench.reduced.simulate(
        Case(CYLINDER, initial=InitialState(tilt=0.5 * CYLINDER.alpha), duration=DURATION),
        rtol=RTOL,
        rest_tilt=0.0,
        plane=0.0,
    )
    return at_most(
        LAYER,
        "energy in planar rocking",
        np.ptp(found.energy) / found.energy[0],
        ENERGY,
        reason=f"steps of {RTOL:g}, and impacts without loss",
        part="planar equation, or the impact",
    )


def _work(bench: Bench) -> Iterator[Finding]:
    motion = el_centro_1940().scaled(2.0)
    for model in ("recess", "flat"):
        found = bench.reduced.simulate(
            Case(CYLINDER, motion, duration=DURATION), rtol=RTOL, **bench.reduced.MODELS[model]
        )
        loss = abs(energy_loss(found, motion))
        yield at_most(
            LAYER,
            f"energy against the work of the ground, El Centro doubled, {model}, of its largest",
            loss if found.peak_tilt > 0.0 else math.nan,
            WORK,
            reason="work from samples 0.01 s apart",
            part="forcing: samples, components or time of the record",
        )
