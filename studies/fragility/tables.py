"""Tables of a fragility: counts, fits with bands, contrasts of methods, gaps, efficiency.

They are of blocks of motions and levels: where each run exceeds each limit. A gap in the overturning region
is a level at which a motion leaves a cylinder standing that the same motion made weaker overturns. An
incremental analysis raises each motion until the cylinder overturns and stops. What it takes for overturned
above that level may stand, so its curve lies to the left of the one of all levels.
"""

from __future__ import annotations

import itertools
import math
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np
import pandas as pd
from numpy.typing import NDArray

from rockwobble.compare.metrics.statistics import Interval
from rockwobble.models.trace import NO_PEAK

from .fit import (
    EXTRAPOLATED,
    FITTED,
    KINDS,
    ONE_MOTION,
    Array,
    Curves,
    Sample,
    bands,
    goodness,
    interval,
    resamples,
    spread_interval,
)
from .intensity import MEASURES

OVERTURNED, CONTACT_LOST, TENDON_YIELDS, SLIDES = "overturned", "contact_lost", "tendon yields", "slides"
# limits by name: tilt reached [alpha]; NaN if the limit is no tilt
LIMITS: Mapping[str, float] = {
    "uplift": 0.0,
    **{f"{tilt:g} alpha": tilt for tilt in (0.1, 0.25, 0.5, 1.0)},
    **dict.fromkeys((OVERTURNED, CONTACT_LOST, TENDON_YIELDS, SLIDES), math.nan),
}
YIELDED = "yielded"  # outcome of a run of which no more is known than that its tendon yields
DEFAULT_LIMITS = tuple(name for name in LIMITS if name not in (CONTACT_LOST, TENDON_YIELDS, SLIDES))


def exceedance(runs: pd.DataFrame, limit: str) -> NDArray[np.float64]:
    """1 where a run exceeds a limit, 0 where it does not, NaN where unknown.

    Overturned is what the run itself says: the side reaches the ground, or no later ground motion can stop
    it. Such a run exceeds every limit: when in its fall it leaves the ground depends on where a method ends
    the fall. One beyond yield exceeds what it passed before, and no more is known. A cylinder at rest has not
    uplifted; any tilt above zero is uplift.

    Parameters
    ----------
    runs : DataFrame
        Columns peak_tilt [alpha], outcome, contact_lost, slides.
    limit : str
        One of `LIMITS`.
    """
    failed = (runs["outcome"].isin(NO_PEAK) | runs["outcome"].isna()).to_numpy(bool)
    fell, yielded = ((runs["outcome"] == name).to_numpy(bool) for name in (OVERTURNED, YIELDED))
    if limit in (CONTACT_LOST, SLIDES):
        lost = runs[limit].to_numpy(float)
        exceeds = np.where(fell & ~np.isnan(lost), 1.0, lost)
    elif limit in (TENDON_YIELDS, OVERTURNED):
        exceeds = np.where(yielded if limit == TENDON_YIELDS else fell, 1.0, 0.0)
    else:
        peaks, bound = runs["peak_tilt"].to_numpy(float), LIMITS[limit]
        exceeds = np.where(fell | (peaks > 0.0 if bound == 0.0 else peaks >= bound), 1.0, 0.0)
    return np.where(failed | (yielded & (exceeds != 1.0)), np.nan, exceeds)


Key = tuple[str, str, str]  # cylinder, method, limit
Row = dict[str, Any]  # of a table, by the names of its columns


def rows_of(table: pd.DataFrame) -> list[Row]:
    """Rows of a table as dictionaries."""
    return [{str(name): value for name, value in row.items()} for row in table.to_dict("records")]


