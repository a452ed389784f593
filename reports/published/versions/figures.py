"""Accuracy figures of one installed engine, measured in a separate process for make.py."""

from __future__ import annotations

import json
import math
import sys
import time
from collections.abc import Callable, Sequence
from typing import Any

import numpy as np

from rockwobble import multibody, reduced
from rockwobble.compare.check import GROUPS
from rockwobble.compare.check import engine as subject_of
from rockwobble.models import Case, Cylinder, InitialState, Trace, el_centro_1940
from rockwobble.multibody import find_engine

# h = 2 b, b = 1 m, released at half its slenderness: its contact point turns by 203.90980 deg on flat ground
CAN = Cylinder(semidiagonal=math.sqrt(5.0), tan_alpha=0.5)
CAN_RELEASE, CAN_LENGTH, CAN_STEP = InitialState(0.5 * CAN.alpha, rolling_rate=0.1), 3.5, 2e-5
RELEASED, RELEASE_STEP = Cylinder(semidiagonal=6.0, tan_alpha=0.35), 1e-4
SHAKEN, SHAKEN_LENGTH, SHAKEN_STEP = Cylinder(semidiagonal=10.0, tan_alpha=0.1), 15.0, 2e-4
_EXACT = 1e-11  # tolerance of the models


def measure(engine: str, *, sweep: bool = True) -> dict[str, Any]:
    """Accuracy figures by name; NaN for failures, with the reason among the remarks.

    The uplift sweep, which takes most of the time, may be left out.
    """
    started = time.perf_counter()
    row: dict[str, Any] = {"version": find_engine(engine).version()}
    figures: list[tuple[str, Callable[[str], Any]]] = [("turn", _turn), ("release", _release)]
    figures += [("el_centro", _shaken), *([("uplift", _uplift)] if sweep else [])]
    for name, figure in figures:
        try:
            row[name] = figure(engine)
        # an old version may raise any error, which becomes its result
        except Exception as error:
            row[name], line = math.nan, (str(error).splitlines() or [""])[0]
            row.setdefault("remarks", []).append(f"{name}: {type(error).__name__}: {line}")
    return row | {"seconds": time.perf_counter() - started}


def _turn(engine: str) -> float:
    """Angle of turn minus that of the flat-ground model [deg]."""
    case = Case(CAN, initial=CAN_RELEASE, duration=CAN_LENGTH)
    run = _finished(multibody.simulate(case, engine=engine, support="flat", time_step=CAN_STEP))
    exact = reduced.simulate(case, support="flat", rtol=_EXACT)
    turned, expected = (float(trace.passes["angle_of_turn"].iloc[0]) for trace in (run, exact))
    return math.degrees(abs(turned) - abs(expected))


def _uplift(engine: str) -> str:
    """Result of the static load sweep: "holds", or the first failure."""
    if not find_engine(engine).uplifts:
        return "no uplift"
    results = [*GROUPS["rest"][-1].run(subject_of(engine))]
    if not any("static loads" in result.name for result in results):
        raise RuntimeError("the sweep of static loads did not run")
    failed = next((result for result in results if result.failed), None)
    return "holds" if failed is None else f"{failed.name}: {failed.value:g}, {failed.note}"


def _release(engine: str) -> float:
    """Largest error of the tilt in 2 s after a release, over alpha."""
    initial = InitialState(0.5 * RELEASED.alpha, rolling_rate=0.5)
    case = Case(RELEASED, initial=initial, duration=2.0)
    support = find_engine(engine).supports[0]
    run = _finished(multibody.simulate(case, engine=engine, support=support, time_step=RELEASE_STEP))
    exact = reduced.simulate(case, support=support, rtol=_EXACT)
    return float(np.abs(run.tilt - exact.tilt).max()) / RELEASED.alpha


def _shaken(engine: str) -> float:
    """Relative root mean square of the tilt difference under El Centro."""
    if not find_engine(engine).uplifts:
        return math.nan
    case = Case(SHAKEN, el_centro_1940(), duration=SHAKEN_LENGTH)
    run = _finished(multibody.simulate(case, engine=engine, time_step=SHAKEN_STEP))
    exact = reduced.simulate(case, rtol=_EXACT)
    return float(np.sqrt(np.mean((run.tilt - exact.tilt) ** 2) / np.mean(exact.tilt**2)))


def _finished(run: Trace) -> Trace:
    if run.outcome == "failed":
        raise RuntimeError(f"the run failed: {', '.join(fact.code for fact in run.facts)}")
    return run


def printed(arguments: Sequence[str]) -> int:
    """Print the figures of the named engine as JSON in the last line."""
    engine, *rest = arguments
    print(json.dumps(measure(engine, sweep="--no-sweep" not in rest)))
    return 0


if __name__ == "__main__":
    sys.exit(printed(sys.argv[1:]))
