"""Annual frequency of overturning: a hazard curve times what overturns at each intensity, integrated.

The mean annual frequency is the integral of p(theta) |d lambda(theta)|, with the frequency of exceedance
lambda of a site and the probability p of overturning at an intensity theta. Without a fitted curve p is the
share of the motions that overturn, the mean of the indicator of each: 1 where the motion, scaled to theta,
overturns the cylinder. So safe gaps above the first overturning count as what they are.

Rule of integration. Lambda is a power of theta between the points of its curve, and the indicator is linear
in ln theta between two levels: where it changes, it changes at a place that is unknown and equally probable
anywhere between them. For both the integral is exact, whatever the points and levels,

    int p |d lambda| = [-p lambda] + sum of dp/d ln theta int lambda d ln theta.

Below the lowest level the indicator falls linearly to 0 at the uplift of the motion: what does not uplift
does not overturn. Beyond the last level, or the last point of the curve, nothing was run or is known: there
the indicator stays what it was, and the share of the frequency that rests on this is stated (tail_share)
beside the bound in which all motions overturn there (annual_frequency_most). For a lognormal curve the
integral is exact, too: C. A. Cornell, F. Jalayer, R. O. Hamburger and D. A. Foutch, J. Struct. Eng. 128,
526-533, 2002, on each piece of the hazard curve.
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass, replace
from functools import partial

import numpy as np
import pandas as pd
from numpy.typing import NDArray

from rockwobble.compare.metrics.statistics import Interval, share_interval
from rockwobble.models.hazard import HazardCurve

from .fit import EXTRAPOLATED, FITTED, KINDS, Array, Sample, interval
from .tables import OVERTURNED, Blocks

TARGET = 2e-4  # [1/year], a common bound on collapse: 1 % in 50 years
RARE = -math.log1p(-0.02) / 50.0  # exceeded with 2 % in 50 years [1/year]
FAR = 5.0  # factor on a motion beyond which its scaling is doubted
# motions that overturn: of fewer, resamples are mostly of none, and each share has its exact bound instead
_FEWEST_OVERTURNING = 3
# standard error of a resample, at least, over that of all motions: one that lacks the few which have most of
# the mean knows nothing of its error
_LEAST_ERROR = 0.6


def lognormal_frequency(hazard: HazardCurve, centre: float, dispersion: float) -> float:
    """Return the annual frequency [1/year] by a lognormal curve.

    Parameters
    ----------
    hazard : HazardCurve
        A power law between its points. Below the first the frequency of the first counts, beyond the last
        the probability of the last.
    centre, dispersion : float
        Logarithm of the median, in the unit of the hazard, and standard deviation of the logarithm.
    """
    from scipy.special import ndtr

    x, y = np.log(hazard.intensity), np.log(hazard.annual_frequency)
    if dispersion == 0.0:
        return float(np.exp(np.interp(centre, x, y, right=-math.inf)))
    k = -np.diff(y) / np.diff(x)
    shift = k * dispersion
    ends = (x[:-1] - centre) / dispersion + shift, (x[1:] - centre) / dispersion + shift
    # lambda at the median by the power law of the piece, times exp(k^2 beta^2 / 2)
    height = np.exp(y[:-1] + k * (x[:-1] - centre) + 0.5 * shift**2)
    # in the tail in which the difference keeps its digits
    upper = ends[0] > 0.0
    shares = np.where(upper, ndtr(-ends[0]) - ndtr(-ends[1]), ndtr(ends[1]) - ndtr(ends[0]))
    with np.errstate(invalid="ignore"):
        pieces = np.where(shares > 0.0, height * shares, 0.0)
    return float(ndtr((x[0] - centre) / dispersion) * hazard.annual_frequency[0] + pieces.sum())


def mean_over(hazard: HazardCurve, low: Array, high: Array) -> Array:
    """Return the mean of the annual frequency over ln theta between two of its values each [1/year].

    Parameters
    ----------
    hazard : HazardCurve
    low, high : ndarray, shape (n,)
        Within the ends of the curve.
    """
    x, y = np.log(hazard.intensity), np.log(hazard.annual_frequency)
    k = -np.diff(y) / np.diff(x)
    whole = np.concatenate([[0.0], np.cumsum(-np.diff(hazard.annual_frequency) / k)])

    def primitive(at: Array) -> Array:
        piece = np.clip(np.searchsorted(x, at, side="right") - 1, 0, len(k) - 1)
        # lambda of the piece times (1 - exp(-k d))/k
        inside = hazard.annual_frequency[piece] * -np.expm1(-k[piece] * (at - x[piece])) / k[piece]
        return np.asarray(whole[piece] + inside, dtype=np.float64)

    width = high - low
    with np.errstate(divide="ignore", invalid="ignore"):
        mean = (primitive(high) - primitive(low)) / width
    return np.where(width > 0.0, mean, np.exp(np.interp(low, x, y)))


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Frequencies:
    """Annual frequencies of R motions [1/year].

    Attributes
    ----------
    total : ndarray, shape (R,)
        With the indicator beyond the last level, or point of the curve, as it is there.
    tail : ndarray, shape (R,)
        Part of the total that lies beyond.
    missing : ndarray, shape (R,)
        What would come to the total if the motion overturned everywhere beyond.
    far : ndarray, shape (R,)
        Part of the total at factors on the motion beyond `FAR`.
    """

    total: Array
    tail: Array
    missing: Array
    far: Array


def frequencies_of(hazard: HazardCurve, x: Array, y: Array, uplift: Array, far: Array) -> Frequencies:
    """Return the annual frequencies of indicators.

    Parameters
    ----------
    hazard : HazardCurve
    x : ndarray, shape (R, S)
        Logarithms of the levels in the unit of the hazard, increasing.
    y : ndarray, shape (R, S)
        Indicator, or share, that overturns there; NaN where it is not known: as between its neighbours.
    uplift : ndarray, shape (R,)
        Logarithms of the intensities below which nothing overturns.
    far : ndarray, shape (R,)
        Logarithms of the intensities beyond which the motions are scaled far.
    """
    known = y.copy()
    for row in np.flatnonzero(np.isnan(y).any(axis=1)):
        known[row] = _fill(x[row], y[row])
    # from 0 at uplift, unless that lies above the lowest level
    first = np.minimum(uplift, x[:, 0])
    x = np.column_stack([first, x])
    y = np.column_stack([np.where(uplift < x[:, 1], 0.0, known[:, 0]), known])
    begin, end = np.log(hazard.intensity[[0, -1]])
    last = np.clip(x[:, -1], begin, end)
    share = y[:, -1].copy()
    for row in np.flatnonzero(x[:, -1] > end):
        share[row] = np.interp(end, x[row], y[row])
    tail, inside = share * _rate(hazard, last), _integral(hazard, x, y, np.full(len(x), begin))
    far_tail = np.where(far < end, share * _rate(hazard, np.maximum(last, far)), 0.0)
    return Frequencies(
        total=inside + tail,
        tail=tail,
        missing=(1.0 - share) * _rate(hazard, last),
        far=_integral(hazard, x, y, np.clip(far, begin, end)) + far_tail,
    )


def _fill(x: Array, y: Array) -> Array:
    """Return an indicator, unknown values interpolated between neighbours; all NaN if none is known."""
    known = ~np.isnan(y)
    return y if known.all() or not known.any() else np.interp(x, x[known], y[known])


def _integral(hazard: HazardCurve, x: Array, y: Array, low: Array) -> Array:
    """Return the integral of each row (R,) over the intervals of its nodes, from `low` to the last point."""
    end = math.log(hazard.intensity[-1])
    a = np.clip(x[:, :-1], low[:, None], max(end, low.max()))
    b = np.clip(x[:, 1:], low[:, None], max(end, low.max()))
    b = np.minimum(b, end)
    width, wide = np.diff(x, axis=1), b > a
    slope = np.divide(np.diff(y, axis=1), width, out=np.zeros_like(width), where=width > 0.0)
    p_a, p_b = (y[:, :-1] + slope * (each - x[:, :-1]) for each in (a, b))
    mean = mean_over(hazard, np.where(wide, a, end), np.where(wide, b, end))
    pieces = p_a * (_rate(hazard, a) - mean) + p_b * (mean - _rate(hazard, b))
    return np.asarray(np.where(wide, pieces, 0.0).sum(axis=1))


def _rate(hazard: HazardCurve, x: Array) -> Array:
    """Return annual frequencies at logarithms of intensities, constant beyond the ends."""
    return np.asarray(np.exp(np.interp(x, np.log(hazard.intensity), np.log(hazard.annual_frequency))))


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
    """

    x: Array
    y: Array
    made: NDArray[np.bool_]
    uplift: Array
    far: Array

    @property
    def stripes(self) -> bool:
        """Whether levels have motions of their own, so that no motion has an indicator of all levels."""
        return not self.made.all()

    def frequencies(self, hazard: HazardCurve) -> Frequencies:
        """Return the annual frequency of each motion; of stripes that of the shares, once."""
        if self.stripes:
            known = np.maximum((~np.isnan(self.y)).sum(axis=0), 1)
            shares = np.nansum(self.y, axis=0)[None] / known
            distant = np.nansum(np.where(self.x > self.far[:, None], self.y, 0.0), axis=0)[None] / known
            of_far = self.of_shares(hazard, distant).total
            return replace(self.of_shares(hazard, shares), far=of_far)
        return frequencies_of(hazard, self.x, self.y, self.uplift, self.far)

    def of_shares(self, hazard: HazardCurve, shares: Array) -> Frequencies:
        """Return the annual frequency of each of some sets of shares (B, S)."""
        x, ones = np.tile(self.x.mean(axis=0), (len(shares), 1)), np.ones(len(shares))
        return frequencies_of(hazard, x, shares, self.uplift.min() * ones, np.inf * ones)

    def largest(self, hazard: HazardCurve) -> float:
        """Return the annual frequency by the upper ends of the intervals of the shares (Clopper-Pearson)."""
        runs, over = (~np.isnan(self.y)).sum(axis=0), np.nansum(self.y, axis=0)
        ends = [share_interval(int(k), int(n)).high if n else 1.0 for k, n in zip(over, runs, strict=True)]
        bound = self.of_shares(hazard, np.array([ends]))
        return float((bound.total + bound.missing)[0])


