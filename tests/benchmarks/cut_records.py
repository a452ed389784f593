"""Print how much too low a peak is that ends with its record, and that of a run that is followed.

Copies of El Centro that end, or are cut, while the cylinder may still swing: each is compared with the same
ground followed by still ground for a minute, in a run as long. Ends with 1 where a peak is too low, or where
the batch kernel differs from a single run.
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from typing import Any, NamedTuple

import numpy as np

from rockwobble import multibody, reduced
from rockwobble.models import Case, Cylinder, GroundMotion, el_centro_1940

from .console import options_of

CUT = (2.3, 12.0)  # [s]
SIZES = (1.5, 30.0)  # [m]
SLENDERNESS = (0.08, 0.4)
INTENSITIES = (1.1, 4.0)  # peak of the record over the acceleration that uplifts
STILL = 60.0  # [s] after the cut; 12 for an engine
STILL_OF_ENGINE = 12.0
TOO_LOW = (0.02, 0.2, 1.0)  # by which the right peak is more than that of the run
SAME = 1e-5  # of the peak: what two ends of a step at the default tolerances leave
SAME_OF_ENGINE = 1e-3  # of the peak: losses of contact in the swings between them
MODELS: dict[str, dict[str, Any]] = {
    "recess": {},
    "flat": {"support": "flat"},
    "planar": {"plane": 0.4},
    "planar with impacts": {"plane": 0.4, "restitution": "momentum"},
}
GRAVITY = 9.81  # [m/s^2]


class Cut(NamedTuple):
    """A record that is cut, and what it shakes."""

    cylinder: Cylinder
    record: GroundMotion
    end: float  # [s]

    @property
    def case(self) -> Case:
        """The whole record in a run that ends early."""
        return Case(self.cylinder, self.record, duration=self.end)

    def followed_by(self, still: float) -> Case:
        """The record that ends there, and still ground [s]."""
        return Case(self.cylinder, self.ended, duration=self.end + still)

    @property
    def ended(self) -> GroundMotion:
        """The record that ends there."""
        count = round(self.end / self.record.time_step) + 1
        return GroundMotion(self.record.acceleration[:count], self.record.time_step)


class Peaks(NamedTuple):
    """Peaks of a run that stands [rad]."""

    to_the_end: float  # of its samples and turning points
    followed: float
    batch: float
    right: float


def cuts(seed: int) -> Iterator[Cut]:
    """Yield random ones."""
    rng, record = np.random.default_rng(seed), el_centro_1940()
    while True:
        size, tan_alpha = (math.exp(rng.uniform(*np.log(span))) for span in (SIZES, SLENDERNESS))
        scale = rng.uniform(*INTENSITIES) * GRAVITY * tan_alpha / record.peak
        end = round(rng.uniform(*CUT) / record.time_step) * record.time_step
        yield Cut(Cylinder(semidiagonal=size, tan_alpha=tan_alpha), record.scaled(scale), end)


def peaks_of(cut: Cut, options: dict[str, Any]) -> Peaks | None:
    """Return the peaks of one run; None where it overturns or does not uplift."""
    short, long = (reduced.simulate(case, **options) for case in (cut.case, cut.followed_by(STILL)))
    if short.outcome != long.outcome:
        raise AssertionError(f"{cut} {options}: {short.outcome}, {long.outcome} with still ground after it")
    if short.outcome != "stands" or math.isnan(short.uplift_time):
        return None
    body = cut.cylinder
    (batch,) = reduced.peak_tilts(
        [body.semidiagonal], body.tan_alpha, cut.ended, [1.0], rtol=1e-8, **options
    )[0]
    return Peaks(short.peak_within_run, short.peak_tilt, float(batch), long.peak_within_run)


def engine_peaks_of(cut: Cut, engine: str) -> Peaks | None:
    """Return the peaks of one run of an engine, that of its model in place of the batch."""
    short, long = (
        multibody.simulate(case, engine=engine) for case in (cut.case, cut.followed_by(STILL_OF_ENGINE))
    )
    if {short.outcome, long.outcome} != {"stands"} or math.isnan(short.uplift_time):
        return None
    return Peaks(
        short.peak_within_run, short.peak_tilt, reduced.simulate(cut.case).peak_tilt, long.peak_within_run
    )


def shares(found: Sequence[Peaks]) -> str:
    """Return how many peaks are too low by each bound, up to the end and followed."""
    right = np.array([each.right for each in found])
    words = []
    for name in ("to_the_end", "followed"):
        low = right / np.array([getattr(each, name) for each in found]) - 1.0
        counts = [f"{np.count_nonzero(low > by)} ({np.mean(low > by):.0%})" for by in TOO_LOW]
        words.append(f"{name.replace('_', ' ')} {', '.join(counts)}, at most {low.max():.2g}")
    return "; ".join(words)


def main(arguments: Sequence[str] | None = None) -> int:
    """Run the command; return its exit code."""
    parser = options_of("cut_records", __doc__.partition("\n")[0])
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--runs", type=int, default=200, help="that stand, of each model")
    parser.add_argument("--engine", default="mujoco")
    parser.add_argument("--engine-runs", type=int, default=4, help="that stand, of the engine")
    given = parser.parse_args(arguments)
    print(f"peaks too low by more than {', '.join(f'{by:.0%}' for by in TOO_LOW)}, of runs that stand")
    wrong = 0
    for name, options in MODELS.items():
        every = (peaks_of(cut, options) for cut in cuts(given.seed))
        found = _first(every, given.runs)
        apart = max(abs(each.batch / each.followed - 1.0) for each in found)
        wrong += sum(abs(each.followed / each.right - 1.0) > SAME for each in found) + (apart > SAME)
        print(
            f"{name}, {len(found)} runs: {shares(found)}; batch against single runs {apart:.1e}", flush=True
        )
    if given.engine_runs:
        every = (engine_peaks_of(cut, given.engine) for cut in cuts(given.seed))
        found = _first(every, given.engine_runs)
        wrong += sum(each.followed / each.right < 1.0 - SAME_OF_ENGINE for each in found)
        print(f"{given.engine}, {len(found)} runs: {shares(found)}")
    return int(wrong > 0)


def _first(every: Iterator[Peaks | None], count: int) -> list[Peaks]:
    found = (each for each in every if each is not None)
    return [next(found) for _ in range(count)]
