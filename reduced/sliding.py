"""The sliding model: a body of any size, at rest on flat ground with friction below b/h, only slides.

The moment of friction, at most mu N h, never reaches N b, so the base never uplifts. Friction is everywhere
opposite to one velocity v, the pressure has its centre at mu h from the axis along v, and the resultant
passes through it: the body never turns. What is left, x'' = -a_h - mu (g + az) v/|v|, is exact
(`integration.sliding`).
"""

from __future__ import annotations

import math
import time
from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike, NDArray

from rockwobble.models import Assumptions, Case, Diagnostic, GroundMotion, Run, Trace
from rockwobble.models.cpus import grid_in_threads
from rockwobble.models.number_checks import require_axis, require_positive
from rockwobble.models.shown import CompactRepr
from rockwobble.models.support import FLAT
from rockwobble.models.trace_file import Array

from ._compile import announce
from .integration.sliding import Slide, slide
from .kernels import interrupted_after
from .problem import ground_at, sample_times, three_columns

_TOLERANCE = 1e-13  # error of the speed in a step: the displacement to 1e-10 of its peak
_COARSE = 1e-8  # tolerance of a batch of slides: to 1e-7 of the peak, in two thirds of the time
_NONE = np.empty(0)  # no sample times


@dataclass(frozen=True, eq=False, kw_only=True, repr=False)
class _Sliding(CompactRepr):
    """Source of the quantities of a slide."""

    case: Case
    time: Array
    samples: Array

    def quantities(self) -> Mapping[str, Array]:
        """Force of the ground, energies and path at the samples."""
        case, samples = self.case, self.samples
        ground, velocity, slides = ground_at(case, self.time), samples[:, 2:4], samples[:, 6] > 0.0
        load = case.gravity + ground[:, 2]
        speed = np.hypot(*velocity.T)
        direction = velocity / np.where(speed > 0.0, speed, 1.0)[:, None]
        pushed = np.where(slides[:, None], -case.friction * load[:, None] * direction, ground[:, :2])
        none = np.zeros(len(self.time))
        return {
            "contact_force": np.column_stack([pushed, load]) / case.gravity,
            "energy": 0.5 * speed * speed,
            "energy_lost": samples[:, 5],
            "slip": samples[:, 4],
            "rolling_rate": none,
            "restraining_moment": none,
        }

    def assumptions(self, until: float) -> Assumptions:
        """Contact and friction hold: the base never opens."""
        return Assumptions(friction=self.case.friction)


def simulate(case: Case, sample_step: float, version: str) -> Trace:
    """Slide of a case from rest on flat ground with friction below b/h, followed to rest."""
    body = case.cylinder
    _make_ready()
    times = sample_times(case.length, sample_step)
    started = time.perf_counter()
    result = _slide_of(case, times)
    if result.end > case.length:
        times = sample_times(result.end, sample_step)
        result = _slide_of(case, times)
    wall_time = time.perf_counter() - started
    failed = not math.isnan(result.lost_contact)
    times, samples = times[: len(result.samples)], result.samples
    count = len(times)
    unknown, none = np.full(count, math.nan), np.zeros(count)
    weightless = Diagnostic(code="weightless", time=result.lost_contact, size=0.0, bound=0.0)
    return Trace(
        case=case,
        run=Run(None, FLAT),
        version=version,
        time=times,
        tilt=none,
        tilt_rate=none,
        rolling_angle=unknown,
        twist=none,
        contact_point=np.column_stack([unknown, unknown]),
        centre_of_mass=np.column_stack([samples[:, :2], np.full(count, body.mass_centre_height)]),
        peak_tilt=math.nan if failed else 0.0,
        outcome="failed" if failed else "stands",
        uplift_time=math.nan,
        uplift_direction=math.nan,
        source=_Sliding(case=case, time=times, samples=samples),
        facts=(weightless,) if failed else (),
        rests=not (failed or result.slides),
        followed_until=result.end if result.end > case.length else math.nan,
        settings={"tolerance": _TOLERANCE},
        wall_time=wall_time,
        step_count=result.steps,
        peak_displacement=result.peak,
    )


def peak_displacements(
    frictions: ArrayLike,
    motion: GroundMotion,
    scales: ArrayLike,
    *,
    gravity: float = 9.81,
    workers: int | None = None,
) -> NDArray[np.float64]:
    """Peak displacement from rest on flat ground for each friction and intensity, of any body that slides.

    A body slides where friction is below b over the height of its mass centre, whatever its size and mass.
    The runs share the cores as threads; each is that of `simulate` under ``motion.scaled(scale)``.

    Parameters
    ----------
    frictions : array_like, shape (n_friction,)
        Coulomb coefficients, not negative [-]. Without friction a body stays in place, and the ground moves.
    motion : GroundMotion
    scales : array_like, shape (n_scale,)
        Factors on the motion, not negative [-].
    gravity : float, optional
        g [m/s^2].
    workers : int, optional
        Number of threads; default: that of the cores.

    Returns
    -------
    ndarray, shape (n_friction, n_scale)
        Largest distance over the ground from where it stood [m]: 0 where it does not slide, NaN where
        g + az reaches 0.

    Raises
    ------
    ValueError
        If a number is out of range or an array is not one-dimensional.

    Examples
    --------
    >>> from rockwobble.models import el_centro_1940
    >>> peak_displacements([0.2, 0.3, 0.9], el_centro_1940(), [2.5]).round(4).ravel().tolist()
    [0.2808, 0.0738, 0.0]
    """
    gravity = require_positive("gravity", gravity, "m/s^2")
    coefficients, factors = require_axis("frictions", frictions), require_axis("scales", scales)
    peaks = np.zeros((len(coefficients), len(factors)))
    if peaks.size == 0:
        return peaks
    _make_ready()
    record = three_columns(motion)

    def fill(column: int, rows: slice) -> None:
        shaken = record * factors[column]
        peaks[rows, column] = [
            slide(shaken, motion.time_step, friction, gravity, motion.duration, _NONE, _COARSE).peak
            for friction in coefficients[rows]
        ]

    for _ in grid_in_threads(fill, peaks.shape, workers):
        pass
    return peaks


def _slide_of(case: Case, times: Array) -> Slide:
    motion = case.motion
    step = 1.0 if motion is None else motion.time_step
    with interrupted_after():
        return slide(three_columns(motion), step, case.friction, case.gravity, case.length, times, _TOLERANCE)


def _make_ready() -> None:
    announce(slide, "sliding", lambda: slide(np.zeros((2, 3)), 1.0, 0.1, 9.81, 1.0, _NONE, _TOLERANCE))