@dataclass(frozen=True, slots=True, kw_only=True)
class Resampled:
    """An annual frequency with those of resamples of its motions.

    Attributes
    ----------
    value : float
    drawn : ndarray, shape (B,)
        Draws of each resample.
    errors : ndarray, shape (1 + B,) or None
        Standard errors of the logarithm of the value and of each that is drawn; None of stripes, whose levels
        have motions of their own.
    parts : ndarray, shape (R,) or None
        What each motion adds to the logarithm of the value, to first order; None of stripes.
    """

    value: float
    drawn: Array
    errors: Array | None
    parts: Array | None

    def over(self, other: Resampled, motions: int) -> Interval:
        """Return the ratio to another of the same resamples, with its 95 % interval: that of their ratios.

        It is wider by what a quantile of Student's t has over that of as many motions, with the degrees of
        freedom that motions of which few have the most leave (F. E. Satterthwaite, Biometrics Bulletin 2,
        110-114, 1946).
        """
        if not other.value > 0.0:
            return Interval(value=math.nan, low=math.nan, high=math.nan)
        with np.errstate(divide="ignore", invalid="ignore"):
            found = interval(self.value / other.value, np.asarray(self.drawn / other.drawn), motions)
        if self.parts is None or other.parts is None or not found.value > 0.0:
            return found
        wider = _few_parts_factor(self.parts - other.parts)
        # an end that is not known or not bounded stays so
        low, high = (
            found.value * (end / found.value) ** wider if 0.0 < end < math.inf else end
            for end in (found.low, found.high)
        )
        return Interval(value=found.value, low=low, high=high)

    def interval(self, motions: int) -> Interval:
        """Return the 95 % interval: of the logarithm over its standard error, as the resamples have it.

        A frequency is a mean of which few motions have the most. The shares of the resamples themselves (the
        percentiles) are too narrow for it, on the side of the danger: B. Efron and R. J. Tibshirani, An
        Introduction to the Bootstrap, 1993, 12.5.
        """
        if self.errors is None or not self.value > 0.0:
            return interval(self.value, self.drawn, motions)
        error, of_drawn = self.errors[0], np.maximum(self.errors[1:], _LEAST_ERROR * self.errors[0])
        with np.errstate(divide="ignore", invalid="ignore"):
            deviations = (np.log(self.drawn) - math.log(self.value)) / of_drawn
        found = interval(0.0, deviations, motions)
        low, high = (self.value * np.exp(-end * error) for end in (found.high, found.low))
        return Interval(value=self.value, low=float(low), high=float(high))


