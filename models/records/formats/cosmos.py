"""COSMOS strong-motion format 1.20: raw counts (V0), uncorrected (V1) and corrected (V2) channels."""

from __future__ import annotations

import re
from collections.abc import Iterator

from ..component import Component, Direction, RecordFile
from ..headers import TURNED_UP, azimuth_of, compare_peak, direction_at, direction_of
from ..numbers import fixed_width_block, stated_format
from ..reading import Reading

NAME = "COSMOS V1/V2"
# "   7000  acceleration pts, approx   70 secs, units=cm/sec2(04),Format=(8F10.5)"
_DATA = re.compile(
    r"\s*(\d{1,9})\s+([A-Z. ]{1,30}?)\s*PTS\b.{0,40}?UNITS\s?=\s?([^(]{0,14})\(\s?(\d{1,3})\s?\)",
    re.IGNORECASE,
)
_HEADER = re.compile(r"\s*(\d{1,4})\s+(INTEGER|REAL)-HEADER VALUES FOLLOW ON", re.IGNORECASE)
_CHANNEL = re.compile(r"STA CHAN?:?\s{0,4}[^\s:]{1,4}\s?:\s{0,4}(.{0,50})", re.IGNORECASE)
# table of physical units: code, the unit here and its factor
_UNITS = {
    2: ("g", 1.0),
    4: ("cm/s2", 1.0),
    7: ("cm/s2", 2.54),
    10: ("cm/s2", 1.0),
    11: ("g", 1e-3),
    12: ("g", 1e-6),
}
# positions in the headers, counted from 0, and the value for unknown
_AZIMUTH, _INTERVAL, _LENGTH, _PEAK = 53, 61, 62, 63
_UNKNOWN = -999
_SHORTEST_LINE = 7  # shorter lines are skipped
_UP, _DOWN, _VERTICAL = 400, 401, 402


def recognizes(file: RecordFile) -> bool:
    """Whether the first line states the version of the format."""
    return bool(file.head) and "(FORMAT V" in file.head[0]


def read(file: RecordFile, reading: Reading) -> list[Component]:
    """Acceleration of every channel; velocities and displacements are skipped.

    Raises
    ------
    ValueError
        If the file holds counts or no acceleration, or a channel is damaged or contradicts itself.
    """
    components = [channel for channel in _channels(file) if channel is not None]
    if not components:
        raise ValueError(f"{file.name} ({NAME}) holds no samples of acceleration")
    return components


def _channels(file: RecordFile) -> Iterator[Component | None]:
    integers: list[float] = []
    reals: list[float] = []
    label, stream = "", ""
    for at, line in enumerate(file.text):
        if len(line) < _SHORTEST_LINE:
            continue
        text = line[:160]
        if "eader values" in text and (match := _HEADER.match(text)):
            shape = stated_format(text, (10, 8) if match[2].upper() == "INTEGER" else (5, 15))
            numbers = list(fixed_width_block(file, at + 1, int(match[1]), shape))
            if match[2].upper() == "INTEGER":
                integers = numbers
            else:
                reals = numbers
        elif text.startswith("Sta Cha") and (match := _CHANNEL.match(text)):
            label, stream = text[: match.end()].split("(")[0].strip(), ""
        elif text.startswith("|<SCNL>"):
            stream = [*text.split(">")[1].split("."), "", ""][1][:3]
        elif "pts" in text and (match := _DATA.match(text)):
            yield _component(file, at, match, integers, reals, label, stream)


def _component(
    file: RecordFile,
    at: int,
    match: re.Match[str],
    integers: list[float],
    reals: list[float],
    label: str,
    stream: str,
) -> Component | None:
    where = f"{file.name} ({NAME}), line {at + 1}"
    count, kind, unit, code = int(match[1]), match[2].lower(), match[3].strip(), int(match[4])
    if "accel" not in kind:
        return None
    if "raw" in kind or code in (50, 51):
        raise ValueError(f"{where}: holds raw counts (V0), which cannot be converted: give the V1 or V2 file")
    if code not in _UNITS:
        raise ValueError(f"{where}: the unit {unit!r} ({code}) is no unit of acceleration that is read here")
    if len(integers) <= _AZIMUTH or len(reals) <= _PEAK:
        raise ValueError(f"{where}: the integer and real headers must stand before the samples")
    interval, seconds = reals[_INTERVAL] * 1e-3, reals[_LENGTH]
    if not interval > 0.0 or (
        seconds > 0.0 and abs(count * interval - seconds) > 0.01 * seconds + 2.0 * interval
    ):
        raise ValueError(
            f"{where}: {count} samples at {1e3 * interval:g} ms contradict its length of {seconds:g} s"
        )
    name, factor = _UNITS[code]
    values = factor * fixed_width_block(
        file, at + 1, count, stated_format(file.text[at][match.end() : 160], (8, 10))
    )
    peak = reals[_PEAK] if reals[_PEAK] != _UNKNOWN else None
    notes = compare_peak(where, values, peak and factor * peak, name, 1e-5)
    direction, azimuth, down = _orientation(where, int(integers[_AZIMUTH]), label, stream)
    return Component(
        path=file.path,
        values=-values if down else values,
        time_step=float(f"{interval:.9g}"),
        unit=name,
        format=NAME,
        label=" ".join([*label.split(), *([stream] if stream else [])]),
        direction=direction,
        azimuth=azimuth,
        notes=(TURNED_UP, *notes) if down else notes,
    )


def _orientation(
    where: str, code: int, label: str, stream: str
) -> tuple[Direction | None, float | None, bool]:
    """Direction, azimuth [deg] and whether the sensor points down, by code, text and stream."""
    match = _CHANNEL.match(label)
    text = match[1] if match else ""
    stated = azimuth_of(text)
    if code in (_UP, _DOWN, _VERTICAL) and stated is None:
        return "z", None, code == _DOWN
    azimuth = float(code % 360) if 1 <= code <= 360 else None  # 0 is no azimuth in this format
    if azimuth is not None and stated not in (None, azimuth):
        raise ValueError(f"{where}: the header states two orientations, {stated:g} deg and code {code}")
    if code in (_UP, _DOWN, _VERTICAL):
        raise ValueError(
            f"{where}: the header states two orientations, {stated:g} deg and code {code}, vertical"
        )
    azimuth = stated if azimuth is None else azimuth
    # in a stream of three letters, such as HNE, the last is the direction
    named = direction_of(text.split()[0] if text else "") or direction_of(stream[2:])
    return (direction_at(azimuth) if azimuth is not None else named), azimuth, False
