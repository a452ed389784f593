"""Commands on stored results: `rockwobble show` and `report`."""

from __future__ import annotations

import dataclasses
from collections.abc import Mapping
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from ..console import interruptible, print_facts, user_input
from ..pages import stored_page
from ..pages.table import number
from ..registry import KINDS
from . import options

if TYPE_CHECKING:
    from rockwobble.compare.storage.manifest import Manifest

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
        found = read_manifests(store) if not going or (store / MANIFEST).exists() else []
    states = [{name: file_state(store, made, name) for name in made.files} for made in found]
    if as_json:
        results = [
            dataclasses.asdict(made) | {"complete": True, "states": files}
            for made, files in zip(found, states, strict=True)
        ]
        results += [{**each, "complete": False} for each in going]
        print(plain_json.dumps({"folder": str(store), "results": results}, indent=2))
    else:
        for made, files in zip(found, states, strict=True):
            _print(store, made, files)
        for each in going:
            far = f"{each['done']} of {each['total']} tasks"
            print(f"{store}: {each['kind']}, not finished: {far}; the same command resumes")
    if any(state != "whole" for files in states for state in files.values()):
        raise typer.Exit(1)


def _print(store: Path, made: Manifest, files: Mapping[str, str]) -> None:
    lines = {name: number(value) for name, value in made.headline.items()}
    lines |= {
        name.replace("_", " "): _text(value)
        for name, value in made.about.items()
        if not isinstance(value, Mapping) and name not in ("inputs", "seed")  # which follow
    }
    lines |= {
        "made by": made.command or "a program",
        "made on": f"{made.date}, {made.processor}",
        "commit": made.commit or "of an installed package",
        "hash of the inputs": made.inputs,
        "seeds": ", ".join(f"{name} {seed}" for name, seed in made.seeds.items()),
        "versions": ", ".join(f"{name} {version}" for name, version in made.versions.items()),
        "files": ", ".join(
            name + (f" ({state})" if state != "whole" else "") for name, state in files.items()
        ),
        "pages": ", ".join(made.pages),
        "drawn by": "" if made.kind in KINDS else _drawn_by(made),
    }
    heading = (f"[bold]{store}[/]: {made.kind}",)
    print_facts(heading, {name: text for name, text in lines.items() if text}, command="made by")


def _drawn_by(made: Manifest) -> str:
    """Release that draws the pages of a kind that this one does not know."""
    return f"the release that made them, rockwobble {made.versions.get('rockwobble', '(not stated)')}"


def _text(value: object) -> str:
    if isinstance(value, Mapping):
        return str(value.get("name", value.get("label", "")))
    if isinstance(value, list):
        shown = ", ".join(_text(item) for item in value[:6])
        return shown + (f" and {len(value) - 6} more" if len(value) > 6 else "")
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


def report(
    folder: Folder, out: Out = None, forms: Forms = None, overwrite: options.Overwrite = False
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
        found = {kind: stored_page(kind, folder) for kind in kinds}
        drawn = {kind: {**page.files(), **page.exports(drawings)} for kind, page in found.items()}
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
