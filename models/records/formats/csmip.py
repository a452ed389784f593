"""CSMIP, CDMG and CGS of California, volumes 1 and 2: every channel of a station in one file of text."""

from __future__ import annotations

import re

from ..component import Component, RecordFile
from ..headers import TURNED_UP, azimuth_of, compare_peak, direction_at, direction_of
from ..numbers import fixed_width_block, stated_format
from ..reading import Reading
from ..units import stated_unit

NAME = "CSMIP V1/V2"
# "12001 POINTS OF ACCEL DATA EQUALLY SPACED AT .005 SEC.  (UNITS: G)",
# " 13400 Accelerogram points at 200 pts/sec in units of g.       Format: (8f9.6)"
_SPACED = re.compile(r"\s*(\d{1,9})\s+POINTS OF ACCEL DATA EQUALLY SPACED AT\s*(\d{0,3}\.?\d{1,9})\s*SEC\b")
_SAMPLED = re.compile(r"\s*(\d{1,9})\s+ACCELEROGRAM POINTS AT\s*(\d{1,5}(?:\.\d{1,6})?)\s*PTS/SEC\b")
_UNIT = re.compile(r"(?:UNITS OF|UNITS:|SEC, IN)\s+([A-Z/*^0-9]{1,12})")
_CHANNEL = re.compile(r"CHAN\s{0,9}(\d{1,4})\s?:\s{0,9}(.{0,60})")
_PEAK = re.compile(r"(?:PEAK ACCELERATION|UNITS OF UNCOR .{1,40}MAX)\s*=\s*([-+]?\d{0,9}\.\d{1,9})")
_PARTS_OF_G = {"G/10": 0.1, "MG": 1e-3}
_SHORTEST_LINE = 8  # shorter lines are skipped
_NUMBERS_PER_LINE = {"V1": (8, 9), "V2": (8, 10)}


def recognizes(file: RecordFile) -> bool:
    """Whether the title is that of an accelerogram, corrected or not, or of its spectra."""
    title = "\n".join(file.head[:3])
    others = title.lstrip().startswith(("1 ", "2 ")) or "GNS SCIENCE" in title  # SMC, GeoNet
    return "CORRECTED ACCELEROGRAM" in title and not others


def read(file: RecordFile, reading: Reading) -> list[Component]:
    """Acceleration of every channel; velocities and displacements of volume 2 are skipped.

    Raises
    ------
    ValueError
        If the file holds spectra (volume 3) or times beside the values (film digitised at uneven times), or
        a channel is damaged.
    """
    if file.head[0].lstrip().startswith("RESPONSE"):
        raise ValueError(f"{file.name} ({NAME}) holds spectra (volume 3): give the V2 file of the station")
    components: list[Component] = []
    channel, peak, corrected = "", None, False
    for at, line in enumerate(file.text):
        if len(line) < _SHORTEST_LINE:
            continue
        text = line[:120].upper()
        if text.startswith("CHAN") and (match := _CHANNEL.match(text)):
            channel, peak = line[: match.end()].rstrip(), None
        elif "ACCEL" in text or "UNCOR" in text:
            corrected = corrected or text.startswith("CORRECTED")
            peak = _PEAK.search(text) or peak
            match = _SPACED.match(text) or _SAMPLED.match(text)
            if match:
                stated = float(peak[1]) if peak else None
                components.append(_component(file, at, match, channel, stated, corrected))
    if not components:
        raise ValueError(
            f"{file.name} ({NAME}) gives a time with each value (film digitised unevenly), or no samples: "
            "give the V2 file of the station"
        )
    return components


def _unit(file: RecordFile, at: int, line: str) -> tuple[str | None, float]:
    """Return the unit of the samples and the factor to it."""
    word = _UNIT.search(line)
    if word is None:
        return None, 1.0
    if word[1] in _PARTS_OF_G:
        return "g", _PARTS_OF_G[word[1]]
    unit = stated_unit(file.path, [f"unit: {word[1]}"])
    if unit is None:
        raise ValueError(f"{file.name} ({NAME}), line {at + 1}: the unit {word[1]!r} is not known here")
    return unit, 1.0


def _component(
    file: RecordFile, at: int, match: re.Match[str], channel: str, peak: float | None, corrected: bool
) -> Component:
    line = file.text[at][:120].upper()
    count, spacing = int(match[1]), float(match[2])
    if not count or not spacing:
        raise ValueError(
            f"{file.name} ({NAME}), line {at + 1}: expected samples and their step, got {line.strip()[:60]!r}"
        )
    shape = stated_format(line[match.end() :], _NUMBERS_PER_LINE["V2" if corrected else "V1"])
    values = fixed_width_block(file, at + 1, count, shape)
    unit, factor = _unit(file, at, line)
    values *= factor
    name = (_CHANNEL.match(channel.upper()) or ["", "", ""])[2].strip()
    azimuth = azimuth_of(name)
    down = name.startswith("DOWN")
    notes = compare_peak(f"{file.name}, {channel}", values, peak, unit or "", 2e-3)
    return Component(
        path=file.path,
        values=-values if down else values,
        time_step=1.0 / spacing if match.re is _SAMPLED else spacing,
        unit=unit,
        format=NAME,
        label=" ".join(channel.split()),
        direction="z" if down else direction_at(azimuth) or direction_of(name.split()[0] if name else ""),
        azimuth=azimuth,
        notes=(TURNED_UP, *notes) if down else notes,
    )
