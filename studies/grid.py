"""Grid of reduced runs from rest: sizes, slenderness, intensities, motions and models."""

from __future__ import annotations

import itertools
import math
from collections import Counter
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
import pandas as pd
from numpy.typing import ArrayLike

from rockwobble import reduced
from rockwobble.compare.metrics.pair import outcome_of_peak
from rockwobble.compare.storage.provenance import fingerprint, reduced_makers, result_fingerprint
from rockwobble.models import Case, Cylinder, GroundMotion, WobblingFrame
from rockwobble.models.argument_kinds import with_argument_kinds
from rockwobble.models.case import TERMS
from rockwobble.models.doubts import doubts_about
from rockwobble.models.number_checks import require_axis, require_one_of
from rockwobble.models.shown import CompactRepr
from rockwobble.models.support import RECESS
from rockwobble.models.trace_file import motion_facts

from .plans import GridPlan

MOST_RUNS = 100_000_000  # limit: the table of so many takes 10 GB
# The runs of a chunk take about a second together: little is lost with it, and keeping it takes a few
# thousandths of that.
_CHUNK_SIZE = 1000
_OPTIONS: Mapping[str, float | None] = {  # options of `reduced.peak_tilts`, and their defaults
    "rtol": None,
    "rest_tilt": None,
    "gravity": 9.81,
    "slab_mass_ratio": 0.0,
    "plane": None,
    "restitution": None,
}
_RTOL = 1e-7  # its default tolerance


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class GridChunk:
    """Some sizes and scales of a grid, with one slenderness, motion and model; `run` solves them."""

    motion: GroundMotion
    model: str
    tan_alpha: float
    semidiagonals: Sequence[float]
    scales: Sequence[float]
    options: Mapping[str, Any]  # options of `reduced.peak_tilts`

    @property
    def name(self) -> str:
        """Description of the chunk."""
        where = f"tan alpha {self.tan_alpha:g}, R from {self.semidiagonals[0]:g} m, scale from"
        return f"{_label(self.motion)}, {self.model}, {where} {self.scales[0]:g}"

    def key(self) -> str:
        """Hash that identifies the results."""
        return result_fingerprint(self, reduced_makers())

    def run(self) -> pd.DataFrame:
        """Table of the results, one row for each run."""
        options = {**reduced.MODELS[self.model], **self.options}
        axes = self.semidiagonals, self.tan_alpha, self.motion, self.scales
        peaks = reduced.peak_tilts(
            *axes, workers=1, **options
        ).ravel()  # processes share the cores already, so one thread each
        sizes, scales = (each.ravel() for each in np.meshgrid(self.semidiagonals, self.scales, indexing="ij"))
        return pd.DataFrame(
            {
                "motion": _label(self.motion),
                "model": self.model,
                "tan_alpha": self.tan_alpha,
                "semidiagonal": sizes,
                "scale": scales,
                "peak_tilt": peaks,
                "peak_tilt_over_alpha": peaks / math.atan(self.tan_alpha),
                "outcome": [
                    # a run without a peak gives its reason
                    self._outcome(size, scale, options) if math.isnan(peak) else outcome_of_peak(peak)
                    for peak, size, scale in zip(peaks.tolist(), sizes, scales, strict=True)
                ],
            }
        )

    def _outcome(self, size: float, scale: float, options: Mapping[str, Any]) -> str:
        terms = {name: value for name, value in options.items() if name in ("gravity", *TERMS)}
        others = {name: options[name] for name in options.keys() - terms.keys() - {"slab_mass_ratio"}}
        column = Cylinder(semidiagonal=float(size), tan_alpha=self.tan_alpha)
        body = WobblingFrame(column, options.get("slab_mass_ratio", 0.0))
        case = Case(body, self.motion.scaled(float(scale)), **terms)
        return reduced.simulate(case, **{"rtol": _RTOL, **others}).outcome


