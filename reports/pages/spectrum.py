"""Values for the page of a spectrum: its words are in the template spectrum.md.j2."""

from __future__ import annotations

import math
from collections.abc import Mapping

import numpy as np
import pandas as pd

from rockwobble.compare.studies.spectrum.maps import TiltMaps
from rockwobble.compare.studies.spectrum.parts import SPATIAL
from rockwobble.compare.studies.spectrum.search import gap_bound
from rockwobble.compare.studies.spectrum.study import (
    CHECK_RTOL,
    NUDGE,
    SAME_PEAK,
    OverturningSpectrum,
    unconservative_from,
)
from rockwobble.models.support import support_named

from ..figures.spectrum import pictures
from .page import Page


def page_of(found: OverturningSpectrum) -> Page:
    """Return the page of a spectrum."""
    values = {**spectrum_values(found.maps, found.tables), "about": found.manifest}
    return Page(name="spectrum", template="spectrum", values=values, pictures=pictures(found))


def spectrum_values(spectrum: TiltMaps, tables: Mapping[str, pd.DataFrame]) -> dict[str, object]:
    """Return the values of the templates of a spectrum, for its own page and for that of the paper."""
    contrast, checked = tables["contrast"], tables["checked"]
    bands, every = contrast.iloc[:-1], contrast.iloc[-1]
    return {
        "spectrum": spectrum,
        "holds": support_named(spectrum.support),
        "cell_rows": contrast.assign(
            band=[f"{row.smallest:.3g} to {row.largest:.3g}" for row in contrast.itertuples()]
        )
        .replace(math.inf, math.nan)
        .to_dict("records"),
        "every": every,
        "wrong": bands[bands["unconservative"] > bands["conservative"]].to_dict("records"),
        "overturns": any(np.isfinite(lowest).any() for lowest in spectrum.lowest.values()),
        "unconservative_from": unconservative_from(spectrum),
        "gaps": _gaps(tables["gaps"]),
        "failed": int(spectrum.failed().sum()),
        "search": _search(spectrum, tables["lowest"]),
        "checked": {
            "count": len(checked),
            "agree": int(checked["agrees"].sum()),
            "chance": int((~checked["agrees"] & checked["sensitive"]).sum()),
        },
        "tolerance": CHECK_RTOL,
        "nudge": NUDGE,
        "agreement": SAME_PEAK,
    }


def _gaps(gaps: pd.DataFrame) -> dict[str, object] | None:
    closed = gaps[gaps["closed"] & (gaps["series"] == SPATIAL)]
    if not len(closed):
        return None
    widest = closed.iloc[int((closed["upper"] - closed["lower"]).argmax())]
    return {"count": len(closed), "sizes": closed["semidiagonal"].nunique(), "widest": widest}


def _search(spectrum: TiltMaps, lowest: pd.DataFrame) -> dict[str, object]:
    space = lowest[lowest["series"] == SPATIAL]
    found = space[np.isfinite(space["intensity"])]
    spacing = float(np.diff(spectrum.intensities).max(initial=0.0))
    chance = found[~found["confirmed"].astype(bool)]
    return {
        "start": spectrum.searched_from[SPATIAL],
        "found": len(found),
        "unseen": int((found["intensity"] < found["on_grid"].fillna(math.inf) - spacing).sum()),
        "lowered": int((space["overturned_below"] > 0).sum()),
        "gap": gap_bound(spectrum.probes) if spectrum.probes else 1.0,
        "chance": len(chance),
        "chance_from": chance["semidiagonal"].min(),
        "chance_to": chance["semidiagonal"].max(),
    }
