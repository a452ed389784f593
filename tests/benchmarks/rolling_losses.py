"""Rolling resistance: laws, error over tolerance, and the engines beside the models.

`python tests/benchmarks rolling_losses` prints five tables: quantities that have a law, by it and by the
models; error of the models over the tolerance in free response; the rolling friction of engines against the
models over step and coefficient of friction, and in a frame; how often MuJoCo's contact is closed then; when
engines uplift.
"""

from __future__ import annotations

import dataclasses
import math
from collections.abc import Sequence
from typing import TYPE_CHECKING, Any, cast

import numpy as np

from rockwobble import multibody, reduced
from rockwobble.models import Case, Cylinder, GroundMotion, InitialState, Trace, WobblingFrame
from rockwobble.multibody.simulation import open_scene
from rockwobble.reduced.body import body_of
from rockwobble.reduced.rolling import impact_ratio

from .console import options_of, show

if TYPE_CHECKING:
    import pandas as pd

SHARE = 0.01  # delta over b
TOLERANCES = (1e-6, 1e-7, 1e-8, 1e-9, 1e-10)
ENGINES = {"mujoco": ((1.0, 20.0), (4e-4, 2e-4, 1e-4)), "pybullet": ((1.0, 4.0), (4e-4, 2e-4))}
GRIP = {"mujoco": 20.0, "pybullet": 4.0}  # friction that leaves the couple whole
UPLIFTS = (("mujoco", 2e-4), ("mujoco", 1e-4), ("pybullet", 2e-4))
_WATCHED = 5000  # steps, half a second
_PIER = Cylinder(semidiagonal=6.0, tan_alpha=1.0 / 3.0)


def _released(
    share: float,
    *,
    spin: float,
    friction: float = 1.0,
    duration: float = 4.0,
    cylinder: Cylinder | WobblingFrame = _PIER,
) -> Case:
    release = InitialState(0.5 * _PIER.alpha, rolling_rate=spin)
    length = share * _PIER.base_radius
    return Case(cylinder, initial=release, duration=duration, friction=friction, rolling_resistance=length)


def _ramp() -> GroundMotion:
    """Return a ground acceleration that grows by 1.25 g tan(alpha) per second."""
    along = 1.25 * 9.81 * _PIER.tan_alpha * np.arange(0.0, 1.0, 0.01)
    return GroundMotion(np.column_stack([along, np.zeros_like(along)]), 0.01)


def _swing(cylinder: Cylinder, length: float, spin: float) -> float:
    """Return the share of its energy that a release from alpha/2 loses to the next maximum."""
    release = InitialState(0.5 * cylinder.alpha, rolling_rate=spin)
    case = Case(cylinder, initial=release, duration=2.5, rolling_resistance=length)
    trace = reduced.simulate(case, rtol=1e-12, sample_step=1e-4)
    maxima = trace.extrema[trace.extrema[:, 3] > 0.0, 0]
    lost = np.interp(maxima[:2], trace.time, trace.energy_lost)
    return float(lost[1] - lost[0]) / float(trace.energy[0])


def _swing_laws(cylinder: Cylinder) -> tuple[float, float]:
    """Return what `_swing` is to first order in delta/b: in a plane, and in the limit of vanishing spin."""
    body, tilt = body_of(cylinder, 9.81), 0.5 * cylinder.alpha
    b, h = body.b, body.h
    theta = np.linspace(0.0, tilt, 20_001)
    lever, height = b * np.cos(theta) - h * np.sin(theta), b * np.sin(theta) + h * np.cos(theta)
    fall = body.g * (height[-1] - height)
    normal = body.g * (1.0 - lever**2 / body.A) - height * 2.0 * fall / body.A
    x = np.linspace(0.0, 1.0, 20_001)
    longer = np.trapezoid(np.sqrt(x * x + body.A / body.J * (1.0 - x * x)), x)
    energy = body.g * (height[-1] - h)
    load, at_pass = 2.0 * b * float(np.trapezoid(normal, theta)) / energy, 4.0 * b * b / body.A
    return load + at_pass, load + longer * at_pass


