"""Figure 3: the period of steady wobble over its tilt, and that of planar rocking."""

from __future__ import annotations

import numpy as np
import pandas as pd
from numpy.typing import NDArray

from rockwobble import reduced
from rockwobble.models import Cylinder

from .statement import Statement, verdict_of

Array = NDArray[np.float64]

DISC = 1000.0  # the slenderness that the paper takes for a spinning disc
TAN_ALPHAS = (0.1, 0.2, 0.5, 1.0, 3.0, DISC)
# next to alpha the last trace of height decides, and no thickness is thin
_DISC_REACH = 0.9
_DISC_TOLERANCE = 0.01  # what no eye sees in a figure
# of the period, over tilts up to this share of alpha: what an engineer accepts of a linearisation
_SLENDER_TOLERANCE = 0.01
_LINEAR_REACH = 0.95
_GRAVITY = 9.81


def periods() -> pd.DataFrame:
    """Return curve, tan_alpha (NaN where linearised), tilt_over_alpha and p_times_period.

    Curves: "wobble", steady wobble (24); "rocking", planar rocking, exact; "housner", the same linearised for
    slender bodies (Housner 1963); "disc", a thin disc in a recess, in closed form, at the tilts of `DISC`.
    """
    # closer where the wobble begins like a root and where both periods rise without bound
    tilt = 0.5 * (1.0 - np.cos(np.linspace(0.03, np.pi - 0.03, 240)))
    curves: list[tuple[str, float, Array]] = []
    for tan_alpha in TAN_ALPHAS:
        cylinder = Cylinder(semidiagonal=1.0, tan_alpha=tan_alpha)
        p, theta = _frequency(cylinder), tilt * cylinder.alpha
        curves += [
            ("wobble", tan_alpha, np.asarray(p * reduced.wobbling_period(cylinder, theta))),
            ("rocking", tan_alpha, np.asarray(p * reduced.rocking_period(cylinder, theta))),
        ]
    disc = Cylinder(semidiagonal=1.0, tan_alpha=DISC)
    closed = _frequency(disc) * _disc_period(disc.base_radius, tilt * disc.alpha)
    curves += [("housner", np.nan, 4.0 * np.arccosh(1.0 / (1.0 - tilt))), ("disc", DISC, closed)]
    tables = [
        pd.DataFrame({"curve": name, "tan_alpha": ta, "tilt_over_alpha": tilt, "p_times_period": values})
        for name, ta, values in curves
    ]
    return pd.concat(tables, ignore_index=True)


def curve(table: pd.DataFrame, name: str, tan_alpha: float = np.nan) -> tuple[Array, Array]:
    """Return tilt over alpha and p times period of a curve."""
    chosen = table[(table["curve"] == name) & (np.isnan(tan_alpha) | (table["tan_alpha"] == tan_alpha))]
    return chosen["tilt_over_alpha"].to_numpy(), chosen["p_times_period"].to_numpy()


def _frequency(cylinder: Cylinder) -> float:
    """P of a homogeneous cylinder [1/s], equation (23)."""
    return float(np.sqrt(12.0 / (15.0 + np.cos(cylinder.alpha) ** 2) * _GRAVITY / cylinder.semidiagonal))


def _disc_period(radius: float, tilt: Array) -> Array:
    """Period of steady wobble of a disc without thickness, held against rolling out [s]."""
    square = 4.0 * _GRAVITY * np.cos(tilt) / (radius * np.sin(tilt) * (6.0 - 5.0 * np.cos(tilt)))
    return np.asarray(2.0 * np.pi / np.sqrt(square))


def statements(table: pd.DataFrame) -> list[Statement]:
    """Hold what the paper says of the figure against the curves."""
    tilt, housner = curve(table, "housner")
    off = _largest(curve(table, "wobble", DISC)[1] / curve(table, "disc")[1], tilt <= _DISC_REACH)
    disc = {"off": off, "reach": _DISC_REACH}
    errors = {
        tan_alpha: _largest(housner / curve(table, "rocking", tan_alpha)[1], tilt <= _LINEAR_REACH)
        for tan_alpha in TAN_ALPHAS
        if tan_alpha != DISC
    }
    slender, squat = errors[min(errors)], errors[max(errors)]
    good = max((ta for ta, error in errors.items() if error < _SLENDER_TOLERANCE), default=0.0)
    linear = {f"{tan_alpha:g}": error for tan_alpha, error in errors.items()}
    linear |= {"reach": _LINEAR_REACH, "tolerance": _SLENDER_TOLERANCE, "good": good}
    return [
        Statement(figure=3, name="disc", numbers=disc, verdict=verdict_of(off < _DISC_TOLERANCE)),
        Statement(
            figure=3,
            name="housner",
            numbers=linear,
            verdict=verdict_of(slender < _SLENDER_TOLERANCE, squat > _SLENDER_TOLERANCE),
        ),
    ]


def _largest(ratio: Array, chosen: NDArray[np.bool_]) -> float:
    return float(np.abs(ratio - 1.0)[chosen].max())
