"""Layer records, third part: values that no cylinder, motion or run can have, each refused by name.

A value that is let in does not stop a run: it ends as a wrong number in a table.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator, Mapping
from dataclasses import replace
from functools import partial
from typing import Any

from rockwobble.models import Case, Cylinder, GroundMotion, InitialState, Run, Suite, el_centro_1940, pulse
from rockwobble.multibody import available_engines, simulate
from rockwobble.multibody.engines.registry import find_engine

from ..bench import Bench
from ..finding import Finding, none_wrong

PIER = Cylinder(semidiagonal=6.0, tan_alpha=0.2)
STILL = Case(PIER, initial=InitialState(0.1), duration=1.0)
MOTION = GroundMotion([[0.0, 0.0], [1.0, 0.5], [0.0, 0.0]], 0.01)
Maker = Callable[[Any], object]
Makers = Mapping[str, Callable[[], object]]
NO_SIZES = (0.0, -1.0, math.nan, math.inf)
NO_NUMBERS = (math.nan, math.inf)


def check(bench: Bench) -> Iterator[Finding]:
    """Yield the findings of this part."""
    makers = {**_values(), **_options(bench)}
    name = f"wrong values that are taken, or refused without their name, of {len(makers)}"
    reason = "each is refused, and the message names it"
    yield none_wrong(name, _accepted(makers), reason, "refusal of wrong values")
    yield none_wrong(
        "values that can be changed from outside",
        [name for name, change in _changes().items() if _is_done(change)],
        "a case that has been run stays what it was",
        "values that a case keeps read-only",
    )


def _accepted(makers: Makers) -> list[str]:
    """Return the values that were made, or refused without the word that its name begins with."""
    wrong = []
    for name, make in makers.items():
        try:
            make()
            wrong.append(f"{name}, which is taken")
        except ValueError as refused:
            if name.split(" = ")[0] not in str(refused):
                wrong.append(f"{name}, which is refused with the words {refused}")
        except Exception as error:  # let in, it did harm further on
            wrong.append(f"{name}, which ends in {type(error).__name__}")
    return wrong


def _is_done(change: Callable[[], object]) -> bool:
    try:
        change()
    except (ValueError, AttributeError, TypeError):
        return False
    return True


def _each(name: str, values: tuple[object, ...], make: Maker, of: str = "") -> Makers:
    return {f"{name} = {value!r}{of}": partial(make, value) for value in values}


def _values() -> Makers:
    """Values of cylinders, motions, releases, cases, runs and suites."""
    body = dict.fromkeys(("base_radius", "height", "mass_centre_height"), 2.0)
    body |= dict.fromkeys(("transverse_inertia", "axial_inertia"), 2.0)
    of_body = {key: lambda value, key=key: Cylinder.from_dimensions(**{**body, key: value}) for key in body}
    sine = {"amplitude": 1.0, "period": 1.0}
    of_pulse = {key: lambda value, key=key: pulse("one-sine", **{**sine, key: value}) for key in sine}
    sizes: dict[str, Maker] = {
        "semidiagonal": lambda value: Cylinder(semidiagonal=value, tan_alpha=0.2),
        "tan_alpha": lambda value: Cylinder(semidiagonal=6.0, tan_alpha=value),
        **of_body,
        **of_pulse,
        "duration": lambda value: replace(STILL, duration=value),
        "gravity": lambda value: replace(STILL, gravity=value),
        "time_step": lambda value: Run("mujoco", "recess", value),
    }
    numbers: dict[str, Maker] = {
        "tilt": InitialState,
        "tilt_rate": lambda value: InitialState(0.1, tilt_rate=value),
        "rolling_angle": lambda value: InitialState(0.1, rolling_angle=value),
        "rolling_rate": lambda value: InitialState(0.1, rolling_rate=value),
        "friction": lambda value: replace(STILL, friction=value),
        "factor": MOTION.scaled,
        "acceleration": lambda value: GroundMotion([[0.0, 0.0], [value, 0.0]], 0.01),
        "start": lambda value: pulse("one-sine", amplitude=1.0, period=1.0, start=value),
    }
    found: dict[str, Callable[[], object]] = {}
    for name, make in sizes.items():
        found |= _each(name, NO_SIZES, make)
    for name, make in numbers.items():
        found |= _each(name, NO_NUMBERS, make)
    samples = MOTION.acceleration
    found |= _each("time_step", NO_SIZES, lambda value: GroundMotion(samples, value), " of a motion")
    found |= _each("tilt", (-0.1, 1.6), InitialState)
    found |= _each("friction", (-0.1,), numbers["friction"])
    found |= _each("start", (-0.1,), numbers["start"])
    found |= _each("pulse", ("two-sines",), lambda kind: pulse(kind, amplitude=1.0, period=1.0))
    found |= _each("duration", (None,), lambda none: Case(PIER, duration=none))
    found |= _each("acceleration", ([[0.0]], [0.0, 1.0], []), lambda samples: GroundMotion(samples, 0.01))
    found |= _each("suite", ([],), lambda cases: Suite(cases, [Run("mujoco", "recess")]))
    return found


def _options(bench: Bench) -> Makers:
    """Options of the reduced models, and of an engine, which is not run."""
    solve = bench.reduced.simulate
    asked: dict[str, tuple[object, ...]] = {
        "rtol": (0.0, 1.0, math.nan),
        "rest_tilt": (-1e-3, 0.5, math.nan),
        "sample_step": NO_SIZES,
        "support": ("ring", ""),
        "plane": NO_NUMBERS,
    }
    found: dict[str, Callable[[], object]] = {}
    for option, values in asked.items():
        found |= {f"{option} = {value!r}": partial(solve, STILL, **{option: value}) for value in values}
    found |= _each("restitution", (-0.1, 1.1), lambda value: solve(STILL, plane=0.0, restitution=value))
    found |= _each("restitution", (0.9,), lambda value: solve(STILL, restitution=value))
    spun = replace(STILL, initial=InitialState(0.1, rolling_rate=0.1))
    found |= _each("rolling_rate", (0.1,), lambda _: solve(spun, plane=0.0))
    found |= _each("support", ("ice",), lambda value: simulate(STILL, support=value))
    found |= {
        f"support = {support!r} of {name}": partial(simulate, STILL, engine=name, support=support)
        for name in available_engines()
        for support in sorted({"recess", "flat", "ring"} - set(find_engine(name).supports))
    }
    found |= _each("engine", ("none",), lambda value: simulate(STILL, engine=value))
    found |= _each("time_step", (-1.0, 1.0), lambda value: simulate(STILL, time_step=value), " of an engine")
    found |= _each("sample_step", NO_SIZES, lambda value: simulate(STILL, sample_step=value), " of an engine")
    found |= _each("step_tolerance", (1e-3,), lambda value: simulate(STILL, step_tolerance=value))
    found |= _each("friction_damping", (0.0, 2.5), lambda value: simulate(STILL, friction_damping=value))
    found |= _each("bounciness", (0.5,), lambda value: simulate(STILL, bounciness=value))
    return found


def _changes() -> Makers:
    motion, run = el_centro_1940(), Run("mujoco", "recess", friction_damping=1.0)
    return {
        "a sample of a ground motion": lambda: motion.acceleration.fill(1.0),
        "the duration of a case": lambda: setattr(STILL, "duration", 2.0),
        "a setting of a run": lambda: run.settings.update(friction_damping=1.8),  # type: ignore[attr-defined]
    }
