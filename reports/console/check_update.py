"""`rockwobble check --update-baseline`: what would change, and why."""

from __future__ import annotations

import datetime
import sys
from typing import TYPE_CHECKING

import rockwobble.compare as rc

from .progress import shown_progress

if TYPE_CHECKING:
    from collections.abc import Sequence

    from rockwobble.compare.check import Bench

_SHOWN = 20


def update(bench: Bench, reason: str | None) -> None:
    """Measure, print the changes, ask for a reason, and write the files.

    Raises
    ------
    ValueError
        If there is no reason, or a file cannot be written.
    """
    from rockwobble.compare.check.baseline_file import changes, folder, read_baseline, updated
    from rockwobble.compare.check.engines import engine_baseline
    from rockwobble.compare.check.models import reduced_baseline
    from rockwobble.compare.storage.provenance import package_versions

    with shown_progress("engine runs") as bench.progress:
        new = {
            reduced_baseline.FILE: {reduced_baseline.GROUP: reduced_baseline.measure(bench)},
            engine_baseline.FILE: engine_baseline.measure(bench),
        }
    found = {name: changes(read_baseline(name), groups) for name, groups in new.items()}
    for name, changed in found.items():
        _show(name, changed)
    if not any(found.values()):
        print("Nothing would change.")
        return
    if reason is None and sys.stdin.isatty():
        reason = input("Reason (empty: leave everything as it is): ")
    if not (reason or "").strip():
        raise ValueError("nothing was changed: a new baseline needs a --reason, got none")
    date = datetime.datetime.now(tz=datetime.UTC).date().isoformat()
    words = {"reason": reason or "", "date": date}
    for name in (name for name, changed in found.items() if changed):
        text = updated(read_baseline(name), new[name], versions=package_versions(), **words)
        rc.replace_files(folder(), {f"{name}.json": text.encode()})
        print(f"Written: {folder() / name}.json")


def _show(name: str, changed: Sequence[tuple[str, str, float | None, float | None]]) -> None:
    """Print the changes, the largest first, and what is new in one line."""
    known = [
        (group, what, before, after)
        for group, what, before, after in changed
        if before is not None and after is not None
    ]
    known.sort(key=lambda each: -abs(each[3] - each[2]))
    for group, what, before, after in known[:_SHOWN]:
        print(f"{group}, {what}: {before:.12g} -> {after:.12g} ({after - before:+.1e})")
    if len(known) > _SHOWN:
        print(f"... and {len(known) - _SHOWN} more values of {name}, which change by less")
    for group in dict.fromkeys(each[0] for each in changed):
        fresh = sum(each[2] is None for each in changed if each[0] == group)
        gone = sum(each[3] is None for each in changed if each[0] == group)
        if fresh or gone:
            print(f"{group}: {fresh} new values, {gone} that are no longer there")
