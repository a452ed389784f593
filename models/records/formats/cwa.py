"""CWA (earlier CWB) of Taiwan, TSMIP text: time and three columns under comments."""

from __future__ import annotations

import re

import numpy as np

from ..component import Component, RecordFile
from ..headers import compare_peak, direction_of
from ..numbers import fixed_width_block, stated_format
from ..reading import Reading
from ..units import stated_unit

NAME = "CWA/TSMIP text"
_RATE = re.compile(r"\s*(\d{1,5}(?:\.\d{1,6})?)")
_EXTREMES = re.compile(r"\s*([-+]?\d{1,6}\.\d{1,9})\s*~\s*([-+]?\d{1,6}\.\d{1,9})")


def recognizes(file: RecordFile) -> bool:
    """Whether the comments name the unit of the amplitude and the sequence of the data."""
    return any(line.startswith("#DATASEQUENCE") for line in file.head) and any(
        line.startswith(("#AMPLITUDEUNIT", "#SAMPLERATE")) for line in file.head
    )


def read(file: RecordFile, reading: Reading) -> list[Component]:
    """Columns in the sequence of the header, "Time U(+); N(+); E(+)".

    Raises
    ------
    ValueError
        If a line of the header is missing or unknown, the times contradict the sample rate, or a line of the
        samples is damaged.
    """
    header = [line for line in file.text[:60] if line.startswith("#")]
    values_of = {line.partition(":")[0].upper(): line.partition(":")[2] for line in header}
    names, signs = _sequence(file, values_of.get("#DATASEQUENCE", ""))
    rate = _RATE.match(values_of.get("#SAMPLERATE(HZ)", ""))
    if rate is None or not float(rate[1]):
        raise ValueError(f"{file.name} ({NAME}): its header must have '#SampleRate(Hz): 100'")
    first = max(at for at, line in enumerate(file.text[:60]) if line.startswith("#")) + 1
    rows = sum(1 for line in file.text[first:] if line.strip())
    length = _RATE.match(values_of.get("#RECORDLENGTH(SEC)", ""))
    if length and abs(rows - float(length[1]) * float(rate[1])) > float(rate[1]):
        raise ValueError(
            f"{file.name} ({NAME}): announces {length[1]} s at {rate[1]} Hz, "
            f"{float(length[1]) * float(rate[1]):.0f} samples, the file holds {rows}"
        )
    if rows < 2:
        raise ValueError(f"{file.name} ({NAME}): no samples follow the header")
    shape = stated_format(values_of.get("#DATA", ""), (len(names) + 1, 10))
    if shape[0] != len(names) + 1:
        raise ValueError(
            f"{file.name} ({NAME}): {shape[0]} columns by '#Data', {len(names) + 1} by '#DataSequence'"
        )
    table = fixed_width_block(file, first, rows * shape[0], shape).reshape(rows, shape[0])
    time, time_step = table[:, 0], 1.0 / float(rate[1])
    wrong = np.flatnonzero(np.abs(time - time[0] - time_step * np.arange(rows)) > 0.5 * time_step + 1e-3)
    if len(wrong):
        raise ValueError(
            f"{file.name} ({NAME}), line {first + wrong[0] + 1}: the time must be "
            f"{time[0] + time_step * wrong[0]:.3f} s by the sample rate, got {time[wrong[0]]:g}"
        )
    unit = stated_unit(file.path, [f"unit: {values_of.get('#AMPLITUDEUNIT', '')}"])
    components = []
    for name, sign, values in zip(names, signs, table.T[1:], strict=True):
        extremes = _EXTREMES.match(values_of.get(f"#AMPLITUDEMAX. {name.upper()}", ""))
        peak = max(abs(float(extremes[1])), abs(float(extremes[2]))) if extremes else None
        components.append(
            Component(
                path=file.path,
                values=sign * values,
                time_step=time_step,
                unit=unit,
                start=float(time[0]),
                format=NAME,
                label=name,
                direction=direction_of(name),
                notes=compare_peak(f"{file.name}, {name}", values, peak, "gal", 1e-3),
            )
        )
    return components


def _sequence(file: RecordFile, text: str) -> tuple[list[str], list[float]]:
    """Names of the columns after the time, and the sign of each positive sense."""
    cells = re.findall(r"([A-Z]{1,9})\s*\(([-+])\)", text[:200], re.IGNORECASE)
    if (
        not cells
        or not text.strip().upper().startswith("TIME")
        or not all(direction_of(cell[0]) for cell in cells)
    ):
        raise ValueError(
            f"{file.name} ({NAME}): expected '#DataSequence: Time U(+); N(+); E(+)', got {text[:60]!r}"
        )
    return [name for name, _ in cells], [float(f"{sign}1") for _, sign in cells]
