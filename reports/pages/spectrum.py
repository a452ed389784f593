"""The page of a spectrum."""

from __future__ import annotations

import math

from rockwobble.models.support import support_named
from rockwobble.studies.spectrum.study import OverturningSpectrum

from ..figures.spectrum import pictures
from .page import Page
from .wording import statement

_ANSWERS = ("mode.", "spectrum.unsolved", "spectrum.overturned")


def page_of(spectrum: OverturningSpectrum) -> Page:
    """Page of a spectrum."""
    values = {**spectrum_values(spectrum), "about": spectrum.manifest}
    return Page(name="spectrum", template="spectrum", values=values, pictures=pictures(spectrum))


def spectrum_values(spectrum: OverturningSpectrum) -> dict[str, object]:
    """Template values of a spectrum, for its page and for the paper's page."""
    contrast = spectrum.tables["contrast"]
    said = {each.key: statement(each) for each in spectrum.findings()}
    return {
        "spectrum": spectrum.maps,
        "holds": support_named(spectrum.maps.plan.support),
        "cell_rows": contrast.assign(
            band=[f"{row.smallest:.3g} to {row.largest:.3g}" for row in contrast.itertuples()]
        )
        .replace(math.inf, math.nan)
        .to_dict("records"),
        "answers": [line for key, line in said.items() if key.startswith(_ANSWERS)],
        "findings": [line for key, line in said.items() if not key.startswith(_ANSWERS)],
    }