@with_argument_kinds
@dataclass(frozen=True, slots=True, kw_only=True, eq=False, repr=False)
class Grid(CompactRepr, GridPlan):
    """Every size with every slenderness, scale, motion and model, each run from rest for its peak tilt.

    Parameters
    ----------
    semidiagonals : sequence of float
        Sizes R [m].
    tan_alphas : sequence of float
        Slendernesses b/h [-].
    scales : sequence of float
        Factors on the motions, not negative [-].
    motions : sequence of GroundMotion
        With different names.
    models : sequence of {"recess", "flat", "planar"}, optional
    gravity, slab_mass_ratio, rtol, rest_tilt
        As in `reduced.peak_tilts`; tendon_prestress and tendon_stiffness of its tendon; and for a grid of
        planar runs alone plane and restitution.

    Raises
    ------
    ValueError
        If an axis is empty, repeats a value or holds one that is out of range, or an option is unusable.

    Examples
    --------
    >>> import rockwobble as rw
    >>> grid = Grid(semidiagonals=[3, 6], tan_alphas=[0.1, 0.2], scales=[1, 2], motions=[rw.el_centro_1940()])
    >>> swept = rw.sweep(grid, workers=1)
    >>> len(swept.table)
    8
    """

    semidiagonals: Sequence[float]
    tan_alphas: Sequence[float]
    scales: Sequence[float]
    motions: Sequence[GroundMotion]
    models: Sequence[str] = (RECESS,)
    rtol: float | None = None
    rest_tilt: float | None = None

    def __post_init__(self) -> None:
        GridPlan.__post_init__(self)
        _require_different("motions", [_label(motion) for motion in self.motions])
        _require_different("models", self.models)
        for model in self.models:
            require_one_of("a model of a grid", model, reduced.MODELS)
        planar = [name for name in ("plane", "restitution") if name in self.options]
        if planar and tuple(self.models) != ("planar",):
            raise ValueError(f"{planar[0]} belongs to planar motion, got models {', '.join(self.models)}")
        for name in ("semidiagonals", "tan_alphas", "scales"):
            object.__setattr__(self, name, _axis(name, getattr(self, name)))
        if self.rows > MOST_RUNS:
            raise ValueError(
                f"a grid has at most {MOST_RUNS:,} runs, got {self.rows:,}: sweep fewer at a time"
            )
        # early check of the options, before another process starts
        for model in self.models if self.options else ():
            run = {**reduced.MODELS[model], **self.options}
            reduced.peak_tilts([1.0], 0.2, self.motions[0], [], **run)

    def doubts(self) -> list[dict[str, object]]:
        """Doubts about motions, sizes and gravity, see `doubts_of_cases`."""
        return doubts_about(
            motions=self.motions,
            cylinders=self.corners(),
            gravities=[self.gravity],
            tendons=[self.tendon],
        )

    def corners(self) -> list[Cylinder]:
        """Smallest and largest cylinders at the least and the largest slenderness."""
        return [
            Cylinder(semidiagonal=size, tan_alpha=tan_alpha)
            for size in (min(self.semidiagonals), max(self.semidiagonals))
            for tan_alpha in (min(self.tan_alphas), max(self.tan_alphas))
        ]

    @property
    def options(self) -> Mapping[str, object]:
        """Options of `reduced.peak_tilts` that are not its defaults."""
        given = {name: getattr(self, name) for name in _OPTIONS}
        tendon = {} if self.tendon is None else {"tendon": self.tendon}
        return {name: value for name, value in given.items() if value != _OPTIONS[name]} | tendon

    @property
    def rows(self) -> int:
        """Number of runs."""
        axes = (self.semidiagonals, self.tan_alphas, self.scales, self.motions, self.models)
        return math.prod(len(axis) for axis in axes)

    def chunks(self, size: int | None = None) -> Iterator[GridChunk]:
        """Chunks of about `size` runs, in the order of the table."""
        blocks = [*self._blocks(size or _CHUNK_SIZE)]
        axes = itertools.product(self.motions, self.models, self.tan_alphas, blocks)
        for motion, model, tan_alpha, (sizes, scales) in axes:
            yield GridChunk(
                motion=motion,
                model=model,
                tan_alpha=tan_alpha,
                semidiagonals=sizes,
                scales=scales,
                options=self.options,
            )

    def describe(self) -> dict[str, object]:
        """Axes and options in SI units, for a file."""
        return {
            "plan": "grid of reduced runs",
            "runs": self.rows,
            "semidiagonals": self.semidiagonals,
            "tan_alphas": self.tan_alphas,
            "scales": self.scales,
            "motions": [
                {**motion_facts(each), "name": _label(each), "fingerprint": _fingerprint(each)}
                for each in self.motions
            ],
            "models": self.models,
            "options": self.options,
        }

    def _blocks(self, size: int) -> Iterator[tuple[Sequence[float], Sequence[float]]]:
        # complete rows of scales if possible, as a row shares all work that depends on the size
        width = min(size, len(self.scales))
        height = max(1, size // width)
        for i in range(0, len(self.semidiagonals), height):
            for j in range(0, len(self.scales), width):
                yield self.semidiagonals[i : i + height], self.scales[j : j + width]


def _label(motion: GroundMotion) -> str:
    return motion.name or "record"


def _fingerprint(motion: GroundMotion) -> str:
    return fingerprint((motion.acceleration, motion.time_step))


def _axis(name: str, values: ArrayLike) -> tuple[float, ...]:
    numbers = tuple(require_axis(name, values).tolist())
    if name != "scales" and 0.0 in numbers:
        raise ValueError(f"{name} must be above zero, got {values!r}")
    _require_different(name, numbers)
    return numbers


def _require_different(name: str, values: Sequence[object]) -> None:
    if not values:
        raise ValueError(f"{name} must hold at least one, got none")
    if repeated := [value for value, count in Counter(values).items() if count > 1]:
        raise ValueError(f"{name} must differ, got {repeated[0]!r} twice")
