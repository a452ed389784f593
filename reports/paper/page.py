"""The page of the paper's figures: what is kept of them, and the report on it."""

from __future__ import annotations

from collections import Counter

import pandas as pd

from rockwobble.compare.runs.progress import ProgressCallback, Stages
from rockwobble.compare.storage.fingerprint import fingerprint
from rockwobble.compare.storage.manifest import Manifest, Results, made_now
from rockwobble.compare.storage.provenance import code_digests, package_versions
from rockwobble.compare.studies.spectrum.spectrum import (
    OverturningSpectrum,
    overturning_spectrum,
    stored_spectrum,
)
from rockwobble.compare.studies.spectrum.tables import tables_of

from ..pages.page import Page
from ..pages.spectrum import spectrum_values
from . import earthquake, free, overturning, period, pictures
from .statement import from_frame, to_frame

KIND = "paper"
_SAMPLES = 12_000  # of figure 5 that are kept


def compute(
    grid: int, command: str = "", progress: ProgressCallback | None = None
) -> tuple[Manifest, dict[str, pd.DataFrame], OverturningSpectrum]:
    """Run figures 3 to 6, the last on `grid` sizes and as many intensities, and keep them as tables."""
    stage = Stages(progress, [1.0, 20.0, 40.0, 0.005 * grid * grid]).stage
    with stage("figure 3"):
        curves = period.periods()
    with stage("figure 4"):
        modes = free.free_modes()
    with stage("figure 5"):
        shaken = earthquake.shaken()
    with stage("figure 6"):
        spectrum = overturning_spectrum(**overturning.problem(grid))
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
    headline = dict(Counter(each.verdict for each in found))
    made = made_now(KIND, inputs=inputs, command=command, headline=headline, about=spectrum.facts())
    return made, tables, spectrum


def paper_page(tables: dict[str, pd.DataFrame], manifest: Manifest, spectrum: OverturningSpectrum) -> Page:
    """Return the page of computed or stored tables."""
    found = {each.name: each for each in from_frame(tables["statements"])}
    shaken = {**found["abrupt"].numbers, "time_step": spectrum.motion.time_step}
    return Page(
        name="paper",
        template="paper",
        values={
            **spectrum_values(spectrum, tables),
            "statements": found,
            "cylinder": free.CYLINDER,
            "release": free.RELEASE,
            "about": manifest,
        },
        pictures=[
            pictures.period_picture(tables["figure-3"]),
            pictures.free_picture(tables["figure-4"]),
            pictures.earthquake_picture(tables["figure-5"], tables["record"], shaken),
            pictures.overturning_picture(spectrum),
        ],
    )


def stored_page(results: Results) -> Page:
    """Return the page of what is stored."""
    names = [name.removesuffix(".parquet") for name in results.manifest.files]
    tables = {name: results.table(name) for name in names}
    return paper_page(tables, results.manifest, stored_spectrum(results))
