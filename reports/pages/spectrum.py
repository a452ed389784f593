"""The page of a spectrum: what its tables say, and how far they can be relied on."""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping

import numpy as np
import pandas as pd

from rockwobble.models.support import support_named
from rockwobble.studies.spectrum.maps import TiltMaps
from rockwobble.studies.spectrum.parts import SPATIAL
from rockwobble.studies.spectrum.search import gap_bound
from rockwobble.studies.spectrum.study import (
    CHECK_RTOL,
    NUDGE,
    SAME_PEAK,
    OverturningSpectrum,
    unconservative_from,
)

from ..figures.spectrum import pictures
from .page import Page
from .table import number


def page_of(found: OverturningSpectrum) -> Page:
    """Return the page of a spectrum."""
    values = {**spectrum_values(found.maps, found.tables), "about": found.manifest}
    return Page(name="spectrum", template="spectrum", values=values, pictures=pictures(found))


def spectrum_values(spectrum: TiltMaps, tables: Mapping[str, pd.DataFrame]) -> dict[str, object]:
    """Return the values of the templates of a spectrum, for its own page and for that of the paper."""
    contrast = tables["contrast"]
    solved = bool(contrast.iloc[-1]["cells"])
    return {
        "spectrum": spectrum,
        "holds": support_named(spectrum.support),
        "cell_rows": contrast.assign(
            band=[f"{row.smallest:.3g} to {row.largest:.3g}" for row in contrast.itertuples()]
        )
        .replace(math.inf, math.nan)
        .to_dict("records"),
        "unsolved": "" if solved else "No cell could be solved.",
        "answers": [_answer(contrast.iloc[-1])] if solved else [],
        "findings": list(_findings(spectrum, tables)) if solved else [],
    }


def _answer(every: pd.Series) -> str:
    """How many cells overturn, and in how many planar analysis is another answer."""
    overturned, one, other = (
        number(every[name], "percent") for name in ("overturned", "unconservative", "conservative")
    )
    return (
        f"In 3D the cylinder overturns in {overturned} of {number(every['cells'], 'd')} cells; planar "
        f"analysis is unconservative in {one}, conservative in {other}."
    )


def _findings(spectrum: TiltMaps, tables: Mapping[str, pd.DataFrame]) -> Iterator[str]:
    """Yield what the tables say beside the answer, and how far they can be relied on."""
    if any(np.isfinite(lowest).any() for lowest in spectrum.lowest.values()):
        yield from _boundary(spectrum, tables)
    if failed := int(spectrum.failed().sum()):
        yield f"Cells without an answer (failed, or past yield): {failed}."
    yield from _search(spectrum, tables["lowest"])
    yield _second_run_words(tables["checked"])


def _boundary(spectrum: TiltMaps, tables: Mapping[str, pd.DataFrame]) -> Iterator[str]:
    """Yield how the overturning boundary in 3D lies to those of both planes, and what is above it."""
    bands, every = tables["contrast"].iloc[:-1], tables["contrast"].iloc[-1]
    words = (
        f"Overturning boundary lower in 3D than in both planes: {number(every['lower_edge'], 'percent')} of "
        f"the sizes; higher than in one: {number(every['higher_edge'], 'percent')}"
    )
    if math.isfinite(lower_from := unconservative_from(spectrum)):
        words += f"; lower at every size from R = {number(lower_from)} m on"
    yield f"{words}."
    wrong = bands[bands["unconservative"] > bands["conservative"]]
    if ranges := [f"{number(band.smallest)} to {number(band.largest)} m" for band in wrong.itertuples()]:
        yield f"More cells unconservative than conservative: R = {', '.join(ranges)}."
    closed = tables["gaps"][tables["gaps"]["closed"] & (tables["gaps"]["series"] == SPATIAL)]
    if len(closed):
        widest = closed.iloc[int((closed["upper"] - closed["lower"]).argmax())]
        lower, upper = (number(widest[end], ".2f") for end in ("lower", "upper"))
        yield (
            f"Safe gaps above the boundary in 3D: {len(closed)} at {closed['semidiagonal'].nunique()} of "
            f"{len(spectrum.semidiagonals)} sizes, the widest from {lower} to {upper} g tan α at R = "
            f"{number(widest['semidiagonal'])} m."
        )


def _search(spectrum: TiltMaps, lowest: pd.DataFrame) -> Iterator[str]:
    """Yield how the boundary was searched, what the search may have missed, and what is left to chance."""
    space, sizes = lowest[lowest["series"] == SPATIAL], len(spectrum.semidiagonals)
    found = space[np.isfinite(space["intensity"])]
    words = (
        f"Search of the boundary: from uplift ({number(spectrum.searched_from[SPATIAL])} g tan α in 3D) in "
        f"steps down to {number(spectrum.search_step)} g tan α."
    )
    if spectrum.probes:
        words += (
            f" {spectrum.probes} random intensities below each boundary stand: at most "
            f"{number(gap_bound(spectrum.probes), 'percent')} of all intensities below it overturn (95 %); "
            f"such intensities lowered it at {(space['overturned_below'] > 0).sum()} of {sizes} sizes."
        )
    if len(found):
        spacing = float(np.diff(spectrum.intensities).max(initial=0.0))
        unseen = (found["intensity"] < found["on_grid"].fillna(math.inf) - spacing).sum()
        words += (
            f" {unseen} of {len(found)} sizes overturn more than one step of the grid below the lowest cell "
            "that overturns."
        )
    yield words
    chance = found.loc[~found["confirmed"].astype(bool), "semidiagonal"]
    if len(chance):
        yield (
            f"Boundary left to chance: at {len(chance)} sizes, with R from {number(chance.min())} to "
            f"{number(chance.max())} m (stands at a tolerance of {number(CHECK_RTOL)} or under a record "
            f"changed by {number(NUDGE)})."
        )


def _second_run_words(checked: pd.DataFrame) -> str:
    """How many of the cells that were run again agree, and why the others do not."""
    agree, chance = int(checked["agrees"].sum()), int((~checked["agrees"] & checked["sensitive"]).sum())
    words = (
        f"Cells run again at a tolerance of {number(CHECK_RTOL)}: {len(checked)}, of which {agree} agree to "
        f"{number(SAME_PEAK, 'percent')} of the peak tilt"
    )
    words += f", {chance} are left to chance" if chance else ""
    neither = len(checked) - agree - chance
    return f"{words}{f' and {neither} do not' if neither else ''}."
