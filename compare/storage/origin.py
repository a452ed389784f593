"""What made a study: kept beside its tables, so that whoever shows them again need not guess."""

from __future__ import annotations

import dataclasses
import os
import platform
from collections.abc import Mapping
from dataclasses import dataclass
from datetime import UTC, datetime
from pathlib import Path
from typing import Any

from rockwobble.models import plain_json

from .provenance import package_versions


@dataclass(frozen=True, slots=True, kw_only=True)
class Origin:
    """Where and when a study was measured, and with what.

    Attributes
    ----------
    command : str
        That asked for it.
    date : str
        Of the day on which it was complete (UTC).
    processor : str
    versions : mapping
        Of the packages and engines, by name.
    """

    command: str
    date: str
    processor: str
    versions: Mapping[str, str]


def origin_now(command: str) -> Origin:
    """Return the origin of what has just been measured here."""
    return Origin(
        command=command,
        date=datetime.now(UTC).date().isoformat(),
        processor=processor(),
        versions=package_versions(),
    )


def processor() -> str:
    """Return the name of the processor and the number of its cores that are ours."""
    name = platform.processor() or platform.machine()
    information = Path("/proc/cpuinfo")
    if information.exists():
        for line in information.read_text().splitlines():
            if line.startswith("model name"):
                name = line.split(":", 1)[1].strip()
                break
    return f"{name}, {os.cpu_count()} cores"


def pack_study(kind: str, origin: Origin, facts: Mapping[str, Any]) -> bytes:
    """Return the JSON file of a study: its kind, its origin, and `facts` that its tables do not hold."""
    content = {"kind": kind, "origin": dataclasses.asdict(origin), **facts}
    return (plain_json.dumps(content, indent=2) + "\n").encode()


def read_study(file: Path, kind: str) -> tuple[Origin, dict[str, Any]]:
    """Return the origin and the facts of a study.

    Raises
    ------
    ValueError
        If the file is missing or holds something else.
    """
    if not file.is_file():
        raise ValueError(f"{file.parent} does not hold what `{kind}` writes: {file.name} is missing")
    try:
        content = plain_json.loads(file.read_bytes())
        stated, origin = content.pop("kind"), Origin(**content.pop("origin"))
    except (KeyError, TypeError, AttributeError, ValueError) as error:
        raise ValueError(f"{file} cannot be read: {error}") from None
    if stated != kind:
        raise ValueError(f"{file} is of `{stated}`, not of `{kind}`")
    return origin, content


def read_table(file: Path) -> Any:
    """Return a table of a study as a DataFrame.

    Raises
    ------
    ValueError
        If the file is missing or cannot be read.
    """
    import pandas as pd

    if not file.is_file():
        raise ValueError(f"{file.parent} is not complete: {file.name} is missing")
    try:
        return pd.read_parquet(file)
    except (OSError, ValueError) as error:
        raise ValueError(f"{file} cannot be read: {error}") from None
