"""The page of a spectrum, in Markdown."""

from __future__ import annotations

from typing import TYPE_CHECKING

from rockwobble.compare.studies.spectrum.planar_contrast import planar_contrast
from rockwobble.compare.studies.spectrum.study import OverturningSpectrum

from ..provenance import made_by
from .words import HEADINGS, LEGEND, check_statement, search_statement, statements, table_cells

if TYPE_CHECKING:
    import pandas as pd


def spectrum_page(spectrum: OverturningSpectrum, checked: pd.DataFrame, lowest: pd.DataFrame) -> str:
    """Return picture, table and sentences; the picture is spectrum.svg beside the page.

    Parameters
    ----------
    spectrum : OverturningSpectrum
    checked, lowest : DataFrame
        From `check_cells` and `confirm_lowest`.
    """
    motion = spectrum.motion.name or "the record"
    sizes, levels = spectrum.semidiagonals, spectrum.intensities
    return "\n\n".join(
        (
            f"# Overturning spectrum: {motion}, tan α = {spectrum.tan_alpha:g}",
            f"{len(sizes)} sizes from R = {sizes[0]:g} m to {sizes[-1]:g} m; {motion} scaled to "
            f"{len(levels)} peaks of the horizontal resultant from {levels[0]:g} to {levels[-1]:g} g tan α. "
            f"3D is the {spectrum.model} model under both components; a planar run takes one component of "
            "the same shaking alone, without loss at impact.",
            "![Peak tilt over size and intensity, and the lowest intensity found to overturn](spectrum.svg)",
            *statements(spectrum),
            search_statement(spectrum, lowest),
            markdown_table(HEADINGS, table_cells(planar_contrast(spectrum))),
            LEGEND,
            check_statement(checked),
            "The cells are in spectrum.parquet, the lowest intensities found to overturn in lowest.parquet, "
            "the safe islands in islands.parquet, this table in contrast.parquet, the cells run again in "
            f"checked.parquet. {made_by()}",
            "",
        )
    )


def markdown_table(headings: tuple[str, ...], rows: list[tuple[str, ...]]) -> str:
    """Return a table in Markdown, its first column to the left and the others to the right."""
    lines = [headings, ("---", *["---:"] * (len(headings) - 1)), *rows]
    return "\n".join(f"| {' | '.join(cells)} |" for cells in lines)
