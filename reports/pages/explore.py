"""Interactive page: one file with the reduced models, ground motions and an initial state."""

from __future__ import annotations

import base64
import importlib.metadata
from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from rockwobble.models import GroundMotion, el_centro_1940
from rockwobble.models.support import RECESS
from rockwobble.models.synthetic import pulse, synthetic_motions

from ..figures.interactive import chart
from ..figures.palette import Style
from ..figures.picture import TIME, Axis, Line, Panel, Picture, ticks_at
from .page import fragment

MOST_RECORDS = 10  # limit for a page: each is some 100 kB of it
_MOST_PEAK = 20.0  # [g]: to which the slider of the intensity brings the weakest ground motion
# motions beside El Centro: length [s], peak [m/s^2], period of the pulse [s], seed
_SYNTHETIC_LENGTH, _SYNTHETIC_PEAK, _PULSE_PERIOD, _SEED = 12.0, 3.0, 0.8, 1

_LEFT = 56  # [pixel] left margin of the graphs over time
# legends of its panels
_COMPONENTS = {"east": "#0072B2", "north": "#D55E00"}
_PATHS = {
    "base at rest": "#bbbbbb",
    "contact point (flat ground)": "#0072B2",
    "top of the column": "#D55E00",
}
_VERDICTS = {
    "no uplift": "#e8e8e8",
    "peak below α/4": "#dbe9f6",
    "to α/2": "#9ecae1",
    "to 3α/4": "#4292c6",
    "to α": "#08519c",
    "beyond α": "#E69F00",
    "overturns": "#B00020",
    "not decided": "#808080",
}


@dataclass(frozen=True, slots=True, kw_only=True)
class Shaking:
    """Ground motion of the interactive page.

    Attributes
    ----------
    motion : GroundMotion
    python : str
        Expression that makes it.
    options : mapping of str to str or bool, optional
        Options of the command line that name it, by their flags without dashes; None where there are none.
    """

    motion: GroundMotion
    python: str
    options: Mapping[str, str | bool] | None = None


@dataclass(frozen=True, slots=True, kw_only=True)
class State:
    """Initial slider values, named as in the address of the page.

    Attributes
    ----------
    height, diameter : float
        [m]
    slab : float
        Mass of the slab over that of the columns [-].
    record : int
        Place of the ground motion; -1 is a release over still ground.
    intensity : float
        Factor on the ground motion.
    tilt, lean : float
        Tilt and direction of a release [deg].
    rate : float
        Rolling rate at release [rad/s].
    support : {"recess", "flat", "planar"}
    plane : float
        Azimuth of the plane of planar motion [deg].
    friction : float
        Friction coefficient on flat ground [-].
    loss : float
        Length of rolling resistance [mm].
    prestress, stiffness : float
        As of `Tendon`.
    yielding : float
        Yield force of the tendon, in weights of one column; 0: elastic without limit.
    """

    height: float
    diameter: float
    slab: float = 0.0
    record: int = 0
    intensity: float = 1.0
    tilt: float = 5.0
    lean: float = 0.0
    rate: float = 0.5
    support: str = RECESS
    plane: float = 0.0
    friction: float = 1.0
    loss: float = 0.0
    prestress: float = 0.0
    stiffness: float = 0.0
    yielding: float = 0.0


def standard_shakings() -> list[Shaking]:
    """Default ground motions of the page: El Centro, a pulse and two synthetic ones."""
    synthetic = synthetic_motions(2, peak=_SYNTHETIC_PEAK, seed=_SEED, duration=_SYNTHETIC_LENGTH)
    made = f"rw.synthetic_motions(2, peak={_SYNTHETIC_PEAK}, seed={_SEED}, duration={_SYNTHETIC_LENGTH})"
    sine = pulse("one-sine", amplitude=_SYNTHETIC_PEAK, period=_PULSE_PERIOD)
    return [
        Shaking(motion=el_centro_1940(), python="rw.el_centro_1940()", options={}),
        Shaking(
            motion=sine,
            python=f'rw.pulse("one-sine", amplitude={_SYNTHETIC_PEAK}, period={_PULSE_PERIOD})',
        ),
        *(Shaking(motion=motion, python=f"{made}[{place}]") for place, motion in enumerate(synthetic)),
    ]


