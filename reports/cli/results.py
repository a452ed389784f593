"""Commands on stored results: `rockwobble show`, `report` and `view`."""

from __future__ import annotations

import dataclasses
import math
import shutil
from collections.abc import Collection, Mapping
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

import rockwobble as rw

from ..console import complain, echo, interruptible, user_input
from ..pages import stored_page
from ..pages.cases import case_lines
from ..pages.command_line import command_lines
from ..pages.table import number
from ..pages.wording import some_of, written
from ..registry import KINDS
from . import options
from .command import Work, saves_results
from .options import settings
from .problem import Problem, given_options, refuse

if TYPE_CHECKING:
    from rockwobble.compare.runs.progress import ProgressCallback
    from rockwobble.compare.storage.manifest import Manifest
    from rockwobble.models.finding import Value

Store = Annotated[Path, typer.Argument(help="Folder of results.", show_default=False)]
Json = Annotated[bool, options.output("Print everything as JSON.", "--json")]


def show(store: Store, as_json: Json = False) -> None:
    """Summary of stored results: kind, main numbers, command and versions that made them.

    Nothing runs, and nothing is written. Files that were changed since are named, with exit code 1.

    Example: rockwobble show rockwobble-compare
    """
    from rockwobble.models import plain_json

    with user_input():
        from rockwobble.compare.runs.cache import unfinished_results
        from rockwobble.compare.storage.manifest import MANIFEST, file_state, read_manifests

        going = unfinished_results(store)
        manifests = read_manifests(store) if not going or (store / MANIFEST).exists() else []
    states = [{name: file_state(store, made, name) for name in made.files} for made in manifests]
    if as_json:
        results = [
            dataclasses.asdict(made) | {"complete": True, "states": files}
            for made, files in zip(manifests, states, strict=True)
        ]
        results += [{**each, "complete": False} for each in going]
        print(plain_json.dumps({"folder": str(store), "results": results}, indent=2))
    else:
        for made, files in zip(manifests, states, strict=True):
            _print(store, made, files)
        for each in going:
            values: dict[str, Value] = {"count": each["done"], "count_all": each["total"]}
            print(f"{store}: {written('progress.unfinished', values | {'detail': each['kind']}, {})}")
    if any(state != "whole" for files in states for state in files.values()):
        raise typer.Exit(1)


def _print(store: Path, made: Manifest, files: Mapping[str, str]) -> None:
    lines = {name: number(value) for name, value in made.headline.items()}
    lines |= {
        name.replace("_", " "): _text(value)
        for name, value in made.about.items()
        if not isinstance(value, Mapping) and name not in ("inputs", "seed")  # facts printed below
    }
    lines |= {
        "made on": f"{made.date}, {made.processor}",
        "commit": written("progress.commit", {"detail": made.commit}, {}),
        "hash of the inputs": made.inputs,
        "seeds": ", ".join(f"{name} {seed}" for name, seed in made.seeds.items()),
        "versions": ", ".join(f"{name} {version}" for name, version in made.versions.items()),
        "files": ", ".join(f"{name} ({state})".removesuffix(" (whole)") for name, state in files.items()),
        "pages": ", ".join(made.pages),
        "drawn by": "" if made.kind in KINDS else _drawn_by(made),
    }
    print(f"{store}: {made.kind}")
    echo(f"{name}: {text}" for name, text in lines.items() if text)
    width = shutil.get_terminal_size().columns
    command = written("progress.made_by", {"detail": made.command}, {})
    print("made by:", *command_lines(command, width), "", sep="\n")


def _drawn_by(made: Manifest) -> str:
    """Release that can draw the pages of an unknown kind."""
    return written("progress.drawn_by", {"detail": made.versions.get("rockwobble")}, {})


def _text(value: object) -> str:
    if isinstance(value, Mapping):
        return str(value.get("name", value.get("label", "")))
    if isinstance(value, list):
        return some_of([_text(item) for item in value[:6]], max(len(value) - 6, 0))
    return number(value)


Folder = Annotated[Path, typer.Argument(help="Folder of results.", show_default=False)]
Out = Annotated[
    Path | None,
    options.output("Folder of the pages. Default: the folder of the results.", show_default=False),
]


Forms = Annotated[
    list[str] | None,
    options.output(
        "Further files: figures as pdf or png, tables as tex (LaTeX); of a fragility nrml (OpenQuake) or "
        "pelicun. May be repeated.",
        "--format",
        metavar="pdf|png|tex|nrml|pelicun",
    ),
]


Width = Annotated[
    str | None,
    options.output(
        "Width of pdf or png in print, with letters of 6 to 8 pt, such as 89mm. Default: a screen's, 218mm.",
        metavar="MM",
    ),
]
_WIDTHS = (60.0, 300.0)  # [mm]
_INCH = 25.4  # [mm]


