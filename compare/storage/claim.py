"""A folder of results belongs to one plan, and during writing to one process.

A plan is a command with its options and the content of the files that it reads. Its hash stands in the
manifest of what is complete; before that, beside the finished tasks, in a file of its own. So the same plan
resumes and replaces its own files, and no other plan removes what took hours.

What an older version wrote has no hash: it is of the same plan if the command is, word for word.
"""

from __future__ import annotations

import dataclasses
import os
import shutil
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from dataclasses import dataclass
from pathlib import Path

from rockwobble.models import plain_json

from .files import remove_folders, sole_writer, write_whole
from .manifest import Manifest, keep_results, manifests_in, require_writable

CACHE = "finished"  # folder of finished tasks, with a folder in it for each kind of results
_CLAIM = ".plan.json"


@dataclass(frozen=True, slots=True, kw_only=True)
class Claim:
    """Claim on a folder.

    Attributes
    ----------
    plan : str
        Hash of the plan.
    command : str
        That stated it.
    process : int
        Its process, while it runs; 0 afterwards.
    """

    plan: str
    command: str
    process: int = 0


def claim_on(folder: str | Path) -> Claim | None:
    """Claim of this process on a folder; None without one."""
    claim = _read(Path(folder))
    return claim if claim is not None and claim.process == os.getpid() else None


@contextmanager
def claim_folder(folder: str | Path, *, plan: str, command: str, overwrite: bool = False) -> Iterator[None]:
    """Claim a folder for a plan, and for this process until the block ends.

    Where results of the plan are complete then, those of other plans go. Where nothing is finished, nothing
    is left behind.

    Parameters
    ----------
    folder : str or Path
        Made where it does not exist.
    plan : str
        Hash of the plan.
    command : str
        That states it.
    overwrite : bool, optional
        Whether results of other plans may be there, which this one replaces when it is complete.

    Raises
    ------
    ValueError
        If the folder holds results of another plan, another process writes to it, or nothing can be written.
    """
    path = require_writable(folder)
    created = [each for each in (path, *path.parents) if not each.exists()]
    try:
        with sole_writer(path):
            if not overwrite and (there := _of_others(path, plan, command)):
                raise ValueError(
                    f"the folder {path} holds {'; '.join(there)}: choose another by --out, or replace that "
                    "by --overwrite"
                )
            _write(path, Claim(plan=plan, command=command, process=os.getpid()))
            try:
                yield
            finally:
                _settle(path, plan, command)
    finally:
        remove_folders(created)


def _of_others(path: Path, plan: str, command: str) -> list[str]:
    """Contents of a folder that belong to other plans, in words."""
    claim, tasks = _read(path), sum(1 for _ in path.glob(f"{CACHE}/*/*.parquet"))
    if claim is not None and tasks:
        return [] if claim.plan == plan else [f"{tasks} finished tasks of `{claim.command}`"]
    manifests = manifests_in(path)
    if tasks and not manifests:
        return [f"{tasks} finished tasks of another program"]
    return [
        f"{each.kind} of `{each.command}`" if each.command else f"{each.kind} of another program"
        for each in manifests
        if not _is_of(each, plan, command)
    ]


def _is_of(manifest: Manifest, plan: str, command: str) -> bool:
    return manifest.plan == plan if manifest.plan else bool(command) and manifest.command == command


def _settle(path: Path, plan: str, command: str) -> None:
    """Remove files of other plans once this one is complete, and its claim once nothing is to resume."""
    own = {each.kind for each in manifests_in(path) if each.plan == plan}
    if own:
        keep_results(path, own)
        for folder in path.glob(f"{CACHE}/*"):
            if folder.name not in own:
                shutil.rmtree(folder)
    with suppress(OSError):
        if own or not any(path.glob(f"{CACHE}/*/*.parquet")):
            (path / _CLAIM).unlink(missing_ok=True)
        else:
            _write(path, Claim(plan=plan, command=command))


def _read(path: Path) -> Claim | None:
    """Claim on a folder, of any process; None without one, or where it is damaged."""
    try:
        return Claim(**plain_json.loads((path / _CLAIM).read_bytes()))
    except (OSError, ValueError, TypeError):
        return None


def _write(path: Path, claim: Claim) -> None:
    write_whole(path / _CLAIM, plain_json.dumps(dataclasses.asdict(claim)).encode())
