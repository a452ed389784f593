"""Cells and lowest overturning intensities of a spectrum, run again singly and to a tighter tolerance."""

from __future__ import annotations

import math

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


def check_cells(spectrum: OverturningSpectrum) -> pd.DataFrame:
    """Run randomly chosen cells again as single runs, each beside a copy with a record stronger by a hair.

    Parameters
    ----------
    spectrum : OverturningSpectrum
        `CELLS` cells are drawn from all its series without repetition, or every one where there are fewer.

    Returns
    -------
    DataFrame
        One row for each cell: series, semidiagonal [m], intensity [-], peak_tilt of the grid,
        single_peak_tilt and copy_peak_tilt [rad], agrees (to 2 % of the peak tilt), and sensitive (single
        run and copy do not agree either).
    """
    shape = len(SERIES), len(spectrum.semidiagonals), len(spectrum.intensities)
    cells = math.prod(shape)
    chosen = np.random.default_rng(0).choice(cells, size=min(CELLS, cells), replace=False)
    rows = []
    for which, i, j in zip(*np.unravel_index(np.sort(chosen), shape), strict=True):
        name = SERIES[which]
        peak = float(spectrum.peak_tilt[name][i, j])
        single, copy = (
            _single(spectrum, name, i, float(spectrum.scales[j]) * factor) for factor in (1.0, 1.0 + NUDGE)
        )
        rows.append(
            {
                "series": name,
                "semidiagonal": float(spectrum.semidiagonals[i]),
                "intensity": float(spectrum.intensities[j]),
                "peak_tilt": peak,
                "single_peak_tilt": single,
                "copy_peak_tilt": copy,
                "agrees": _agree(peak, single),
                "sensitive": not _agree(copy, single),
            }
        )
    return pd.DataFrame(rows)


def confirm_lowest(spectrum: OverturningSpectrum) -> pd.DataFrame:
    """Run each lowest intensity again, to a tighter tolerance and under a record that differs by a hair.

    Returns
    -------
    DataFrame
        That of `lowest_frame` with a column more. confirmed: it overturns again, in all of three runs under
        the record and under those larger and smaller by `NUDGE`. What does not is a matter of chance: many
        passes have multiplied the rounding of the solution to the size of the tilt.
    """
    table = spectrum.lowest_frame()
    unit = float(spectrum.scales[0] / spectrum.intensities[0])
    table["confirmed"] = [
        _overturns_again(spectrum, name, i, unit * float(lowest))
        for name in SERIES
        for i, lowest in enumerate(spectrum.lowest[name])
    ]
    return table


def _overturns_again(spectrum: OverturningSpectrum, series: str, i: int, scale: float) -> bool:
    if math.isnan(scale):
        return False
    factors = (1.0, 1.0 - NUDGE, 1.0 + NUDGE)
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