def resampled(exposure: Exposure, hazard: HazardCurve, single: Array, weights: Array) -> Resampled:
    """Return the annual frequency with that of each set of weights (B, R), from that of each motion (R,)."""
    if exposure.stripes:
        runs, over = Sample(x=exposure.x, y=exposure.y).counts(weights)[1:]
        with np.errstate(divide="ignore", invalid="ignore"):
            shares = over / runs  # NaN where all motions of a level that were drawn failed
        drawn = exposure.of_shares(hazard, shares).total
        return Resampled(value=float(single.mean()), drawn=drawn, errors=None, parts=None)
    known = ~np.isnan(single)
    counted = np.vstack([np.ones((1, weights.shape[1])), weights])[:, known]
    counts = counted.sum(axis=1)
    with np.errstate(divide="ignore", invalid="ignore"):
        means = counted @ single[known] / counts
        # what each motion adds to the logarithm of the mean, to first order
        parts = (single[known] / means[:, None] - 1.0) / counts[:, None]
    errors = np.sqrt((counted * parts**2).sum(axis=1))
    all_parts = np.zeros(len(single))
    all_parts[known] = parts[0]
    return Resampled(value=float(means[0]), drawn=means[1:], errors=errors, parts=all_parts)


def _few_parts_factor(parts: Array) -> float:
    """Return the 97.5 % quantile of Student's t for a sum of parts (R,), over that for equal parts."""
    from scipy.special import stdtrit

    squares, most = (parts**2).sum(), len(parts) - 1
    of_error = (parts**4).sum() - squares**2 / len(parts)
    freedom = min(max(2.0 * squares**2 / of_error, 1.0), most) if of_error > 0.0 else most
    return float(stdtrit(freedom, 0.975) / stdtrit(most, 0.975)) if most > 0 else 1.0


