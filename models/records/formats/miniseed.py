"""MiniSEED of the seismological data centres, by obspy."""

from __future__ import annotations

from ..component import Component, RecordFile
from ..headers import direction_of
from ..reading import Reading
from ..waveforms import read_waveforms, require_accelerations

NAME = "miniSEED"
_QUALITIES = b"DRQMVAST"  # quality of a data record, or kind of a control header


def recognizes(file: RecordFile) -> bool:
    """Whether the first record begins with a sequence number and a quality code."""
    content = file.content[:48]
    sequence, quality, reserved = content[:6], content[6:7], content[7:8]
    return (
        len(content) == 48
        and all(byte in b"0123456789 \0" for byte in sequence)
        and quality in (bytes([code]) for code in _QUALITIES)
        and reserved in (b" ", b"\0", b"*")
        and file.lines is None
    )


def read(file: RecordFile, reading: Reading) -> list[Component]:
    """Read every channel; the format states no unit, and most files hold counts.

    Raises
    ------
    ValueError
        If obspy is missing, the file is damaged or has a gap, or it holds counts.
    """
    return [
        Component(
            path=file.path,
            values=require_accelerations(file, NAME, waveform),
            time_step=waveform.time_step,
            unit=None,
            start=waveform.start,
            format=NAME,
            label=waveform.channel,
            direction=direction_of(waveform.channel[-1:]),
        )
        for waveform in read_waveforms(file, NAME, "MSEED")
    ]
