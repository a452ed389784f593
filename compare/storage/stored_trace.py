"""A run that was kept in a file, with the attributes of the run itself."""

from __future__ import annotations

import dataclasses
import io
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from . import parquet_file, plain_json

if TYPE_CHECKING:
    import pandas as pd

Array = NDArray[np.float64]

# columns of `to_frame` that are components of one attribute
_VECTORS = {
    "contact_point": ("contact_x", "contact_y"),
    "centre_of_mass": ("centre_x", "centre_y", "centre_z"),
    "contact_force": ("force_x", "force_y", "force_z"),
}
# what every run has, or only some
_NAMES = (
    *("model", "engine", "engine_version", "support", "time_step", "settings", "outcome", "message"),
    *("peak_tilt", "uplift_time", "uplift_direction", "wall_time", "contact_resolution"),
    *("residual_displacement", "residual_twist", "energy", "contact_point", "assumptions"),
)
_INTERNAL = ("momentum", "twist_momentum", "roll_out")


@dataclass(frozen=True, slots=True, eq=False)
class StoredTrace:
    """One run of a reduced model or an engine, as a file holds it.

    It has the samples and the single numbers of a `reduced.Response` or a `multibody.Trajectory` as the
    same attributes with the same bits, and `passes` and `to_frame`. An attribute that the file does
    not hold does not exist, as where the file is older than the attribute.

    Parameters
    ----------
    frame : tuple of str
        Columns of `to_frame`.
    samples : DataFrame
        These columns and further ones.
    passes : DataFrame
        As those of the run.
    facts : mapping
        What does not change with time: peak_tilt, outcome, engine, settings and so on.
    """

    frame: tuple[str, ...]
    samples: pd.DataFrame
    passes: pd.DataFrame
    facts: Mapping[str, Any]

    def __getattr__(self, name: str) -> Any:
        if name.startswith("_"):  # asked for by copies and pickles before there are fields
            raise AttributeError(name)
        if name == "assumptions" and name in self.facts:
            return _assumptions(self.facts[name])
        if name in self.facts:
            return self.facts[name]
        if name in self.samples.columns:
            return self.samples[name].to_numpy()
        for parts in (_VECTORS.get(name, ()), [f"{name}_{axis}" for axis in "xyz"]):
            columns = [part for part in parts if part in self.samples.columns]
            if columns:
                return self.samples[columns].to_numpy()
        raise AttributeError(f"the stored run has no {name}")

    def to_frame(self) -> pd.DataFrame:
        """Return the sampled fields as a table with one row for each sample and units in SI."""
        return self.samples[list(self.frame)].copy()


def stored(trace: Any) -> StoredTrace:
    """Return what a file keeps of a response or a trajectory."""
    if isinstance(trace, StoredTrace):
        return trace
    frame = trace.to_frame()
    samples, facts = frame.copy(), {}
    for name in _public_names(trace):
        value = getattr(trace, name, None)
        if isinstance(value, np.ndarray):
            if value.shape == (len(frame),) and name not in samples:
                samples[name] = value
            elif value.shape in ((len(frame), 2), (len(frame), 3)) and name not in _VECTORS:
                samples[[f"{name}_{axis}" for axis in "xyz"[: value.shape[1]]]] = value
        elif (name == "assumptions" and value is not None) or _is_plain(value):
            facts[name] = plain_json.loads(plain_json.dumps(value))
    return StoredTrace(tuple(frame.columns), samples, trace.passes, facts)


def to_parquet(trace: StoredTrace, about: Mapping[str, Any]) -> bytes:
    """Return a run as one Parquet file: the samples, and in its metadata all the rest and `about`."""
    rest = {
        **about,
        "frame": trace.frame,
        "facts": trace.facts,
        "passes": {name: trace.passes[name].tolist() for name in trace.passes.columns},
    }
    return parquet_file.pack(trace.samples, rest)


def from_parquet(content: bytes) -> StoredTrace:
    """Return the run in a Parquet file that `to_parquet` made."""
    import pandas as pd

    samples = pd.read_parquet(io.BytesIO(content))
    rest = parquet_file.read_about(content)
    return StoredTrace(tuple(rest["frame"]), samples, passes_table(rest["passes"]), rest["facts"])


def passes_table(columns: Mapping[str, Sequence[Any]]) -> pd.DataFrame:
    """Return a table of passes of its columns: numbers, and `resolved`, which says yes or no."""
    import pandas as pd

    return pd.DataFrame(
        {
            name: np.asarray(column, dtype=bool if name == "resolved" else float)
            for name, column in columns.items()
        }
    )


def _public_names(trace: Any) -> list[str]:
    """Names of all that a run has, but the variables that only its solver knows."""
    kind = type(trace)
    fields = [field.name for field in dataclasses.fields(trace)] if dataclasses.is_dataclass(trace) else []
    derived = [name for name in dir(kind) if isinstance(getattr(kind, name), property)]
    names = dict.fromkeys([*_NAMES, *fields, *derived])
    return [name for name in names if not name.startswith("_") and name not in _INTERNAL]


def _is_plain(value: Any) -> bool:
    return isinstance(value, bool | int | float | str | Mapping | np.generic)


def _assumptions(values: Mapping[str, Any]) -> Any:
    from rockwobble.reduced.assumptions import Assumptions, Breach

    breaches = tuple(Breach(**breach) for breach in values["breaches"])
    return Assumptions(**{**values, "breaches": breaches})
