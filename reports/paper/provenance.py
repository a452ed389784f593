"""How a result was made, and the form in which its numbers are kept."""

from __future__ import annotations

import importlib.metadata
import io
import platform
import shlex
import sys
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


def made_by() -> str:
    """Return the command and the versions as the last paragraph of a page in Markdown."""
    packages = ", ".join(f"{name} {version}" for name, version in versions().items())
    return f"Made by `{command_line()}` with {packages}."


def parquet(table: pd.DataFrame) -> bytes:
    """Return a table as the bytes of a Parquet file."""
    buffer = io.BytesIO()
    table.to_parquet(buffer, index=False)
    return buffer.getvalue()
