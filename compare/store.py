"""Files of results: written beside and renamed, so that none is ever seen half-written."""

from __future__ import annotations

import contextlib
import os
import tempfile
from collections.abc import Mapping
from pathlib import Path


def require_writable(folder: str | Path) -> Path:
    """Return `folder` as a path if files can be written there, and leave no trace.

    A folder that does not exist yet is one that can be made: its nearest ancestor decides.

    Raises
    ------
    ValueError
        If something else is in the way, or nothing may be written there.
    """
    path = Path(folder)
    try:
        place = next(p for p in (path.absolute(), *path.absolute().parents) if p.exists())
        if not place.is_dir():
            raise ValueError(f"the output folder must be a folder, got {path}: {place} is a file")
        with tempfile.TemporaryFile(dir=place):
            pass
    except OSError as error:
        raise ValueError(f"the output folder {path} cannot be written: {error.strerror or error}") from None
    return path


def replace_files(folder: str | Path, contents: Mapping[str, bytes]) -> None:
    """Write files into `folder`, all of them or, where one cannot be written, none.

    Parameters
    ----------
    folder : str or Path
        Made where it does not exist.
    contents : mapping
        File names and what is in them; files with other names are left alone.

    Raises
    ------
    ValueError
        If the folder cannot be written.
    """
    path = require_writable(folder)
    beside: dict[Path, Path] = {}
    try:
        path.mkdir(parents=True, exist_ok=True)
        for name, content in contents.items():
            target = path / name
            if target.is_dir():
                raise ValueError(f"the output file must not be a folder, got {target}")
            part = path / f".{name}.{os.getpid()}.part"
            beside[part] = target
            part.write_bytes(content)
        for part, target in beside.items():
            part.replace(target)
    except OSError as error:
        raise ValueError(f"the output folder {path} cannot be written: {error.strerror or error}") from None
    finally:
        for part in beside:
            with contextlib.suppress(OSError):
                part.unlink(missing_ok=True)
