"""`rockwobble fragility`: the probability of overturning by several methods under the same motions."""

from __future__ import annotations

import math
from pathlib import Path
from typing import Annotated, Any

import typer

import rockwobble as rw
import rockwobble.compare as rc

from ..console.progress import shown_progress
from ..console.results import show_and_write
from ..console.terminal import command_line, interruptible, user_input
from .inputs import options
from .inputs.grid import values_of
from .inputs.method_values import settings
from .inputs.plan_options import takes_options
from .inputs.problem import refuse
from .inputs.several import ManyMotions, cylinders_of, methods_of
from .sweep import Scheduler

_intensity, _statistics = map(options.panel, ("Intensity", "Statistics"))

Cylinders = Annotated[
    list[str] | None,
    options.body(
        "A cylinder by name, as NAME=R,TAN_ALPHA such as pier=6,0.2; may be repeated.",
        metavar="NAME=R,TAN_ALPHA",
    ),
]
MeasureName = Annotated[
    str,
    _intensity(
        "Intensity: peak_acceleration (over g tan alpha), peak_velocity (times p over g tan alpha), "
        "pga, pgv, sa or sa_mean."
    ),
]
Levels = Annotated[
    str | None,
    _intensity(
        "Intensities to which every motion is scaled: a list 1.5,2,3 or FROM:TO:COUNT, evenly in the "
        "logarithm. Default: 20, from a little above uplift to where most overturn."
    ),
]
Cloud = Annotated[
    str | None,
    _intensity("Motions as they are in the place of levels, times each of these factors: 1, or 0.5,1,2."),
]
Period = Annotated[float, _intensity("Of sa and sa_mean, in s.")]
Models = Annotated[
    list[str] | None,
    options.method(
        "Reduced model: recess, flat, planar-x, planar-y, worse-plane (of the two), or none; may be "
        "repeated. Default: all."
    ),
]
Engines = Annotated[
    list[str] | None,
    options.method(f"{options.ENGINES}; may be repeated. Default: none."),
]
Restitution = Annotated[
    str,
    options.method(
        "Of the planar models: a number, or momentum for Housner's. Default: 1, as the models in three "
        "dimensions."
    ),
]
StepFactor = Annotated[
    float,
    options.method(
        "On the default time step of the engines, in place of --time-step: a share of many runs needs less "
        "than a trace."
    ),
]
Limits = Annotated[
    list[str] | None,
    _statistics(
        'uplift, "0.1 alpha", "0.25 alpha", "0.5 alpha", "1 alpha", overturned or contact_lost; may be '
        "repeated. Default: all but the last, which takes the forces of every run."
    ),
]
Margin = Annotated[float, _statistics("Within which two medians count as equivalent.")]
Resamples = Annotated[int, _statistics("Of the motions, for intervals.", callback=options.whole(2))]


@takes_options
def fragility(
    context: typer.Context,
    many: ManyMotions,
    semidiagonal: Annotated[float, options.body("R, in m.")] = 6.0,
    tan_alpha: Annotated[float, options.TAN_ALPHA] = 0.2,
    cylinder: Cylinders = None,
    measure: MeasureName = "peak_acceleration",
    levels: Levels = None,
    cloud: Cloud = None,
    period: Period = 1.0,
    model: Models = None,
    engine: Engines = None,
    support: options.Supports = None,
    settings_given: options.Settings = None,
    time_step: options.TimeStep = None,
    step_factor: StepFactor = 1.0,
    restitution: Restitution = "1",
    friction: options.Friction = 1.0,
    gravity: options.Gravity = 9.81,
    limit: Limits = None,
    margin: Margin = 0.1,
    resamples: Resamples = 1000,
    seed: options.Seed = 0,
    workers: options.Workers = None,
    scheduler: Scheduler = None,
    out: options.Out = Path("rockwobble-fragility"),
) -> None:
    """Say how probable it is that shaking of an intensity overturns a cylinder, by several methods.

    Every motion is scaled to the same intensities and moves every cylinder by every method, so that
    methods are compared motion by motion. Lognormal curves by maximum likelihood, with bands by
    resampling the motions.

    Without options: the five reduced models of R = 6 m, tan alpha = 0.2 under 100 synthetic motions.

    Whatever ends it, the same command goes on where it stopped.

    Writes fragility.html, the same as fragility.md with its figures, the tables as Parquet, and
    counts.csv and counts.json, from which other tools can fit curves of their own.
    """
    from .inputs.method_values import restitution as restitution_of

    with interruptible(out):
        with user_input():
            from rockwobble.compare.studies.fragility.samples import DEFAULT_LIMITS
            from rockwobble.compare.studies.fragility.study import require_asked
            from rockwobble.models.records.plausibility import doubts_of

            from ..pages.words.diagnostics import warnings

            rc.require_writable(out)
            if cylinder:
                refuse(
                    context, {"semidiagonal", "tan_alpha"}, "does not go with --cylinder, which states both"
                )
            if not engine:
                refuse(context, {"step_factor"}, "belongs to engines, give --engine as well")
            if time_step is not None:
                refuse(context, {"step_factor"}, "does not go with --time-step, which states the step")
            if model and not {"planar-x", "planar-y", "worse-plane"} & set(model):
                refuse(context, {"restitution"}, "belongs to planar models, give --model planar-x or another")
            bodies = cylinders_of(cylinder, semidiagonal, tan_alpha)
            methods = methods_of(
                next(iter(bodies.values())), model, engine, support, settings(settings_given), time_step
            )
            asked: dict[str, Any] = {
                "methods": methods,
                "measure": measure,
                "levels": None if levels is None else _levels(levels),
                "scales": None if cloud is None else values_of("--cloud", cloud),
                "limits": DEFAULT_LIMITS if limit is None else tuple(limit),
                "margin": margin,
                "restitution": restitution_of(restitution),
                "resamples": resamples,
            }
            require_asked(**asked)
            motions, source = many.read(seed)
            for name, body in bodies.items():
                size = f"R = {body.semidiagonal:g} m, tan alpha = {body.tan_alpha:g}"
                print(f"{name}: {size}" if cylinder else size)
            print(f"Motions: {len(motions)}, {source}", *warnings(doubts_of(motions)), sep="\n")
        from rockwobble.compare.studies.fragility.study import manifest_of

        from ..pages.fragility import count_files, fragility_page

        with user_input(), shown_progress() as tell:
            found = rw.fragility(
                bodies,
                motions,
                **asked,
                period=period,
                gravity=gravity,
                friction=friction,
                step_factor=step_factor,
                seed=seed,
                workers=workers,
                scheduler=scheduler,
                progress=tell,
                resume=out,
                source=source,
            )
        manifest = manifest_of(found, command_line())
        show_and_write(out, fragility_page(found, manifest), manifest, found.tables, count_files(found))


def _levels(text: str) -> list[float]:
    """Return the numbers of a list, or of a range, which is even in the logarithm."""
    from rockwobble.models.number_checks import require_increasing

    found = values_of("--levels", text)
    require_increasing("--levels", found)
    if ":" not in text:
        return found
    low, high, count = found[0], found[-1], len(found)
    return [low * math.exp(math.log(high / low) * place / (count - 1)) for place in range(count)]