@dataclass(frozen=True, kw_only=True, eq=False)
class Blocks:
    """Runs as arrays by motion and level.

    Attributes
    ----------
    motions : list of str
        In the order in which they were run.
    points : mapping of str to DataFrame
        Points by cylinder, the S levels of each of R motions one after the other; a row of NaN where a motion
        is not run at a level.
    runs : mapping of (str, str) to DataFrame
        Runs by cylinder and method, in the same order.
    limits : sequence of str
        That are asked about.
    measure : str
        Intensity of the levels.
    """

    motions: list[str]
    points: Mapping[str, pd.DataFrame]
    runs: Mapping[tuple[str, str], pd.DataFrame]
    limits: Sequence[str]
    measure: str

    @property
    def cylinders(self) -> list[str]:
        """Names of the cylinders."""
        return list(self.points)

    @property
    def methods(self) -> list[str]:
        """Labels of the methods."""
        return list(dict.fromkeys(method for _, method in self.runs))

    @cached_property
    def made(self) -> NDArray[np.bool_]:
        """Whether a motion is run at a level (R, S)."""
        return np.isfinite(self.of_points(self.cylinders[0], "scale"))

    @property
    def fewest(self) -> int:
        """Least number of motions at any level."""
        return int(self.made.sum(axis=0).min())

    def weights(self, count: int, seed: int) -> Array:
        """Resamples (count, R) of the motions, stratified by their set of levels."""
        strata = np.unique(self.made, axis=0, return_inverse=True)[1].ravel()
        return resamples(len(self.motions), count, seed, strata=strata)

    def known_keys(self) -> Iterator[Key]:
        """Yield each cylinder, method and limit with any known outcome."""
        for key in itertools.product(self.cylinders, self.methods, self.limits):
            if not np.isnan(self.exceedance(*key)).all():
                yield key

    def sample(self, cylinder: str, method: str, limit: str, measure: str | None = None) -> Sample:
        """Sample of a method and a limit, by one intensity measure; default: that of the levels."""
        x = self.intensities(cylinder, measure or self.measure)
        return Sample(x=x, y=self.exceedance(cylinder, method, limit))

    def exceedance(self, cylinder: str, method: str, limit: str) -> Array:
        """Exceedance indicator (1, 0 or NaN) for each motion and level (R, S)."""
        return exceedance(self.runs[cylinder, method], limit).reshape(len(self.motions), -1)

    def of_points(self, cylinder: str, column: str) -> Array:
        """Column of the points of a cylinder by motion and level (R, S)."""
        return self.points[cylinder][column].to_numpy(float).reshape(len(self.motions), -1)

    def intensities(self, cylinder: str, measure: str) -> Array:
        """Log intensities (R, S), constant in a stripe; the level mean where a run is missing."""
        with np.errstate(divide="ignore"):
            x = np.log(self.of_points(cylinder, measure))
        known = ~np.isnan(x)
        if known.all():
            return x
        return np.where(known, x, np.where(known, x, 0.0).sum(axis=0) / np.maximum(known.sum(axis=0), 1))


def blocks_of(runs: pd.DataFrame, points: pd.DataFrame, limits: Sequence[str], measure: str) -> Blocks:
    """Blocks from a table of runs and the table of its points."""
    motions, places = list(dict.fromkeys(points["motion"])), ["motion", "step"]
    whole = pd.MultiIndex.from_product([motions, range(int(points["step"].max()) + 1)], names=places)

    def grid(part: pd.DataFrame) -> pd.DataFrame:
        return part.set_index(places).reindex(whole).reset_index()

    of_runs = runs.groupby(["cylinder", "method"], sort=False)
    return Blocks(
        motions=motions,
        points={str(name): grid(part) for name, part in points.groupby("cylinder", sort=False)},
        runs={(str(key[0]), str(key[1])): grid(part) for key, part in of_runs},
        limits=limits,
        measure=measure,
    )


# range of a curve: from half of the lowest intensity to twice the highest
_POINTS, _BEYOND = 60, 2.0
ALL = "all"  # cylinders
_KEY = ("cylinder", "method", "limit")
_CURVE = [*_KEY, "intensity", "probability", "low", "high"]
_NO_FIT = {"deviance": math.nan, "degrees": 0, "p": math.nan, "largest": math.nan}


def count_table(blocks: Blocks) -> pd.DataFrame:
    """Number of runs n and exceedances k at each intensity, for fits by other tools.

    Of a cloud each run is a row with n = 1.
    """
    tables = []
    for key in blocks.known_keys():
        x, n, k = blocks.sample(*key).counts()
        intensities = [float(f"{math.exp(each):.12g}") for each in x]
        counts = {"intensity": intensities, "n": n[0].astype(int), "k": k[0].astype(int)}
        tables.append(pd.DataFrame(_about(key) | {"measure": blocks.measure} | counts))
    return pd.concat(tables, ignore_index=True)


