"""`rockwobble check --update-baseline`: what would change, and why."""

from __future__ import annotations

import datetime
import sys
from typing import TYPE_CHECKING

import rockwobble.compare.storage as rs

from .progress import shown_progress

if TYPE_CHECKING:
    from collections.abc import Sequence

_SHOWN = 20


def update(reason: str | None) -> None:
    """Measure, print the changes, ask for a reason, and write the file.

    Raises
    ------
    ValueError
        If there is no reason, or the file cannot be written.
    """
    from rockwobble.compare.check import agreement
    from rockwobble.compare.check.groups import baseline_subjects
    from rockwobble.compare.storage.provenance import package_versions

    with shown_progress("engine runs"):
        new = agreement.baseline_numbers(baseline_subjects())
    old = agreement.read_baseline()
    changed = agreement.baseline_changes(old, new)
    _show(changed)
    if not changed:
        print("Nothing would change.")
        return
    if reason is None and sys.stdin.isatty():
        reason = input("Reason (empty: leave everything as it is): ")
    if not (reason or "").strip():
        raise ValueError("nothing was changed: a new baseline needs a --reason, got none")
    date = datetime.datetime.now(tz=datetime.UTC).date().isoformat()
    text = agreement.updated_baseline(old, new, reason=reason or "", date=date, versions=package_versions())
    rs.replace_files(agreement.baseline_folder(), {agreement.BASELINES: text.encode()})
    print(f"Written: {agreement.baseline_folder() / agreement.BASELINES}")


def _show(changed: Sequence[tuple[str, str, float | None, float | None]]) -> None:
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
        print(f"... and {len(known) - _SHOWN} more values, which change by less")
    for group in dict.fromkeys(each[0] for each in changed):
        fresh = sum(each[2] is None for each in changed if each[0] == group)
        gone = sum(each[3] is None for each in changed if each[0] == group)
        if fresh or gone:
            print(f"{group}: {fresh} new values, {gone} that are no longer there")
