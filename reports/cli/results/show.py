"""`rockwobble show`: what a folder of results holds."""

from __future__ import annotations

import dataclasses
from collections.abc import Mapping
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from ...console.results import print_facts
from ...console.terminal import user_input
from ...pages.table import number

if TYPE_CHECKING:
    from rockwobble.compare.storage.manifest import Manifest

Store = Annotated[
    Path, typer.Argument(help="Folder of results that a command has written.", show_default=False)
]
Json = Annotated[bool, typer.Option("--json", help="Print all there is to know as JSON.")]


def show(store: Store, as_json: Json = False) -> None:
    """Summarise a folder of results: what they are, their main numbers, and what made them.

    Nothing runs, and nothing is written. Files that are not what was written are named, with exit code 1.

    Example: rockwobble show rockwobble-compare
    """
    from rockwobble.models import plain_json

    with user_input():
        from rockwobble.compare.runs.cache import unfinished
        from rockwobble.compare.storage.manifest import MANIFEST, file_state, read_manifests

        going = unfinished(store)
        found = read_manifests(store) if not going or (store / MANIFEST).exists() else []
    states = [{name: file_state(store, made, name) for name in made.files} for made in found]
    if as_json:
        results = [
            dataclasses.asdict(made) | {"complete": True, "states": files}
            for made, files in zip(found, states, strict=True)
        ]
        results += [{**dataclasses.asdict(each), "complete": False} for each in going]
        print(plain_json.dumps({"folder": str(store), "results": results}, indent=2))
    else:
        for made, files in zip(found, states, strict=True):
            _print(store, made, files)
        for each in going:
            far = f"{each.done} of {each.total} tasks"
            print(f"{store}: {each.kind}, not finished: {far}; the same command goes on")
    if any(state != "whole" for files in states for state in files.values()):
        raise typer.Exit(1)


def _print(store: Path, made: Manifest, files: Mapping[str, str]) -> None:
    lines = {name: number(value) for name, value in made.headline.items()}
    lines |= {name: _text(value) for name, value in made.about.items() if not isinstance(value, Mapping)}
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
    }
    print_facts((f"[bold]{store}[/]: {made.kind}",), {name: text for name, text in lines.items() if text})


def _text(value: object) -> str:
    if isinstance(value, Mapping):
        return str(value.get("name", value.get("label", "")))
    if isinstance(value, list):
        shown = ", ".join(_text(item) for item in value[:6])
        return shown + (f" and {len(value) - 6} more" if len(value) > 6 else "")
    return number(value)
