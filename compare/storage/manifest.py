"""One manifest.json for every folder of results: kind, origin and files of each.

It gets its name last. So a folder with a manifest is whole, and what was written to it can be checked.
"""

from __future__ import annotations

import dataclasses
import hashlib
import io
from collections.abc import Collection, Mapping, Sequence
from dataclasses import dataclass, field
from datetime import UTC, datetime
from pathlib import Path
from typing import TYPE_CHECKING, Any

from rockwobble.models import plain_json
from rockwobble.models.shown import CompactRepr
from rockwobble.models.trace_file import pack

from .files import replace_files, require_folder
from .provenance import code_digests, commit, package_versions, processor

if TYPE_CHECKING:
    import pandas as pd

MANIFEST = "manifest.json"
Number = float | int | str | None


@dataclass(frozen=True, slots=True, kw_only=True, repr=False)
class Manifest(CompactRepr):
    """Record of the kind, inputs and origin of results.

    Attributes
    ----------
    kind : str
        Kind of the results, such as "comparison".
    inputs : str
        Hash of all that they depend on, see `fingerprint`.
    command : str
        That asked for them; empty where it was a program.
    plan : str
        Hash of the plan that the command stated, see `claimed`; empty where it was a program.
    date : str
        Date on which they were complete (UTC).
    commit : str
        Commit of the checkout that made them, with "+" where it had changes; empty for an installed package.
    processor : str
    versions, code : mapping
        Versions of packages and engines, and hashes of the folders of the code, by name.
    seeds : mapping
        Seeds of the random numbers of the inputs.
    headline : mapping
        The main numbers, by what they are.
    about : mapping
        What the tables do not hold: plain values, lists and mappings.
    files : mapping
        SHA-256 of each file of data.
    pages : sequence of str
        Files drawn from the data, which can be drawn again.
    """

    kind: str
    inputs: str = field(default="", repr=False)
    command: str = ""
    plan: str = ""
    date: str = ""
    commit: str = ""
    processor: str = ""
    versions: Mapping[str, str] = field(default_factory=dict)
    code: Mapping[str, str] = field(default_factory=dict)
    seeds: Mapping[str, int] = field(default_factory=dict)
    headline: Mapping[str, Number] = field(default_factory=dict)
    about: Mapping[str, Any] = field(default_factory=dict)
    files: Mapping[str, str] = field(default_factory=dict)
    pages: tuple[str, ...] = ()


def with_provenance(manifest: Manifest) -> Manifest:
    """Manifest with date, commit, processor, code and, unless stated, the installed versions."""
    return dataclasses.replace(
        manifest,
        date=datetime.now(UTC).date().isoformat(),
        commit=commit(),
        processor=processor(),
        versions=manifest.versions or package_versions(),
        code=code_digests(),
    )


def require_writable(folder: str | Path) -> Path:
    """Path of `folder` if results can be written there, tested before a run without a trace.

    Parameters
    ----------
    folder : str or Path
        One that does not exist yet is made later.

    Returns
    -------
    Path

    Raises
    ------
    ValueError
        If something else is in the way, nothing may be written there, or its manifest.json is none of ours.
    """
    path = require_folder(folder)
    try:
        manifests_in(path)
    except ValueError:
        raise ValueError(
            f"the output folder must have no {MANIFEST} but one of rockwobble, got {path / MANIFEST}: "
            "move it away, or choose another folder"
        ) from None
    return path


def write_results(
    folder: str | Path,
    manifest: Manifest,
    tables: Mapping[str, pd.DataFrame],
    *,
    files: Mapping[str, bytes] | None = None,
    pages: Mapping[str, bytes] | None = None,
) -> Manifest:
    """Write results into `folder`, whole or not at all, and their manifest last.

    Files of an earlier result of this kind that are no part of this one go; all others stay, and so do the
    results of other kinds there.

    Parameters
    ----------
    folder : str or Path
    manifest : Manifest
        See `with_provenance`.
    tables : mapping
        Each becomes NAME.parquet, which says in its metadata what made it.
    files, pages : mapping, optional
        Other files of data, and what is drawn from them, by name.

    Raises
    ------
    ValueError
        If the folder cannot be written.
    """
    origin = {name: getattr(manifest, name) for name in ("kind", "inputs", "command", "commit", "versions")}
    data = {f"{name}.parquet": pack(table, origin) for name, table in tables.items()} | dict(files or {})
    hashes = {name: hashlib.sha256(content).hexdigest() for name, content in data.items()}
    whole = dataclasses.replace(manifest, files=hashes, pages=tuple(pages or ()))
    place = Path(folder)
    before = manifests_in(place)
    written = {**data, **(pages or {})}
    # results that lost a file to these are damaged
    others = [each for each in before if each.kind != manifest.kind and not written.keys() & {*each.files}]
    replace_files(place, {**written, MANIFEST: _pack([whole, *others])})
    _remove(place, [each for each in before if each.kind == manifest.kind], kept=[whole, *others])
    return whole


