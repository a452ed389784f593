"""Annual frequency of exceeding a limit under the motions of a fragility: its interval and contributions.

One interval serves frequencies and ratios of two, motions at all levels and motions of each level alone. The
logarithm of a frequency is, to first order, a sum of parts, one a motion, and so is that of a ratio. Its
standard error is that of the parts, and the interval that of the logarithm over its standard error in
resamples of the motions (bootstrap-t: B. Efron and R. J. Tibshirani, An Introduction to the Bootstrap, 1993,
12.5): of a mean of which few motions have the most the plain percentiles are too narrow, on the side of the
danger. It is wider by what a quantile of Student's t has over that of as many motions, with the degrees of
freedom that motions of which few have the most leave (F. E. Satterthwaite, Biometrics Bulletin 2, 110-114,
1946). `python tests/benchmarks risk_coverage` says how often it holds the truth.
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from functools import partial
from typing import Any

import numpy as np
import pandas as pd
from numpy.typing import NDArray

from rockwobble.compare.metrics.statistics import Interval, share_interval
from rockwobble.models.finding import Finding, Level, Value
from rockwobble.models.hazard import HazardCurve

from .fit import EXTRAPOLATED, FITTED, KINDS, Array, Sample, interval
from .integral import Frequencies, continued, frequencies_of, lognormal_frequency, rate_at
from .tables import OVERTURNED, Blocks

TARGET = 2e-4  # [1/year], collapse of 1 % in 50 years: ASCE/SEI 7-16, 21.2.1.2
RARE = -math.log1p(-0.02) / 50.0  # exceeded with 2 % in 50 years [1/year]
FAR = 5.0  # factor on a motion beyond which its scaling is doubted
# motions that exceed the limit: of fewer, too many resamples are of none, and each share has its exact bound
FEWEST_EXCEEDING = 5
# standard error of a resample, at least, over that of all motions: one that lacks the few which have most of
# the mean knows nothing of its error
_LEAST_ERROR = 0.6


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Exposure:
    """Motions of one cylinder and one method, in the unit of a hazard; R motions at S levels.

    Attributes
    ----------
    x, y : ndarray, shape (R, S)
        Logarithms of the intensities of R motions at S levels; 1 where they overturn, 0 where not, NaN where
        that is not known.
    made : ndarray of bool, shape (R, S)
        Whether a motion is run at a level.
    uplift : ndarray, shape (R,)
        Logarithm of the intensity at which each motion begins to uplift the cylinder.
    far : ndarray, shape (R,)
        Logarithm of the intensity beyond which its factor is larger than `FAR`; infinite of a synthetic
        motion, which a factor makes no less likely.
    curve : (float, float), optional
        Centre and dispersion of the lognormal curve; None without.
    """

    x: Array
    y: Array
    made: NDArray[np.bool_]
    uplift: Array
    far: Array
    curve: tuple[float, float] | None = None

    @property
    def stripes(self) -> bool:
        """Whether each level has its own motions, so that no motion has an indicator at all levels."""
        return not self.made.all()

    @property
    def exceeding(self) -> int:
        """Number of motions that exceed the limit at some level."""
        return int((np.nansum(self.y, axis=1) > 0.0).sum())

    def frequencies(self, hazard: HazardCurve) -> Frequencies:
        """Annual frequency of each motion; for stripes one frequency from the shares."""
        if not self.stripes:
            return frequencies_of(hazard, self.x, self.y, self.uplift, self.far)
        known = np.maximum((~np.isnan(self.y)).sum(axis=0), 1)
        shares, distant = (
            self.of_shares(hazard, np.nansum(each, axis=0)[None] / known)
            for each in (self.y, np.where(self.x > self.far[:, None], self.y, 0.0))
        )
        return replace(shares, far=distant.total)

    def terms(self, hazard: HazardCurve, single: Frequencies) -> Array:
        """Terms (R, G) whose column means add up to the frequency; NaN where unknown.

        One column, the frequency of each motion; of stripes one a level, to whose share it is proportional.
        """
        if not self.stripes:
            return single.total[:, None]
        return self.y * self.of_shares(hazard, np.eye(self.y.shape[1])).total

    def of_shares(self, hazard: HazardCurve, shares: Array) -> Frequencies:
        """Annual frequency for each set of exceedance shares (B, S)."""
        x, ones = np.tile(self.x.mean(axis=0), (len(shares), 1)), np.ones(len(shares))
        return frequencies_of(hazard, x, shares, self.uplift.min() * ones, np.inf * ones)

    def between_levels(self, hazard: HazardCurve) -> tuple[float, float]:
        """Annual frequency if every change between two levels lies at the upper, or at the lower one."""
        known = ~np.isnan(self.y).all(axis=0)
        x, y = self.x.mean(axis=0)[known], np.nanmean(self.y[:, known], axis=0)
        uplift, far = self.uplift.min(keepdims=True), np.array([np.inf])
        low, high = (
            frequencies_of(
                hazard, np.repeat(x, 2)[None], np.r_[y[:1], np.repeat(of, 2), y[-1:]][None], uplift, far
            )
            for of in (np.minimum(y[:-1], y[1:]), np.maximum(y[:-1], y[1:]))
        )
        return float(low.least[0]), float(high.most[0])

    def largest(self, hazard: HazardCurve) -> float:
        """Annual frequency from the upper Clopper-Pearson bounds of the shares."""
        runs, over = (~np.isnan(self.y)).sum(axis=0).tolist(), np.nansum(self.y, axis=0).astype(int).tolist()
        ends = [share_interval(k, n).high if n else 1.0 for k, n in zip(over, runs, strict=True)]
        longer = continued(hazard, float(self.uplift.min()))
        bound = self.of_shares(longer, np.array([ends]))
        missing = (1.0 - ends[-1]) * rate_at(longer, self.x.mean(axis=0)[-1:])
        return float((bound.total + missing)[0])


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Resampled:
    """Logarithm of an annual frequency, or of a ratio of two, for all motions and for resamples.

    Attributes
    ----------
    logs : ndarray, shape (1 + B,)
        Of all motions, and of each resample; minus infinity of none that exceeds the limit.
    parts : ndarray, shape (1 + B, R)
        What each motion adds to it, to first order.
    counts : ndarray, shape (1 + B, R)
        How often each is drawn.
    """

    logs: Array
    parts: Array
    counts: Array

    def over(self, other: Resampled) -> Resampled:
        """Ratio to another frequency from the same resamples."""
        with np.errstate(invalid="ignore"):  # zero over zero has no ratio
            return replace(self, logs=self.logs - other.logs, parts=self.parts - other.parts)

    def interval(self, motions: int) -> Interval:
        """Value with its 95 % interval; ends are NaN if all motions are equal, or at 0 or infinity."""
        value = float(np.exp(self.logs[0]))
        errors = np.sqrt((self.counts * self.parts**2).sum(axis=1))
        if not (0.0 < value < math.inf and errors[0] > 1e-9):
            return Interval(value=value, low=math.nan, high=math.nan)
        with np.errstate(invalid="ignore"):
            deviations = (self.logs[1:] - self.logs[0]) / np.maximum(errors[1:], _LEAST_ERROR * errors[0])
        ends, error = interval(0.0, deviations, motions), errors[0] * _few_parts_factor(self.parts[0])
        low, high = (value * float(np.exp(-end * error)) for end in (ends.high, ends.low))
        return Interval(value=value, low=low, high=high)


def _few_parts_factor(parts: Array) -> float:
    """97.5 % quantile of Student's t for a sum of parts (R,), over the quantile for equal parts."""
    from scipy.special import stdtrit

    squares, most = (parts**2).sum(), len(parts) - 1
    of_error = (parts**4).sum() - squares**2 / len(parts)
    freedom = min(max(2.0 * squares**2 / of_error, 1.0), most) if of_error > 0.0 else most
    return float(stdtrit(freedom, 0.975) / stdtrit(most, 0.975)) if most > 0 else 1.0


