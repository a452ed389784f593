"""Peak tilts over grids of size and intensity: the runs that make a spectrum."""

from __future__ import annotations

import math
from collections.abc import Callable

import numpy as np
from numpy.typing import ArrayLike, NDArray

from rockwobble.models import Case, Cylinder, GroundMotion, Tendon, WobblingFrame
from rockwobble.models.bounds import OVERTURNED_TILT
from rockwobble.models.cpus import grid_in_threads, in_threads
from rockwobble.models.number_checks import require_axis
from rockwobble.models.support import RECESS

from .integration.result import OVERTURNED, IntegrationResult
from .problem import REST_TILT, Problem
from .simulation import make_ready


def peak_tilts(
    semidiagonals: ArrayLike,
    tan_alpha: float,
    motion: GroundMotion,
    scales: ArrayLike,
    *,
    support: str = RECESS,
    plane: float | None = None,
    restitution: float | str = 1.0,
    rtol: float = 1e-7,
    rest_tilt: float = REST_TILT,
    gravity: float = 9.81,
    slab_mass_ratio: float = 0.0,
    rolling_resistance: float = 0.0,
    tendon: Tendon | None = None,
    workers: int | None = None,
    progress: Callable[[float], None] | None = None,
) -> NDArray[np.float64]:
    """Return the peak tilt from rest for each size and intensity.

    The runs are independent and share the cores as threads: the result has the same bits whatever
    their number, and each is that of `simulate` under ``motion.scaled(scale)``.

    Parameters
    ----------
    semidiagonals : array_like, shape (n_R,)
        Sizes R [m].
    tan_alpha : float
        Slenderness b/h [-].
    motion : GroundMotion
    scales : array_like, shape (n_scale,)
        Factors on the motion, not negative [-].
    support, plane, restitution, rtol, rest_tilt
        As in `simulate`, but "flat" has no friction here: for what slides see `peak_displacements`.
    gravity : float, optional
        g [m/s^2].
    slab_mass_ratio : float, optional
        Mass of the slab over that of all columns [-]: the peaks of a `WobblingFrame`.
    rolling_resistance : float, optional
        As in `Case` [m]: the same length for every size.
    tendon : Tendon, optional
        As in `Case`: the same multiples of weight and base radius for every size.
    workers : int, optional
        Number of threads; default: that of the cores.
    progress : callable, optional
        Called with the fraction done, now and then.

    Returns
    -------
    ndarray, shape (n_R, n_scale)
        Peak tilt [rad]: 0 without uplift, pi/2 if overturned, NaN where the run failed or is undecided.

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
    sizes, factors = require_axis("semidiagonals", semidiagonals), require_axis("scales", scales)
    cylinders = (Cylinder(semidiagonal=float(size), tan_alpha=tan_alpha) for size in sizes)
    bodies = [
        Problem(
            Case(
                WobblingFrame(cylinder, slab_mass_ratio),
                motion,
                gravity=gravity,
                friction=tan_alpha + 1.0,  # friction high enough that none slides
                rolling_resistance=rolling_resistance,
                tendon=tendon,
            ),
            support=support,
            plane=plane,
            restitution=restitution,
            rtol=rtol,
            rest_tilt=rest_tilt,
        )
        for cylinder in cylinders
    ]
    peaks = np.zeros((len(sizes), len(factors)))
    if peaks.size == 0:
        return peaks
    make_ready(bodies[0].kernel)

    def fill(column: int, rows: slice) -> None:
        shaking = bodies[0].shaking(float(factors[column]))
        peaks[rows, column] = [_peak(body.solve_under(shaking)) for body in bodies[rows]]

    for done in grid_in_threads(fill, peaks.shape, workers):
        if progress is not None:
            progress(done)
    return peaks


def peak_tilts_of_case(
    case: Case,
    scales: ArrayLike,
    *,
    support: str = RECESS,
    plane: float | None = None,
    rtol: float = 1e-7,
    workers: int | None = None,
) -> NDArray[np.float64]:
    """Return the peak tilt of a case, released or from rest, under its ground motion times each scale.

    Parameters
    ----------
    case : Case
        With a ground motion.
    scales : array_like, shape (n_scale,)
        Factors on the motion, not negative [-].
    support, plane, rtol
        As in `simulate`.
    workers : int, optional
        Number of threads; default: that of the cores.

    Returns
    -------
    ndarray, shape (n_scale,)
        Peak tilt [rad]: 0 without uplift, as where it slides, pi/2 if overturned, NaN where the run failed.

    Raises
    ------
    ValueError
        If the case has no ground motion, or an option is out of range.

    Examples
    --------
    >>> from rockwobble.models import el_centro_1940
    >>> case = Case(Cylinder(semidiagonal=6.0, tan_alpha=0.2), el_centro_1940(), duration=5.0)
    >>> peaks = peak_tilts_of_case(case, [0.5, 2.0])
    >>> peaks.shape, float(peaks[0])
    ((2,), 0.0)
    """
    if case.motion is None:
        raise ValueError("scales need a ground motion, got a case without one")
    problem = Problem(case, support=support, plane=plane, rtol=rtol)
    if problem.slides:
        return np.zeros(len(require_axis("scales", scales)))
    make_ready(problem.kernel)

    def peak(factor: float) -> float:
        return _peak(problem.solve_under(problem.shaking(factor)))

    factors = [float(factor) for factor in require_axis("scales", scales)]
    return np.array(list(in_threads(peak, factors, workers=workers)))


def _peak(result: IntegrationResult) -> float:
    if result.status == OVERTURNED:
        return OVERTURNED_TILT
    return result.peak if result.status < OVERTURNED else math.nan
