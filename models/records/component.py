"""Files of records as their readers see them, and the components that readers return."""

from __future__ import annotations

import codecs
import math
from dataclasses import dataclass, field
from functools import cached_property
from pathlib import Path
from typing import Literal

import numpy as np
from numpy.typing import NDArray

#: Direction of a component: x east, y north, z up.
Direction = Literal["x", "y", "z"]

# what spreadsheets call "Unicode text"
_UTF16 = (codecs.BOM_UTF16_LE, codecs.BOM_UTF16_BE)
# non-breaking blanks, and the typographic minus sign
_TYPESET = str.maketrans({"\u00a0": " ", "\u2007": " ", "\u2009": " ", "\u202f": " ", "\u2212": "-"})
# the largest files of the networks are below 50 MB; a larger file is one by mistake
LARGEST_FILE = 200_000_000  # [bytes]
STEP_OPTION, COLUMNS_OPTION = "--record-step (time_step=)", "--record-columns (columns=)"
_END_OF_FILE = b"\x1a"  # Ctrl-Z of DOS
_HEAD = 60  # lines; the longest headers of the networks have 55


_LONGEST_LINE = 300_000  # characters: a record of 30,000 samples in one line; patterns go over each line


@dataclass(frozen=True)
class RecordFile:
    """A file of a record, read once: its bytes, and its lines where it is text.

    Attributes
    ----------
    path : Path
    content : bytes
    """

    path: Path
    content: bytes = field(repr=False)

    @property
    def name(self) -> str:
        """Name of the file, as messages begin."""
        return self.path.name

    @cached_property
    def lines(self) -> tuple[str, ...] | None:
        """Lines without their ends; None where the file is binary: it holds null bytes."""
        if b"\0" in self.content:
            return None
        content = self.content.rstrip(b" \t\r\n" + _END_OF_FILE)
        try:  # utf-8-sig drops the byte-order mark that spreadsheets write
            text = content.decode("utf-8-sig")
        except UnicodeDecodeError:  # western Europe, and Turkey, which differs in six letters of Icelandic
            text = content.decode("cp1254", errors="replace")
        return tuple((text if text.isascii() else text.translate(_TYPESET)).splitlines())

    @property
    def text(self) -> tuple[str, ...]:
        """Lines of a text file.

        Raises
        ------
        ValueError
            If it is binary.
        """
        if self.lines is None:
            raise ValueError(
                f"the record {self.path} is no text in UTF-8, or in UTF-16 with its mark: it holds null bytes"
            )
        return self.lines

    @cached_property
    def head(self) -> tuple[str, ...]:
        """First lines in capitals, cut to 200 characters, which show the format; empty if binary."""
        return tuple(line[:200].upper() for line in (self.lines or ())[:_HEAD])


def open_record(path: Path) -> RecordFile:
    """Read the bytes of a file.

    Raises
    ------
    ValueError
        If it cannot be read, is empty, no regular file, damaged text in UTF-16, beyond 200 MB, or has a line
        that is longer than any record in one line.
    """
    try:
        content = bytes_of(path)
    except (OSError, ValueError) as error:  # ValueError: null byte in the name
        reason = getattr(error, "strerror", None) or error
        name = str(path)
        shown = name if name.isprintable() and len(name) <= _LONGEST_NAME else repr(name[-_LONGEST_NAME:])
        raise ValueError(f"cannot read the record {shown}: {reason}") from None
    if content.startswith(_UTF16):
        try:
            content = content.decode("utf-16").encode()
        except UnicodeDecodeError:
            raise ValueError(
                f"the record {path} is text in UTF-16 that is damaged: save it as UTF-8"
            ) from None
    file = RecordFile(path, content)
    if not content or (file.lines is not None and not any(line.strip() for line in file.lines)):
        raise ValueError(f"the record {path} is empty")
    longest = max(map(len, file.lines or ("",)))
    if longest > _LONGEST_LINE:
        raise ValueError(
            f"the record {path} has a line of {longest:,} characters, allowed are {_LONGEST_LINE:,}: break it"
        )
    return file


_LONGEST_NAME = 150  # characters of a path in a message


def bytes_of(path: Path) -> bytes:
    """Bytes of a file.

    Raises
    ------
    OSError
        If it cannot be read.
    ValueError
        If it is no regular file, larger than any record, or its name holds a null byte.
    """
    if path.exists() and not (path.is_file() or path.is_dir()):
        raise ValueError("it is no file, but a device, a pipe or a socket")
    size = path.stat().st_size
    if size > LARGEST_FILE:
        raise ValueError(f"it has {size / 1e6:.0f} MB, allowed are {LARGEST_FILE / 1e6:.0f}")
    return path.read_bytes()


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class Component:
    """Samples of one component, in the unit that the file states.

    Parameters
    ----------
    path : Path
        The file, for messages.
    values : ndarray, shape (n,)
        Acceleration [`unit`]; n >= 2, finite.
    time_step : float
        [s]
    unit : str or None
        One of `METRES_PER_SECOND_SQUARED`; None where the file is silent.
    start : float or None
        Time of the first sample [s]; None where the file gives no times.
    format : str
        NAME of the reader.
    label : str
        Column or channel as the file names it; empty where it has no name.
    direction : "x", "y", "z" or None
        East, north or up, where the file says so.
    azimuth : float or None
        Azimuth of the positive sense, where the file gives one [deg, clockwise from north].
    notes : tuple of str
        How the file was read where that is not plain, such as "mean of 12 gal removed by the network".

    Raises
    ------
    ValueError
        If there are fewer than two samples, or the time step is not positive and finite.
    """

    path: Path
    values: NDArray[np.float64]
    time_step: float
    unit: str | None
    start: float | None = None
    format: str = ""
    label: str = ""
    direction: Direction | None = None
    azimuth: float | None = None
    notes: tuple[str, ...] = ()

    def __post_init__(self) -> None:
        if len(self.values) < 2:
            raise ValueError(f"{self.path.name} must hold at least two samples, got {len(self.values)}")
        if not 0.0 < self.time_step < math.inf:
            raise ValueError(
                f"{self.path.name}: the time step must be positive and finite [s], got {self.time_step:g}"
            )