def resampled(terms: Array, weights: Array) -> Resampled:
    """Logarithm of the sum of the column means of terms (R, G), of all motions and each of weights (B, R)."""
    known = ~np.isnan(terms)
    values = np.where(known, terms, 0.0)
    counts = np.vstack([np.ones((1, len(terms))), weights])
    with np.errstate(divide="ignore", invalid="ignore"):  # all drawn motions failed, or none exceeds
        runs = counts @ known
        means = (counts @ values) / runs
        sums = means.sum(axis=1)
        each = 1.0 / (runs * sums[:, None])
        parts = each @ values.T - (each * means) @ known.T
        return Resampled(logs=np.log(sums), parts=parts, counts=counts)


def risk_tables(
    blocks: Blocks,
    exposures: Mapping[tuple[str, str], Exposure],
    hazard: HazardCurve,
    *,
    weights: Array,
    years: float,
    target: float,
) -> tuple[pd.DataFrame, pd.DataFrame]:
    """Risk of exceeding a limit for each cylinder and method, and its contributions.

    Parameters
    ----------
    blocks : Blocks
    exposures : mapping
        By cylinder and method.
    hazard : HazardCurve
    weights : ndarray, shape (B, R)
        How often each motion is drawn.
    years : float
        For the probability.
    target : float
        Annual frequency that is compared with the interval [1/year].

    Returns
    -------
    DataFrame, DataFrame
        See `Fragility.risk`; and cylinder, method, intensity, annual_frequency (of exceedance), probability
        and probability_fit of overturning, contribution and contribution_fit (p |d lambda / d ln theta|).
    """
    rows: list[dict[str, float | str]] = []
    parts: list[pd.DataFrame] = []
    references: dict[str, Resampled] = {}
    for (cylinder, method), exposure in exposures.items():
        single, curve = exposure.frequencies(hazard), exposure.curve
        drawn = resampled(exposure.terms(hazard, single), weights)
        reference = references.setdefault(cylinder, drawn)
        frequency = frequency_interval(hazard, exposure, single, drawn, blocks.fewest)
        verdict = "below" if frequency.high < target else "above" if frequency.low > target else UNDECIDED
        most, *resting = (
            float(np.nanmean(each)) for each in (single.most, single.head, single.tail, single.far)
        )
        share = 1.0 / frequency.value if frequency.value > 0.0 else math.nan
        about = {"cylinder": cylinder, "method": method}
        rows.append(
            {
                **about,
                **frequency.columns("annual_frequency"),
                "annual_frequency_most": most,
                **{name: part * share for name, part in zip(_SHARES, resting, strict=True)},
                "motions": len(exposure.y),
                "overturning_motions": exposure.exceeding,
                "failed": int((np.isnan(exposure.y) & exposure.made).sum()),
                "annual_frequency_fit": lognormal_frequency(hazard, *curve) if curve else math.nan,
                "verdict": verdict,
                "probability": -math.expm1(-frequency.value * years),
                "margin": math.exp(curve[0]) / hazard.intensity_at(RARE) if curve else math.nan,
                **drawn.over(reference).interval(blocks.fewest).columns("ratio"),
            }
        )
        parts.append(_contributions(hazard, exposure).assign(**about))
    return pd.DataFrame(rows), pd.concat(parts, ignore_index=True)


