"""A grid of reduced runs from rest: sizes, slenderness, intensities, motions and models."""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from rockwobble import reduced
from rockwobble.models import GroundMotion
from rockwobble.models.shown import Brief

from ..metrics.pair import overturned
from ..storage.provenance import fingerprint, reduced_makers

MODELS = ("recess", "flat", "planar")
# The runs of a chunk take about a second together: little is lost with it, and keeping it takes a few
# thousandths of that.
_CHUNK_SIZE = 1000


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class GridChunk:
    """Some sizes and scales of a grid, with one slenderness, motion and model; `run` solves them."""

    motion: GroundMotion
    motion_key: str  # hash of its samples, the same for many chunks
    label: str  # of the motion
    model: str
    tan_alpha: float
    semidiagonals: tuple[float, ...]
    scales: tuple[float, ...]
    options: Mapping[str, object]  # of `reduced.peak_tilts`

    @property
    def rows(self) -> int:
        """Number of runs."""
        return len(self.semidiagonals) * len(self.scales)

    @property
    def name(self) -> str:
        """Description of the chunk."""
        where = f"tan alpha {self.tan_alpha:g}, R from {self.semidiagonals[0]:g} m, scale from"
        return f"{self.label}, {self.model}, {where} {self.scales[0]:g}"

    def key(self) -> str:
        """Return the hash of all that the results depend on."""
        return fingerprint(
            {
                "motion": (self.motion_key, self.label),
                "model": self.model,
                "tan_alpha": self.tan_alpha,
                "semidiagonals": np.array(self.semidiagonals),
                "scales": np.array(self.scales),
                "options": self.options,
                "made with": reduced_makers(),
            }
        )

    def run(self) -> dict[str, object]:
        """Return the columns of the results, one row for each run."""
        peaks = reduced.peak_tilts(
            self.semidiagonals,
            self.tan_alpha,
            self.motion,
            self.scales,
            workers=1,  # the processes share the cores already
            **{**reduced.MODELS[self.model], **self.options},
        ).ravel()
        sizes, scales = np.meshgrid(self.semidiagonals, self.scales, indexing="ij")
        return {
            "motion": [self.label] * self.rows,
            "model": [self.model] * self.rows,
            "tan_alpha": np.full(self.rows, self.tan_alpha),
            "semidiagonal": sizes.ravel(),
            "scale": scales.ravel(),
            "peak_tilt": peaks,
            "peak_tilt_over_alpha": peaks / math.atan(self.tan_alpha),
            "outcome": [_outcome(float(peak)) for peak in peaks],
        }


@dataclass(frozen=True, slots=True, eq=False, init=False, repr=False)
class Grid(Brief):
    """Every size with every slenderness, scale, motion and model, each run from rest for its peak tilt.

    Parameters
    ----------
    semidiagonals : array_like, shape (n_R,)
        Sizes R [m].
    tan_alphas : array_like, shape (n_a,)
        Slendernesses b/h [-].
    scales : array_like, shape (n_s,)
        Factors on the motions, not negative [-].
    motions : sequence of GroundMotion
        With different names.
    models : sequence of {"recess", "flat", "planar"}, optional
    **options
        rtol, rest_tilt, gravity, slab_mass_ratio, and for a grid of planar runs alone plane and restitution:
        as in `reduced.peak_tilts`.

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

    semidiagonals: tuple[float, ...]
    tan_alphas: tuple[float, ...]
    scales: tuple[float, ...]
    motions: tuple[GroundMotion, ...]
    models: tuple[str, ...]
    options: Mapping[str, object]

    def __init__(
        self,
        *,
        semidiagonals: ArrayLike,
        tan_alphas: ArrayLike,
        scales: ArrayLike,
        motions: Sequence[GroundMotion],
        models: Sequence[str] = ("recess",),
        **options: Any,
    ) -> None:
        labels = [motion.name or "record" for motion in motions]
        _require_different("motions", labels)
        _require_different("models", models)
        for model in models:
            if model not in MODELS:
                raise ValueError(f"models must be of {', '.join(MODELS)}, got {model!r}")
        planar = [name for name in ("plane", "restitution") if name in options]
        if planar and tuple(models) != ("planar",):
            raise ValueError(f"{planar[0]} is of planar motion, got models {', '.join(models)}")
        object.__setattr__(self, "semidiagonals", _axis("semidiagonals", semidiagonals, above_zero=True))
        object.__setattr__(self, "tan_alphas", _axis("tan_alphas", tan_alphas, above_zero=True))
        object.__setattr__(self, "scales", _axis("scales", scales, above_zero=False))
        object.__setattr__(self, "motions", tuple(motions))
        object.__setattr__(self, "models", tuple(models))
        object.__setattr__(self, "options", options)
        self._try_options()

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
                {
                    "name": motion.name or "record",
                    "time_step": motion.time_step,
                    "samples": len(motion.acceleration),
                    "components": motion.acceleration.shape[1],
                    "peak": motion.peak,
                    "fingerprint": _motion_key(motion),
                }
                for motion in self.motions
            ],
            "models": self.models,
            "options": self.options,
        }

    def _blocks(self, size: int) -> Iterator[tuple[tuple[float, ...], tuple[float, ...]]]:
        # whole rows of scales where they fit, because a row shares what depends on the size alone
        width = min(size, len(self.scales))
        height = max(1, size // width)
        for i in range(0, len(self.semidiagonals), height):
            for j in range(0, len(self.scales), width):
                yield self.semidiagonals[i : i + height], self.scales[j : j + width]

    def _try_options(self) -> None:
        """Let `reduced.peak_tilts` look at the options here, not first in another process."""
        if not self.options:
            return
        for model in self.models:
            try:
                reduced.peak_tilts(
                    [1.0], 0.2, self.motions[0], [], **{**reduced.MODELS[model], **self.options}
                )
            except TypeError:
                allowed = "rtol, rest_tilt, gravity, slab_mass_ratio, plane and restitution"
                raise ValueError(
                    f"the options of a grid are {allowed}, got {', '.join(self.options)}"
                ) from None


def _motion_key(motion: GroundMotion) -> str:
    return fingerprint((motion.acceleration, motion.time_step))


def _outcome(peak: float) -> str:
    if math.isnan(peak):
        return "failed"
    return "overturned" if overturned(peak) else "stands"


def _axis(name: str, values: ArrayLike, *, above_zero: bool) -> tuple[float, ...]:
    axis: NDArray[np.float64] = np.atleast_1d(np.asarray(values, dtype=np.float64))
    if axis.ndim != 1 or not np.isfinite(axis).all():
        raise ValueError(f"{name} must be a sequence of finite numbers, got {values!r}")
    if (axis < 0.0).any() or (above_zero and (axis == 0.0).any()):
        raise ValueError(
            f"{name} must {'be above zero' if above_zero else 'not be negative'}, got {values!r}"
        )
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