def risk_tables(
    blocks: Blocks,
    exposures: Mapping[tuple[str, str], Exposure],
    curves: Mapping[tuple[str, str], tuple[float, float] | None],
    hazard: HazardCurve,
    *,
    weights: Array,
    years: float,
) -> tuple[pd.DataFrame, pd.DataFrame]:
    """Return the risk of overturning of each cylinder and method, and what contributes to it.

    Parameters
    ----------
    blocks : Blocks
    exposures, curves : mapping
        By cylinder and method; a curve by its centre and dispersion in the unit of the hazard, None without.
    hazard : HazardCurve
    weights : ndarray, shape (B, R)
        How often each motion is drawn.
    years : float
        For the probability.

    Returns
    -------
    DataFrame, DataFrame
        See `Fragility.risk`; and cylinder, method, intensity, annual_frequency (of exceedance), probability
        and probability_fit of overturning, contribution and contribution_fit (p |d lambda / d ln theta|).
    """
    rows: list[dict[str, float | str]] = []
    parts = []
    for cylinder in blocks.cylinders:
        reference: Resampled | None = None
        for method in blocks.methods:
            exposure = exposures.get((cylinder, method))
            if exposure is None:
                continue
            single = exposure.frequencies(hazard)
            drawn = resampled(exposure, hazard, single.total, weights)
            stated = _frequency_row(hazard, exposure, single, drawn, blocks.fewest)
            value = float(stated["annual_frequency"])
            reference = drawn if reference is None else reference
            curve = curves[cylinder, method]
            fit = math.nan if curve is None else lognormal_frequency(hazard, *curve)
            about = {"cylinder": cylinder, "method": method}
            rows.append(
                {
                    **about,
                    **stated,
                    "annual_frequency_fit": fit,
                    "probability": -math.expm1(-value * years),
                    "margin": math.nan if curve is None else math.exp(curve[0]) / hazard.intensity_at(RARE),
                    **drawn.over(reference, blocks.fewest).columns("ratio"),
                }
            )
            parts.append(_contributions(hazard, exposure, curve).assign(**about))
    return pd.DataFrame(rows), pd.concat(parts, ignore_index=True)


