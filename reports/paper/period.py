"""Figure 3: the period of steady wobble over its tilt, and that of planar rocking."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from rockwobble import reduced
from rockwobble.models import Cylinder

from ..figures.drawing import drawn, with_grid
from .claim import Claim, verdict_of

if TYPE_CHECKING:
    import pandas as pd
    from matplotlib.figure import Figure

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
# the curves of slender bodies lie under Housner's
_ROCKING_SHOWN = (1.0, DISC)
_HEIGHT = 4.6


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Periods:
    """Periods over tilt, both without dimension.

    Attributes
    ----------
    tilt : ndarray, shape (n,)
        theta/alpha [-].
    wobble, rocking : mapping of tan alpha to ndarray, shape (n,)
        p T of steady wobble (24), and of planar rocking, exact [-].
    housner : ndarray, shape (n,)
        p T of planar rocking, linearised for slender bodies (Housner 1963) [-].
    disc : ndarray, shape (n,)
        p T of a thin disc in a recess, in closed form, at the tilts of `DISC` [-].
    """

    tilt: Array
    wobble: Mapping[float, Array]
    rocking: Mapping[float, Array]
    housner: Array
    disc: Array

    def to_frame(self) -> pd.DataFrame:
        """Return a table: tilt_over_alpha, tan_alpha (NaN where linearised), curve, p_times_period."""
        import pandas as pd

        curves = [("wobble", ta, values) for ta, values in self.wobble.items()]
        curves += [("rocking", ta, values) for ta, values in self.rocking.items()]
        curves += [("housner", np.nan, self.housner), ("disc", DISC, self.disc)]
        tables = [
            pd.DataFrame(
                {"tilt_over_alpha": self.tilt, "tan_alpha": ta, "curve": name, "p_times_period": values}
            )
            for name, ta, values in curves
        ]
        return pd.concat(tables, ignore_index=True)


def periods() -> Periods:
    """Compute the curves."""
    # closer where the wobble begins like a root and where both periods rise without bound
    tilt = 0.5 * (1.0 - np.cos(np.linspace(0.03, np.pi - 0.03, 240)))
    wobble, rocking = {}, {}
    for tan_alpha in TAN_ALPHAS:
        cylinder = Cylinder(semidiagonal=1.0, tan_alpha=tan_alpha)
        p = _frequency(cylinder)
        wobble[tan_alpha] = p * reduced.wobbling_period(cylinder, tilt * cylinder.alpha)
        rocking[tan_alpha] = p * reduced.rocking_period(cylinder, tilt * cylinder.alpha)
    disc = Cylinder(semidiagonal=1.0, tan_alpha=DISC)
    return Periods(
        tilt=tilt,
        wobble=wobble,
        rocking=rocking,
        housner=4.0 * np.arccosh(1.0 / (1.0 - tilt)),
        disc=_frequency(disc) * _disc_period(disc.base_radius, tilt * disc.alpha),
    )


def _frequency(cylinder: Cylinder) -> float:
    """P of a homogeneous cylinder [1/s], equation (23)."""
    return float(np.sqrt(12.0 / (15.0 + np.cos(cylinder.alpha) ** 2) * _GRAVITY / cylinder.semidiagonal))


def _disc_period(radius: float, tilt: Array) -> Array:
    """Period of steady wobble of a disc without thickness, held against rolling out [s]."""
    square = 4.0 * _GRAVITY * np.cos(tilt) / (radius * np.sin(tilt) * (6.0 - 5.0 * np.cos(tilt)))
    return np.asarray(2.0 * np.pi / np.sqrt(square))


def period_figure(data: Periods) -> bytes:
    """Return the figure as SVG."""

    def draw(figure: Figure) -> None:
        import matplotlib as mpl

        axes = figure.subplots()
        colours = mpl.colormaps["cividis"](np.linspace(0.0, 0.88, len(data.wobble)))
        for colour, (tan_alpha, values) in zip(colours, data.wobble.items(), strict=True):
            label = f"wobble, tan α = {tan_alpha:g}" + (" (disc)" if tan_alpha == DISC else "")
            axes.plot(data.tilt, values, color=colour, linewidth=1.6, label=label)
        for colour, (tan_alpha, values) in zip(colours, data.rocking.items(), strict=True):
            if tan_alpha in _ROCKING_SHOWN:
                label = f"planar, exact, tan α = {tan_alpha:g}"
                axes.plot(data.tilt, values, color=colour, linewidth=1.1, linestyle=(0, (5, 2)), label=label)
        axes.plot(
            data.tilt,
            data.housner,
            color="#D55E00",
            linewidth=2.0,
            linestyle=(0, (1, 1)),
            label="planar, Housner",
        )
        axes.set_xlim(0.0, 1.0)
        axes.set_ylim(0.0, 15.0)
        axes.set_xlabel("tilt / α [-]")
        axes.set_ylabel("p × period [-]")
        axes.legend(loc="upper left", ncols=2)
        with_grid(axes)

    return drawn(draw, _HEIGHT)


def period_claims(data: Periods) -> list[Claim]:
    """Hold what the paper says of the figure against the curves."""
    return [_disc_claim(data), _housner_claim(data)]


def _disc_claim(data: Periods) -> Claim:
    near = data.tilt <= _DISC_REACH
    off = float(np.abs(data.wobble[DISC] / data.disc - 1.0)[near].max())
    return Claim(
        says=f"the curve of tan α = {DISC:g} is that of a spinning disc.",
        found=f"it differs from the closed form for a disc without thickness by at most {100.0 * off:.2g} % "
        f"of the period up to a tilt of {_DISC_REACH:g} α.",
        verdict=verdict_of(off < _DISC_TOLERANCE),
    )


def _housner_claim(data: Periods) -> Claim:
    near = data.tilt <= _LINEAR_REACH
    off = {
        tan_alpha: float(np.abs(data.housner / exact - 1.0)[near].max())
        for tan_alpha, exact in data.rocking.items()
        if tan_alpha != DISC
    }
    good = [tan_alpha for tan_alpha, error in off.items() if error < _SLENDER_TOLERANCE]
    listed = ", ".join(f"{100.0 * error:.2g} % at tan α = {tan_alpha:g}" for tan_alpha, error in off.items())
    slender, squat = off[min(off)], off[max(off)]
    reach = (
        f"within {100.0 * _SLENDER_TOLERANCE:g} % up to tan α = {max(good):g}" if good else "never so close"
    )
    return Claim(
        says="Housner's period of planar rocking is linearised, holds only for small α, and is then "
        "independent of its value.",
        found=f"against the exact period it errs, up to a tilt of {_LINEAR_REACH:g} α, by {listed}: {reach}.",
        verdict=verdict_of(slender < _SLENDER_TOLERANCE, squat > _SLENDER_TOLERANCE),
    )
