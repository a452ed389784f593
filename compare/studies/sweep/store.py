"""The folder of a sweep: what it is, and a Parquet file for each chunk that is finished.

sweep.json          axes, versions, and the chunks in the order of the table
motions.parquet     the ground motions
chunks/*.parquet    a dataset; each file is named by its place in the order and the hash of its inputs
"""

from __future__ import annotations

import io
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from rockwobble.models import GroundMotion, plain_json

from ...storage.files import replace_files, write_whole
from ...storage.parquet_file import pack
from ...storage.provenance import about_results

if TYPE_CHECKING:
    import pandas as pd

ABOUT, MOTIONS, CHUNKS = "sweep.json", "motions.parquet", "chunks"
KIND = "rockwobble sweep"


@dataclass(frozen=True, slots=True, eq=False)
class SweepStore:
    """The folder of one sweep.

    Parameters
    ----------
    folder : Path
    about : mapping
        What sweep.json says.
    """

    folder: Path
    about: Mapping[str, Any]

    @property
    def keys(self) -> tuple[str, ...]:
        """Hash of each chunk, in the order of the table."""
        return tuple(key for key, _ in self.about["chunks"])

    @property
    def rows(self) -> dict[str, int]:
        """Number of runs in each chunk."""
        return dict(self.about["chunks"])

    def finished(self) -> dict[str, Path]:
        """Return the file of each chunk that is there."""
        found = {path.stem.partition("-")[2]: path for path in (self.folder / CHUNKS).glob("*.parquet")}
        return {key: found[key] for key in self.keys if key in found}

    def others(self) -> list[Path]:
        """Return the chunks in the folder that belong to another sweep."""
        mine = set(self.finished().values())
        return sorted(path for path in (self.folder / CHUNKS).glob("*.parquet") if path not in mine)

    def write_chunk(self, index: int, columns: Mapping[str, Any], versions: Mapping[str, str]) -> None:
        """Keep the results of the chunk with this place in the order, and what they were made with."""
        key = self.keys[index]
        about = about_results(KIND, key, versions=versions, seeds=self.about["seeds"])
        write_whole(self._path(index, key), pack(columns, about))

    def put_in_order(self) -> None:
        """Name each chunk that is there by its place: where a grid has grown, places have moved."""
        places = {key: index for index, key in enumerate(self.keys)}
        for key, path in self.finished().items():
            if path != self._path(places[key], key):
                path.replace(self._path(places[key], key))

    def read(self) -> pd.DataFrame:
        """Return the table of all chunks that are there, in order.

        Raises
        ------
        ValueError
            If a file cannot be read.
        """
        import pandas as pd
        import pyarrow as pa
        import pyarrow.parquet as pq

        tables = []
        for path in self.finished().values():
            try:
                tables.append(pq.read_table(io.BytesIO(path.read_bytes())).replace_schema_metadata(None))
            except (OSError, pa.ArrowException) as error:
                raise ValueError(
                    f"{path} cannot be read, remove it and sweep again: {str(error).partition('.')[0]}"
                ) from None
        frame: pd.DataFrame = pa.concat_tables(tables).to_pandas() if tables else pd.DataFrame()
        return frame

    def _path(self, index: int, key: str) -> Path:
        return self.folder / CHUNKS / f"{index:06d}-{key}.parquet"


def create_sweep_store(
    folder: Path, about: Mapping[str, Any], motions: Mapping[str, GroundMotion]
) -> SweepStore:
    """Write what a sweep is into `folder`, and return its store with the chunks that are already there."""
    contents = {ABOUT: (plain_json.dumps(about, indent=1) + "\n").encode()}
    if motions:
        contents[MOTIONS] = _motions_table(motions)
    replace_files(folder, contents)
    store = open_sweep_store(folder)
    store.put_in_order()
    return store


def open_sweep_store(folder: str | Path) -> SweepStore:
    """Return the store of a sweep.

    Raises
    ------
    ValueError
        If the folder holds none.
    """
    path = Path(folder)
    try:
        about = plain_json.loads((path / ABOUT).read_bytes())
        whole = about["kind"] == KIND
    except (OSError, ValueError, KeyError, TypeError):
        whole = False
    if not whole:
        raise ValueError(f"{path} must be the folder of a sweep, found no {ABOUT} of one")
    return SweepStore(path, about)


def _motions_table(motions: Mapping[str, GroundMotion]) -> bytes:
    """Stack the motions; a component that a motion does not have is missing, not zero."""
    labels: list[str] = []
    columns: dict[str, list[Any]] = {"time": [], "x": [], "y": [], "z": []}
    for label, motion in motions.items():
        samples = motion.acceleration
        labels += [label] * len(samples)
        columns["time"].append(np.arange(len(samples)) * motion.time_step)
        for i, axis in enumerate("xyz"):
            missing = np.full(len(samples), np.nan)
            columns[axis].append(samples[:, i] if i < samples.shape[1] else missing)
    stacked = {"time": np.concatenate(columns["time"])}
    stacked |= {f"acceleration_{axis}": np.concatenate(columns[axis]) for axis in "xyz"}
    steps = {label: motion.time_step for label, motion in motions.items()}
    return pack({"motion": labels, **stacked}, {"kind": "ground motions", "time_step": steps})
