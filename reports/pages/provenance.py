"""How a result was made, and the form in which its numbers are kept."""

from __future__ import annotations

import importlib.metadata
import platform
import shlex
import sys
from collections.abc import Mapping
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    import pandas as pd

_PACKAGES = ("rockwobble", "numpy", "scipy", "numba", "matplotlib")


def command_line() -> str:
    """Return the command that runs, as it would be typed."""
    return shlex.join(["rockwobble", *sys.argv[1:]])


def versions() -> dict[str, str]:
    """Return the versions of Python and of the packages that the numbers and pictures depend on."""
    return {
        "python": platform.python_version(),
        **{package: importlib.metadata.version(package) for package in _PACKAGES},
    }


def made_by(given: Mapping[str, str] | None = None, command: str | None = None) -> str:
    """Return the command and the versions, those here or those given, as the last paragraph of a page."""
    packages = ", ".join(f"{name} {version}" for name, version in (given or versions()).items())
    return f"Made by `{command or command_line()}` with {packages}."


def parquet(table: pd.DataFrame, kind: str, inputs: str) -> bytes:
    """Return a table as the bytes of a Parquet file that says, as the stores do, what made it."""
    from rockwobble.compare.storage.parquet_file import pack
    from rockwobble.compare.storage.provenance import about_results

    return pack(table, about_results(kind, inputs) | {"command": command_line()})