def _frequency_row(
    hazard: HazardCurve, exposure: Exposure, single: Frequencies, drawn: Resampled, motions: int
) -> dict[str, float | int]:
    """Return the annual frequency with its interval and with what it rests on."""
    total, tail, missing, far = (
        float(np.nanmean(each)) for each in (single.total, single.tail, single.missing, single.far)
    )
    overturning = int((np.nansum(exposure.y, axis=1) > 0.0).sum())
    if overturning < _FEWEST_OVERTURNING:
        found = Interval(value=total, low=0.0, high=exposure.largest(hazard))
    else:
        found = drawn.interval(motions)
        # where so few overturn that many resamples are of none, these have no upper end
        found = replace(found, high=min(found.high, max(exposure.largest(hazard), total)))
    share = 1.0 / total if total > 0.0 else math.nan
    return {
        **found.columns("annual_frequency"),
        "annual_frequency_most": total + missing,
        "tail_share": tail * share,
        "far_share": far * share,
        "motions": len(exposure.y),
        "overturning_motions": overturning,
        "failed": int((np.isnan(exposure.y) & exposure.made).sum()),
    }


_POINTS = 200  # of the picture


def _contributions(
    hazard: HazardCurve, exposure: Exposure, curve: tuple[float, float] | None
) -> pd.DataFrame:
    from scipy.special import ndtr

    x = np.linspace(math.log(hazard.intensity[0]), math.log(hazard.intensity[-1]), _POINTS)
    if exposure.stripes:
        share = np.interp(x, exposure.x[0], np.nanmean(exposure.y, axis=0), left=0.0)
    else:
        rows = [_indicator(x, *each) for each in zip(exposure.x, exposure.y, exposure.uplift, strict=True)]
        share = np.nanmean(rows, axis=0)
    rate = _rate(hazard, x)
    slope = -np.gradient(np.log(rate), x)
    fit = np.full(_POINTS, np.nan)
    if curve is not None:
        centre, dispersion = curve
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
    """Return the measure of a fragility, and the factor on it, that give the measure of a hazard.

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
    blocks: Blocks,
    points: pd.DataFrame,
    of_hazard: Mapping[str, tuple[str, float]],
    dispersion: float | None,
) -> tuple[dict[tuple[str, str], Exposure], dict[tuple[str, str], tuple[float, float] | None]]:
    """Return the exposure and the lognormal curve of each cylinder and method in the unit of a hazard.

    Parameters
    ----------
    blocks : Blocks
    points : DataFrame
        Points of the same fragility.
    of_hazard : mapping of str to (str, float)
        By cylinder: a measure of the points, and the factor on it that gives that of the hazard.
    dispersion : float or None
        Total dispersion of the curves, in the place of that of the motions.
    """
    exposures, curves = {}, {}
    for cylinder in blocks.cylinders:
        measure, factor = of_hazard[cylinder]
        x = blocks.intensities[cylinder, measure] + math.log(factor)
        if not blocks.made.all() and measure != blocks.measure:
            raise ValueError(
                f"motions by level are of the measure of their levels: the hazard must be of "
                f"{blocks.measure}, got {measure}"
            )
        of_points = partial(blocks.of_points, points, cylinder)
        as_recorded = np.nanmean(x - np.log(of_points("scale")), axis=1)
        uplift = as_recorded + np.log(np.nanmean(of_points("uplift_scale"), axis=1))
        synthetic = "synthetic" in points and np.nanmax(of_points("synthetic"), axis=1) > 0.0
        far = np.where(synthetic, np.inf, as_recorded + math.log(FAR))
        for method in blocks.methods:
            y = blocks.exceedance(cylinder, method, OVERTURNED)
            if np.isnan(y).all():
                continue
            key = cylinder, method
            exposures[key] = Exposure(x=x, y=y, made=blocks.made, uplift=uplift, far=far)
            curve = Sample(x=x, y=y).curves()
            own = float(curve.dispersion[0]) if dispersion is None else dispersion
            fitted = KINDS[curve.kinds[0]] in (FITTED, EXTRAPOLATED)
            curves[key] = (float(curve.centre[0]), own) if fitted else None
    return exposures, curves
