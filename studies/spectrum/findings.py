"""Findings of a spectrum, from the numbers of its tables."""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping

import numpy as np
import pandas as pd

from rockwobble.compare.metrics.mode import mode_findings
from rockwobble.models.finding import Finding, Value
from rockwobble.models.mode import ROCKS_AND_SLIDES, expected_mode

from .maps import TiltMaps
from .parts import SPATIAL
from .search import gap_bound
from .verification import CHECK_RTOL, NUDGE, SAME_PEAK, unconservative_from


def spectrum_findings(spectrum: TiltMaps, tables: Mapping[str, pd.DataFrame]) -> Iterator[Finding]:
    """Findings: which motion, what overturns, where planar analysis differs, how far both are reliable."""
    yield from _mode(spectrum)
    every = tables["contrast"].iloc[-1]
    if not every["cells"]:
        yield Finding(key="spectrum.unsolved", level="not tested")
        return
    shares = {f"share_{name}": float(every[name]) for name in ("unconservative", "conservative")}
    values: dict[str, Value] = {"share": float(every["overturned"]), "count": int(every["cells"]), **shares}
    yield Finding(key="spectrum.overturned", values=values)
    if any(np.isfinite(lowest).any() for lowest in spectrum.lowest.values()):
        yield from _boundary(spectrum, tables)
    if failed := int(spectrum.failed().sum()):
        yield Finding(key="spectrum.failed", level="caution", values={"count": failed})
    yield from _search(spectrum, tables["lowest"])
    checked = tables["checked"]
    agree, chance = int(checked["agrees"].sum()), int((~checked["agrees"] & checked["sensitive"]).sum())
    values = {"bound": CHECK_RTOL, "count": len(checked), "count_agree": agree, "share": SAME_PEAK}
    others = {"count_chance": chance or None, "count_other": len(checked) - agree - chance or None}
    yield Finding(key="spectrum.checked", values=values | others)


def _mode(spectrum: TiltMaps) -> Iterator[Finding]:
    """Findings on the mode under the strongest shaking, where the friction is given."""
    if spectrum.plan.friction is None:
        return
    case = spectrum.case(float(spectrum.semidiagonals[0]), float(spectrum.scales[-1]))
    yield from mode_findings(case, spectrum.plan.support)
    if expected_mode(case, spectrum.plan.support) == ROCKS_AND_SLIDES:
        yield Finding(key="mode.no_engine", level="not tested")


def _boundary(spectrum: TiltMaps, tables: Mapping[str, pd.DataFrame]) -> Iterator[Finding]:
    """Findings on the overturning boundary in 3D compared with both planes, and on safe gaps above it."""
    bands, every = tables["contrast"].iloc[:-1], tables["contrast"].iloc[-1]
    shares = {f"share_{name}": float(every[f"{name}_edge"]) for name in ("lower", "higher")}
    yield Finding(key="spectrum.boundary", values={**shares, "length": unconservative_from(spectrum)})
    wrong = bands[bands["unconservative"] > bands["conservative"]]
    if len(wrong):
        names = tuple(f"{band.smallest:.3g} to {band.largest:.3g} m" for band in wrong.itertuples())
        yield Finding(key="spectrum.unconservative", level="caution", values={"names": names})
    closed = tables["gaps"][tables["gaps"]["closed"] & (tables["gaps"]["series"] == SPATIAL)]
    if len(closed):
        widest = closed.iloc[int((closed["upper"] - closed["lower"]).argmax())]
        counts = {"count": len(closed), "count_sizes": closed["semidiagonal"].nunique()}
        ends = {"intensity": float(widest["lower"]), "intensity_end": float(widest["upper"])}
        size = {"length": float(widest["semidiagonal"])}
        yield Finding(
            key="spectrum.gaps", values={**counts, "count_all": len(spectrum.semidiagonals), **ends, **size}
        )


def _search(spectrum: TiltMaps, lowest: pd.DataFrame) -> Iterator[Finding]:
    """Findings on the search for the boundary: its resolution, missed windows, and sensitive cells."""
    space, sizes = lowest[lowest["series"] == SPATIAL], len(spectrum.semidiagonals)
    overturned = space[np.isfinite(space["intensity"])]
    steps = {"intensity": spectrum.searched_from[SPATIAL], "intensity_step": spectrum.plan.search_step}
    yield Finding(key="spectrum.search", values=steps)
    if probes := spectrum.plan.probes:
        values: dict[str, Value] = {"count": probes, "share": gap_bound(probes)}
        values |= {"count_lowered": int((space["overturned_below"] > 0).sum()), "count_all": sizes}
        yield Finding(key="spectrum.probes", values=values)
    if len(overturned):
        spacing = float(np.diff(spectrum.intensities).max(initial=0.0))
        unseen = int((overturned["intensity"] < overturned["on_grid"].fillna(math.inf) - spacing).sum())
        yield Finding(key="spectrum.unseen", values={"count": unseen, "count_all": len(overturned)})
    chance = overturned.loc[~overturned["confirmed"].astype(bool), "semidiagonal"]
    if len(chance):
        ends = {"length": float(chance.min()), "length_end": float(chance.max())}
        bounds = {"bound": CHECK_RTOL, "bound_nudge": NUDGE}
        yield Finding(key="spectrum.chance", level="caution", values={"count": len(chance), **ends, **bounds})
