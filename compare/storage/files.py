"""Files of results: written beside and renamed, so that a file is never half-written.

A file is forced to the disk before it gets its name. So whatever ends the process, or the machine, a
name stands for a whole file, and what was not finished is a leftover whose name says so.
"""

from __future__ import annotations

import contextlib
import os
import tempfile
from collections.abc import Iterator, Mapping, Sequence
from contextlib import contextmanager
from pathlib import Path

_PART = ".part"
_LOCK = ".lock"


def require_folder(folder: str | Path) -> Path:
    """Path of `folder` if files can be written there, tested without a trace.

    A folder that does not exist yet is one that can be made: its nearest ancestor decides.

    Parameters
    ----------
    folder : str or Path

    Returns
    -------
    Path

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


def require_file(what: str, path: Path) -> None:
    """Refuse a path where a file cannot be written, tested without a trace.

    Raises
    ------
    ValueError
        If it is a folder, or in one that does not exist or cannot be written.
    """
    if path.is_dir() or not path.absolute().parent.is_dir():
        raise ValueError(f"{what} must be a file in a folder that exists, got {path}")
    if not _is_stream(path):
        require_folder(path.resolve().parent)


def replace_files(folder: str | Path, contents: Mapping[str, bytes]) -> None:
    """Write files into `folder`, all of them or, where one cannot be written, none.

    A name that stands for a device or a pipe, such as /dev/stdout, is written to and stays what it is; behind
    a link the file that it leads to is replaced.

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
    path = Path(folder)
    streams = {path / name: content for name, content in contents.items() if _is_stream(path / name)}
    if len(streams) < len(contents):
        require_folder(path)
    beside: dict[Path, Path] = {}
    try:
        path.mkdir(parents=True, exist_ok=True)
        for name, content in contents.items():
            target = path / name
            if target in streams:
                continue
            if target.is_symlink():
                target = target.resolve()
            if target.is_dir():
                raise ValueError(f"the output file must not be a folder, got {target}")
            part = target.with_name(f".{target.name}.{os.getpid()}{_PART}")  # until it is whole
            beside[part] = target
            part.write_bytes(content)
            _force_to_disk(part)
        for part, target in beside.items():
            part.replace(target)
        for target, content in streams.items():
            with target.open("wb") as stream:
                stream.write(content)
        if beside:
            _force_to_disk(path)
    except OSError as error:
        raise ValueError(f"the output folder {path} cannot be written: {error.strerror or error}") from None
    finally:
        for part in beside:
            with contextlib.suppress(OSError):
                part.unlink(missing_ok=True)


def write_whole(target: Path, content: bytes) -> None:
    """Write one file, whole or not at all; see `replace_files`."""
    replace_files(target.parent, {target.name: content})


def remove_leftovers(folder: Path) -> None:
    """Remove unfinished files in `folder` of a process that has ended.

    Only for a folder that no other process writes to: see `sole_writer`.
    """
    for part in folder.glob(f".*{_PART}"):
        part.unlink(missing_ok=True)


def remove_folders(folders: Sequence[Path], *, without: Sequence[str] = ()) -> None:
    """Remove folders, the innermost first, if they hold only files of these names."""
    with contextlib.suppress(OSError):
        for folder in folders:
            for name in without:
                (folder / name).unlink(missing_ok=True)
            folder.rmdir()


@contextmanager
def sole_writer(folder: Path) -> Iterator[None]:
    """Lock `folder`, created where it does not exist, for this process alone.

    The lock ends with the process, however that ends. Where the system has no such locks there is none.

    Raises
    ------
    ValueError
        If another process has locked it.
    """
    path = require_folder(folder)
    try:
        import fcntl
    except ImportError:  # Windows
        path.mkdir(parents=True, exist_ok=True)
        yield
        return
    place = path / _LOCK
    while True:
        path.mkdir(parents=True, exist_ok=True)
        try:
            lock = place.open("a")
        except FileNotFoundError:  # another process has just removed the folder
            continue
        try:
            fcntl.flock(lock, fcntl.LOCK_EX | fcntl.LOCK_NB)
        except OSError:
            lock.close()
            raise ValueError(f"another process is writing to {path}, wait for its end") from None
        # the other process removes its lock file at the end: then this one is no longer the file of that name
        if place.exists() and os.fstat(lock.fileno()).st_ino == place.stat().st_ino:
            break
        lock.close()
    try:
        yield
    finally:
        with contextlib.suppress(OSError):
            place.unlink(missing_ok=True)
        lock.close()


def _is_stream(target: Path) -> bool:
    """Whether a path is a device or a pipe, which a rename would replace by a file."""
    return target.exists() and not (target.is_file() or target.is_dir())


def _force_to_disk(path: Path) -> None:
    """Wait until a file, or the names in a folder, would survive a loss of power."""
    if path.is_dir() and os.name == "nt":  # a folder cannot be opened there
        return
    descriptor = os.open(path, os.O_RDONLY if path.is_dir() else os.O_RDWR)
    try:
        os.fsync(descriptor)
    finally:
        os.close(descriptor)
