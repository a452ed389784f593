"""A grid of reduced runs from rest: sizes, slenderness, intensities, motions and models."""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
import pandas as pd
from numpy.typing import ArrayLike, NDArray

from rockwobble import reduced
from rockwobble.compare.metrics.pair import outcome_of_peak
from rockwobble.compare.storage.provenance import fingerprint, reduced_makers, result_fingerprint
from rockwobble.models import Case, Cylinder, GroundMotion, WobblingFrame
from rockwobble.models.argument_kinds import with_argument_kinds
from rockwobble.models.case import TERMS
from rockwobble.models.doubts import doubts_about
from rockwobble.models.number_checks import require_one_of
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
    motion_key: str  # hash of its samples, the same for many chunks
    label: str  # label of the motion
    model: str
    tan_alpha: float
    semidiagonals: Sequence[float]
    scales: Sequence[float]
    options: Mapping[str, object]  # options of `reduced.peak_tilts`

    @property
    def name(self) -> str:
        """Description of the chunk."""
        where = f"tan alpha {self.tan_alpha:g}, R from {self.semidiagonals[0]:g} m, scale from"
        return f"{self.label}, {self.model}, {where} {self.scales[0]:g}"

    def key(self) -> str:
        """Hash that identifies the results."""
        return result_fingerprint(
            {
                "motion": (self.motion_key, self.label),
                "model": self.model,
                "tan_alpha": self.tan_alpha,
                "semidiagonals": np.array(self.semidiagonals),
                "scales": np.array(self.scales),
                "options": self.options,
            },
            reduced_makers(),
        )

    def run(self) -> pd.DataFrame:
        """Return the table of the results, one row for each run."""
        peaks = reduced.peak_tilts(
            self.semidiagonals,
            self.tan_alpha,
            self.motion,
            self.scales,
            workers=1,  # the processes share the cores already
            **{**reduced.MODELS[self.model], **self.options},
        ).ravel()
        sizes, scales = np.meshgrid(self.semidiagonals, self.scales, indexing="ij")
        return pd.DataFrame(
            {
                "motion": self.label,
                "model": self.model,
                "tan_alpha": self.tan_alpha,
                "semidiagonal": sizes.ravel(),
                "scale": scales.ravel(),
                "peak_tilt": peaks,
                "peak_tilt_over_alpha": peaks / math.atan(self.tan_alpha),
                "outcome": [
                    # a run without a peak gives its reason
                    self._outcome(size, scale) if math.isnan(peak) else outcome_of_peak(peak)
                    for peak, size, scale in zip(peaks.tolist(), sizes.ravel(), scales.ravel(), strict=True)
                ],
            }
        )

    def _outcome(self, size: float, scale: float) -> str:
        options: dict[str, Any] = {**reduced.MODELS[self.model], **self.options}
        column = Cylinder(semidiagonal=float(size), tan_alpha=self.tan_alpha)
        ratio = options.pop("slab_mass_ratio", 0.0)
        cylinder = WobblingFrame(column, ratio) if ratio else column
        stated = {name: options.pop(name) for name in ("gravity", *TERMS) if name in options}
        case = Case(cylinder, self.motion.scaled(float(scale)), **stated)
        return reduced.simulate(case, **{"rtol": _RTOL, **options}).outcome


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
    >>> found = rw.sweep(grid, workers=1)
    >>> len(found.table)
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
        _require_different("motions", [motion.name or "record" for motion in self.motions])
        _require_different("models", self.models)
        for model in self.models:
            require_one_of("a model of a grid", model, reduced.MODELS)
        planar = [name for name in ("plane", "restitution") if name in self.options]
        if planar and tuple(self.models) != ("planar",):
            raise ValueError(f"{planar[0]} belongs to planar motion, got models {', '.join(self.models)}")
        for name in ("semidiagonals", "tan_alphas", "scales"):
            object.__setattr__(self, name, _axis(name, getattr(self, name), zero=name == "scales"))
        if self.rows > MOST_RUNS:
            raise ValueError(
                f"a grid has at most {MOST_RUNS:,} runs, got {self.rows:,}: sweep fewer at a time"
            )
        # looks at the options here, not first in another process
        for model in self.models if self.options else ():
            run = {**reduced.MODELS[model], **self.options}
            reduced.peak_tilts([1.0], 0.2, self.motions[0], [], **run)

    def doubts(self) -> list[dict[str, object]]:
        """Return the doubts about its motions, sizes and gravity, as `doubts_of_cases` does."""
        return doubts_about(
            motions=self.motions,
            cylinders=self.corners(),
            gravities=[self.gravity],
            tendons=[self.tendon],
        )

    def corners(self) -> list[Cylinder]:
        """Return the smallest and the largest cylinders of the least and of the largest slenderness."""
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
        """Cut the grid into chunks of about `size` runs, in the order of the table."""
        size = size or _CHUNK_SIZE
        for motion in self.motions:
            motion_key = _motion_key(motion)
            for model in self.models:
                for tan_alpha in self.tan_alphas:
                    for sizes, scales in self._blocks(size):
                        yield GridChunk(
                            motion=motion,
                            motion_key=motion_key,
                            label=motion.name or "record",
                            model=model,
                            tan_alpha=tan_alpha,
                            semidiagonals=sizes,
                            scales=scales,
                            options=self.options,
                        )

    def describe(self) -> dict[str, object]:
        """Return the axes and options, for a file; SI units."""
        return {
            "plan": "grid of reduced runs",
            "runs": self.rows,
            "semidiagonals": self.semidiagonals,
            "tan_alphas": self.tan_alphas,
            "scales": self.scales,
            "motions": [
                motion_facts(motion) | {"name": motion.name or "record", "fingerprint": _motion_key(motion)}
                for motion in self.motions
            ],
            "models": self.models,
            "options": self.options,
        }

    def _blocks(self, size: int) -> Iterator[tuple[Sequence[float], Sequence[float]]]:
        # whole rows of scales where they fit, because a row shares what depends on the size alone
        width = min(size, len(self.scales))
        height = max(1, size // width)
        for i in range(0, len(self.semidiagonals), height):
            for j in range(0, len(self.scales), width):
                yield self.semidiagonals[i : i + height], self.scales[j : j + width]


def _motion_key(motion: GroundMotion) -> str:
    return fingerprint((motion.acceleration, motion.time_step))


def _axis(name: str, values: ArrayLike, *, zero: bool) -> tuple[float, ...]:
    axis: NDArray[np.float64] = np.atleast_1d(np.asarray(values, dtype=np.float64))
    if axis.ndim != 1 or not np.isfinite(axis).all():
        raise ValueError(f"{name} must be a sequence of finite numbers, got {values!r}")
    if (axis < 0.0).any() or (not zero and (axis == 0.0).any()):
        raise ValueError(f"{name} must {'not be negative' if zero else 'be above zero'}, got {values!r}")
    numbers = tuple(axis.tolist())
    _require_different(name, numbers)
    return numbers


def _require_different(name: str, values: Sequence[object]) -> None:
    if not values:
        raise ValueError(f"{name} must hold at least one, got none")
    seen: set[object] = set()
    for value in values:
        if value in seen:
            raise ValueError(f"{name} must differ, got {value!r} twice")
        seen.add(value)
