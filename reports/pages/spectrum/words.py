"""What a spectrum says, in a table and in sentences made from its numbers."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Any

import numpy as np

from rockwobble.compare.studies.spectrum.lowest_overturning import Island, safe_islands
from rockwobble.compare.studies.spectrum.planar_contrast import planar_contrast, unconservative_from
from rockwobble.compare.studies.spectrum.series import SERIES, SPATIAL
from rockwobble.compare.studies.spectrum.study import OverturningSpectrum
from rockwobble.compare.studies.spectrum.verification import AGREEMENT, CHECK_RTOL, NUDGE

if TYPE_CHECKING:
    import pandas as pd

HEADINGS = (
    "R [m]",
    "lowest 3D",
    "lowest planar EW",
    "lowest planar NS",
    "3D falls [%]",
    "missed [%]",
    "overcalled [%]",
    "3D tilts more [%]",
)
LEGEND = (
    "lowest: median over the sizes of the lowest intensity found to overturn, in g tan alpha (-: most "
    "stand). missed: the 3D model overturns and neither planar run does. overcalled: a planar run "
    "overturns and the 3D model does not. 3D tilts more: than both planar runs."
)


def table_cells(contrast: pd.DataFrame) -> list[tuple[str, ...]]:
    """Return the rows of the table under `HEADINGS`; the last is for all sizes."""
    return [_cells(row, last=i == len(contrast) - 1) for i, (_, row) in enumerate(contrast.iterrows())]


def _cells(row: Any, *, last: bool) -> tuple[str, ...]:
    band = f"{row.smallest:.3g} to {row.largest:.3g}"
    lowest = (row.lowest, row.planar_x_lowest, row.planar_y_lowest)
    shares = (row.falls, row.missed, row.overcalled, row.larger_tilt)
    return (
        f"all, {band}" if last else band,
        *(f"{value:.2f}" if math.isfinite(value) else "-" for value in lowest),
        *(f"{100.0 * value:.1f}" if math.isfinite(value) else "-" for value in shares),
    )


def islands_of(spectrum: OverturningSpectrum) -> dict[str, list[Island]]:
    """Return the safe islands of each series."""
    return {
        series: safe_islands(
            spectrum.semidiagonals, spectrum.intensities, spectrum.peak_tilt[series], spectrum.lowest[series]
        )
        for series in SERIES
    }


def statements(spectrum: OverturningSpectrum) -> list[str]:
    """Return what the spectrum says, one sentence or two each."""
    contrast = planar_contrast(spectrum)
    every = contrast.iloc[-1]
    if not every.cells:
        return ["No cell could be solved."]
    said = [_headline(every)]
    if any(np.isfinite(lowest).any() for lowest in spectrum.lowest.values()):
        said += [_by_size(contrast), _edges(spectrum, every), _islands(spectrum)]
    failed = int(spectrum.failed().sum())
    if failed:
        said.append(f"{_count(failed, 'cell')} could not be solved and {_is(failed)} left out.")
    return said


def check_statement(checked: pd.DataFrame) -> str:
    """Return what running some cells again has shown; `checked` is from `check_cells`."""
    agree = int(checked["agrees"].sum())
    chance = int((~checked["agrees"] & checked["sensitive"]).sum())
    wrong = len(checked) - agree - chance
    said = (
        f"Of {_count(len(checked), 'cell')} drawn at random and run again singly at a tolerance of "
        f"{CHECK_RTOL:.0e}, {agree} agree to {100.0 * AGREEMENT:g} % of the peak tilt"
    )
    if chance:
        said += (
            f", {chance} {_is(chance)} a matter of chance (a record nudged by {NUDGE:.0e} changes as much)"
        )
    return f"{said}, {wrong} {'does' if wrong == 1 else 'do'} not." if wrong else f"{said}."


def search_statement(spectrum: OverturningSpectrum, lowest: pd.DataFrame) -> str:
    """Return how the lowest intensities were found, and what they are worth.

    Parameters
    ----------
    spectrum : OverturningSpectrum
    lowest : DataFrame
        From `confirm_lowest`.
    """
    said = (
        "The lowest intensities were searched from the threshold of uplift up "
        f"({spectrum.searched_from[SPATIAL]:.3g} g tan alpha in 3D), in steps of {spectrum.search_step:g}, "
        "down to a sixteenth of it where the tilt changes fast. All that was run below the lowest stands; a "
        "narrower window of overturning may lie in between."
    )
    found = lowest[(lowest["series"] == SPATIAL) & np.isfinite(lowest["intensity"])]
    if not len(found):
        return said
    spacing = float(np.diff(spectrum.intensities).max(initial=0.0))
    missed = int((found["intensity"] < found["on_grid"].fillna(math.inf) - spacing).sum())
    said += (
        f" Of {_count(len(found), 'size')} that overturn in 3D {missed} {'does' if missed == 1 else 'do'} so "
        "more than a step of the grid below the lowest cell of the grid that does."
    )
    chance = found[~found["confirmed"]]
    if not len(chance):
        return f"{said} All overturn again at a tolerance of {CHECK_RTOL:.0e}."
    return (
        f"{said} {len(chance)}, with R from {chance['semidiagonal'].min():.3g} to "
        f"{chance['semidiagonal'].max():.3g} m, {_is(len(chance))} a matter of chance: they stand there at a "
        f"tolerance of {CHECK_RTOL:.0e} or under a record nudged by {NUDGE:.0e}."
    )


def _headline(every: Any) -> str:
    return (
        f"In 3D the cylinder overturns in {_percent(every.falls)} of {int(every.cells)} cells, in at least "
        f"one plane in {_percent(every.planar_falls)}. Planar analysis is unconservative in "
        f"{_percent(every.missed)} of the cells (3D overturns, neither planar run does) and conservative "
        f"in {_percent(every.overcalled)} (a planar run overturns, 3D does not)."
    )


def _by_size(contrast: pd.DataFrame) -> str:
    bands = contrast.iloc[:-1]
    worst = bands.iloc[int(bands["missed"].argmax())]
    wrong = bands[bands["missed"] > bands["overcalled"]]
    more = ", ".join(f"{row.smallest:.3g} to {row.largest:.3g} m" for _, row in wrong.iterrows())
    return (
        f"It misses most at R = {worst.smallest:.3g} to {worst.largest:.3g} m, {_percent(worst.missed)} "
        f"of the cells there. It misses more cells than it overcalls at {more}."
        if more
        else "In no band of sizes does it miss more cells than it overcalls."
    )


def _edges(spectrum: OverturningSpectrum, every: Any) -> str:
    start = unconservative_from(spectrum)
    sentence = (
        f"The lowest intensity found to overturn is lower in 3D than in both planes at "
        f"{_percent(every.lower_edge)} of the sizes, and higher than in one of them at "
        f"{_percent(every.higher_edge)}"
    )
    if math.isnan(start):
        return f"{sentence}."
    return f"{sentence}; from R = {start:.3g} m on it is lower in 3D at every size."


def _islands(spectrum: OverturningSpectrum) -> str:
    closed = [island for island in islands_of(spectrum)[SPATIAL] if island.closed]
    if not closed:
        return "No cylinder that a weaker shaking overturns in 3D stands a stronger one and falls again."
    sizes = len({island.semidiagonal for island in closed})
    widest = max(closed, key=lambda island: island.upper - island.lower)
    return (
        f"Above its lowest overturning intensity in 3D a cylinder stands again in "
        f"{_count(len(closed), 'safe island')} at {sizes} of {len(spectrum.semidiagonals)} sizes; the "
        f"widest reaches from {widest.lower:.2f} to {widest.upper:.2f} g tan alpha at "
        f"R = {widest.semidiagonal:.3g} m. A run that stands proves nothing for weaker shaking."
    )


def _percent(share: float) -> str:
    return f"{100.0 * share:.1f} %"


def _count(number: int, what: str) -> str:
    return f"{number} {what}{'' if number == 1 else 's'}"


def _is(number: int) -> str:
    return "is" if number == 1 else "are"
