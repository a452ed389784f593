"""Derivatives of evenly sampled motions, to rounding: central differences of a high order."""

from __future__ import annotations

from math import factorial

import numpy as np

from .bench import Array

REACH = 6  # samples on either side: order 12, so what is left out is (step/time scale)^12


def first(values: Array, step: float) -> Array:
    """Return the rate (n - 2 REACH, ...) of samples (n, ...) that are `step` [s] apart."""
    weights = [_weight(k) / k for k in range(1, REACH + 1)]
    pairs = (weight * (_shifted(values, k) - _shifted(values, -k)) for k, weight in enumerate(weights, 1))
    return np.asarray(sum(pairs) / step)


def second(values: Array, step: float) -> Array:
    """Return the second derivative (n - 2 REACH, ...) of samples (n, ...)."""
    centre = _shifted(values, 0)
    pairs = (
        2.0 * _weight(k) / k**2 * ((_shifted(values, k) - centre) + (_shifted(values, -k) - centre))
        for k in range(1, REACH + 1)
    )
    return np.asarray(sum(pairs) / step**2)


def _weight(k: int) -> float:
    return float((-1) ** (k + 1) * factorial(REACH) ** 2 / (factorial(REACH - k) * factorial(REACH + k)))


def _shifted(values: Array, by: int) -> Array:
    return values[REACH + by : len(values) - REACH + by]