def _about(key: Key) -> dict[str, Any]:
    return dict(zip(_KEY, key, strict=True))


def fit_table(blocks: Blocks, fitted: Mapping[Key, Curves], drawn: Mapping[Key, Curves]) -> pd.DataFrame:
    """Curve of each cylinder, method and limit with its intervals and goodness of fit."""
    rows = []
    motions = blocks.fewest
    for key, curves in fitted.items():
        sample, many = blocks.sample(*key), drawn[key]
        x, n, k = sample.counts()
        centre, dispersion = float(curves.centre[0]), float(curves.dispersion[0])
        kind, middle = KINDS[curves.kinds[0]], float(curves.median[0])
        median = interval(middle, many.low, motions, above=many.high)
        spread = spread_interval(dispersion, many.dispersion, motions)
        held = goodness(x, n[0], k[0], centre, dispersion) if kind in (FITTED, EXTRAPOLATED) else _NO_FIT
        rows.append(
            {
                **_about(key),
                "kind": kind,
                "runs": int(n.sum()),
                "exceeded": int(k.sum()),
                "failed": int((np.isnan(sample.y) & blocks.made).sum()),
                **median.exponential().columns("median"),
                **dict(zip(MEDIANS_OF_FAILED, _bounds_of_failed(sample, blocks.made), strict=True)),
                **spread.columns("dispersion"),
                # medians beyond the intensities run
                "extrapolated": not x.min() <= middle <= x.max(),
                "without_curve": float((many.kinds != KINDS.index(FITTED)).mean()),
                **held,
            }
        )
    return pd.DataFrame(rows)


# medians if all failed runs exceed the limit, and if none does
MEDIANS_OF_FAILED = ("median_if_exceeded", "median_if_not")
# least and largest ratio of two medians over all outcomes of the failed runs
RATIOS_OF_FAILED = ("ratio_least", "ratio_most")


def _bounds_of_failed(sample: Sample, made: NDArray[np.bool_] | bool = True) -> tuple[float, float]:
    """Medians if all failed runs exceed the limit, and if none does."""
    failed = np.isnan(sample.y) & made
    least, most = (Sample(x=sample.x, y=np.where(failed, fate, sample.y)).curves() for fate in (1.0, 0.0))
    return math.exp(least.median[0]), math.exp(most.median[0])


def curve_table(blocks: Blocks, fitted: Mapping[Key, Curves], drawn: Mapping[Key, Curves]) -> pd.DataFrame:
    """Curves point by point, each with its band.

    One whose median lies below the intensities that were run is unknown there, and so is one above them.
    Where all depends on one motion there is none.
    """
    tables = []
    for key, curves in fitted.items():
        if KINDS[curves.kinds[0]] == ONE_MOTION:
            continue
        sample, median = blocks.sample(*key), curves.median[0]
        first = sample.x.min() - math.log(_BEYOND) * (median != -math.inf)
        x = np.linspace(first, sample.x.max() + math.log(_BEYOND) * (median != math.inf), _POINTS)
        low, high = bands(drawn[key], x, blocks.fewest)
        band = {"intensity": np.exp(x), "probability": curves.at(x)[0], "low": low, "high": high}
        tables.append(pd.DataFrame(_about(key) | band))
    return pd.concat(tables, ignore_index=True) if tables else pd.DataFrame(columns=_CURVE)


