"""Baselines: numbers that were looked at once and are kept, with the reason for each change.

They are data files beside this module: `baselines/reduced.json` and `baselines/engines.json`. Each holds
its values by name, and the reasons why they were written, the last one last.
"""

from __future__ import annotations

import json
from collections.abc import Mapping
from dataclasses import dataclass
from importlib.resources import files
from pathlib import Path

Values = Mapping[str, float]


@dataclass(frozen=True, slots=True, kw_only=True)
class Baseline:
    """A file of baselines.

    Parameters
    ----------
    values : mapping
        Values of each group by name: one group for the reduced models, one for each engine version.
    reasons : tuple of mapping
        date, reason, and the versions that the values were made with.
    """

    values: Mapping[str, Values]
    reasons: tuple[Mapping[str, object], ...] = ()


def folder() -> Path:
    """Return the folder of the data files: where an update writes."""
    return Path(str(files("rockwobble.compare.check") / "baselines"))


def read_baseline(name: str) -> Baseline:
    """Return the baselines of the file `name`; empty if there is no such file."""
    place = folder() / f"{name}.json"
    if not place.is_file():
        return Baseline(values={})
    content = json.loads(place.read_text(encoding="utf-8"))
    return Baseline(values=content["values"], reasons=tuple(content["reasons"]))


def changes(old: Baseline, new: Mapping[str, Values]) -> list[tuple[str, str, float | None, float | None]]:
    """Return what would change if the groups of `new` took the place of those of `old`.

    Returns
    -------
    list of (group, name, before, after)
        None where there is no value.
    """
    return [
        (group, name, before.get(name), values.get(name))
        for group, values in new.items()
        for before in [old.values.get(group, {})]
        for name in dict.fromkeys([*before, *values])
        if before.get(name) != values.get(name)
    ]


def updated(
    old: Baseline, new: Mapping[str, Values], *, reason: str, date: str, versions: Mapping[str, str]
) -> str:
    """Return the text of the file with the groups of `new` in place, and the reason kept.

    Raises
    ------
    ValueError
        If no reason is given.
    """
    reason = " ".join(reason.split())
    if not reason:
        raise ValueError("a reason must be given for changing a baseline, got none")
    entry = {"date": date, "reason": reason, "groups": sorted(new), "versions": dict(versions)}
    content = {
        "reasons": [*old.reasons, entry],
        "values": {**old.values, **{group: dict(values) for group, values in new.items()}},
    }
    return json.dumps(content, indent=1, allow_nan=False) + "\n"
