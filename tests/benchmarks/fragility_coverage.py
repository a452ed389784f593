"""Coverage of the intervals of a fragility, by simulation.

`python tests/benchmarks fragility_coverage` prints one line for each kind of study: in what share of
simulated studies the 95 % interval holds the true median, the true dispersion, and the true ratio of the
medians of two methods under the same motions.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from rockwobble.studies.fragility.fit import (
    Array,
    Sample,
    interval,
    resamples,
    spread_interval,
)

from .console import options_of

STUDIES, RESAMPLES = 2000, 400
MEDIAN = 4.0
HEADINGS = ("study", "n", "levels", "median", "dispersion", "ratio")


@dataclass(frozen=True, slots=True, kw_only=True)
class Kind:
    """Kind of study: motions with one capacity each from a lognormal distribution.

    Attributes
    ----------
    name : str
    motions, levels : int
    dispersion : float
    between_levels : float
        Probability that a run above the capacity of its motion stands, and that one below it falls: more of
        the dispersion is then within the motions.
    """

    name: str
    motions: int = 22
    levels: int = 20
    dispersion: float = 0.6
    between_levels: float = 0.0

    def draw(self, random: np.random.Generator) -> tuple[Sample, Sample]:
        """Motions by two methods with equal capacity except for a scatter of 20 %."""
        x = np.log(np.geomspace(1.25, 12.0, self.levels))
        capacity = random.normal(math.log(MEDIAN), self.dispersion, self.motions)
        scatter = 0.2 * random.standard_normal((2, self.motions))
        # the scatter adds to the dispersion of either method
        return self._sample(x, capacity + scatter[0], random), self._sample(x, capacity + scatter[1], random)

    def _sample(self, x: Array, capacity: Array, random: np.random.Generator) -> Sample:
        # within a motion, what a level needs scatters from level to level
        within = self.between_levels * random.standard_normal((self.motions, self.levels))
        y = x >= capacity[:, None] + within
        return Sample(x=np.tile(x, (self.motions, 1)), y=y.astype(np.float64))

    @property
    def whole(self) -> float:
        """True dispersion of either method."""
        return math.sqrt(self.dispersion**2 + 0.2**2 + self.between_levels**2)


KINDS = (
    *(Kind(name="22 motions", levels=levels) for levels in (8, 12, 20)),
    Kind(name="22 motions, little dispersion", dispersion=0.35),
    Kind(name="22 motions, with scatter between levels", between_levels=0.3),
    Kind(name="22 motions, with scatter between levels", between_levels=0.3, levels=8),
    *(Kind(name=f"{motions} motions", motions=motions) for motions in (11, 44, 100)),
)


def coverage(kind: Kind, studies: int, draws: int = RESAMPLES, seed: int = 1) -> tuple[float, float, float]:
    """Shares of studies whose intervals contain the median, the dispersion and a ratio of 1."""
    random = np.random.default_rng(seed)
    inside, once = np.zeros((studies, 3)), np.ones((1, kind.motions))
    for place in range(studies):
        weights = resamples(kind.motions, draws, int(random.integers(2**31)))
        ours, theirs = kind.draw(random)
        one, other, drawn, others = (
            each.curves(drawing) for drawing in (once, weights) for each in (ours, theirs)
        )
        with np.errstate(invalid="ignore"):
            ratio, ratios = one.centre[0] - other.centre[0], drawn.centre - others.centre
        held_and_true = (
            (interval(float(one.centre[0]), drawn.centre, kind.motions), math.log(MEDIAN)),
            (spread_interval(float(one.dispersion[0]), drawn.dispersion, kind.motions), kind.whole),
            (interval(float(ratio), ratios, kind.motions), 0.0),
        )
        for column, (held, truth) in enumerate(held_and_true):
            inside[place, column] = held.low <= truth <= held.high
    shares = inside.mean(axis=0)
    return float(shares[0]), float(shares[1]), float(shares[2])


def main(arguments: Sequence[str] | None = None) -> int:
    """Print the table."""
    parser = options_of("fragility_coverage", "Coverage of the intervals of a fragility.")
    parser.add_argument("--studies", type=int, default=STUDIES, help="simulated of each kind (%(default)s)")
    studies = parser.parse_args(arguments).studies
    print(f"Coverage of 95 % intervals, {studies} studies of each kind")
    print(f"{HEADINGS[0]:32}" + "".join(f"{name:>12}" for name in HEADINGS[1:]))
    for kind in KINDS:
        cells = (str(kind.motions), str(kind.levels), *(f"{share:.3f}" for share in coverage(kind, studies)))
        print(f"{kind.name:32}" + "".join(f"{cell:>12}" for cell in cells), flush=True)
    return 0
