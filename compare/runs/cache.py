"""Cache of finished tasks in a folder of results, each under the hash of its inputs."""

from __future__ import annotations

import hashlib
from collections.abc import Callable, Iterator
from contextlib import AbstractContextManager, contextmanager
from dataclasses import dataclass, field
from pathlib import Path
from typing import TYPE_CHECKING, Generic, TypedDict, TypeVar

from rockwobble.models import plain_json
from rockwobble.models.trace_file import pack, read

from ..storage.claim import CACHE, claim_on
from ..storage.files import remove_folders, remove_leftovers, sole_writer, write_whole

if TYPE_CHECKING:
    import pandas as pd

T = TypeVar("T")
R = TypeVar("R")

_PLAN = "tasks.json"  # exists only until all tasks are done


@dataclass(slots=True, kw_only=True, eq=False)
class Cache(Generic[T, R]):
    """The folder finished/KIND in a folder of results: one file for each finished task.

    A second run, after whatever ended the first, repeats none that is there. The name of a file holds the
    hash of its content, so no damage to it goes unseen.

    Parameters
    ----------
    folder : Path
        That of the files, which exists.
    kind : str
        Kind of the results.
    name : callable
        Returns the hash of all that the result of a task depends on: inputs, versions and code. What a task
        is called is no part of it: renaming it repeats nothing.
    pack, unpack : callable
        A result as the bytes of a file, and back.

    Attributes
    ----------
    damaged : list of Path
        Files that were asked for and are not what was written: their tasks run again.
    """

    folder: Path
    kind: str
    name: Callable[[T], str]
    pack: Callable[[T, R], bytes]
    unpack: Callable[[T, bytes], R]
    damaged: list[Path] = field(default_factory=list, init=False)
    _there: dict[str, Path] = field(init=False)
    _used: set[Path] = field(default_factory=set, init=False)
    _expected: int = field(default=0, init=False)

    def __post_init__(self) -> None:
        self._there = {path.stem.partition("-")[0]: path for path in self.folder.glob("*.parquet")}

    @property
    def count(self) -> int:
        """Number of stored results."""
        return len(self._there)

    def find(self, task: T) -> R | None:
        """Result of a task if it is stored and undamaged; a damaged task runs again."""
        path = self._there.get(self.name(task))
        if path is None:
            return None
        try:
            content = path.read_bytes()
            if path.stem.partition("-")[2] == _digest(content):
                result = self.unpack(task, content)
                self._used.add(path)
                return result
        except (OSError, ValueError):
            pass
        self.damaged.append(path)
        return None

    def keep(self, task: T, result: R) -> None:
        """Store the result of a task.

        Raises
        ------
        ValueError
            If it cannot be written.
        """
        key, content = self.name(task), self.pack(task, result)
        path = self.folder / f"{key}-{_digest(content)}.parquet"
        write_whole(path, content)
        if (before := self._there.get(key, path)) != path:
            before.unlink(missing_ok=True)
        self._there[key] = path
        self._used.add(path)

    def expect(self, count: int) -> None:
        """Store the least number of tasks to come, for the finished share."""
        if count > self._expected:
            self._expected = count
            plan = {"kind": self.kind, "total": count}
            write_whole(self.folder / _PLAN, plain_json.dumps(plan).encode())

    def complete(self, *, alone: bool) -> None:
        """Mark the plan as complete; with `alone`, remove results that none of its tasks has used."""
        for path in set(self.folder.glob("*.parquet")) - self._used if alone else ():
            path.unlink()
        (self.folder / _PLAN).unlink(missing_ok=True)


def _digest(content: bytes) -> str:
    return hashlib.sha256(content).hexdigest()[:32]


@contextmanager
def open_cache(
    folder: str | Path,
    kind: str,
    *,
    name: Callable[[T], str],
    pack: Callable[[T, R], bytes],
    unpack: Callable[[T, bytes], R],
) -> Iterator[Cache[T, R]]:
    """Open the finished tasks of one kind of results in `folder`, locked against other processes.

    What was left half-written is removed. If the block ends well, and this process has claimed the folder for
    one plan, so are the results that it did not ask for, such as those of an older version; else all are
    kept, and where there are none the folders that were made for them go. See `Cache` for the parameters.

    Raises
    ------
    ValueError
        If nothing can be written there, or another process has it open.
    """
    path = Path(folder) / CACHE / kind
    created = [each for each in (path, *path.parents) if not each.exists()]
    try:
        with sole_writer(path):
            remove_leftovers(path)
            cache: Cache[T, R] = Cache(folder=path, kind=kind, name=name, pack=pack, unpack=unpack)
            yield cache
            cache.complete(alone=claim_on(folder) is not None)
    except BaseException:
        if created and not any(path.glob("*.parquet")):
            remove_folders(created, without=(_PLAN,))
        raise


def open_table_cache(
    folder: str | Path, kind: str, name: Callable[[T], str]
) -> AbstractContextManager[Cache[T, pd.DataFrame]]:
    """Open the finished tasks whose results are tables; see `open_cache`."""

    def to_bytes(task: T, table: pd.DataFrame) -> bytes:
        return pack(table, {"kind": f"task of {kind}", "task": str(getattr(task, "name", task))})

    return open_cache(folder, kind, name=name, pack=to_bytes, unpack=lambda _, content: read(content)[0])


class UnfinishedResults(TypedDict):
    """Unfinished results in a folder: kind, finished tasks and all tasks."""

    kind: str
    done: int
    total: int


def unfinished_results(folder: str | Path) -> list[UnfinishedResults]:
    """Kind, finished tasks and all tasks of the unfinished results in a folder."""
    entries: list[UnfinishedResults] = []
    for path in sorted(Path(folder).glob(f"{CACHE}/*/{_PLAN}")):
        plan = plain_json.loads(path.read_bytes())
        done = len(list(path.parent.glob("*.parquet")))
        entries.append({"kind": plan["kind"], "done": min(done, plan["total"]), "total": plan["total"]})
    return entries
