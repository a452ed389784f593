"""Parts of a trace and its Parquet file: samples as the table, the rest in its metadata.

The sampled quantities of a trace have a source, which has them at hand or computes them when they are first
asked for. A trace comes back from its file with the same bits.
"""

from __future__ import annotations

import io
import math
from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Protocol

import numpy as np
from numpy.typing import NDArray

from . import plain_json
from .case import Case, InitialState, Run
from .cylinder import cylinder_of
from .diagnostic import Assumptions, Diagnostic
from .ground_motion import GroundMotion
from .plain_json import Facts, JsonObject, fields_of
from .record_source import source_from_plain
from .shown import CompactRepr
from .tendon import Tendon

if TYPE_CHECKING:
    import pandas as pd

Array = NDArray[np.float64]
# key of our part of the metadata of a Parquet file, besides that of pandas
METADATA = b"rockwobble"
# names of samples in a table, components of a vector together, their unit and meaning
_SAMPLES = (
    ("time", "s", "from the start of the run"),
    ("tilt", "rad", "of the axis from the vertical"),
    ("tilt_rate", "rad/s", "its rate"),
    ("rolling_angle", "rad", "azimuth of the lean, unwrapped; empty at rest"),
    ("rolling_rate", "rad/s", "its rate"),
    ("twist", "rad", "rolling angle plus spin about the axis"),
    (
        "contact_x contact_y",
        "m",
        "contact point, relative to the original base centre, which moves with the ground",
    ),
    ("centre_x centre_y centre_z", "m", "mass centre, relative to the same point"),
    ("displacement_x displacement_y", "m", "base centre, relative to the same point"),
    ("force_x force_y force_z", "weights", "contact force on the cylinder"),
    (
        "top_force_x top_force_y top_force_z",
        "weights",
        "of a frame: contact force of a column on its share of the slab",
    ),
    ("friction_needed", "", "horizontal over normal force; infinite where the normal force is not positive"),
    ("restraining_moment", "m", "of the recess: kappa in kappa (z_world + z_body), over the weight"),
    ("elongation", "m", "of the tendon, since rest"),
    ("tendon_force", "weights", "tension of the tendon, over the weight of one column"),
    ("energy", "m2/s2", "relative to the ground, per unit mass, zero standing"),
    ("energy_lost", "m2/s2", "energy that rolling resistance and impacts took so far, per unit mass"),
    ("energy_error", "m2/s2", "energy that neither the start nor the excitation supplied"),
    ("slip", "m", "distance slipped so far"),
    ("wall_contact", "s", "time at walls so far"),
    ("wall_impulse", "m/s", "size of the force of those walls, summed over time so far, per unit mass"),
)
# name: (unit, meaning), of the samples as a table
COLUMNS = {
    name: (unit, words if not at else "likewise, up" if name.endswith("_z") else "likewise")
    for names, unit, words in _SAMPLES
    for at, name in enumerate(names.split())
}
PASS_COLUMNS = {
    "time": ("s", "of the least tilt"),
    "minimum_tilt": ("rad", "the least tilt"),
    "angle_of_turn": ("rad", "of the azimuth, from maximum to maximum"),
    "resolved": ("", "whether contact was stiff and steps short enough for it"),
}
VECTORS = {
    "contact_point": ("contact_x", "contact_y"),
    "centre_of_mass": ("centre_x", "centre_y", "centre_z"),
    "displacement": ("displacement_x", "displacement_y"),
    "contact_force": ("force_x", "force_y", "force_z"),
    "top_contact_force": ("top_force_x", "top_force_y", "top_force_z"),
}
OF_FRAMES = VECTORS["top_contact_force"]  # columns that only the trace of a frame has
OF_TENDONS = ("elongation", "tendon_force")  # and of a body with a tendon
# columns of the trace itself; the others in a table of samples belong to its source
FIELDS = ("time", "tilt", "tilt_rate", "rolling_angle", "twist", "contact_point", "centre_of_mass")


class Source(Protocol):
    """Source of the lazily computed quantities of a trace."""

    def quantities(self) -> Mapping[str, Array]:
        """Return the sampled quantities beyond the fields of a trace, (n,) or (n, 3)."""
        ...

    def assumptions(self, until: float) -> Assumptions | None:
        """Whether contact and friction held until a time [s]; None if unknown."""
        ...


@dataclass(frozen=True, slots=True, eq=False, repr=False)
class EagerSource(CompactRepr):
    """Source whose quantities are already computed, such as an engine or a stored file."""

    values: Mapping[str, Array]
    held: Assumptions | None = None

    def quantities(self) -> Mapping[str, Array]:
        """Return the quantities, each (n,) or (n, 3)."""
        return self.values

    def assumptions(self, until: float) -> Assumptions | None:
        """Assumptions over the whole motion, as far as known."""
        return self.held


def pass_table(columns: Mapping[str, Array], resolved: NDArray[np.bool_]) -> pd.DataFrame:
    """Table of passes from its columns (p,)."""
    import pandas as pd

    return pd.DataFrame({**columns, "resolved": resolved})


def no_passes() -> pd.DataFrame:
    """Return an empty table of passes."""
    import pandas as pd

    table = pd.DataFrame({name: np.empty(0) for name in ("time", "minimum_tilt", "angle_of_turn")})
    return table.assign(resolved=np.empty(0, dtype=bool))


