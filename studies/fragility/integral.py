"""Annual frequency of exceeding a limit: a hazard curve integrated with the probability of exceedance.

The mean annual frequency is the integral of p(theta) |d lambda(theta)|, with the frequency of exceedance
lambda of a site and the probability p of exceeding a limit at an intensity theta. Without a fitted curve p is
the share of the motions that exceed it, the mean of the indicator of each: 1 where the motion, scaled to
theta, exceeds it. So safe gaps above the first overturning count as what they are.

Rule of integration. Lambda is a power of theta between the points of its curve, and the indicator is linear
in ln theta between two levels: where it changes, it changes at a place that is unknown and equally probable
anywhere between them. For both the integral is exact, whatever the points and levels,

    int p |d lambda| = [-p lambda] + sum of dp/d ln theta int lambda d ln theta.

Two ends are open. Beyond the last level, or the last point of the curve, the indicator stays what it was. A
motion that exceeds the limit at the lowest level does so from somewhere between there and its uplift on, and
one that does at the first point of the curve counts with the frequency there, the least that it has. The
parts of the frequency that rest on either (tail, head) are stated, and the least and the most that it can be:
where nothing exceeds the limit below the lowest level; and where these motions do from their uplift on, under
a hazard as steep below its first point as above, and all motions do beyond the last level or point, and where
nothing is known.

For a lognormal curve the integral is exact, too: C. A. Cornell, F. Jalayer, R. O. Hamburger and D. A. Foutch,
J. Struct. Eng. 128, 526-533, 2002, on each piece of the hazard curve.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, replace

import numpy as np

from rockwobble.models.hazard import HazardCurve

from .fit import Array

# largest frequency of an extended curve [1/year]: a steeply beginning curve would exceed all numbers below it
OFTEN = 1e3


def lognormal_frequency(hazard: HazardCurve, centre: float, dispersion: float) -> float:
    """Annual frequency [1/year] by a lognormal curve.

    Parameters
    ----------
    hazard : HazardCurve
        A power law between its points. Below the first the frequency of the first counts, beyond the last
        the probability of the last.
    centre, dispersion : float
        Logarithm of the median, in the unit of the hazard, and standard deviation of the logarithm.
    """
    from scipy.special import log_ndtr, ndtr

    x, y = np.log(hazard.intensity), np.log(hazard.annual_frequency)
    if dispersion == 0.0:
        return float(np.exp(np.interp(centre, x, y, right=-math.inf)))
    k = -np.diff(y) / np.diff(x)
    shift = k * dispersion
    a, b = (x[:-1] - centre) / dispersion + shift, (x[1:] - centre) / dispersion + shift
    # evaluated in the tail where the difference of both shares keeps its digits
    a, b = np.where(a > 0.0, -b, a), np.where(a > 0.0, -a, b)
    with np.errstate(divide="ignore"):
        shares = log_ndtr(b) + np.log(-np.expm1(log_ndtr(a) - log_ndtr(b)))
    # lambda at the median by the power law of the piece, times exp(k^2 beta^2 / 2): alone it may overflow
    pieces = np.exp(y[:-1] + k * (x[:-1] - centre) + 0.5 * shift**2 + shares)
    return float(ndtr((x[0] - centre) / dispersion) * hazard.annual_frequency[0] + pieces.sum())


def mean_over(hazard: HazardCurve, low: Array, high: Array) -> Array:
    """Mean annual frequency over ln theta between each `low` and `high` [1/year].

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


def rate_at(hazard: HazardCurve, x: Array) -> Array:
    """Return annual frequencies at logarithms of intensities, constant beyond the ends."""
    return np.asarray(np.exp(np.interp(x, np.log(hazard.intensity), np.log(hazard.annual_frequency))))


def continued(hazard: HazardCurve, low: float) -> HazardCurve:
    """Hazard curve extended down to the logarithm of an intensity, with its first slope, up to `OFTEN`."""
    x, y = np.log(hazard.intensity), np.log(hazard.annual_frequency)
    if low >= x[0] - 1e-9:
        return hazard
    first = min(y[0] + (x[0] - low) * (y[0] - y[1]) / (x[1] - x[0]), max(math.log(OFTEN), y[0] + 1e-6))
    ends = (hazard.intensity, low), (hazard.annual_frequency, first)
    intensity, frequency = (np.concatenate([[math.exp(end)], values]) for values, end in ends)
    return replace(hazard, intensity=intensity, annual_frequency=frequency)


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Frequencies:
    """Annual frequencies of R motions [1/year].

    Attributes
    ----------
    total : ndarray, shape (R,)
        By the rule of integration.
    head : ndarray, shape (R,)
        Part of the total of what exceeds the limit at the lowest level, or at the first point, already.
    tail : ndarray, shape (R,)
        Part of the total that lies beyond the last level or point.
    least, most : ndarray, shape (R,)
        The total at least and at most, whatever happens below and beyond.
    far : ndarray, shape (R,)
        Part of the total at factors on the motion that are far.
    """

    total: Array
    head: Array
    tail: Array
    least: Array
    most: Array
    far: Array