# shares of the frequency above which a caution is stated
_OPEN, _SCALED = 0.1, 0.5
_SHARES = ("head_share", "tail_share", "far_share")
UNDECIDED = "inconclusive"
_LEVELS: Mapping[str, Level] = {"below": "satisfied", UNDECIDED: "caution", "above": "not satisfied"}


def risk_findings(rows: Sequence[Mapping[str, Any]], site: Mapping[str, Any]) -> Iterator[Finding]:
    """Findings of a risk table: frequencies of its first method, and the shares they depend on.

    Parameters
    ----------
    rows : sequence of mapping
        Of the table.
    site : mapping
        Facts of the hazard: limit, target, total_dispersion.
    """
    limit, target = site.get("limit", OVERTURNED), site.get("target", TARGET)
    values: dict[str, Value]
    for row in rows:
        if row["method"] != rows[0]["method"]:
            continue
        value, low, high = (row[f"annual_frequency{end}"] for end in ("", "_low", "_high"))
        verdict = row["verdict"]
        values = {"name": row["cylinder"], "detail": limit, "reason": verdict, "frequency_target": target}
        values |= {"frequency": (value, low, high), "years": 1.0 / value} if value > 0.0 else {}
        values |= {"frequency_high": high}
        yield Finding(
            key="risk.frequency" if value > 0.0 else "risk.none",
            level=_LEVELS[verdict],
            values=values,
            runs=row["method"],
        )
    for row in rows:
        few, head, tail, far = (row[name] for name in ("overturning_motions", *_SHARES))
        values = {"name": row["cylinder"], "detail": limit}
        values |= {f"frequency_{end}": row[f"annual_frequency_{end}"] for end in ("low", "high", "most")}
        doubts: tuple[tuple[str, bool, dict[str, Value]], ...] = (
            ("few", few < FEWEST_EXCEEDING, {"count": few}),
            ("head", head > _OPEN, {"share": head}),
            ("tail", tail > _OPEN, {"share": tail}),
            ("far", far > _SCALED, {"share": far, "factor": FAR}),
        )
        for name, holds, more in doubts:
            if holds:
                yield Finding(key=f"risk.{name}", level="caution", values=values | more, runs=row["method"])
    if total := site.get("total_dispersion"):
        yield Finding(key="risk.dispersion", values={"ratio": total})


def frequency_interval(
    hazard: HazardCurve, exposure: Exposure, single: Frequencies, drawn: Resampled, motions: int
) -> Interval:
    """Annual frequency with its 95 % interval, widened for unresolved levels and hazard ends."""
    total, least, most = (float(np.nanmean(each)) for each in (single.total, single.least, single.most))
    of_motions = drawn.interval(motions)
    few = exposure.exceeding < FEWEST_EXCEEDING
    if few or of_motions.high == math.inf:
        low = 0.0 if few else of_motions.low * least / total
        high = max(exposure.largest(hazard), most)
    elif math.isnan(of_motions.low):  # all motions are equal: only the levels bound the value
        low, high = exposure.between_levels(hazard)
    else:
        low, high = of_motions.low * least / total, of_motions.high + most - total
    return Interval(value=total, low=min(low, total), high=max(high, total))


