"""Peak tilts over grids of size and intensity: the runs that make a spectrum."""

from __future__ import annotations

import math
import os
from collections.abc import Callable
from concurrent.futures import ThreadPoolExecutor, as_completed

import numpy as np
from numpy.typing import ArrayLike, NDArray

from rockwobble.models import Cylinder, GroundMotion

from .driver import OVERTURNED
from .problem import SEATING, Problem, make_problem
from .simulate import make_ready

# A run through a whole record takes one to three steps a sample. Only a small cylinder that shaking has
# hardly lifted takes more: it rocks hundreds of times a second, at a ten-thousandth of alpha, for the rest
# of the record. After so many steps for each sample, for each time 1/p (what rocking at a hundredth of alpha
# takes, which a coarse record may well cause), or in all, the tilt of the seating rule is raised, and again
# after each eighth as many more; without the rule a run fails after five times as many.
_STEPS_PER_SAMPLE = 4
_STEPS_PER_TIME = 60
_STEPS_AT_LEAST = 5_000
_SHARE_TO_GO_ON = 8
_WITHOUT_RULE = 5


def peak_tilts(
    semidiagonals: ArrayLike,
    tan_alpha: float,
    motion: GroundMotion,
    scales: ArrayLike,
    *,
    model: str = "recess",
    rtol: float = 1e-7,
    seating: float = SEATING,
    gravity: float = 9.81,
    plane: float = 0.0,
    restitution: float | str = 1.0,
    workers: int | None = None,
    progress: Callable[[float], None] | None = None,
) -> NDArray[np.float64]:
    """Return the peak tilt from rest for each size and intensity.

    The runs are independent and share the cores as threads: the result has the same bits whatever
    their number. A fall that nothing later in the record can stop ends its run at once. A run that
    chatters beyond 4 steps for each sample of the record (60 for each time 1/p, 5000 in all at least)
    goes on with ten times the seating, and with ten times that after each eighth as many more. Without
    a seating rule it fails after five times as many. Every other run is that of `simulate`.

    Parameters
    ----------
    semidiagonals : array_like, shape (n_R,)
        Sizes R [m].
    tan_alpha : float
        Slenderness b/h [-].
    motion : GroundMotion
    scales : array_like, shape (n_scale,)
        Factors on the motion, not negative [-].
    model, rtol, seating, gravity, plane, restitution
        As in `simulate`.
    workers : int, optional
        Number of threads; default: that of the cores.
    progress : callable, optional
        Called with the fraction done, after each size.

    Returns
    -------
    ndarray, shape (n_R, n_scale)
        Peak tilt [rad]: 0 without uplift, pi/2 if overturned, NaN where the run failed (only with
        `seating` 0, where the motion can chatter beyond the step budget).

    Raises
    ------
    ValueError
        If an option is out of range or an array is not one-dimensional.

    Examples
    --------
    >>> from rockwobble.models import el_centro_1940
    >>> peaks = peak_tilts([6.0], 0.2, el_centro_1940(), [0.5, 1.0])
    >>> peaks.shape, float(peaks[0, 0])
    ((1, 2), 0.0)
    """
    sizes, factors = _axis("semidiagonals", semidiagonals), _axis("scales", scales)
    problems = [
        make_problem(
            model,
            Cylinder(semidiagonal=float(size), tan_alpha=tan_alpha),
            motion,
            None,
            None,
            gravity=gravity,
            rtol=rtol,
            seating=seating,
            plane=plane,
            restitution=restitution,
        )
        for size in sizes
    ]
    peaks = np.zeros((len(sizes), len(factors)))
    if peaks.size == 0:
        return peaks
    make_ready("planar" if problems[0].is_planar() else model)
    with ThreadPoolExecutor(workers or os.cpu_count()) as pool:
        rows = {pool.submit(_row, problem, factors): i for i, problem in enumerate(problems)}
        try:
            for done, row in enumerate(as_completed(rows), start=1):
                peaks[rows[row]] = row.result()
                if progress is not None:
                    progress(done / len(rows))
        except BaseException:
            pool.shutdown(wait=False, cancel_futures=True)
            raise
    return peaks


def _row(problem: Problem, factors: NDArray[np.float64]) -> list[float]:
    solve = problem.scaled_solver(*_limits(problem))
    peaks = []
    for factor in factors:
        march = solve(float(factor))
        peak = march.peak if march.status <= OVERTURNED else math.nan
        peaks.append(0.5 * math.pi if march.status == OVERTURNED else peak)
    return peaks


def _limits(problem: Problem) -> tuple[int, int]:
    """Return the steps that a run may take, and by how many they grow when they are used up."""
    assert problem.motion is not None
    by_sample = _STEPS_PER_SAMPLE * len(problem.motion.acceleration)
    by_time = _STEPS_PER_TIME * problem.duration * problem.body.p
    budget = int(min(max(_STEPS_AT_LEAST, by_sample, by_time), 2**58))
    return (budget, budget // _SHARE_TO_GO_ON) if problem.seating > 0.0 else (_WITHOUT_RULE * budget, 0)


def _axis(name: str, values: ArrayLike) -> NDArray[np.float64]:
    axis = np.asarray(values, dtype=np.float64)
    if axis.ndim != 1 or not np.isfinite(axis).all() or (axis < 0.0).any():
        raise ValueError(f"{name} must be a sequence of finite numbers, none negative, got {values!r}")
    return axis
