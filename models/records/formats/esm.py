"""ESM, ITACA and AFAD's newer .ASC (header DYNA 1.2): a header of keys, then a value a line."""

from __future__ import annotations

import re
from itertools import takewhile

from ..component import Component, RecordFile
from ..headers import compare_peak, direction_of
from ..numbers import table_of_numbers
from ..reading import Reading
from ..units import stated_unit

NAME = "ESM/ITACA ASC"
_KEY = re.compile(r"[A-Z][A-Z0-9_/^ ]{1,60}:", re.IGNORECASE)
_NUMBER = re.compile(r"[-+]?\d{0,12}\.?\d{0,12}(?:[Ee][-+]?\d{1,3})?")


def recognizes(file: RecordFile) -> bool:
    """Whether the header has the keys of the sampling interval and of the component."""
    keys = {line.partition(":")[0].strip() for line in file.head}
    return "SAMPLING_INTERVAL_S" in keys and bool(keys & {"STREAM", "COMPONENT", "NDATA"})


def read(file: RecordFile, reading: Reading) -> list[Component]:
    """Read the samples of a component of acceleration.

    Raises
    ------
    ValueError
        If a key is missing, the file holds velocities, displacements or a spectrum, or fewer samples than it
        announces.
    """
    lines = list(takewhile(lambda line: _KEY.match(line[:70]), file.text))
    header = {key.strip().upper(): value.strip() for key, _, value in (line.partition(":") for line in lines)}
    kind = header.get("DATA_TYPE", "ACCELERATION").upper()
    if kind != "ACCELERATION":
        raise ValueError(
            f"{file.name} ({NAME}) holds {kind[:40].lower()}, not acceleration: give its ACC.ASC"
        )
    time_step, count = _positive(file, header, "SAMPLING_INTERVAL_S"), int(_positive(file, header, "NDATA"))
    name = header.get("STREAM") or header.get("COMPONENT", "")
    values = table_of_numbers(file, len(lines), 1, count=count)[:, 0]
    unit = stated_unit(file.path, [f"UNITS: {header.get('UNITS', '')}"])
    peak = _NUMBER.fullmatch(header.get("PGA_CM/S^2", ""))
    stated = float(peak[0]) if peak and any(map(str.isdigit, peak[0])) else None
    notes = compare_peak(file.name, values, stated, "cm/s2", 1e-3) if unit == "cm/s2" else ()
    return [
        Component(
            path=file.path,
            values=values,
            time_step=time_step,
            unit=unit,
            format=NAME,
            label=name,
            # in a stream of three letters, such as HNE, the last is the direction
            direction=direction_of(name[2:] if len(name) == 3 and name[1:2].upper() in "NLHG" else name),
            notes=notes,
        )
    ]


def _positive(file: RecordFile, header: dict[str, str], key: str) -> float:
    match = _NUMBER.fullmatch(header.get(key, ""))
    value = float(match[0]) if match and any(map(str.isdigit, match[0])) else 0.0
    if not value > 0.0:
        raise ValueError(
            f"{file.name} ({NAME}): {key} must be a positive number, got {header.get(key, 'none')[:30]!r}"
        )
    return value
