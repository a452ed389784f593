"""Waveforms that obspy reads, for the formats whose files are binary."""

from __future__ import annotations

import io
import warnings
from collections.abc import Iterable
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from .component import RecordFile

_STEP_AGREEMENT = 0.05  # share of a step: a sample further off leaves a gap, or overlaps another


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class Waveform:
    """Samples of a channel.

    Attributes
    ----------
    values : ndarray, shape (n,)
        In the type of the file: integers are counts.
    time_step : float
        [s]
    start : float
        Time of the first sample since 1970 [s].
    channel : str
        Network, station, location and channel, parted by dots.
    header : dict
        Fields of the format beside these; empty where it has none.
    """

    values: NDArray[np.generic]
    time_step: float
    start: float
    channel: str
    header: dict[str, object]


def read_waveforms(file: RecordFile, name: str, obspy_format: str) -> list[Waveform]:
    """Channels of a file by obspy, each without gaps.

    Parameters
    ----------
    file : RecordFile
    name : str
        Name of the format, for messages.
    obspy_format : str
        As obspy calls it.

    Raises
    ------
    ValueError
        If obspy is not installed, does not read the file or warns of damage, or a channel has a gap.
    """
    try:
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")  # it loads its plugins in a way that Python deprecates
            from obspy import read
    except ImportError:
        raise ValueError(f"{file.name} is {name}, which needs obspy: pip install obspy") from None
    try:
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")
            warnings.filterwarnings("error", module="obspy", category=UserWarning)
            stream = read(io.BytesIO(file.content), format=obspy_format)
    except Exception as error:  # obspy raises the exceptions of its parts, of any kind, on a damaged file
        words = "".join(each if each.isprintable() else " " for each in str(error)).split()
        reason = " ".join(words)[:120] or type(error).__name__
        raise ValueError(f"{file.name} ({name}) is damaged: {reason}") from None
    channels: dict[str, list[Waveform]] = {}
    for trace in stream:
        part = Waveform(
            values=np.asarray(trace.data),  # no mask: a gap begins another trace
            time_step=float(trace.stats.delta),
            start=float(trace.stats.starttime.timestamp),
            channel=str(trace.id),
            header=dict(trace.stats.get(obspy_format.lower(), {})),
        )
        if len(part.values):
            channels.setdefault(part.channel, []).append(part)
    if not channels:
        raise ValueError(f"{file.name} ({name}) holds no samples")
    return [_join(file, name, parts) for parts in channels.values()]


def _join(file: RecordFile, name: str, parts: Iterable[Waveform]) -> Waveform:
    """Parts of a channel joined, if each begins a step after the one before."""
    first, *others = sorted(parts, key=lambda part: part.start)
    for part in others:
        due = first.start + len(first.values) * first.time_step
        if part.time_step != first.time_step or abs(part.start - due) > _STEP_AGREEMENT * first.time_step:
            raise ValueError(
                f"{file.name} ({name}), {first.channel[:30]}: has a gap or an overlap of "
                f"{part.start - due:.4g} s after {due - first.start:.4g} s: give a whole record"
            )
        first = Waveform(
            values=np.concatenate([first.values, part.values]),
            time_step=first.time_step,
            start=first.start,
            channel=first.channel,
            header=first.header,
        )
    return first


def require_accelerations(file: RecordFile, name: str, waveform: Waveform) -> NDArray[np.float64]:
    """Samples of a channel; refused where they are counts or not finite.

    Raises
    ------
    ValueError
        If they are integers, hence counts, or not finite.
    """
    if waveform.values.dtype.kind not in "fiu":
        raise ValueError(f"{file.name} ({name}), {waveform.channel[:30]}: holds no numbers")
    if waveform.values.dtype.kind != "f":
        raise ValueError(
            f"{file.name} ({name}), {waveform.channel[:30]}: contains counts, not accelerations: "
            "remove the response (obspy: remove_response(inventory, output='ACC')), or give --units"
        )
    values = waveform.values.astype(np.float64)
    if not np.isfinite(values).all():
        raise ValueError(f"{file.name} ({name}), {waveform.channel[:30]}: a sample must be a finite number")
    return values
