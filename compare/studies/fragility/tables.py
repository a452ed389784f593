"""The tables of a fragility: counts, fits with their bands, and every method against every other."""

from __future__ import annotations

import itertools
import math
from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np
import pandas as pd

from ...metrics.order_statistics import Interval
from .fit import ALWAYS, FITTED, KINDS, NEVER, Curves, goodness
from .resampling import Array, Sample, bands, interval, spread_interval
from .samples import Blocks, Key

# of a curve: from half of the lowest intensity to twice the highest
_POINTS, _BEYOND = 60, 2.0
ALL = "all"  # cylinders
_KEY = ("cylinder", "method", "limit")
_NO_FIT = {"deviance": math.nan, "degrees": 0, "p": math.nan, "largest": math.nan}


def count_table(blocks: Blocks) -> pd.DataFrame:
    """Return n runs and k exceedances at each intensity, from which other tools can fit curves of their own.

    Of a cloud each run is a row with n = 1.
    """
    rows = []
    for key in blocks.known_keys():
        x, n, k = blocks.sample(*key).counts()
        for place, (runs, over) in enumerate(zip(n[0], k[0], strict=True)):
            rows.append(
                {
                    **dict(zip(_KEY, key, strict=True)),
                    "measure": blocks.measure,
                    "intensity": float(f"{math.exp(x[place]):.12g}"),
                    "n": int(runs),
                    "k": int(over),
                }
            )
    return pd.DataFrame(rows)


def fit_table(blocks: Blocks, fitted: Mapping[Key, Curves], drawn: Mapping[Key, Curves]) -> pd.DataFrame:
    """Return the curve of each cylinder, method and limit with its intervals and its goodness of fit."""
    rows = []
    motions = len(blocks.motions)
    for key, found in fitted.items():
        sample, many = blocks.sample(*key), drawn[key]
        x, n, k = sample.counts()
        centre, dispersion = float(found.centre[0]), float(found.dispersion[0])
        kind = KINDS[found.kinds[0]]
        median = interval(centre, many.low, motions, above=many.high)
        spread = spread_interval(dispersion, many.dispersion, motions)
        held = goodness(x, n[0], k[0], centre, dispersion) if kind == FITTED else _NO_FIT
        rows.append(
            {
                **dict(zip(_KEY, key, strict=True)),
                "kind": kind,
                "runs": int(n.sum()),
                "exceeded": int(k.sum()),
                "failed": int(np.isnan(sample.y).sum()),
                **median.exponential().columns("median"),
                **spread.columns("dispersion"),
                # beyond the intensities that were run the curve is a guess
                "extrapolated": not x.min() <= centre <= x.max(),
                "without_curve": float((many.kinds != KINDS.index(FITTED)).mean()),
                **held,
            }
        )
    return pd.DataFrame(rows)


def curve_table(blocks: Blocks, fitted: Mapping[Key, Curves], drawn: Mapping[Key, Curves]) -> pd.DataFrame:
    """Return the curves point by point, each with its band.

    One that all runs exceed is unknown below the intensities that were run, one that none exceeds above.
    """
    tables = []
    for key, found in fitted.items():
        sample, kind = blocks.sample(*key), KINDS[found.kinds[0]]
        first = sample.x.min() - math.log(_BEYOND) * (kind != ALWAYS)
        x = np.linspace(first, sample.x.max() + math.log(_BEYOND) * (kind != NEVER), _POINTS)
        low, high = bands(drawn[key], x, len(blocks.motions))
        tables.append(
            pd.DataFrame(
                {
                    **dict(zip(_KEY, key, strict=True)),
                    "intensity": np.exp(x),
                    "probability": found.at(x)[0],
                    "low": low,
                    "high": high,
                }
            )
        )
    return pd.concat(tables, ignore_index=True)


def contrast_table(
    blocks: Blocks,
    fitted: Mapping[Key, Curves],
    drawn: Mapping[Key, Curves],
    weights: Array,
    margin: float,
) -> pd.DataFrame:
    """Return the ratio of the medians and the difference of the dispersions of every two methods.

    Of the same motions: a run that failed by one method leaves out that of the other, and both curves are of
    the same resamples. Rows of the cylinder "all" are geometric means of the ratios over the cylinders.
    """
    rows: list[dict[str, Any]] = []
    pairs = itertools.combinations(blocks.methods, 2)
    for limit, (against, method) in itertools.product(blocks.limits, pairs):
        about = {"limit": limit, "method": method, "against": against}
        found: list[tuple[Array, Array]] = []
        for cylinder in blocks.cylinders:
            pair = [blocks.sample(cylinder, name, limit) for name in (method, against)]
            unknown = np.isnan(pair[0].y) | np.isnan(pair[1].y)
            if unknown.all():
                continue
            own, many = ([of[cylinder, name, limit] for name in (method, against)] for of in (fitted, drawn))
            if unknown.any():
                pair = [Sample(x=each.x, y=np.where(unknown, np.nan, each.y)) for each in pair]
                own, many = [each.curves() for each in pair], [each.curves(weights) for each in pair]
            found.append((_differences(own), _differences(many)))
            row = contrast_row(*found[-1], len(blocks.motions), margin)
            rows.append({"cylinder": cylinder, **about, **row})
        if len(found) == len(blocks.cylinders) > 1:
            with np.errstate(invalid="ignore"):  # of one beyond all levels and one below there is none
                mean, means = (np.mean(each, axis=0) for each in zip(*found, strict=True))
            rows.append({"cylinder": ALL, **about, **contrast_row(mean, means, len(blocks.motions), margin)})
    return pd.DataFrame(rows)


def _differences(pair: Sequence[Curves]) -> Array:
    """Differences (4, B): of the medians' logarithms, of dispersions, and the first's least and largest."""
    first, second = pair
    with np.errstate(invalid="ignore"):  # of two curves that are never reached there is none
        return np.array(
            [
                first.centre - second.centre,
                first.dispersion - second.dispersion,
                first.low - second.high,
                first.high - second.low,
            ]
        )


def contrast_row(found: Array, drawn: Array, motions: int, margin: float) -> dict[str, Any]:
    """Return the contrast of two curves.

    Parameters
    ----------
    found, drawn : ndarray, shapes (4, 1) and (4, B)
        Differences of the logarithms of the medians, of the dispersions, and the least and the largest that
        the first may be, and those of the resamples.
    motions : int
    margin : float
    """
    (centre, spread), (spreads, lows, highs) = found[:2, 0], drawn[1:]
    ratio = interval(float(centre), lows, motions, above=highs).exponential()
    return {
        **ratio.columns("ratio"),
        **interval(float(spread), spreads, motions).columns("dispersion_difference"),
        "within": margin_of(ratio),
        "verdict": ratio.about_one(margin),
    }


def margin_of(ratio: Interval) -> float:
    """Return the least margin within which the whole interval of a ratio lies; infinite without an end."""
    if not (ratio.low > 0.0 and math.isfinite(ratio.high)):
        return math.inf
    return max(ratio.high, 1.0 / ratio.low, 1.0) - 1.0


def curves_of(blocks: Blocks, weights: Array | None = None) -> dict[Key, Curves]:
    """Return by cylinder, method and limit the curve, or with weights (B, R) those of all resamples."""
    return {key: blocks.sample(*key).curves(weights) for key in blocks.known_keys()}