def contrast_table(
    blocks: Blocks,
    fitted: Mapping[Key, Curves],
    drawn: Mapping[Key, Curves],
    weights: Array,
    margin: float,
) -> pd.DataFrame:
    """Ratio of the medians and the difference of the dispersions of every two methods.

    Of the same motions: a run that failed by one method leaves out that of the other, and both curves are of
    the same resamples. Rows of the cylinder "all" are geometric means of the ratios over the cylinders. A run
    may fail where the cylinder overturns, so that leaving it out is not neutral: the ratio lies between
    ratio_least and ratio_most, for which the failed runs of one method exceed the limit and those of the
    other do not.
    """
    rows: list[dict[str, float | str]] = []
    pairs = itertools.combinations(blocks.methods, 2)
    for limit, (against, method) in itertools.product(blocks.limits, pairs):
        entries: dict[str, list[Array]] = {}
        for cylinder in blocks.cylinders:
            pair = [blocks.sample(cylinder, name, limit) for name in (method, against)]
            unknown = (np.isnan(pair[0].y) | np.isnan(pair[1].y)) & blocks.made
            if unknown.all():
                continue
            with np.errstate(divide="ignore", invalid="ignore"):  # curves without a median
                (least, most), (other_least, other_most) = (
                    np.log(_bounds_of_failed(each, blocks.made)) for each in pair
                )
                bounds = np.array([least - other_most, most - other_least])
            own, many = ([of[cylinder, name, limit] for name in (method, against)] for of in (fitted, drawn))
            if unknown.any():
                pair = [Sample(x=each.x, y=np.where(unknown, np.nan, each.y)) for each in pair]
                own, many = [each.curves() for each in pair], [each.curves(weights) for each in pair]
            entries[cylinder] = [_differences(own), _differences(many), bounds]
        if len(entries) == len(blocks.cylinders) > 1:
            with np.errstate(invalid="ignore"):  # medians above and below all levels have no ratio
                entries[ALL] = [np.mean(each, axis=0) for each in zip(*entries.values(), strict=True)]
        rows += [
            {"cylinder": cylinder, "limit": limit, "method": method, "against": against}
            | curve_contrast(one, resampled, blocks.fewest, margin)
            | dict(zip(RATIOS_OF_FAILED, np.exp(ends).tolist(), strict=True))
            for cylinder, (one, resampled, ends) in entries.items()
        ]
    return pd.DataFrame(rows)


def _differences(pair: Sequence[Curves]) -> Array:
    """Differences (4, B): log medians, dispersions, and the least and largest of the first."""
    first, second = ([each.median, each.dispersion, each.low, each.high] for each in pair)
    with np.errstate(invalid="ignore"):  # curves that are never reached have no ratio
        return np.asarray(np.subtract(first, [*second[:2], *second[:1:-1]]), dtype=np.float64)


def curve_contrast(differences: Array, drawn: Array, motions: int, margin: float) -> dict[str, float | str]:
    """Contrast of two curves.

    Parameters
    ----------
    differences, drawn : ndarray, shapes (4, 1) and (4, B)
        Differences of the logarithms of the medians, of the dispersions, and the least and the largest that
        the first may be, and those of the resamples.
    motions : int
    margin : float
    """
    (centre, spread), (spreads, lows, highs) = differences[:2, 0], drawn[1:]
    ratio = interval(float(centre), lows, motions, above=highs).exponential()
    return {
        **ratio.columns("ratio"),
        **interval(float(spread), spreads, motions).columns("dispersion_difference"),
        "within": margin_of(ratio),
        "verdict": ratio.about_one(margin),
    }


def margin_of(ratio: Interval) -> float:
    """Least margin that contains the whole interval of a ratio; infinite without an end."""
    if not (ratio.low > 0.0 and math.isfinite(ratio.high)):
        return math.inf
    return max(ratio.high, 1.0 / ratio.low, 1.0) - 1.0


def curves_of(blocks: Blocks, weights: Array | None = None) -> dict[Key, Curves]:
    """Fragility curves by cylinder, method and limit; with `weights` (B, R), one per bootstrap resample."""
    return {key: blocks.sample(*key).curves(weights) for key in blocks.known_keys()}


_GAPS = ["cylinder", "method", "motions", "motions_with_gaps", "runs", "runs_below_gaps"]
_GAPS += ["median", "median_incremental", "bias", "bias_low", "bias_high"]