def friction_of(force: Array) -> Array:
    """Horizontal over normal force (n,) of `force` (n, 3); inf where N is not positive."""
    horizontal, normal = np.hypot(force[:, 0], force[:, 1]), force[:, 2]
    pressed = normal > 0.0
    needed = np.where(pressed, horizontal / np.where(pressed, normal, 1.0), math.inf)
    return np.where(np.isnan(normal), math.nan, needed)


def trace_arguments(facts: Facts, samples: pd.DataFrame) -> JsonObject:
    """Arguments of a trace, except its case, from `Trace.to_plain` and its samples."""
    import pandas as pd

    if "rest_intervals" not in facts:
        raise ValueError("a trace of 0.2 or older must be run again: it does not say where it rests")
    # a file of an older version lacks later fields
    arguments: dict[str, Array] = {name: samples[name].to_numpy() for name in samples.columns}
    for name, columns in VECTORS.items():
        if columns[0] in arguments:
            arguments[name] = samples[list(columns)].to_numpy()
    held, run = facts["assumptions"], facts["run"]
    passes = {
        name: np.array(column, dtype=bool if name == "resolved" else float)
        for name, column in facts["passes"].items()
    }
    return {
        **facts,
        **{name: arguments[name] for name in FIELDS},
        "run": Run(run["engine"], run["support"], run["time_step"], **run["settings"]),
        "facts": _diagnostics(facts["facts"]),
        "rest_intervals": np.array(facts["rest_intervals"], dtype=float).reshape(-1, 2),
        "extrema": np.array(facts["extrema"], dtype=float).reshape(-1, 4),
        "passes": pd.DataFrame(passes),
        "source": EagerSource(
            arguments,
            None if held is None else Assumptions(**held | {"breaches": _diagnostics(held["breaches"])}),
        ),
    }


def _diagnostics(given: Iterable[Facts]) -> tuple[Diagnostic, ...]:
    return tuple(Diagnostic(**each) for each in given)


def motion_facts(motion: GroundMotion) -> JsonObject:
    """Numbers of a ground motion, without its samples; SI units."""
    return {
        "name": motion.name,
        "time_step": motion.time_step,
        "samples": len(motion.acceleration),
        "components": "xyz"[: motion.acceleration.shape[1]],
        "peak": motion.peak,
    }


def case_facts(case: Case) -> JsonObject:
    """Fields of a case, with `motion_facts` of its ground motion; SI units and radians."""
    return fields_of(case) | {"motion": case.motion and motion_facts(case.motion)}


def case_from_plain(given: Facts) -> Case:
    """Case from its fields, as read from JSON."""
    motion, initial = given["motion"], given["initial"]
    fields = {
        "cylinder": cylinder_of(given["cylinder"]),
        "motion": motion and GroundMotion(**{**motion, "source": source_from_plain(motion.get("source"))}),
        "initial": initial and InitialState(**initial),
        "tendon": (tendon := given.get("tendon")) and Tendon(**tendon),
    }
    return Case(**{**given, **fields})


def pack(table: pd.DataFrame, about: Mapping[str, object]) -> bytes:
    """Table as the bytes of a Parquet file with `about` in its metadata."""
    import pyarrow as pa
    import pyarrow.parquet as pq

    packed = pa.Table.from_pandas(table, preserve_index=False)
    metadata = {**(packed.schema.metadata or {}), METADATA: plain_json.dumps(about).encode()}
    split = [field.name for field in packed.schema if pa.types.is_floating(field.type)]
    buffer = io.BytesIO()
    pq.write_table(
        packed.replace_schema_metadata(metadata),
        buffer,
        compression="zstd",
        use_byte_stream_split=split,  # takes a quarter off the size of numbers under zstd
        use_dictionary=[name for name in packed.column_names if name not in split],
        write_page_checksum=True,
    )
    return buffer.getvalue()


def read(content: bytes) -> tuple[pd.DataFrame, JsonObject]:
    """Return the table of a file written by `pack`, and its metadata.

    Raises
    ------
    ValueError or OSError
        If it cannot be read, or its data are damaged.
    """
    import pyarrow.parquet as pq

    table = pq.read_table(io.BytesIO(content), page_checksum_verification=True)
    return table.to_pandas(), read_about(content)


def read_about(source: bytes | Path) -> JsonObject:
    """Metadata of a Parquet file; empty where rockwobble did not write it."""
    import pyarrow.parquet as pq

    metadata = pq.read_schema(io.BytesIO(source) if isinstance(source, bytes) else source).metadata or {}
    values: JsonObject = plain_json.loads(metadata.get(METADATA, b"{}"))
    return values


def to_parquet(samples: pd.DataFrame, facts: Mapping[str, object], case: Case) -> bytes:
    """Return a trace as the bytes of a Parquet file."""
    return pack(samples, {"case": case, "trace": facts})


def from_parquet(path: str | Path) -> tuple[JsonObject, pd.DataFrame, Case]:
    """Facts, samples and case of a file of `to_parquet`.

    Raises
    ------
    ValueError
        If it is not one.
    """
    try:
        samples, about = read(Path(path).read_bytes())
        return about["trace"], samples, case_from_plain(about["case"])
    except (OSError, ValueError, KeyError) as error:
        why = str(error).partition("\n")[0] or type(error).__name__
        raise ValueError(f"{path} must be the file of a trace, cannot read it as one: {why}") from None