def explore_page(
    shakings: Sequence[Shaking],
    state: State,
    *,
    gravity: float = 9.81,
    duration: float | None = None,
    free: float = 10.0,
    plan: str = "",
) -> str:
    """The page as self-contained HTML.

    Parameters
    ----------
    shakings : sequence of Shaking
        Up to `MOST_RECORDS`.
    state : State
    gravity : float, optional
        [m/s^2]
    duration : float, optional
        Length of the runs under a ground motion [s]. Default: that of the motion.
    free : float, optional
        Length of a release [s].
    plan : str, optional
        Hash of the command that writes it.

    Raises
    ------
    ValueError
        If there are no ground motions, or too many.
    """
    if not 1 <= len(shakings) <= MOST_RECORDS:
        raise ValueError(f"a page holds 1 to {MOST_RECORDS} ground motions, got {len(shakings)}")
    weakest = min(each.motion.peak for each in shakings) or 9.81
    values = {name: getattr(state, name) for name in State.__slots__}
    given = {
        "records": [_shaking_values(each) for each in shakings],
        "state": values,
        "gravity": gravity,
        "duration": duration,
        "free": free,
        "most": max(float(f"{_MOST_PEAK * 9.81 / weakest:.2g}"), state.intensity),
    }
    return fragment(
        "explore/explore.html.j2",
        given=given,
        panels=_panels(),
        plan=plan,
        version=importlib.metadata.version("rockwobble"),
    )


def _shaking_values(shaking: Shaking) -> dict[str, object]:
    motion = shaking.motion
    columns = dict(zip("xyz", np.asarray(motion.acceleration, dtype=np.float64).T, strict=False))
    return {
        "name": motion.name or "record",
        "dt": motion.time_step,
        "python": shaking.python,
        "options": None if shaking.options is None else dict(shaking.options),
        # doubles: a state that is copied out of the page gives the same numbers
        **{key: _doubles(columns[key]) if key in columns else None for key in "xyz"},
    }


def _doubles(values: ArrayLike) -> str:
    return base64.b64encode(np.asarray(values, dtype="<f8").tobytes()).decode()


def _panel(
    x: Axis, y: Axis, height: float, entries: Mapping[str, Style], **look: object
) -> dict[str, object]:
    """Empty panel in the format of `charts.js`, filled by the page; `entries`: its legend."""
    nothing = np.empty(0)
    lines = [Line(x=nothing, y=nothing, name=name, style=style, width=2.0) for name, style in entries.items()]
    empty = chart(Panel(x=x, y=y, layers=lines, height=height), Picture(name="explore", panels=()))
    return empty | {"layers": []} | look


def _panels() -> dict[str, dict[str, object]]:
    """The panels of the page by name."""
    # a logarithmic axis of the map spans little more than a decade
    ticks = ticks_at(factor * 10.0**power for power in range(-4, 4) for factor in (1, 2, 5))
    size = Axis(label="size R", unit="m", log=True, ticks=ticks)
    peak = Axis(label="peak ground acceleration", unit="g", log=True, ticks=ticks)
    east, north = Axis(label="east", unit="m"), Axis(label="north", unit="m")
    over_time = {"link": TIME.title, "left": _LEFT}
    tilt, ground = Axis(label="tilt", unit="deg", low=0.0), Axis(label="ground", unit="g")
    return {
        "tilt": _panel(TIME, tilt, 1.84, {}, **over_time),
        "ground": _panel(TIME, ground, 1.6, _styles(_COMPONENTS), **over_time),
        "path": _panel(east, north, 2.4, _styles(_PATHS), equal=True),
        "map": _panel(size, peak, 2.4, _styles(_VERDICTS, dash="")),
    }


def _styles(colours: Mapping[str, str], dash: str = "solid") -> dict[str, Style]:
    return {name: Style(colour=colour, dash=dash) for name, colour in colours.items()}
