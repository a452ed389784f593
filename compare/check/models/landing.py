"""Layer rest, second part: landings of planar motion, with and without loss, on ground that accelerates.

Under an even acceleration of the ground the energy with its inertia force is constant between two
landings. The cylinder stands upright in a landing, so that all of it is kinetic there, and what is left
of it afterwards is exactly r^2.
"""

from __future__ import annotations

import math
from collections.abc import Iterator

import numpy as np

from rockwobble.models import Case, Cylinder, InitialState

from ..bench import Bench
from ..finding import Finding, at_most
from ..polyline import steady
from . import lagrange, quadrature
from .lagrange import shape_of

LAYER = "rest"
GRAVITY = 9.81
CYLINDER = Cylinder(semidiagonal=6.0, tan_alpha=0.2)
PART = "landing: restitution, or where the base meets the ground"
# steps of rtol 1e-11, and rates of rounding at the landing: 2e-11 was measured
ENERGY = 1e-9
# relative to tilts and times of swings that shrink to a hundredth; 5e-10 was measured
SWINGS = 2e-8


def check(bench: Bench) -> Iterator[Finding]:
    """Yield the findings of this part."""
    shape = shape_of(CYLINDER, GRAVITY)
    inertia = quadrature.tilt_inertia(shape)
    for name, ratio, ground in (
        ("still ground", 0.9, (0.0, 0.0, 0.0)),
        ("horizontal acceleration", 0.9, (0.02 * GRAVITY, 0.0, 0.0)),
        ("more weight", 0.9, (0.02 * GRAVITY, 0.0, 0.25 * GRAVITY)),
        ("less weight, no loss", 1.0, (0.01 * GRAVITY, 0.0, -0.25 * GRAVITY)),
    ):
        found = bench.reduced.simulate(
            Case(
                CYLINDER,
                steady(ground, 10.0),
                initial=InitialState(tilt=0.25 * CYLINDER.alpha),
                duration=5.0,
                gravity=GRAVITY,
            ),
            sample_step=0.05,
            rtol=1e-11,
            rest_tilt=0.0,
            plane=0.0,
            restitution=ratio,
        )
        force = np.tile(np.array(ground), (len(found.time), 1))
        energy = 0.5 * inertia * found.tilt_rate**2
        energy += lagrange.potential(shape, found.tilt, found.rolling_angle, force)
        landed = found.extrema[(found.extrema[:, 3] < 0.0) & (found.extrema[:, 1] == 0.0), 0]
        count = np.searchsorted(landed, found.time, side="right")
        yield at_most(
            LAYER,
            f"energy after each landing, {name}",
            np.abs(energy / (energy[0] * ratio ** (2.0 * count)) - 1.0).max()
            if len(landed) > 1
            else math.nan,
            ENERGY,
            reason="r^2 of what it was, and constant in between",
            part=PART,
            note=f"{len(landed)} landings",
        )
    yield from _dying_swings(bench)


def _dying_swings(bench: Bench) -> Iterator[Finding]:
    """Tilts and times of free rocking with the loss that the moment of momentum about the new rim gives."""
    shape = shape_of(CYLINDER, GRAVITY)
    ratio = (16.0 - 25.0 * math.sin(CYLINDER.alpha) ** 2) / (16.0 - math.sin(CYLINDER.alpha) ** 2)
    found = bench.reduced.simulate(
        Case(CYLINDER, initial=InitialState(tilt=0.5 * CYLINDER.alpha), duration=16.0, gravity=GRAVITY),
        sample_step=1.0,
        rtol=1e-12,
        rest_tilt=0.0,
        plane=0.0,
        restitution="momentum",
    )
    tops = found.extrema[found.extrema[:, 3] > 0.0]
    heights = quadrature.height_energy(shape, tops[:, 1])
    expected = heights[:1] * ratio ** (2.0 * np.arange(len(tops)))
    yield at_most(
        LAYER,
        "tilts of free rocking with loss",
        np.abs(heights / expected - 1.0).max() if len(tops) > 8 else math.nan,
        SWINGS,
        reason="each rises to r^2 of the height before, r = (16 - 25 sin^2)/(16 - sin^2)",
        part=PART,
        note=f"{len(tops)} swings",
    )
    quarters = np.array([quadrature.planar_quarter(shape, float(tilt)) for tilt in tops[:, 1]])
    times = np.concatenate([[0.0], np.cumsum(quarters[:-1] + quarters[1:])])
    yield at_most(
        LAYER,
        "times of free rocking with loss",
        np.abs(tops[:, 0] - times).max() / times[-1] if len(tops) > 8 else math.nan,
        SWINGS,
        reason="quadrature of each quarter of a swing",
        part=PART,
    )
    upright = bench.reduced.simulate(
        Case(
            Cylinder(semidiagonal=2.0, tan_alpha=1.5),
            initial=InitialState(tilt=0.1),
            duration=3.0,
            gravity=GRAVITY,
        ),
        sample_step=1.0,
        plane=0.0,
        restitution="momentum",
    )
    yield at_most(
        LAYER,
        "a body too squat to rock stops at its landing",
        0.0 if upright.outcome == "rest" else math.nan,
        0.0,
        reason="r < 0 beyond tan(alpha) = 4/3",
        part=PART,
    )
