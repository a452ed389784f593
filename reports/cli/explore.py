"""Command that writes the interactive page: `rockwobble explore`."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import asdict, dataclass, fields, replace
from pathlib import Path
from typing import Annotated, Any

import typer

import rockwobble as rw
from rockwobble.compare.runs.plan import OptionsIn, Plan

from ..console import echo, interruptible, open_page, user_input
from ..pages.cases import record_lines
from . import options
from .command import takes_options
from .outputs import plan_of, require_own_file
from .problem import (
    FREE_DURATION,
    PROBLEM,
    WAYS,
    Problem,
    Record,
    Release,
    Steel,
    first_given,
    given_options,
    needs,
    refuse,
    stated_options,
)

_several = OptionsIn("Many ground motions")

# options of a problem that the page has; the rest is refused
_OF_PAGE = {
    *(field.name for each in (Record, Release, Steel) for field in fields(each)),
    *("semidiagonal", "tan_alpha", "diameter", "height", "slab_mass_ratio"),
    *("gravity", "friction", "rolling_resistance"),
    *("tendon_prestress", "tendon_stiffness", "tendon_yield"),
}
_RECORD = {field.name for field in fields(Record)} - {"scale"}


@dataclass(frozen=True, kw_only=True)
class Records(Plan):
    """Option that names several ground motions."""

    records: Path | None = _several(
        None, "Folder of up to 10 records, as for ensemble, instead of one record."
    )


Plane = Annotated[
    float | None,
    options.method(
        "Azimuth of the plane of a planar motion at the start, in rad. Default: motion in three dimensions."
    ),
]
Support = Annotated[str, options.method("Support at the start: recess (ideal recess) or flat (flat ground).")]
Out = Annotated[Path, options.output("File of the page.")]


@takes_options
def explore(
    context: typer.Context,
    problem: Problem,
    several: Records,
    support: Support = "recess",
    plane: Plane = None,
    out: Out = Path("explore.html"),
    overwrite: options.Overwrite = False,
    opened: options.Open = None,
) -> None:
    """Interactive page of the motion, with sliders for column, ground motion and support.

    The reduced model runs in the page itself: it works offline, from a mail or on a phone. The options set
    the initial values of the sliders.

    Without options: R = 6 m, tan alpha = 0.2 under the 1940 El Centro record, with a pulse and two
    synthetic ground motions to choose from.

    Example: rockwobble explore --diameter 0.3 --height 1.2 --record-x EW.AT2 --record-y NS.AT2
    """
    with interruptible(), user_input():
        from rockwobble.compare.storage.files import replace_files
        from rockwobble.models.number_checks import require_one_of
        from rockwobble.models.support import MODELLED

        from ..pages.explore import explore_page

        refuse(context, PROBLEM - _OF_PAGE, "is not part of the model in the page")
        require_one_of("--support", support, MODELLED)
        if plane is not None and "support" in given_options(context):
            raise ValueError("--plane holds the motion on any support, got --support beside it")
        require_own_file(context, "--out", out)
        shakings = _shakings(context, problem, several.records)
        page = explore_page(
            shakings,
            _state(problem, several.records, support, plane),
            gravity=problem.gravity,
            duration=problem.duration if problem.release_tilt_deg is None else None,
            free=problem.duration or FREE_DURATION,
            plan=plan_of(context),
        )
        echo(record_lines([each.motion for each in shakings]))
        content = page.encode()
        replace_files(out.parent, {out.name: content})
    print(f"{out}: {len(content) / 1000:.0f} kB, {len(shakings)} ground motions")
    open_page(out, opened)


def _shakings(context: typer.Context, problem: Problem, records: Path | None) -> Sequence[Any]:
    """Ground motions of the page: those of a folder, one record, or the shipped ones.

    Raises
    ------
    ValueError
        If a folder and a record are given, or neither can be read.
    """
    from ..pages.explore import Shaking, standard_shakings

    one = first_given(problem, "record", "record_x", "record_y", "record_z")
    reading = problem.reading()
    ways = {name: value for name, value in asdict(reading).items() if value not in (None, False)}
    if records is not None:
        if one:
            raise ValueError(f"--records names all ground motions, got {one} beside it")
        motions = rw.read_records(records, reading)
        made = f"rw.read_records({str(records)!r}, {_call('rw.Reading', **ways)})"
        return [Shaking(motion=motion, python=f"{made}[{place}]") for place, motion in enumerate(motions)]
    if not one:
        needs(problem, WAYS, "record", "record_x", "record_y")
        return standard_shakings()
    motion = replace(problem, scale=1.0).motion()
    assert motion is not None
    paths = [problem.record] if problem.record else [problem.record_x, problem.record_y, problem.record_z]
    made = _call("rw.read_record", *(str(path) for path in paths if path is not None), **ways)
    stated = {
        name.replace("_", "-"): value for name, value in stated_options(context).items() if name in _RECORD
    }
    return [Shaking(motion=motion, python=made, options=stated)]


def _call(name: str, *values: object, **named: object) -> str:
    """Python call as text."""
    return f"{name}({', '.join([*map(repr, values), *(f'{key}={value!r}' for key, value in named.items())])})"


def _state(problem: Problem, records: Path | None, support: str, plane: float | None) -> Any:
    """Initial values of the sliders.

    Raises
    ------
    ValueError
        If an option is out of range, or two do not go together.
    """
    from rockwobble.models.support import support_named

    from ..pages.explore import State

    initial, cylinder = problem.initial(), problem.cylinder()
    if initial is not None and (
        given := first_given(problem, "record", "record_x") or ("--records" if records else "")
    ):
        raise ValueError(f"--release-tilt-deg takes the place of a record here, got {given} beside it")
    # early refusal of what the models refuse
    rw.Case(
        cylinder,
        initial=initial or rw.InitialState(tilt=0.5 * cylinder.alpha),
        duration=problem.duration or FREE_DURATION,
        gravity=problem.gravity,
        friction=problem.friction,
        rolling_resistance=problem.rolling_resistance,
    )
    tendon = problem.tendon(cylinder, problem.gravity)
    if tendon is not None and not support_named(support).guided:
        raise ValueError("the models have no tendon on --support flat, got both")
    released: dict[str, Any] = {} if initial is None else {
        "record": -1, "tilt": math.degrees(initial.tilt), "lean": math.degrees(initial.rolling_angle),
        "rate": initial.rolling_rate,
    }  # fmt: skip
    return State(
        height=2.0 * cylinder.half_height,
        diameter=2.0 * cylinder.base_radius,
        slab=cylinder.slab_mass_ratio,
        intensity=problem.scale,
        support=support if plane is None else "planar",
        plane=0.0 if plane is None else math.degrees(plane),
        friction=problem.friction,
        loss=1e3 * problem.rolling_resistance,
        prestress=tendon.prestress if tendon else 0.0,
        stiffness=tendon.stiffness if tendon else 0.0,
        yielding=(tendon.yield_force or 0.0) if tendon else 0.0,
        **released,
    )
