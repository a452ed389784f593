"""Cells and lowest overturning intensities of a spectrum, run again singly and to a tighter tolerance."""

from __future__ import annotations

import math
from collections.abc import Sequence

import numpy as np
import pandas as pd

from rockwobble import reduced
from rockwobble.models import Case, Cylinder

from ...metrics.tilt import overturned
from .result import OverturningSpectrum
from .series import SERIES, series_options

CHECK_RTOL = 1e-9
# Relative change of the record. A cell that it changes as much as the tolerance of the grid does is a
# matter of chance and says nothing of accuracy.
NUDGE = 1e-9
AGREEMENT = 0.02  # of the peak tilt
CELLS = 60  # enough to find one wrong cell in twenty almost surely, in half a second


def check_cells(
    spectrum: OverturningSpectrum,
    count: int = CELLS,
    *,
    series: Sequence[str] = SERIES,
    nudge: float = NUDGE,
    seed: int = 0,
) -> pd.DataFrame:
    """Run randomly chosen cells again as single runs, each beside a twin whose record differs by a hair.

    Parameters
    ----------
    spectrum : OverturningSpectrum
    count : int, optional
        Number of cells, drawn without repetition; at most those there are.
    series : sequence of str, optional
        From which to draw.
    nudge : float, optional
        By how much, relatively, the record of the twin differs.
    seed : int, optional
        Of the choice.

    Returns
    -------
    DataFrame
        One row for each cell: series, semidiagonal [m], intensity [-], peak_tilt of the grid,
        single_peak_tilt and twin_peak_tilt [rad], agrees (to 2 % of the peak tilt), and sensitive (single
        run and twin do not agree either).

    Raises
    ------
    ValueError
        If `count` is not positive.
    """
    if count < 1:
        raise ValueError(f"count must be at least 1, got {count!r}")
    n_sizes, n_levels = len(spectrum.semidiagonals), len(spectrum.intensities)
    cells = len(series) * n_sizes * n_levels
    chosen = np.random.default_rng(seed).choice(cells, size=min(count, cells), replace=False)
    rows = []
    for cell in np.sort(chosen):
        which, rest = divmod(int(cell), n_sizes * n_levels)
        i, j = divmod(rest, n_levels)
        name = series[which]
        peak = float(spectrum.peak_tilt[name][i, j])
        single, twin = (
            _single(spectrum, name, i, float(spectrum.scales[j]) * factor) for factor in (1.0, 1.0 + nudge)
        )
        rows.append(
            (
                name,
                float(spectrum.semidiagonals[i]),
                float(spectrum.intensities[j]),
                peak,
                single,
                twin,
                _agree(peak, single),
                not _agree(twin, single),
            )
        )
    names = ["series", "semidiagonal", "intensity", "peak_tilt", "single_peak_tilt", "twin_peak_tilt"]
    return pd.DataFrame(rows, columns=[*names, "agrees", "sensitive"])


def confirm_lowest(spectrum: OverturningSpectrum, *, nudge: float = NUDGE) -> pd.DataFrame:
    """Run each lowest intensity again, to a tighter tolerance and under a record that differs by a hair.

    Returns
    -------
    DataFrame
        That of `lowest_frame` with a column more. confirmed: it overturns again, in all of three runs under
        the record and under those larger and smaller by `nudge`. What does not is a matter of chance: many
        passes have multiplied the rounding of the solution to the size of the tilt.
    """
    table = spectrum.lowest_frame()
    unit = float(spectrum.scales[0] / spectrum.intensities[0])
    table["confirmed"] = [
        _overturns_again(spectrum, name, i, unit * float(lowest), nudge)
        for name in SERIES
        for i, lowest in enumerate(spectrum.lowest[name])
    ]
    return table


def _overturns_again(spectrum: OverturningSpectrum, series: str, i: int, scale: float, nudge: float) -> bool:
    if math.isnan(scale):
        return False
    factors = (1.0, 1.0 - nudge, 1.0 + nudge)
    return all(overturned(_single(spectrum, series, i, scale * factor)) for factor in factors)


def _single(spectrum: OverturningSpectrum, series: str, i: int, scale: float) -> float:
    run = reduced.simulate(
        Case(
            Cylinder(semidiagonal=float(spectrum.semidiagonals[i]), tan_alpha=spectrum.tan_alpha),
            spectrum.motion.scaled(scale),
            gravity=spectrum.gravity,
        ),
        rtol=CHECK_RTOL,
        rest_tilt=spectrum.rest_tilt,
        sample_step=spectrum.motion.duration,
        **series_options(series, spectrum.support),
    )
    return run.peak_tilt


def _agree(peak: float, other: float) -> bool:
    return math.isnan(peak) == math.isnan(other) and not abs(peak - other) > AGREEMENT * other