def quantities() -> pd.DataFrame:
    """Return quantities that have a law of first order in delta/b, by it and by the models."""
    import pandas as pd

    small, tall = 1e-6, Cylinder(semidiagonal=math.sqrt(5.0), tan_alpha=0.5)
    length = small * tall.base_radius
    plane, space = _swing_laws(tall)
    slender = Cylinder(semidiagonal=1.0, tan_alpha=0.025)
    body = body_of(slender, 9.81)
    loss = 2.0 * body.b**2 / body.A
    rolled = 1.0 - impact_ratio(body._replace(delta=body.b), 1.0)
    housner = 1.0 - reduced.restitution_from_momentum(slender)
    disc, tilt = Cylinder(semidiagonal=1.0, tan_alpha=1e4), 0.02
    ends = math.sqrt(tilt) / (2.0 / 3.0 * 2e-3 * math.sqrt(9.81))
    release = InitialState(tilt, rolling_rate=reduced.steady_wobble_rate(disc, tilt))
    case = Case(disc, initial=release, duration=0.9 * ends, rolling_resistance=2e-3 * disc.base_radius)
    spun = reduced.simulate(case, rtol=1e-9)
    late = spun.time > 0.5 * ends
    logs = np.log(ends - spun.time[late]), np.log(np.abs(spun.rolling_rate[late]))
    waits = [
        reduced.simulate(Case(_PIER, _ramp(), rolling_resistance=share * _PIER.base_radius)).uplift_time
        for share in (0.0, 0.03)
    ]
    rows = [
        ("loss of a swing from rest, over delta/b", plane, _swing(tall, length, 0.0) / small),
        ("the same with a near-upright pass", space, _swing(tall, length, 1e-5) / small),
        ("loss of speed at a pass, delta = b, tan(alpha) 0.025", loss, rolled),
        ("the same of Housner's impact", loss, housner),
        ("exponent of a disc's precession in the time left", -1.0, float(np.polyfit(*logs, 1)[0])),
        ("delay of uplift on 1.25 g tan(alpha)/s, delta/b 0.03 [s]", 0.03 / 1.25, waits[1] - waits[0]),
    ]
    return pd.DataFrame(rows, columns=["quantity", "law", "model"])


def errors() -> pd.DataFrame:
    """Return the largest error of tilt [alpha] and energy account (relative) over the tolerance."""
    import pandas as pd

    rows = []
    for model, options in reduced.MODELS.items():
        case = _released(SHARE, spin=0.0 if model == "planar" else 0.3, duration=12.0)
        exact = reduced.simulate(case, rtol=1e-13, **options).tilt
        for rtol in TOLERANCES:
            trace = reduced.simulate(case, rtol=rtol, **options)
            account = (trace.energy + trace.energy_lost) / trace.energy[0] - 1.0
            error = float(np.abs(trace.tilt - exact).max()) / _PIER.alpha
            rows.append((model, rtol, error, float(np.abs(account).max()), trace.step_count))
    return pd.DataFrame(rows, columns=["model", "rtol", "tilt_error", "energy_error", "steps"])


def engines() -> pd.DataFrame:
    """Return what engines and models have of the same releases, of a cylinder and of a frame.

    Columns: the largest error of the tilt, and what it would be without loss [alpha]; the share of the energy
    that model and engine lose, and the largest difference of it on the way.
    """
    import pandas as pd

    cases = []
    for share in (0.0, 0.004, 0.02):
        for engine, (frictions, steps) in ENGINES.items():
            for friction in frictions if share else [GRIP[engine]]:
                cases += [(_released(share, spin=0.5, friction=friction), engine, step) for step in steps]
    frame = WobblingFrame(_PIER, 1.0, columns=1)
    for engine, friction in GRIP.items():
        case = _released(0.02, spin=0.5, friction=friction, duration=2.0, cylinder=frame)
        cases += [(case, engine, step) for step in (2e-4, 5e-5)]
    rows: list[tuple[object, ...]] = []
    for support in ("recess", "flat"):
        for case, engine, step in cases:
            model = reduced.simulate(case, support=support, rtol=1e-10)
            free = reduced.simulate(dataclasses.replace(case, rolling_resistance=0.0), support=support)
            trace = multibody.simulate(case, engine=engine, support=support, time_step=step)
            kept, taken = model.energy / model.energy[0], trace.energy / trace.energy[0]
            body = "frame" if case.cylinder is frame else "cylinder"
            share = case.rolling_resistance / _PIER.base_radius
            row = (
                support,
                body,
                share,
                engine,
                case.friction,
                step,
                _apart(trace, model),
                _apart(free, model),
            )
            rows.append((*row, 1.0 - kept[-1], 1.0 - taken[-1], float(np.abs(taken - kept).max())))
    names = ["support", "body", "delta_b", "engine", "friction", "step"]
    names += ["tilt_error", "effect", "lost", "engine_lost", "account"]
    return pd.DataFrame(rows, columns=names)


