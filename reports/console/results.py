"""The end of a command that makes results: its files are written, and its report is printed."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from typing import TYPE_CHECKING

from .terminal import user_input

if TYPE_CHECKING:
    import pandas as pd

    from rockwobble.compare.storage.manifest import Manifest

    from ..pages.page import Page


def show_and_write(
    out: Path,
    page: Page,
    manifest: Manifest,
    tables: Mapping[str, pd.DataFrame],
    files: Mapping[str, bytes] | None = None,
) -> None:
    """Write a page with its tables, other files of data and the manifest; then print it."""
    from rockwobble.compare.storage.manifest import MANIFEST, write_results

    pages = page.files()
    with user_input():
        write_results(out, manifest, tables, files=files, pages=pages)
    page.show()
    names = [MANIFEST, *(f"{name}.parquet" for name in tables), *(files or ()), *pages]
    print(f"\nWritten to {out}: {', '.join(names)}")
