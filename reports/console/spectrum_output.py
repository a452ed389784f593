"""A spectrum with its progress shown, and what becomes of it: a table, sentences, files."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray
from rich import box
from rich.console import Console
from rich.table import Table

from rockwobble.compare.storage.fingerprint import fingerprint
from rockwobble.compare.storage.provenance import reduced_makers
from rockwobble.compare.studies.spectrum.lowest_overturning import STEP, islands_frame
from rockwobble.compare.studies.spectrum.planar_contrast import planar_contrast
from rockwobble.compare.studies.spectrum.series import SERIES
from rockwobble.compare.studies.spectrum.study import OverturningSpectrum, overturning_spectrum
from rockwobble.models import Cylinder, GroundMotion

from ..figures.spectrum_figure import TITLES, spectrum_figure
from ..pages.provenance import parquet
from ..pages.spectrum.page import spectrum_page
from ..pages.spectrum.words import (
    HEADINGS,
    LEGEND,
    check_statement,
    islands_of,
    search_statement,
    statements,
    table_cells,
)
from .spectrum_progress import shown_fraction
from .summary_table import MINIMUM_WIDTH

if TYPE_CHECKING:
    import pandas as pd

Array = NDArray[np.float64]

# cells run again singly: enough to find one wrong cell in twenty almost surely, in half a second
CHECKED_CELLS = 60


def describe_grid(
    tan_alpha: float, motion: GroundMotion, *, semidiagonals: Array, intensities: Array
) -> list[str]:
    """Return the lines that echo a grid: what was understood, in numbers."""
    first, last = (Cylinder(semidiagonal=float(semidiagonals[i]), tan_alpha=tan_alpha) for i in (0, -1))
    return [
        f"Cylinders: {len(semidiagonals)} sizes, R = {first.semidiagonal:g} to {last.semidiagonal:g} m, "
        f"b = {first.base_radius:.4g} to {last.base_radius:.4g} m, "
        f"2h = {2.0 * first.half_height:.4g} to {2.0 * last.half_height:.4g} m, "
        f"alpha = {math.degrees(first.alpha):.4g} deg (tan alpha = {tan_alpha:g})",
        f"Ground: {motion.name or 'record'}, {motion.acceleration.shape[1]} components, "
        f"{motion.duration:.4g} s, peak resultant {motion.peak:.4g} m/s^2",
        f"Intensities: {len(intensities)}, the record scaled to a peak resultant of {intensities[0]:g} to "
        f"{intensities[-1]:g} g tan alpha, {intensities[0] * tan_alpha:.3g} to "
        f"{intensities[-1] * tan_alpha:.3g} g",
    ]


def run_spectrum(
    tan_alpha: float,
    motion: GroundMotion,
    *,
    semidiagonals: Array,
    intensities: Array,
    model: str = "recess",
    search_step: float = STEP,
) -> OverturningSpectrum:
    """Run a spectrum with progress shown."""
    with shown_fraction([TITLES[series] for series in SERIES]) as tell:
        return overturning_spectrum(
            tan_alpha,
            motion,
            semidiagonals=semidiagonals,
            intensities=intensities,
            model=model,
            search_step=search_step,
            progress=lambda series, fraction: tell(TITLES[series], fraction),
        )


def print_spectrum(result: OverturningSpectrum, checked: pd.DataFrame, lowest: pd.DataFrame) -> None:
    """Print the table by size, and what the spectrum says in words."""
    table = Table(box=box.SIMPLE_HEAD, padding=(0, 1, 0, 0), pad_edge=False)
    for i, heading in enumerate(HEADINGS):
        # a narrow terminal has room for one word of a heading
        name = heading.replace(" ", "\n") if i else heading
        table.add_column(name, justify="right" if i else "left", no_wrap=True)
    for cells in table_cells(planar_contrast(result)):
        table.add_row(*cells)
    console = Console()
    if not console.is_terminal:
        console.width = max(console.width, MINIMUM_WIDTH)
    console.print()
    console.print(table)
    console.print(LEGEND, style="dim", highlight=False)
    console.print()
    for i, sentence in enumerate(statements(result)):
        console.print(sentence, style="bold" if i == 0 else "", highlight=False, markup=False)
    for sentence in (search_statement(result, lowest), check_statement(checked)):
        console.print(sentence, highlight=False, markup=False)


def spectrum_files(
    result: OverturningSpectrum, checked: pd.DataFrame, lowest: pd.DataFrame
) -> dict[str, bytes]:
    """Return the files of a spectrum by name."""
    tables = {
        "spectrum": result.to_frame(),
        "lowest": lowest,
        "islands": islands_frame(islands_of(result)),
        "contrast": planar_contrast(result),
        "checked": checked,
    }
    inputs = _inputs(result)
    return {
        "spectrum.md": spectrum_page(result, checked, lowest).encode(),
        "spectrum.svg": spectrum_figure(result),
        **{f"{name}.parquet": parquet(table, f"rockwobble {name}", inputs) for name, table in tables.items()},
    }


def _inputs(result: OverturningSpectrum) -> str:
    """Return the hash of all that a spectrum depends on."""
    names = ("tan_alpha", "gravity", "model", "rest_tilt", "semidiagonals", "intensities", "search_step")
    return fingerprint(
        {
            "motion": (result.motion.acceleration, result.motion.time_step),
            **{name: getattr(result, name) for name in names},
            "made with": reduced_makers(),
        }
    )