def write_pages(folder: str | Path, kind: str, pages: Mapping[str, bytes]) -> None:
    """Write new pages of the results in `folder`, which stay unchanged.

    Raises
    ------
    ValueError
        If the folder cannot be written.
    """
    place = Path(folder)
    drawn = [
        dataclasses.replace(each, pages=tuple(pages)) if each.kind == kind else each
        for each in manifests_in(place)
    ]
    replace_files(place, {**pages, **({MANIFEST: _pack(drawn)} if drawn else {})})


@dataclass(frozen=True, slots=True, kw_only=True)
class Stored:
    """Results of one kind in a folder, with all files undamaged."""

    folder: Path
    manifest: Manifest

    def tables(self) -> dict[str, pd.DataFrame]:
        """Return all tables by name."""
        names = [Path(name) for name in self.manifest.files]
        return {name.stem: self.table(name.stem) for name in names if name.suffix == ".parquet"}

    def table(self, name: str) -> pd.DataFrame:
        """Return a table.

        Raises
        ------
        ValueError
            If it is not one of these results.
        """
        import pandas as pd

        return pd.read_parquet(io.BytesIO(self.content(f"{name}.parquet")))

    def content(self, name: str) -> bytes:
        """Bytes of a file of data.

        Raises
        ------
        ValueError
            If it is not one of these results.
        """
        if name not in self.manifest.files:
            raise ValueError(f"{self.folder} is of another version of rockwobble: {name} is not part of it")
        return (self.folder / name).read_bytes()


def read_results(folder: str | Path, kind: str) -> Stored:
    """Results of one kind in `folder`, independent of the installed versions.

    Raises
    ------
    ValueError
        If there are none, or a file is missing or damaged: the first such file is named.
    """
    place = Path(folder)
    manifests = {each.kind: each for each in read_manifests(place)}
    if kind not in manifests:
        raise ValueError(f"{place} does not hold results of kind {kind!r}, but of {', '.join(manifests)}")
    for name in manifests[kind].files:
        if (state := file_state(place, manifests[kind], name)) != "whole":
            raise ValueError(f"{place / name} is {state}: it is not what was written there")
    return Stored(folder=place, manifest=manifests[kind])


def file_state(folder: Path, manifest: Manifest, name: str) -> str:
    """State of a file of data: "whole", "damaged" or "missing"."""
    try:
        content = (folder / name).read_bytes()
    except OSError:
        return "missing"
    return "whole" if hashlib.sha256(content).hexdigest() == manifest.files[name] else "damaged"


def read_manifests(folder: str | Path) -> list[Manifest]:
    """Manifest of each kind of results in `folder`, the last written first.

    Raises
    ------
    ValueError
        If there is none, or it cannot be read.
    """
    manifests = manifests_in(Path(folder))
    if not manifests:
        raise ValueError(f"{folder} does not hold results of rockwobble: it has no {MANIFEST}")
    return manifests


def keep_results(folder: Path, kinds: Collection[str]) -> None:
    """Remove the results of all other kinds from a folder, except files in use by the kinds given.

    Raises
    ------
    ValueError
        If the manifest cannot be read or written.
    """
    there = manifests_in(folder)
    kept, gone = ([each for each in there if (each.kind in kinds) is wanted] for wanted in (True, False))
    if kept and gone:
        replace_files(folder, {MANIFEST: _pack(kept)})
        _remove(folder, gone, kept)


def _remove(folder: Path, gone: Sequence[Manifest], kept: Sequence[Manifest]) -> None:
    names, stay = ({name for each in part for name in (*each.files, *each.pages)} for part in (gone, kept))
    for name in names - stay:
        (folder / name).unlink(missing_ok=True)


def manifests_in(folder: Path) -> list[Manifest]:
    """Manifests in `folder`, the last written first; none where there is no manifest.json.

    Raises
    ------
    ValueError
        If it cannot be read.
    """
    path = folder / MANIFEST
    if not path.is_file():
        return []
    known = {each.name for each in dataclasses.fields(Manifest)}
    try:
        top = plain_json.loads(path.read_bytes())
        return [
            Manifest(**{k: v for k, v in each.items() if k in known} | {"pages": tuple(each["pages"])})
            for each in (top, *top.get("others", ()))
        ]
    except (OSError, ValueError, KeyError, TypeError, AttributeError) as error:
        raise ValueError(f"{path} cannot be read: {error}") from None


def _pack(manifests: list[Manifest]) -> bytes:
    top, *others = (dataclasses.asdict(each) for each in manifests)
    content = top | ({"others": others} if others else {})
    return (plain_json.dumps(content, indent=1) + "\n").encode()
