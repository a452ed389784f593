"""Figure 4: three modes of free response, from hardly any spin to steady wobble."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from rockwobble import reduced
from rockwobble.models import Case, Cylinder, InitialState

from ..figures.drawing import drawn, drawn_samples, line, path, with_grid
from ..figures.thinning import kept_samples
from .claim import Claim, verdict_of

if TYPE_CHECKING:
    import pandas as pd
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

    from rockwobble.reduced import Response

Array = NDArray[np.float64]

SPIN, STEADY, BOTH = "very small spin", "steady wobble", "both"
CYLINDER = Cylinder(semidiagonal=6.0, tan_alpha=0.2)
# the paper does not say from where it releases
RELEASE = 0.5  # tilt over alpha
_SMALL_SPIN = 1e-3  # [rad/s]
_SHARE_OF_STEADY = 0.4  # of the spin of steady wobble, in between
_DURATION = 15.0  # [s]
_RTOL = 1e-11
# a pass takes some minimum tilt over tilt rate, here a quarter of a millisecond [s]
_SAMPLE_STEP = 5e-5
_POINTS = 4000
_HEIGHT = 9.4
_COLOUR = "#0072B2"

# "a little over pi", and "compares well" [rad]
_LITTLE = math.radians(10.0)
_WELL = math.radians(1.0)
# steady to the eye
_STEADY = 1e-3
# a tenth of the spin gives ten times the force in the limit: the greater part of that
_GROWTH = 5.0
# a millionth of the base radius is below what any survey of a structure resolves
_RESIDUAL = 1e-6


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class FreeModes:
    """The three responses, and one of yet smaller spin.

    Attributes
    ----------
    responses : mapping of mode to Response
    smaller : Response
        With a tenth of the very small spin.
    """

    responses: Mapping[str, Response]
    smaller: Response

    def to_frame(self) -> pd.DataFrame:
        """Return the samples drawn, one row each, with the mode in the first column."""
        import pandas as pd

        tables = []
        for mode, response in self.responses.items():
            keep = kept_samples(response.tilt, response.tilt_rate, response.rolling_rate, points=_POINTS)
            table = drawn_samples(response, keep)
            table.insert(0, "mode", mode)
            tables.append(table)
        return pd.concat(tables, ignore_index=True)


def free_modes() -> FreeModes:
    """Run the three releases."""
    steady = reduced.steady_wobble_rate(CYLINDER, RELEASE * CYLINDER.alpha)
    spins = {SPIN: _SMALL_SPIN, STEADY: steady, BOTH: _SHARE_OF_STEADY * steady}
    return FreeModes(
        responses={mode: _released(spin) for mode, spin in spins.items()},
        smaller=_released(0.1 * _SMALL_SPIN, sample_step=_DURATION),  # only its greatest force is asked for
    )


def _released(spin: float, sample_step: float = _SAMPLE_STEP) -> Response:
    release = InitialState(tilt=RELEASE * CYLINDER.alpha, rolling_rate=spin)
    return reduced.simulate(
        Case(CYLINDER, initial=release, duration=_DURATION), rtol=_RTOL, sample_step=sample_step
    )


def free_figure(data: FreeModes) -> bytes:
    """Return the figure as SVG: one column for each mode, the orbit above its time histories."""

    def draw(figure: Figure) -> None:
        rows = figure.subplots(5, 3, height_ratios=[2.4, 1, 1, 1, 1])
        for column, (letters, (mode, response)) in enumerate(
            zip(("a, b", "c, d", "e, f"), data.responses.items(), strict=True)
        ):
            spin = float(response.rolling_rate[0])
            rows[0, column].set_title(f"({letters}) {mode}\nφ'(0) = {spin:.3g} rad/s")
            _orbit(rows[0, column], response)
            _histories(rows[1:, column], response)
        for row, label in zip(
            rows[:, 0],
            ("y of the centre of mass [m]", "θ / α [-]", "θ' [rad/s]", "φ / π [-]", "φ' [rad/s]"),
            strict=True,
        ):
            row.set_ylabel(label)
        # the same scale across, so that the modes compare; the rates of the spin mode need their own
        for i in (1, 2):
            low = min(axes.get_ylim()[0] for axes in rows[i])
            high = max(axes.get_ylim()[1] for axes in rows[i])
            for axes in rows[i]:
                axes.set_ylim(low, high)
        for axes in rows[4]:
            axes.set_xlabel("time [s]")
        figure.align_ylabels(rows[:, 0])

    return drawn(draw, _HEIGHT)


def _orbit(axes: Axes, response: Response) -> None:
    centre = response.centre_of_mass[:, :2]
    path(axes, centre, color=_COLOUR, linewidth=0.9)
    axes.plot(*centre[0], marker="o", color="black", markersize=4)
    reach = 1.12 * float(np.abs(centre).max())
    axes.set_xlim(-reach, reach)
    axes.set_ylim(-reach, reach)
    axes.set_aspect("equal")
    axes.set_xlabel("x [m]")
    with_grid(axes)


def _histories(column: NDArray[np.object_], response: Response) -> None:
    time = response.time
    shown = (
        response.tilt / CYLINDER.alpha,
        response.tilt_rate,
        response.rolling_angle / math.pi,
        response.rolling_rate,
    )
    for axes, values in zip(column, shown, strict=True):
        line(axes, time, values, color=_COLOUR, linewidth=1.0)
        axes.set_xlim(0.0, time[-1])
        with_grid(axes)
    column[0].set_ylim(0.0, 1.1 * RELEASE)
    rates = response.rolling_rate
    if rates.max() > 100.0 * rates.min():
        column[3].set_yscale("log")
    else:
        column[3].set_ylim(0.0, 1.15 * float(rates.max()))
    for axes in column[:-1]:
        axes.tick_params(labelbottom=False)


def free_claims(data: FreeModes) -> list[Claim]:
    """Hold what the paper says of the figure against the responses."""
    return [
        _turn_claim(data.responses[SPIN]),
        _force_claim(data),
        _steady_claim(data.responses[STEADY]),
        _return_claim(data),
    ]


def _turn_claim(response: Response) -> Claim:
    turns = response.passes["angle_of_turn"].to_numpy()
    turn, spread = float(turns.mean()), float(np.ptp(turns))
    spin = float(response.rolling_rate[0])
    exact = reduced.angle_of_turn(CYLINDER, InitialState(tilt=response.tilt[0], rolling_rate=spin))
    limit = reduced.limiting_angle_of_turn(CYLINDER)
    return Claim(
        says="for a very small spin the pivot changes rapidly by an angle of turn slightly larger than π, "
        "which compares well with the prediction of Srinivasan and Ruina.",
        found=f"at {len(turns)} passes the contact point turns by {_degrees(turn)}, the same to "
        f"{math.degrees(spread):.1g} deg ({_degrees(turn - math.pi)} more than π; exact for this spin "
        f"{_degrees(exact)}; their limit for vanishing spin {_degrees(limit)}).",
        verdict=verdict_of(0.0 < turn - math.pi < _LITTLE, abs(turn - limit) < _WELL),
    )


def _force_claim(data: FreeModes) -> Claim:
    small, smaller = data.responses[SPIN], data.smaller
    force, larger = (run.assumptions.largest_normal_force for run in (small, smaller))
    return Claim(
        says="the abrupt change of pivot is smooth but generates large vertical forces, which in the limit "
        "become infinite.",
        found=f"the vertical force rises to {force:.3g} weights at a spin of "
        f"{float(small.rolling_rate[0]):.0e} rad/s and to {larger:.3g} at "
        f"{float(smaller.rolling_rate[0]):.0e} rad/s.",
        verdict=verdict_of(force > 1.0, larger > _GROWTH * force),
    )


def _steady_claim(response: Response) -> Claim:
    tilt = response.tilt
    change = float(np.abs(tilt / tilt[0] - 1.0).max())
    turned = response.rolling_angle - response.rolling_angle[0]
    period = float(np.interp(2.0 * math.pi, turned, response.time))
    formula = reduced.wobbling_period(CYLINDER, float(tilt[0]))
    return Claim(
        says="with the spin of (24) the tilt stays constant and the cylinder only wobbles.",
        found=f"in {response.time[-1]:g} s the tilt changes by at most {change:.1g} of itself, and the "
        f"contact point goes round in {period:.4f} s, (24) without its misprints {formula:.4f} s.",
        verdict=verdict_of(change < _STEADY, abs(period / formula - 1.0) < _STEADY),
    )


def _return_claim(data: FreeModes) -> Claim:
    # the centre of the base is b (1 - cos theta) from its place: equation (10)
    least = float(data.responses[SPIN].passes["minimum_tilt"].min())
    away = 2.0 * math.sin(0.5 * least) ** 2
    twist = max(float(np.abs(run.twist).max()) for run in data.responses.values())
    combined = reduced.free_response(
        CYLINDER,
        InitialState(tilt=RELEASE * CYLINDER.alpha, rolling_rate=float(data.responses[BOTH].rolling_rate[0])),
    )
    turns = data.responses[BOTH].passes["angle_of_turn"].to_numpy()
    return Claim(
        says="the third mode combines the two, and the cylinder has no residual displacement.",
        found=f"in the third mode the tilt swings between {combined.minimum_tilt / CYLINDER.alpha:.3f} and "
        f"{combined.maximum_tilt / CYLINDER.alpha:.3f} α while the contact point turns by "
        f"{_degrees(float(turns.mean()))} from maximum to maximum. Where the cylinder comes nearest to "
        f"upright the centre of its base is within {away:.0e} b of its place, and its twist is {twist:g}.",
        verdict=verdict_of(
            0.0 < combined.minimum_tilt < combined.maximum_tilt, away < _RESIDUAL and twist == 0.0
        ),
    )


def _degrees(angle: float) -> str:
    return f"{math.degrees(angle):.2f} deg"