_POINTS = 200  # points of the picture


def _contributions(hazard: HazardCurve, exposure: Exposure) -> pd.DataFrame:
    from scipy.special import ndtr

    x = np.linspace(math.log(hazard.intensity[0]), math.log(hazard.intensity[-1]), _POINTS)
    if exposure.stripes:
        share = np.interp(x, exposure.x[0], np.nanmean(exposure.y, axis=0), left=0.0)
    else:
        rows = [_indicator(x, *each) for each in zip(exposure.x, exposure.y, exposure.uplift, strict=True)]
        share = np.nanmean(rows, axis=0)
    rate = rate_at(hazard, x)
    slope = -np.gradient(np.log(rate), x)
    centre, dispersion = exposure.curve or (math.nan, math.nan)
    with np.errstate(divide="ignore"):
        fit = np.asarray(ndtr((x - centre) / dispersion))
    return pd.DataFrame(
        {
            "intensity": np.exp(x),
            "annual_frequency": rate,
            "probability": share,
            "probability_fit": fit,
            "contribution": share * rate * slope,
            "contribution_fit": fit * rate * slope,
        }
    )


def _indicator(at: Array, x: Array, y: Array, uplift: float) -> Array:
    known = ~np.isnan(y)
    if not known.any():
        return np.full(len(at), np.nan)
    x, y = x[known], y[known]
    if uplift < x[0]:
        x, y = np.concatenate([[uplift], x]), np.concatenate([[0.0], y])
    return np.interp(at, x, y)


def measure_factor(hazard: HazardCurve, body: Mapping[str, float], period: float) -> tuple[str, float]:
    """Intensity measure of the fragility that matches the hazard curve, and the conversion factor.

    Parameters
    ----------
    hazard : HazardCurve
    body : mapping
        Facts of a cylinder: tan_alpha, velocity_unit (g tan alpha / p [m/s]).
    period : float
        Period of Sa in the fragility [s].

    Raises
    ------
    ValueError
        If the fragility has no such measure, or Sa at another period.
    """
    if hazard.period is not None and abs(hazard.period - period) > 1e-9 * period:
        raise ValueError(
            f"the hazard is of Sa at {hazard.period:g} s, the fragility has it at {period:g} s: run the "
            f"fragility with --period {hazard.period:g}"
        )
    if hazard.measure == "pga_resultant":
        return "peak_acceleration", body["tan_alpha"]
    if hazard.measure == "pgv_resultant":
        if "velocity_unit" not in body:
            raise ValueError("a fragility of an older version has no resultant velocities: run it again")
        return "peak_velocity", body["velocity_unit"]
    return hazard.measure, 1.0


def exposures_of(
    blocks: Blocks, of_hazard: Mapping[str, tuple[str, float]], dispersion: float | None, limit: str
) -> dict[tuple[str, str], Exposure]:
    """Exposure of each cylinder and method in the intensity measure of a hazard.

    Parameters
    ----------
    blocks : Blocks
    of_hazard : mapping of str to (str, float)
        By cylinder: a measure of the points, and the factor on it that gives that of the hazard.
    dispersion : float or None
        Total dispersion of the curves, in the place of that of the motions.
    limit : str
    """
    exposures = {}
    for cylinder in blocks.cylinders:
        measure, factor = of_hazard[cylinder]
        x = blocks.intensities(cylinder, measure) + math.log(factor)
        if not blocks.made.all() and measure != blocks.measure:
            raise ValueError(
                f"motions by level are of the measure of their levels: the hazard must be of "
                f"{blocks.measure}, got {measure}"
            )
        of_points = partial(blocks.of_points, cylinder)
        as_recorded = np.nanmean(x - np.log(of_points("scale")), axis=1)
        uplift = as_recorded + np.log(np.nanmean(of_points("uplift_scale"), axis=1))
        synthetic = np.nanmax(of_points("synthetic"), axis=1) > 0.0
        far = np.where(synthetic, np.inf, as_recorded + math.log(FAR))
        for method in blocks.methods:
            y = blocks.exceedance(cylinder, method, limit)
            if np.isnan(y).all():
                continue
            fit = Sample(x=x, y=y).curves()
            own = float(fit.dispersion[0]) if dispersion is None else dispersion
            known = KINDS[fit.kinds[0]] in (FITTED, EXTRAPOLATED)
            curve = (float(fit.centre[0]), own) if known else None
            exposures[cylinder, method] = Exposure(
                x=x, y=y, made=blocks.made, uplift=uplift, far=far, curve=curve
            )
    return exposures
