"""Outputs of a command: files written by another command or plan are not overwritten."""

from __future__ import annotations

import hashlib
from pathlib import Path
from typing import TYPE_CHECKING, Any

from ..console import command_line

if TYPE_CHECKING:
    import typer

# options without effect on the results
_NOT_OF_PLAN = {"out", "overwrite", "workers", "scheduler", "chunk", "details", "opened"}
_NOT_OF_PLAN |= {"json", "junit", "markdown", "place"}


def claim_folder(context: typer.Context) -> None:
    """Lock the folder of --out for this command.

    Raises
    ------
    ValueError
        If it holds results of another plan and --overwrite is not given, another process writes to it, or
        nothing can be written there.
    """
    from rockwobble.compare.storage import claim

    stated = context.params
    context.with_resource(
        claim.claim_folder(
            stated["out"], plan=plan_of(context), command=command_line(), overwrite=stated["overwrite"]
        )
    )


def plan_of(context: typer.Context) -> str:
    """Hash of a command: its name, its options and the content of the named files."""
    from rockwobble.compare.storage.provenance import fingerprint

    stated = {name: _content(value) for name, value in context.params.items() if name not in _NOT_OF_PLAN}
    if isinstance(suite := context.params.get("suite"), str):
        stated["suite"] = _suite(suite)
    return fingerprint({"command": context.info_name, "options": stated})


def require_own_file(context: typer.Context, option: str, path: Path) -> None:
    """Refuse to replace a file without the hash of this plan.

    Raises
    ------
    ValueError
        If it cannot be written, or holds something else and --overwrite is not given.
    """
    from rockwobble.compare.storage.files import require_file

    require_file(option, path)
    if path.is_file() and not context.params["overwrite"]:
        content = path.read_bytes()
        if content and plan_of(context).encode() not in content:
            raise ValueError(
                f"{option} {path} holds something else than what this command makes with these options: name "
                "another file, or replace it by --overwrite"
            )


def _suite(name: str) -> object:
    from rockwobble import read_suite
    from rockwobble.compare.runs.execution import case_inputs

    suite = read_suite(name)
    return [(case.name, case_inputs(case)) for case in suite.cases], suite.runs


def _content(value: Any) -> object:
    """Value of an option; for a file or folder a hash of its content."""
    if isinstance(value, list | tuple):
        return [_content(each) for each in value]
    if not isinstance(value, Path):
        return value
    if value.is_dir():
        manifest = value / "manifest.json"  # its manifest has the hashes of the other files
        files = [manifest] if manifest.is_file() else sorted(each for each in value.rglob("*"))
        return [(str(each.relative_to(value)), _digest(each)) for each in files if each.is_file()]
    return _digest(value) if value.is_file() else str(value)


def _digest(path: Path) -> str:
    return hashlib.sha256(path.read_bytes()).hexdigest()
