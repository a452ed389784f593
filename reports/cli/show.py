"""`rockwobble show`: what a folder of results holds."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Annotated, Any

import typer

from ..console.terminal import user_input

Store = Annotated[
    Path,
    typer.Argument(
        help="Folder of results: a sweep, a comparison, a spectrum, a run, or a study such as validity.",
        show_default=False,
    ),
]
Json = Annotated[bool, typer.Option("--json", help="Print all there is to know as JSON.")]


def show(store: Store, as_json: Json = False) -> None:
    """Summarise a folder of results: inputs, versions, how complete, outcomes and main figures.

    Nothing runs, and nothing is written.
    """
    with user_input():
        from rockwobble.compare.describe.folder import describe_store

        found = describe_store(store)
    if as_json:
        print(json.dumps({"folder": str(store), "results": found}, indent=2, allow_nan=False))
        return
    for result in found:
        print_description(store, result)


def print_description(store: Path, result: dict[str, Any]) -> None:
    """Print what `describe_store` says of one kind of result."""
    from rich import box
    from rich.console import Console
    from rich.table import Table

    console = Console()
    table = Table(box=box.SIMPLE_HEAD, show_header=False, padding=(0, 2, 0, 0), pad_edge=False)
    table.add_column(no_wrap=True)
    table.add_column(overflow="fold")
    for name, text in _lines(result).items():
        table.add_row(name, text)
    console.print(f"[bold]{store}[/]: {result['kind']}, {_completeness(result)}", highlight=False)
    console.print(table)
    if result["figures"]:
        figures = Table(box=box.SIMPLE_HEAD, padding=(0, 2, 0, 0), pad_edge=False)
        for name in result["figures"][0]:
            figures.add_column(name, justify="left" if name == "run" else "right")
        for row in result["figures"]:
            figures.add_row(*(_cell(value) for value in row.values()))
        console.print(figures)


def _completeness(result: dict[str, Any]) -> str:
    if result["complete"]:
        return f"complete, {result['runs']:,} run{'s' if result['runs'] != 1 else ''}"
    if "runs" not in result:
        return f"{result['runs_finished']:,} runs are finished; the same command goes on"
    share = 100.0 * result["runs_finished"] / result["runs"]
    return (
        f"{result['runs_finished']:,} of {result['runs']:,} runs are finished ({share:.0f} %); "
        "the same command goes on"
    )


def _lines(result: dict[str, Any]) -> dict[str, str]:
    lines = {}
    for name, value in result["inputs"].items():
        if value not in ("", {}, []):
            lines["hash of the inputs" if name == "fingerprint" else name] = _text(value)
    if result.get("chunks"):
        other = result["chunks_of_another_sweep"]
        lines["chunks"] = f"{result['chunks_finished']} of {result['chunks']}" + (
            f", and {other} of another sweep, which go when this one is complete" if other else ""
        )
    if result.get("seeds"):
        lines["seeds"] = _text(result["seeds"])
    lines["versions"] = ", ".join(f"{name} {version}" for name, version in result["versions"].items())
    if "outcomes" in result:
        lines["outcomes"] = ", ".join(f"{count:,} {name}" for name, count in result["outcomes"].items())
    return {name: text or "not known" for name, text in lines.items()}


def _text(value: Any) -> str:
    if isinstance(value, dict) and set(value) == {"from", "to", "count"}:
        if value["count"] == 1:
            return f"{value['from']:g}"
        return f"{value['count']} from {value['from']:g} to {value['to']:g}"
    if isinstance(value, dict):
        return ", ".join(f"{name} {_text(item)}" for name, item in value.items())
    if isinstance(value, list):
        shown = ", ".join(str(item) for item in value[:6])
        return shown + (f" and {len(value) - 6} more" if len(value) > 6 else "")
    return f"{value:g}" if isinstance(value, float) else str(value)


def _cell(value: Any) -> str:
    if value is None:
        return "-"
    return f"{value:.3g}" if isinstance(value, float) else str(value)
