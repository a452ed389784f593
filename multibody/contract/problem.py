"""The problem of the contract, its runs, and how a rule says that it does not hold."""

from __future__ import annotations

from typing import Any

import numpy as np

from rockwobble.models import Case, Cylinder, GroundMotion, InitialState, Trace

from ..body import scaled_body
from ..protocol import Scene
from ..scene.froude import REFERENCE_GRAVITY, REFERENCE_TIME_STEP, froude_scale
from ..simulation import simulate
from ..start import starting_state

PIER = Cylinder(semidiagonal=6.0, tan_alpha=0.2)
RELEASE = InitialState(PIER.alpha / 2, rolling_rate=0.5)
PASS = 1.3  # [s] until after the first pass


def run(engine: str, support: str, **changes: Any) -> Trace:
    """Run the release, or the problem that `changes` make of it."""
    given: dict[str, Any] = {"initial": RELEASE, "duration": PASS, **changes}
    names = ("initial", "duration", "gravity", "friction", "motion")
    stated = {name: given.pop(name) for name in names if name in given}
    case = Case(given.pop("cylinder", PIER), **stated)
    return simulate(case, engine=engine, support=support, **given)


def hold(condition: bool, otherwise: str) -> None:
    """Raise an AssertionError that says `otherwise`."""
    # not by the statement, which python -O leaves out
    if not condition:
        raise AssertionError(otherwise)


def small(values: Any, limit: float, otherwise: str) -> None:
    """Raise an AssertionError with the largest of `values`, where it exceeds the limit."""
    largest = float(np.max(np.abs(values)))
    hold(largest <= limit, f"{otherwise}: by {largest:.2e}, allowed is {limit:.0e}")


def refused(arguments: dict[str, Any], named: str) -> None:
    """Hold that a run is refused by a ValueError of one line with the word `named`."""
    try:
        run(**{"duration": 0.01, **arguments})
    except ValueError as error:
        text = str(error)
        hold("\n" not in text and named in text, f"it is refused in other words than one line: {text!r}")
    else:
        raise AssertionError(f"it is not refused: {arguments}")


def shaking() -> GroundMotion:
    """A pulse in both components, weak enough not to overturn the pier."""
    return GroundMotion([[0.5, -0.3], [1.5, 0.4], [-1.0, 0.8], [0.3, -1.2], [0.0, 0.0]], 0.3)


def scene_of(support: str, initial: InitialState = RELEASE) -> Scene:
    """A release as a stepper meets it."""
    scale = froude_scale(PIER.semidiagonal, REFERENCE_GRAVITY)
    body = scaled_body(PIER, scale.length)
    case = Case(PIER, initial=initial, duration=PASS, name="contract")
    return Scene(
        body=body,
        start=starting_state(body, case.initial, scale.time),
        support=support,
        friction=case.friction,
        time_step=REFERENCE_TIME_STEP,
        gravity=REFERENCE_GRAVITY,
        components="",
        unit_time=scale.time,
    )
