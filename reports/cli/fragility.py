"""`rockwobble fragility`: the probability of overturning by several methods under the same motions."""

from __future__ import annotations

import dataclasses
from pathlib import Path
from typing import Annotated

import typer

import rockwobble as rw
import rockwobble.compare.storage as rs
from rockwobble.compare.studies.plans import FragilityPlan

from ..console.progress import shown_progress
from ..console.results import show_and_save
from ..console.terminal import interruptible, user_input
from .inputs import options
from .inputs.plan_options import takes_options
from .inputs.problem import BODY, Body, refuse
from .inputs.several import ManyMethods, ManyMotions, cylinders_of
from .sweep import Scheduler

Cylinders = Annotated[
    list[str] | None,
    options.body(
        "A cylinder by name, as NAME=R,TAN_ALPHA such as pier=6,0.2; may be repeated.",
        metavar="NAME=R,TAN_ALPHA",
    ),
]


@takes_options
def fragility(
    context: typer.Context,
    many: ManyMotions,
    body: Body,
    methods: ManyMethods,
    plan: FragilityPlan,
    cylinder: Cylinders = None,
    workers: options.Workers = None,
    scheduler: Scheduler = None,
    out: options.Out = Path("rockwobble-fragility"),
) -> None:
    """Say how probable it is that shaking of an intensity overturns a cylinder, by several methods.

    Every motion is scaled to the same intensities and moves every cylinder by every method, so that
    methods are compared motion by motion. Lognormal curves by maximum likelihood, with bands by
    resampling the motions.

    Without options: the five reduced models of R = 6 m, tan alpha = 0.2 under 100 synthetic motions.

    Whatever ends it, the same command resumes.

    Writes fragility.html, the same as fragility.md with its figures, the tables as Parquet, and
    counts.csv and counts.json, from which other tools can fit curves of their own.
    """
    with interruptible(out):
        with user_input():
            from rockwobble.compare.studies.fragility.runs import methods_of
            from rockwobble.models.records.plausibility import doubts_of

            from ..pages.words.diagnostics import warnings

            rs.require_writable(out)
            if cylinder:
                of_body = BODY - {"slab_mass_ratio", "columns"}
                refuse(context, of_body, "does not go with --cylinder, which states the cylinder")
            bodies = cylinders_of(cylinder, body)
            chosen = methods.methods(next(iter(bodies.values())))
            methods_of(chosen, restitution=plan.restitution)  # before motions are read
            motions, source = many.read(plan.seed)
            for name, each in bodies.items():
                size = f"R = {each.semidiagonal:g} m, tan alpha = {each.tan_alpha:g}"
                print(f"{name}: {size}" if cylinder else size)
            print(f"Motions: {len(motions)}, {source}", *warnings(doubts_of(motions)), sep="\n")
        with user_input(), shown_progress() as progress:
            found = rw.fragility(
                bodies,
                motions,
                methods=chosen,
                workers=workers,
                scheduler=scheduler,
                progress=progress,
                resume=out,
                source=source,
                **dataclasses.asdict(plan),
            )
        show_and_save(found, out)