def report(
    folder: Folder,
    out: Out = None,
    forms: Forms = None,
    width: Width = None,
    overwrite: options.Overwrite = False,
) -> None:
    """Pages and figures of stored results, drawn again without new runs.

    The pages depend on the stored results only, not on the engines and records installed here. The results
    stay unchanged.

    Example: rockwobble report rockwobble-compare --out pages
    """
    from rockwobble.compare.storage.manifest import require_writable

    place = folder if out is None else out
    with interruptible(), user_input():
        from rockwobble.compare.storage.files import sole_writer
        from rockwobble.compare.storage.manifest import manifests_in, read_manifests, write_pages
        from rockwobble.models.number_checks import require_one_of
        from rockwobble.studies import Fragility
        from rockwobble.studies.fragility.export import EXPORTS, exported

        data = [form for form in forms or () if form in EXPORTS]
        drawings = [form for form in forms or () if form not in EXPORTS]
        for form in forms or ():
            require_one_of("--format", form, ("pdf", "png", "tex", *EXPORTS))
        inches = _inches(width, drawings)
        if not folder.is_dir():
            raise ValueError(f"{folder} is not a folder of results")
        require_writable(place)
        there = read_manifests(folder)
        kinds = [made.kind for made in there if made.kind in KINDS]
        if not kinds:
            raise ValueError(
                f"{folder} holds results of kind {there[0].kind}, drawn by {_drawn_by(there[0])}"
            )
        others = [] if overwrite or place.resolve() == folder.resolve() else manifests_in(place)
        if others:
            listed = "; ".join(f"{each.kind} of `{each.command or 'another program'}`" for each in others)
            raise ValueError(
                f"the folder {place} holds {listed}: choose another by --out, or write there by --overwrite"
            )
        by_kind = {kind: stored_page(kind, folder) for kind in kinds}
        drawn = {
            kind: {**page.files(), **page.exports(drawings, width=inches)} for kind, page in by_kind.items()
        }
        if data:
            if Fragility.kind not in drawn:
                raise ValueError(f"--format {data[0]} is of a fragility, got {', '.join(drawn)} in {folder}")
            study = Fragility.load(folder)
            drawn[study.kind] |= dict(exported(study, form) for form in data)
        with sole_writer(place):
            for kind, pages in drawn.items():
                write_pages(place, kind, pages)
    names = dict.fromkeys(name for pages in drawn.values() for name in pages)
    print(f"Written to {place}: {', '.join(names)}")


def _inches(width: str | None, forms: Collection[str]) -> float | None:
    """Print width in inches from an option such as 89mm, for the given file formats."""
    if width is None:
        return None
    if not {"pdf", "png"} & {*forms}:
        raise ValueError(f"--width is of --format pdf or png, got {width} without one")
    try:
        size = float(width.removesuffix("mm"))
    except ValueError:
        size = math.nan
    if not _WIDTHS[0] <= size <= _WIDTHS[1]:
        low, high = (f"{each:g}mm" for each in _WIDTHS)
        raise ValueError(f"--width must be {low} to {high}, as 89mm, got {width}")
    return size / _INCH


Stored = Annotated[
    Path | None,
    typer.Argument(help="Folder of a stored comparison. Without it the case is run.", show_default=False),
]
CaseName = Annotated[str | None, typer.Option("--case", help="Name of the case, if the folder has several.")]
Engine = Annotated[str | None, options.method(f"{options.ENGINE}. Default: mujoco.")]


@saves_results
def view(
    context: typer.Context,
    problem: Problem,
    folder: Stored = None,
    case_name: CaseName = None,
    engine: Engine = None,
    support: options.Support = "recess",
    time_step: options.TimeStep = None,
    setting: options.Settings = None,
    opened: options.Open = None,
) -> Work:
    """3D animation of one case: the cylinder of an engine, with the reduced model translucent over it.

    Without options: MuJoCo in a recess under the 1940 El Centro record, R = 6 m, tan alpha = 0.2.

    Writes view.html (works offline) and the comparison that it shows.

    Example: rockwobble view --scale 2 --support flat
    """
    from rockwobble.compare.comparison.result import View
    from rockwobble.compare.runs.choice import require_runnable, with_settings

    from ..figures.playback import require_motion

    if folder is not None:
        others = set(given_options(context)) - {"folder", "case_name", "out", "overwrite", "opened"}
        refuse(context, others, "states a run and does not go with a stored one")
        stored = rw.Comparison.load(folder)
        name = _chosen_case(stored, case_name)
        require_motion(name, stored.of_case(name).traces.values())
        return Work(lambda progress: View.of(stored, name), opened=opened)
    if case_name is not None:
        raise ValueError("--case chooses from a folder, give the folder of a comparison as well")
    case = problem.case()
    asked = rw.Run(engine or _default_engine(support), support, time_step)
    (run,) = with_settings(case, [asked], settings(setting))
    require_runnable(case, run)
    require_motion(case.name, [rw.simulate(case)])  # checked before an engine runs for seconds

    def view_of_case(progress: ProgressCallback) -> View:
        shown = View.of(rw.comparison(case, runs=[run], progress=progress), case.name)
        require_motion(case.name, shown.comparison.traces.values())
        return shown

    return Work(view_of_case, case_lines(case), opened=opened)


def _default_engine(support: str) -> str:
    """Default engine, or the first loadable engine with the support."""
    from rockwobble.multibody.engines.registry import engine_fault, find_engine, standard_engines

    default = rw.multibody.DEFAULT_ENGINE
    fault = engine_fault(default)
    for name in standard_engines() if fault else ():
        if not engine_fault(name) and support in find_engine(name).supports:
            complain(f"{default} {fault}; {name} runs in its place")
            return name
    return default


def _chosen_case(comparison: rw.Comparison, name: str | None) -> str:
    names = list(comparison.cases)
    if name is None and len(names) > 1:
        complain(f"{len(names)} cases, the first is shown; --case chooses: {'; '.join(names[:6])} ...")
    if name is not None and name not in names:
        raise ValueError(f"--case must be one of {'; '.join(names)}, got {name!r}")
    return names[0] if name is None else name