def _apart(trial: Trace, reference: Trace) -> float:
    """Return the largest difference of two tilts [alpha]."""
    return float(np.abs(trial.tilt - reference.tilt).max()) / _PIER.alpha


def contact_shares() -> pd.DataFrame:
    """Return the share of steps in which an end of MuJoCo's column is in contact, after a release."""
    import pandas as pd

    rows = []
    for body, cylinder, ends in (
        ("cylinder", _PIER, 1),
        ("frame", WobblingFrame(_PIER, 1.0, columns=1), 2),
    ):
        for share in (0.0, 0.004, 0.02):
            case = _released(share, spin=0.5, friction=GRIP["mujoco"], duration=1.0, cylinder=cylinder)
            with open_scene(case, "mujoco", "recess", {}) as stepper:
                counts, inside = [], cast("Any", stepper)
                for still in np.zeros((_WATCHED, 1, 3)):
                    stepper.advance(still)
                    counts.append(inside.counts().contacts)
            rows.append((body, share, float(np.mean(counts)) / ends))
    return pd.DataFrame(rows, columns=["body", "delta_b", "in_contact"])


def uplifts() -> pd.DataFrame:
    """Return when the tilt of an engine on the ramp reaches 1e-4 alpha, after that of the model [ms].

    Beside it that of the model without loss, and the largest difference of the tilts [alpha], in 0.95 s;
    delta/b 0.03.
    """
    import pandas as pd

    rows = []
    for engine, step in UPLIFTS:
        length = 0.03 * _PIER.base_radius
        case = Case(_PIER, _ramp(), duration=0.95, friction=GRIP[engine], rolling_resistance=length)
        model = reduced.simulate(case, rtol=1e-10, sample_step=1e-3)
        free = reduced.simulate(dataclasses.replace(case, rolling_resistance=0.0), sample_step=1e-3)
        trace = multibody.simulate(case, engine=engine, time_step=step, sample_step=1e-3)
        tilts = [each.tilt / _PIER.alpha for each in (model, free, trace)]
        begun, without, later = (float(np.interp(1e-4, tilt, model.time)) for tilt in tilts)
        rows.append((engine, step, 1e3 * (later - begun), 1e3 * (without - begun), _apart(trace, model)))
    return pd.DataFrame(rows, columns=["engine", "step", "after", "without_loss", "tilt_error"])


def main(arguments: Sequence[str]) -> int:
    """Print the tables."""
    options_of("rolling_losses", "Error and engines with rolling resistance.").parse_args(arguments)
    forms = {"quantity": "", "law": ".5g", "model": ".5g"}
    show(quantities(), "Quantities by law and model", forms)
    forms = {"model": "", "rtol": ".0e", "tilt_error": ".1e", "energy_error": ".1e", "steps": "d"}
    show(errors(), "Free response, errors of tilt (in alpha) and of the energy account", forms)
    forms = {"support": "", "body": "", "delta_b": ".3f", "engine": "", "friction": ".0f", "step": ".0e"}
    forms |= {"tilt_error": ".1e", "effect": ".1e", "lost": ".4f", "engine_lost": ".4f", "account": ".1e"}
    show(engines(), "Rolling friction of engines against the models, tilt in alpha", forms)
    forms = {"body": "", "delta_b": ".3f", "in_contact": ".3f"}
    show(contact_shares(), "Steps in which an end of MuJoCo's column is in contact", forms)
    forms = {"engine": "", "step": ".0e", "after": ".1f", "without_loss": ".1f", "tilt_error": ".1e"}
    show(uplifts(), "Uplift of engines after the models [ms], delta/b 0.03, tilt in alpha", forms)
    return 0
