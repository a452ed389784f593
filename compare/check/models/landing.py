"""Layer rest, second part: landings of planar motion, with and without loss, on ground that accelerates.

Under an even acceleration of the ground the energy with its inertia force is constant between two
landings. The cylinder stands upright in a landing, so that all of it is kinetic there, and what is left
of it afterwards is exactly r^2.
"""

from __future__ import annotations

import dataclasses
import math
from collections.abc import Iterator

import numpy as np

from rockwobble.models import Cylinder

from ..bench import Bench, largest
from ..finding import Bound, Finding, at_most
from ..problems import GRAVITY, PIER, released, steady
from . import lagrange, quadrature
from .lagrange import shape_of

PART = "landing: restitution, or where the base meets the ground"
# steps of rtol 1e-11, and rates of rounding at the landing: 2e-11 was measured
ENERGY = Bound(1e-9, "r^2 of what it was, and constant in between")
# relative to tilts and times of swings that shrink to a hundredth; 5e-10 was measured
TILTS = Bound(2e-8, "each rises to r^2 of the height before, r = (16 - 25 sin^2)/(16 - sin^2)")
TIMES = Bound(2e-8, "quadrature of each quarter of a swing")
STOPS = Bound(0.0, "r < 0 beyond tan(alpha) = 4/3")
# ratio of the rates, and acceleration of the ground over that of gravity
GROUNDS = {
    "still ground": (0.9, (0.0, 0.0, 0.0)),
    "horizontal acceleration": (0.9, (0.02, 0.0, 0.0)),
    "more weight": (0.9, (0.02, 0.0, 0.25)),
    "less weight, no loss": (1.0, (0.01, 0.0, -0.25)),
}


def check(bench: Bench) -> Iterator[Finding]:
    """Yield the findings of this part."""
    shape = shape_of(PIER)
    inertia = quadrature.tilt_inertia(shape)
    for name, (ratio, share) in GROUNDS.items():
        ground = tuple(GRAVITY * each for each in share)
        case = dataclasses.replace(released(0.25, 0.0, 5.0), motion=steady(ground, 10.0))
        found = bench.solve(case, "planar", sample_step=0.05, rtol=1e-11, rest_tilt=0.0, restitution=ratio)
        force = np.tile(np.array(ground), (len(found.time), 1))
        energy = 0.5 * inertia * found.tilt_rate**2
        energy += lagrange.potential(shape, found.tilt, found.rolling_angle, force)
        landed = found.extrema[(found.extrema[:, 3] < 0.0) & (found.extrema[:, 1] == 0.0), 0]
        count = np.searchsorted(landed, found.time, side="right")
        apart = largest(energy / (energy[0] * ratio ** (2.0 * count)) - 1.0)
        value = apart if len(landed) > 1 else math.nan
        yield at_most(f"energy after each landing, {name}", value, ENERGY, PART, f"{len(landed)} landings")
    yield from _dying_swings(bench)


def _dying_swings(bench: Bench) -> Iterator[Finding]:
    """Tilts and times of free rocking with the loss that the moment of momentum about the new rim gives."""
    shape = shape_of(PIER)
    ratio = (16.0 - 25.0 * math.sin(PIER.alpha) ** 2) / (16.0 - math.sin(PIER.alpha) ** 2)
    found = bench.solve(
        released(0.5, 0.0, 16.0),
        "planar",
        sample_step=1.0,
        rtol=1e-12,
        rest_tilt=0.0,
        restitution="momentum",
    )
    tops = found.extrema[found.extrema[:, 3] > 0.0]
    many = len(tops) > 8
    heights = quadrature.height_energy(shape, tops[:, 1])
    apart = largest(heights / (heights[:1] * ratio ** (2.0 * np.arange(len(tops)))) - 1.0)
    note = f"{len(tops)} swings"
    yield at_most("tilts of free rocking with loss", apart if many else math.nan, TILTS, PART, note)
    quarters = np.array([quadrature.planar_quarter(shape, float(tilt)) for tilt in tops[:, 1]])
    times = np.concatenate([[0.0], np.cumsum(quarters[:-1] + quarters[1:])])
    apart = largest(tops[:, 0] - times) / times[-1] if many else math.nan
    yield at_most("times of free rocking with loss", apart, TIMES, PART)
    squat = Cylinder(semidiagonal=2.0, tan_alpha=1.5)
    case = released(0.1 / squat.alpha, 0.0, 3.0, squat)
    upright = bench.solve(case, "planar", sample_step=1.0, restitution="momentum")
    stops = 0.0 if upright.rests else math.nan
    yield at_most("a body too squat to rock stops at its landing", stops, STOPS, PART)