def frequencies_of(hazard: HazardCurve, x: Array, y: Array, uplift: Array, far: Array) -> Frequencies:
    """Annual frequencies from indicators of exceedance.

    Parameters
    ----------
    hazard : HazardCurve
    x : ndarray, shape (R, S)
        Logarithms of the levels in the unit of the hazard, increasing.
    y : ndarray, shape (R, S)
        Indicator, or share, that exceeds the limit there; NaN where it is not known: as between neighbours.
    uplift : ndarray, shape (R,)
        Logarithms of the intensities below which nothing exceeds it.
    far : ndarray, shape (R,)
        Logarithms of the intensities beyond which the motions are scaled far.
    """
    stated, known = y, y.copy()
    for row in np.flatnonzero(np.isnan(y).any(axis=1)):
        known[row] = _fill(x[row], y[row])
    lowest = known[:, 0]
    # share 0 at uplift, if uplift lies below the lowest level
    first = np.minimum(uplift, x[:, 0])
    x = np.column_stack([first, x])
    y = np.column_stack([np.where(uplift < x[:, 1], 0.0, lowest), known])
    begin, end = np.log(hazard.intensity[[0, -1]])
    last = np.clip(x[:, -1], begin, end)
    share = y[:, -1].copy()
    for row in np.flatnonzero(x[:, -1] > end):
        share[row] = np.interp(end, x[row], y[row])
    tail = share * rate_at(hazard, last)
    pieces = _pieces(hazard, x, y, np.full(len(x), begin))
    total = pieces.sum(axis=1) + tail
    # lowest level, or first hazard point: without runs, or hazard, below
    met = np.clip(x[:, 1], begin, end)
    at_met = np.array([np.interp(*each) for each in zip(met, x, y, strict=True)])
    nothing_run = end < x[:, 1]
    longer, worst = continued(hazard, float(first.min())), np.where(np.isnan(stated), 1.0, stated)
    below = worst[:, 0] * (rate_at(longer, first) - rate_at(longer, np.minimum(x[:, 1], end)))
    above = _pieces(longer, x[:, 1:], worst, first).sum(axis=1) + 0.0 * total
    far_tail = np.where(far < end, share * rate_at(hazard, np.maximum(last, far)), 0.0)
    return Frequencies(
        total=total,
        head=np.minimum(pieces[:, 0] + at_met * rate_at(hazard, met), total),
        tail=tail,
        least=np.maximum(total - pieces[:, 0] - np.where(nothing_run, tail, 0.0), 0.0),
        most=below + above + rate_at(longer, np.minimum(x[:, -1], end)),
        far=_pieces(hazard, x, y, np.clip(far, begin, end)).sum(axis=1) + far_tail,
    )


def _fill(x: Array, y: Array) -> Array:
    """Indicator with unknown values interpolated between neighbours; all NaN if none is known."""
    known = ~np.isnan(y)
    return y if known.all() or not known.any() else np.interp(x, x[known], y[known])


def _pieces(hazard: HazardCurve, x: Array, y: Array, low: Array) -> Array:
    """Integral over each interval of the nodes (R, N), from `low` (R,) to the last point."""
    end = math.log(hazard.intensity[-1])
    a, b = (np.minimum(np.maximum(each, low[:, None]), end) for each in (x[:, :-1], x[:, 1:]))
    width, wide = np.diff(x, axis=1), b > a
    slope = np.divide(np.diff(y, axis=1), width, out=np.zeros_like(width), where=width > 0.0)
    p_a, p_b = (y[:, :-1] + slope * (each - x[:, :-1]) for each in (a, b))
    mean = mean_over(hazard, np.where(wide, a, end), np.where(wide, b, end))
    pieces = p_a * (rate_at(hazard, a) - mean) + p_b * (mean - rate_at(hazard, b))
    return np.asarray(np.where(wide, pieces, 0.0))
