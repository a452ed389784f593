"""The page of the paper's figures: what is kept of them, and the report on it."""

from __future__ import annotations

from collections import Counter
from dataclasses import dataclass

from rockwobble.compare.runs.progress import ProgressCallback, Stages
from rockwobble.compare.storage.manifest import Number
from rockwobble.compare.storage.provenance import code_digests, fingerprint, package_versions
from rockwobble.compare.storage.results import Results
from rockwobble.compare.studies.spectrum.maps import maps_of, tilt_maps
from rockwobble.compare.studies.spectrum.study import tables_of

from ..pages.page import Page
from ..pages.spectrum import spectrum_values
from . import earthquake, free, overturning, period, pictures
from .statement import from_frame, to_frame

KIND = "paper"
_SAMPLES = 12_000  # of figure 5 that are kept


@dataclass(frozen=True, kw_only=True, eq=False, repr=False)
class Paper(Results, kind=KIND):
    """The figures of the paper, computed again, and verdicts on what it says of them.

    Attributes
    ----------
    figure-3, figure-4, figure-5 : DataFrame
        What the figures show.
    statements : DataFrame
        Numbers of each statement and its verdict, see `to_frame`.
    spectrum, record, lowest, gaps, contrast, checked : DataFrame
        Figure 6, see `OverturningSpectrum`.
    """

    def headline(self) -> dict[str, Number]:
        """Return the number of statements with each verdict."""
        return {**Counter(each.verdict for each in from_frame(self.statements))}


def compute(grid: int, progress: ProgressCallback | None = None) -> Paper:
    """Run figures 3 to 6, the last on `grid` sizes and as many intensities."""
    stage = Stages(progress, [1.0, 20.0, 40.0, 0.005 * grid * grid]).stage
    with stage("figure 3"):
        curves = period.periods()
    with stage("figure 4"):
        modes = free.free_modes()
    with stage("figure 5"):
        shaken = earthquake.shaken()
    with stage("figure 6"):
        spectrum = tilt_maps(**overturning.problem(grid))
    found = [
        *period.statements(curves),
        *free.statements(modes),
        *earthquake.statements(shaken),
        *overturning.statements(spectrum),
    ]
    tables = {
        "figure-3": curves,
        "figure-4": free.to_frame(modes),
        "figure-5": free.drawn_samples(shaken.trace, _SAMPLES),
        "statements": to_frame(found),
        **tables_of(spectrum),
    }
    inputs = fingerprint([grid, code_digests(), package_versions()])
    return Paper(tables=tables, facts=spectrum.facts() | {"inputs": inputs})


def page_of(paper: Paper) -> Page:
    """Return the page of the figures."""
    tables, spectrum = paper.tables, maps_of(paper.tables, paper.facts)
    found = {each.name: each for each in from_frame(paper.statements)}
    shaken = {**found["abrupt"].numbers, "time_step": spectrum.motion.time_step}
    return Page(
        name="paper",
        template="paper",
        values={
            **spectrum_values(spectrum, tables),
            "statements": found,
            "cylinder": free.CYLINDER,
            "release": free.RELEASE,
            "about": paper.manifest,
        },
        pictures=[
            pictures.period_picture(tables["figure-3"]),
            pictures.free_picture(tables["figure-4"]),
            pictures.earthquake_picture(tables["figure-5"], tables["record"], shaken),
            pictures.overturning_picture(spectrum),
        ],
    )
