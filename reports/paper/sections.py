"""Each figure of the paper: run, picture, claims and data."""

from __future__ import annotations

from rockwobble.compare.studies.spectrum.lowest_overturning import islands_frame
from rockwobble.compare.studies.spectrum.planar_contrast import planar_contrast
from rockwobble.compare.studies.spectrum.verification import check_cells, confirm_lowest

from ..console.spectrum_output import CHECKED_CELLS, run_spectrum
from ..figures.spectrum_figure import spectrum_figure
from ..pages.spectrum.words import check_statement, islands_of, search_statement, statements
from . import earthquake, earthquake_claims, free, overturning, period
from .page import Section


def period_section() -> Section:
    """Run figure 3."""
    data = period.periods()
    return Section(
        number=3,
        title="period of steady wobble over the tilt",
        text="Time in which the contact point goes once round the rim at constant tilt, times p, for bodies "
        "from slender to flat; and the full period of planar rocking released at that tilt, exact "
        "(dashed) and linearised after Housner (dotted), which does not depend on α.",
        claims=period.period_claims(data),
        svg=period.period_figure(data),
        tables={"figure-3.parquet": data.to_frame()},
    )


def free_section() -> Section:
    """Run figure 4."""
    data = free.free_modes()
    cylinder = free.CYLINDER
    return Section(
        number=4,
        title="three modes of free response",
        text=f"R = {cylinder.semidiagonal:g} m, tan α = {cylinder.tan_alpha:g}, released at "
        f"{free.RELEASE:g} α. Above, the path of the centre of mass seen from above, from the dot on. The "
        "paper gives neither the tilt of release nor the spins of its first and last mode.",
        claims=free.free_claims(data),
        svg=free.free_figure(data),
        tables={"figure-4.parquet": data.to_frame()},
    )


def earthquake_section() -> Section:
    """Run figure 5."""
    data = earthquake.shaken()
    cylinder = earthquake.CYLINDER
    return Section(
        number=5,
        title="response to the 1940 El Centro record",
        text=f"R = {cylinder.semidiagonal:g} m, tan α = {cylinder.tan_alpha:g}; x is the east-west and y the "
        "north-south component of PEER record RSN6, whose peak depends on its processing: the paper does "
        f"not say which it used. {earthquake_claims.sensitivity(data)}",
        claims=earthquake_claims.earthquake_claims(data),
        svg=earthquake.earthquake_figure(data),
        tables={"figure-5.parquet": data.to_frame()},
    )


def overturning_section(grid: int = overturning.GRID) -> Section:
    """Run figure 6 on a grid of `grid` sizes and as many intensities."""
    spectrum = run_spectrum(**overturning.problem(grid))
    checked, lowest = check_cells(spectrum, CHECKED_CELLS), confirm_lowest(spectrum)
    return Section(
        number=6,
        title="overturning spectra of the 1940 El Centro record",
        text=f"Peak tilt of {grid} sizes under {grid} intensities, tan α = {overturning.TAN_ALPHA:g}, in 3D "
        "and of each component alone, undamped; in black the lowest intensity found to overturn. "
        "The three runs of a cell share one factor on the record, so that cells correspond; the scale on the "
        "right of a planar map is the peak of its own component. "
        + " ".join(
            [
                *statements(spectrum),
                search_statement(spectrum, lowest),
                check_statement(checked),
            ]
        ),
        claims=overturning.overturning_claims(spectrum),
        svg=spectrum_figure(spectrum),
        tables={
            "figure-6.parquet": spectrum.to_frame(),
            "figure-6-lowest.parquet": lowest,
            "figure-6-islands.parquet": islands_frame(islands_of(spectrum)),
            "figure-6-contrast.parquet": planar_contrast(spectrum),
            "figure-6-checked.parquet": checked,
        },
    )
