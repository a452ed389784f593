"""Tables as Parquet files that say in their metadata what they are and what made them."""

from __future__ import annotations

import io
from collections.abc import Mapping
from pathlib import Path
from typing import TYPE_CHECKING

from . import plain_json
from .plain_json import JsonObject

if TYPE_CHECKING:
    import pandas as pd

# the name of our part of a file's metadata, beside that of pandas
METADATA = b"rockwobble"


def pack(table: pd.DataFrame, about: Mapping[str, object]) -> bytes:
    """Return a table as the bytes of a Parquet file with `about` in its metadata."""
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
