"""Result of a fragility, made from its runs."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, fields, replace
from typing import Any, ClassVar

import pandas as pd

from rockwobble.models.shown import Shown

from ...storage.manifest import Manifest, Results, made_now
from .efficiency import efficiency_table
from .fit import TOO_FEW
from .islands import island_table
from .limits import OVERTURNED
from .resampling import resamples
from .samples import blocks_of
from .tables import contrast_table, count_table, curve_table, curves_of, fit_table

KIND = "fragility"
# a curve is stated of no fewer: of four motions a median has no ends, and of one level no slope
FEWEST_MOTIONS, FEWEST_LEVELS = 6, 2
_COUNTED = ("cylinder", "method", "limit", "runs", "exceeded", "failed")


@dataclass(frozen=True, slots=True, kw_only=True, eq=False, repr=False)
class Fragility(Shown):
    """Probabilities of exceeding limits by several methods, under the same motions.

    Intervals are of 95 %, by resampling the motions; their ends are in columns NAME_low and NAME_high.

    Parameters
    ----------
    runs : DataFrame
        One row for each cylinder, motion, step (place of the level) and method: peak_tilt [alpha], outcome,
        contact_lost (1, 0, NaN where nobody asked).
    points : DataFrame
        One row for each cylinder, motion and step: scale, and every intensity of `MEASURES`.
    counts : DataFrame
        n runs and k that exceed a limit, by cylinder, method, limit and intensity.
    fits : DataFrame
        One row for each cylinder, method and limit: kind ("fitted", "never", "always", "separated", "not
        increasing"; of fewer motions or levels than a curve takes "too few", and no number but counts; then
        the tables below are empty), median, dispersion, runs, exceeded, failed, extrapolated, without_curve
        (share of the resamples), and of the goodness of fit deviance, degrees, p and largest (difference of
        share and curve).
    curves : DataFrame
        The curves point by point: intensity, probability, low, high.
    contrasts : DataFrame
        One row for each two methods: ratio of the medians, dispersion_difference, within (least margin that
        holds the interval of the ratio), verdict for the margin that was stated.
    efficiency : DataFrame
        Dispersion of the first method by each measure, and over that of the best.
    islands : DataFrame
        Motions that overturn a cylinder which stands under the same motion made stronger, and bias of the
        median of an analysis that stops at the first overturning.
    about : mapping
        What the tables do not hold: cylinders, methods, measure, levels, margin, seed, and the hash of all
        inputs.

    Examples
    --------
    >>> import rockwobble as rw
    >>> pier = rw.Cylinder(semidiagonal=6.0, tan_alpha=0.2)
    >>> from rockwobble.compare import synthetic_motions
    >>> shaking = synthetic_motions(6, peak=1.0, seed=1)
    >>> found = rw.fragility(pier, shaking, methods=["recess"], levels=[2, 4, 8], resamples=20, workers=1)
    >>> overturned = found.fits[found.fits["limit"] == "overturned"]
    >>> overturned[["method", "runs", "exceeded"]].to_dict("records")
    [{'method': 'recess model', 'runs': 18, 'exceeded': 10}]
    """

    _figures: ClassVar[str] = "fragility"
    runs: pd.DataFrame
    points: pd.DataFrame
    counts: pd.DataFrame
    fits: pd.DataFrame
    curves: pd.DataFrame
    contrasts: pd.DataFrame
    efficiency: pd.DataFrame
    islands: pd.DataFrame
    about: Mapping[str, Any]

    def _said(self) -> dict[str, str]:
        runs = self.runs
        return {
            "cylinders": str(runs["cylinder"].nunique()),
            "motions": str(runs["motion"].nunique()),
            "runs": str(len(runs)),
            "failed": str(int((runs["outcome"] == "failed").sum())),
            "methods": ", ".join(dict.fromkeys(runs["method"])),
        }

    @property
    def tables(self) -> dict[str, pd.DataFrame]:
        """The tables by name."""
        return {field.name: getattr(self, field.name) for field in fields(self) if field.name != "about"}


def fragility_of(runs: pd.DataFrame, points: pd.DataFrame, about: Mapping[str, Any]) -> Fragility:
    """Return the fragility by the runs of the plan that `about` states."""
    if (runs["outcome"] == "failed").all():
        raise ValueError(f"a fragility needs runs that do not fail, got {len(runs)} runs that all failed")
    blocks = blocks_of(runs, points, about["limits"], str(about["measure"]))
    weights = resamples(len(blocks.motions), int(about["resamples"]), int(about["seed"]))
    fitted, drawn = curves_of(blocks), curves_of(blocks, weights)
    found = Fragility(
        runs=runs,
        points=points,
        counts=count_table(blocks),
        fits=fit_table(blocks, fitted, drawn),
        curves=curve_table(blocks, fitted, drawn),
        contrasts=contrast_table(blocks, fitted, drawn, weights, float(about["margin"])),
        efficiency=efficiency_table(blocks, blocks.methods[0], weights),
        islands=island_table(blocks, weights),
        about=about,
    )
    levels = points.groupby("cylinder")[blocks.measure].nunique()
    enough = len(blocks.motions) >= FEWEST_MOTIONS and levels.min() >= FEWEST_LEVELS
    return found if enough else _counts_alone(found)


def _counts_alone(found: Fragility) -> Fragility:
    """Return a fragility of too few motions or levels: what was counted, and nothing fitted."""
    fits = found.fits.assign(kind=TOO_FEW, extrapolated=False)
    fitted = fits.columns.difference([*_COUNTED, "kind", "extrapolated"])
    fits[fitted] = float("nan")
    tables = ("curves", "contrasts", "efficiency", "islands")
    return replace(found, fits=fits, **{name: getattr(found, name).iloc[:0] for name in tables})


def stored_fragility(results: Results) -> Fragility:
    """Return the fragility that is stored in a folder."""
    names = [field.name for field in fields(Fragility) if field.name != "about"]
    return Fragility(**{name: results.table(name) for name in names}, about=results.manifest.about)


def manifest_of(found: Fragility, command: str = "") -> Manifest:
    """Return the manifest of a fragility, with its medians and the contrasts of overturning as headline."""
    fits = found.fits[found.fits["limit"] == OVERTURNED]
    headline = {
        f"{row['cylinder']}, {row['method']}, overturned of {row['runs']}": row["exceeded"]
        if row["kind"] == TOO_FEW
        else row["median"]
        for row in fits.to_dict("records")
    } | {
        f"{row['cylinder']}, {row['method']} / {row['against']}": row["ratio"]
        for row in found.contrasts.to_dict("records")
        if row["limit"] == OVERTURNED
    }
    return made_now(
        KIND,
        inputs=str(found.about["inputs"]),
        command=command,
        seeds={"resamples": int(found.about["seed"])},
        headline=headline,
        about=found.about,
    )
