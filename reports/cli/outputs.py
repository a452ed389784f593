"""Outputs of a command: a folder or file that holds what another command has made is refused."""

from __future__ import annotations

import hashlib
import json
from collections.abc import Callable, Collection, Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import TYPE_CHECKING, Any

from ..console import command_line, interruptible, shown_progress, user_input

if TYPE_CHECKING:
    import typer

    from rockwobble.compare.runs.progress import ProgressCallback

# options that change no number of the results
_NOT_OF_PLAN = {"out", "overwrite", "workers", "scheduler", "chunk", "details", "opened"}
_NOT_OF_PLAN |= {"json", "junit", "markdown", "place"}


def claim_folder(context: typer.Context) -> None:
    """Claim the folder of --out for this command until it ends.

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
            stated["out"],
            plan=plan_of(context),
            command=command_line(),
            overwrite=stated["overwrite"],
        )
    )


@contextmanager
def results_in(
    context: typer.Context, what: str = "runs", *, resumes: bool = True
) -> Iterator[ProgressCallback]:
    """Yield the progress callback of a study that writes to --out; one that `resumes` keeps runs there.

    An interrupt and a folder that cannot be written end the command.
    """
    with interruptible(context.params["out"] if resumes else None):
        with user_input():
            claim_folder(context)
        with shown_progress(what) as progress:
            yield progress


def plan_of(context: typer.Context) -> str:
    """Return the hash of a command: its name, its options and the content of the files that they name."""
    from rockwobble.compare.storage.provenance import fingerprint

    stated = {name: _content(value) for name, value in context.params.items() if name not in _NOT_OF_PLAN}
    if isinstance(suite := context.params.get("suite"), str):
        stated["suite"] = _suite(suite)
    return fingerprint({"command": context.info_name, "options": stated})


def require_own_file(option: str, path: Path, plan: str, plan_in: Callable[[bytes], str | None]) -> None:
    """Refuse a file that would be replaced and is of another plan.

    Parameters
    ----------
    option : str
        That names the file.
    path : Path
    plan : str
        Hash of the plan.
    plan_in : callable
        Returns the hash in such a file, empty where it states none; None or a ValueError for another kind.

    Raises
    ------
    ValueError
        If it holds something else, or cannot be written.
    """
    from rockwobble.compare.storage.files import require_file

    require_file(option, path)
    if not path.is_file() or not (content := path.read_bytes()):
        return
    try:
        there = plan_in(content)
    except (ValueError, AttributeError):
        there = None
    if there not in ("", plan):
        what = "something else than this command with these options makes"
        raise ValueError(f"{option} {path} holds {what}: name another file, or replace it by --overwrite")


def plan_in_json(keys: Collection[str]) -> Callable[[bytes], str | None]:
    """Reader of the hash of a plan from JSON that has these keys, see `require_own_file`."""

    def plan_in(content: bytes) -> str | None:
        found = json.loads(content)
        return str(found.get("plan", "")) if {*keys} <= {*found} else None

    return plan_in


def _suite(name: str) -> object:
    from rockwobble import read_suite
    from rockwobble.compare.runs.execution import case_inputs

    suite = read_suite(name)
    return [(case.name, case_inputs(case)) for case in suite.cases], suite.runs


def _content(value: Any) -> object:
    """Return the value of an option; of a file or folder a hash of what is in it."""
    if isinstance(value, list | tuple):
        return [_content(each) for each in value]
    if not isinstance(value, Path):
        return value
    if value.is_dir():
        manifest = value / "manifest.json"  # it has the hashes of the others
        files = [manifest] if manifest.is_file() else sorted(each for each in value.rglob("*"))
        return [(str(each.relative_to(value)), _digest(each)) for each in files if each.is_file()]
    return _digest(value) if value.is_file() else str(value)


def _digest(path: Path) -> str:
    return hashlib.sha256(path.read_bytes()).hexdigest()
