"""SAC (Seismic Analysis Code), binary, by obspy."""

from __future__ import annotations

import struct

from ..component import Component, Direction, RecordFile
from ..headers import direction_at, direction_of
from ..reading import Reading
from ..waveforms import Waveform, read_waveforms, require_accelerations

NAME = "SAC"
_HEADER_BYTES = 632
_VERSIONS = (6, 7)  # version of the header, the 77th of its words
_KINDS = {6: "displacements", 7: "velocities", 50: "volts"}  # quantity of the samples, by IDEP


def recognizes(file: RecordFile) -> bool:
    """Return whether the version of the header is one of the format's, in either order of bytes."""
    if len(file.content) < _HEADER_BYTES:
        return False
    version = file.content[4 * 76 : 4 * 77]
    return any(struct.unpack(f"{order}i", version)[0] in _VERSIONS for order in "<>") and file.lines is None


def read(file: RecordFile, reading: Reading) -> list[Component]:
    """Read the samples; the format states no unit.

    Raises
    ------
    ValueError
        If obspy is missing, the file is damaged, or its header says that it holds velocities.
    """
    components = []
    for waveform in read_waveforms(file, NAME, "SAC"):
        kind = _KINDS.get(int(_number(waveform, "idep") or 0))
        if kind is not None:
            raise ValueError(f"{file.name} ({NAME}) holds {kind} by its header (IDEP), not accelerations")
        values = require_accelerations(file, NAME, waveform)
        direction, azimuth = _orientation(waveform)
        components.append(
            Component(
                path=file.path,
                values=values,
                time_step=float(f"{waveform.time_step:.7g}"),  # the format has single precision
                unit=None,
                start=waveform.start,
                format=NAME,
                label=waveform.channel,
                direction=direction,
                azimuth=azimuth,
                notes=("its values are whole numbers, as counts are",) if (values % 1.0 == 0.0).all() else (),
            )
        )
    return components


def _orientation(waveform: Waveform) -> tuple[Direction | None, float | None]:
    """Direction and azimuth [deg], by CMPINC (from up) and CMPAZ, else by the channel."""
    inclination, azimuth = _number(waveform, "cmpinc"), _number(waveform, "cmpaz")
    if inclination == 0.0:
        return "z", None
    if inclination == 90.0 and azimuth is not None:
        azimuth = float(f"{azimuth % 360.0:.6g}")
        return direction_at(azimuth), azimuth
    return direction_of(waveform.channel[-1:]), None


def _number(waveform: Waveform, key: str) -> float | None:
    value = waveform.header.get(key)
    try:
        return None if value is None else float(value)  # type: ignore[arg-type]
    except (TypeError, ValueError):
        return None
