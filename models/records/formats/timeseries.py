"""TIMESERIES text of the FDSN data centres (SLIST, TSPAIR): a header line, then the samples of a channel."""

from __future__ import annotations

import re

from ..component import Component, ReadingOptions, RecordFile
from ..headers import direction_of
from ..numbers import block_of_numbers
from ..units import stated_unit

NAME = "TIMESERIES text"
# "TIMESERIES XX_ABC__HNE_R, 240 samples, 100 sps, 2023-02-06T01:17:30.000000, SLIST, FLOAT, M/S**2"
_HEADER = re.compile(
    r"TIMESERIES ([^,\s]{1,40}), (\d{1,9}) samples?, (\d{1,6}(?:\.\d{1,12})?) sps, [^,]{10,40}, "
    r"(SLIST|TSPAIR), (INTEGER|FLOAT|ASCII), ?([^,]{0,30})",
    re.IGNORECASE,
)


def recognizes(file: RecordFile) -> bool:
    """Return whether the first line begins with TIMESERIES and names one of the two lists."""
    return bool(file.head) and file.head[0].startswith("TIMESERIES ") and "SAMPLE" in file.head[0]


def read(file: RecordFile, options: ReadingOptions) -> list[Component]:
    """Read the channels one after another.

    Raises
    ------
    ValueError
        If a header or its number of samples is not as the format has it, the samples are whole numbers, hence
        counts, a channel has a gap, or the unit is none of an acceleration.
    """
    starts = [at for at, line in enumerate(file.text) if line.startswith("TIMESERIES ")]
    parts = [_component(file, at, end) for at, end in zip(starts, [*starts[1:], len(file.text)], strict=True)]
    labels = [part.label for part in parts]
    twice = next((label for label in labels if labels.count(label) > 1), None)
    if twice is not None:
        raise ValueError(f"{file.name} ({NAME}): {twice[:40]} has a gap: give a whole record")
    return parts


def _component(file: RecordFile, at: int, end: int) -> Component:
    line = file.text[at][:200]
    match = _HEADER.match(line)
    if match is None or not float(match[3]) > 0.0:
        raise ValueError(
            f"{file.name} ({NAME}), line {at + 1}: expected channel, samples, sps, start, SLIST or TSPAIR, "
            f"kind and unit, got {line[:60]!r}"
        )
    channel, count, unit = match[1], int(match[2]), match[6].strip()
    if match[5].upper() != "FLOAT" or unit.lower().startswith("count"):
        raise ValueError(
            f"{file.name} ({NAME}), line {at + 1}: {channel} holds counts, no accelerations: ask for "
            "corrected units, or remove the response"
        )
    if match[4].upper() == "TSPAIR":
        rows = [text.split()[1:] for text in file.text[at + 1 : end] if text.strip()]
        body = RecordFile(file.path, "\n".join([""] * (at + 1) + [" ".join(row) for row in rows]).encode())
        values = block_of_numbers(body, at + 1)
    else:
        values = block_of_numbers(file, at + 1, end)
    if len(values) != count:
        raise ValueError(
            f"{file.name} ({NAME}), line {at + 1}: announces {count} samples, the file holds {len(values)}"
        )
    name = channel.split("_")
    code = name[3] if len(name) > 3 else ""
    return Component(
        path=file.path,
        values=values,
        time_step=1.0 / float(match[3]),
        unit=stated_unit(file.path, [f"unit: {unit}"]) if unit else None,
        format=NAME,
        label=channel,
        direction=direction_of(code[-1:]),
    )
