"""Tables of an overturning spectrum, with its verification, and its manifest."""

from __future__ import annotations

from collections.abc import Mapping

import pandas as pd

from rockwobble.models.records.plausibility import doubts_of

from ...storage.fingerprint import fingerprint
from ...storage.manifest import Manifest, made_now
from ...storage.provenance import reduced_makers
from .planar_contrast import planar_contrast
from .result import KIND, OverturningSpectrum, record_frame, safe_islands
from .verification import check_cells, confirm_lowest


def tables_of(spectrum: OverturningSpectrum) -> dict[str, pd.DataFrame]:
    """Return the tables of a spectrum by name; cells and lowest intensities are verified for them."""
    return {
        "spectrum": spectrum.to_frame(),
        "record": record_frame(spectrum.motion),
        "lowest": confirm_lowest(spectrum),
        "islands": safe_islands(spectrum),
        "contrast": planar_contrast(spectrum),
        "checked": check_cells(spectrum),
    }


def manifest_of(
    spectrum: OverturningSpectrum, tables: Mapping[str, pd.DataFrame], command: str = ""
) -> Manifest:
    """Return the manifest of a spectrum, with what planar analysis misses as headline."""
    grid = spectrum.semidiagonals, spectrum.intensities
    every = tables["contrast"].iloc[-1]
    return made_now(
        KIND,
        inputs=fingerprint([spectrum.facts(), *grid, spectrum.motion.acceleration, reduced_makers()]),
        command=command,
        headline={
            "cells": int(every["cells"]),
            "share that overturns in 3D": float(every["overturned"]),
            "share that overturns in 3D and in neither plane": float(every["missed"]),
            "share that overturns in a plane and not in 3D": float(every["overcalled"]),
        },
        about=spectrum.facts() | {"doubts": doubts_of([spectrum.motion])},
    )