def gap_table(blocks: Blocks, weights: Array) -> pd.DataFrame:
    """Number of motions with gaps for each cylinder and method, and the effect of stopping early.

    Empty where the motions are not all run at every level.

    The columns: motions, motions_with_gaps (of these), runs, runs_below_gaps (those that overturn while a
    stronger one stands), median of all levels and median_incremental, and bias, the second over the first,
    with the interval of the same resamples.
    """
    rows = []
    motions = len(blocks.motions)
    several = blocks.cylinders if blocks.made.all() else []  # motions of one level each have no gaps
    for cylinder, method in itertools.product(several, blocks.methods):
        sample = blocks.sample(cylinder, method, OVERTURNED)
        if np.isnan(sample.y).all():
            continue
        stopped, gaps = Sample(x=sample.x, y=incremental(sample.y)), below_gaps(sample.y)
        (whole, many), (early, many_early) = (
            (each.curves(), each.curves(weights)) for each in (sample, stopped)
        )
        with np.errstate(invalid="ignore"):
            value = float(early.median[0] - whole.median[0])
            ends = np.array([many_early.low - many.high, many_early.high - many.low])
        # equal counts have equal curves, also beyond the levels
        same = (stopped.counts(weights)[2] == sample.counts(weights)[2]).all(axis=1)
        low, high = np.where(same, 0.0, ends)
        counts = int(gaps.any(axis=1).sum()), int((~np.isnan(sample.y)).sum()), int(gaps.sum())
        bias = interval(value, low, motions, above=high).exponential()
        medians = float(np.exp(whole.median[0])), float(np.exp(early.median[0]))
        rows.append((cylinder, method, motions, *counts, *medians, *bias.columns("bias").values()))
    return pd.DataFrame(rows, columns=_GAPS)


def below_gaps(y: Array) -> NDArray[np.bool_]:
    """Mask (R, S) of overturned runs with a standing run of the motion at a higher level.

    Parameters
    ----------
    y : ndarray, shape (R, S)
        1, 0, or NaN where a run failed, from the weakest level to the strongest.
    """
    stands = np.nan_to_num(y, nan=1.0) == 0.0
    later = np.zeros_like(stands)
    later[:, :-1] = np.logical_or.accumulate(stands[:, :0:-1], axis=1)[:, ::-1]
    return np.asarray((y == 1.0) & later, dtype=np.bool_)


def incremental(y: Array) -> Array:
    """Outcome (R, S) of an incremental analysis that stops at the first overturning."""
    fell = np.maximum.accumulate(np.nan_to_num(y, nan=0.0), axis=1)
    return np.where(np.isnan(y) & (fell == 0.0), np.nan, fell)


# Every run has an intensity of its own in each measure but that of the levels, and so many numbers in each
# resample: as many resamples as keep this many numbers, and no fewer than give an end of an interval.
_MOST_NUMBERS, _FEWEST = 150_000, 100


def efficiency_table(blocks: Blocks, method: str, weights: Array) -> pd.DataFrame:
    """Dispersion of one method by each intensity measure, and its ratio to the least, of the same resamples.

    The runs are the same for every measure: from where no motion overturns to where nearly all do, so that
    it matters little by which measure their levels were chosen.
    """
    rows = []
    motions = blocks.fewest
    for cylinder in blocks.cylinders:
        if np.isnan(blocks.exceedance(cylinder, method, OVERTURNED)).all():  # every run failed
            continue
        samples = {
            measure: blocks.sample(cylinder, method, OVERTURNED, measure)
            for measure in MEASURES
            if measure in blocks.points[cylinder]
            and np.isfinite(blocks.of_points(cylinder, measure)[blocks.made]).all()
        }
        curves = {measure: sample.curves() for measure, sample in samples.items()}
        fitted = [measure for measure, curve in curves.items() if KINDS[curve.kinds[0]] == FITTED]
        if not fitted:
            continue
        some = weights[: max(_FEWEST, _MOST_NUMBERS // samples[fitted[0]].y.size)]
        spreads = {measure: float(curves[measure].dispersion[0]) for measure in fitted}
        drawn = {measure: samples[measure].curves(some).dispersion for measure in fitted}
        best = min(fitted, key=spreads.__getitem__)
        for measure, spread in spreads.items():
            with np.errstate(divide="ignore", invalid="ignore"):  # separated resamples have no dispersion
                ratios = np.log(drawn[measure] / drawn[best]) if measure != best else np.zeros(len(some))
            over = interval(math.log(spread / spreads[best]), ratios, motions).exponential()
            rows.append(
                {
                    "cylinder": cylinder,
                    "method": method,
                    "measure": measure,
                    "median": float(np.exp(curves[measure].centre[0])),
                    **spread_interval(spread, drawn[measure], motions).columns("dispersion"),
                    **over.columns("over_best"),
                    "best": measure == best,
                }
            )
    return pd.DataFrame(rows)
