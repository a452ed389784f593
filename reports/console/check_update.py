"""`rockwobble check --update-baseline`: what would change, and why."""

from __future__ import annotations

import datetime
import sys
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from collections.abc import Sequence

    from rockwobble.compare.check import Bench
    from rockwobble.compare.check.baseline_file import Change

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

    from .check_progress import shown_progress

    with shown_progress("baseline") as (tell, _):
        bench.progress = tell
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
    for name, changed in found.items():
        if changed:
            text = updated(
                read_baseline(name),
                new[name],
                reason=reason or "",
                date=datetime.datetime.now(tz=datetime.UTC).date().isoformat(),
                versions=package_versions(),
            )
            path = folder() / f"{name}.json"
            try:
                folder().mkdir(exist_ok=True)
                beside = path.with_suffix(".part")
                beside.write_text(text, encoding="utf-8")
                beside.replace(path)
            except OSError as error:
                raise ValueError(f"cannot write the baselines {path}: {error.strerror or error}") from None
            print(f"Written: {path}")


def _show(name: str, changed: Sequence[Change]) -> None:
    """Print the changes, the largest first, and what is new in one line."""
    known = [each for each in changed if each.before is not None and each.after is not None]
    known.sort(key=lambda each: -abs((each.after or 0.0) - (each.before or 0.0)))
    for each in known[:_SHOWN]:
        assert each.before is not None
        assert each.after is not None
        print(
            f"{each.group}, {each.name}: {each.before:.12g} -> {each.after:.12g} "
            f"({each.after - each.before:+.1e})"
        )
    if len(known) > _SHOWN:
        print(f"... and {len(known) - _SHOWN} more values of {name}, which change by less")
    for group in dict.fromkeys(each.group for each in changed):
        fresh = sum(each.before is None for each in changed if each.group == group)
        gone = sum(each.after is None for each in changed if each.group == group)
        if fresh or gone:
            print(f"{group}: {fresh} new values, {gone} that are no longer there")
