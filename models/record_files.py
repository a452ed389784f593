"""Strong-motion records from files: PEER AT2, two-column text, CSV."""

from __future__ import annotations

import math
import re
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from .ground_motion import GroundMotion

# 1 g is 9.81 m/s^2, the default gravity of every model here, so that a/g stays what the file says
_METRES_PER_SECOND_SQUARED = {"g": 9.81, "m/s2": 1.0, "cm/s2": 0.01}
UNITS = tuple(_METRES_PER_SECOND_SQUARED)

_NUMBER = r"[-+]?(?:\d+\.?\d*|\.\d+)(?:[EeDd][-+]?\d+)?"
# AT2 columns of width 15 may touch, so numbers are matched and not split at blanks
_NUMBERS_ONLY = re.compile(rf"(?:\s*{_NUMBER})+\s*")
_SPELLINGS = {
    "g": ("g", "g's", "gs"),
    "m/s2": ("m/s2", "m/s^2", "m/s/s", "m/s**2", "m/sec2", "m/sec^2", "m/sec/sec", "m/s²"),
    "cm/s2": ("cm/s2", "cm/s^2", "cm/s/s", "cm/s**2", "cm/sec2", "cm/sec^2", "cm/sec/sec", "cm/s²", "gal"),
}
_UNIT_OF = {spelling: unit for unit, spellings in _SPELLINGS.items() for spelling in spellings}


@dataclass(frozen=True, slots=True)
class _Component:
    """One component as its file gives it, in the unit that the file states (None: silent)."""

    path: Path
    values: NDArray[np.float64]
    time_step: float
    unit: str | None


def read_record(
    x_path: str | Path,
    y_path: str | Path,
    z_path: str | Path | None = None,
    *,
    units: str | None = None,
    name: str | None = None,
) -> GroundMotion:
    """Read a ground motion, one file for each component.

    Each file may be PEER AT2 (in each form of its header line), text of two columns, time [s] and
    acceleration, or the same as CSV with or without a header line. 1 g is 9.81 m/s^2.

    Parameters
    ----------
    x_path, y_path : str or Path
        East-west and north-south component.
    z_path : str or Path, optional
        Vertical component.
    units : {"g", "m/s2", "cm/s2"}, optional
        Required where a file does not say its unit; where it does, both must agree.
    name : str, optional
        Default: the name of the x file without its ending.

    Returns
    -------
    GroundMotion
        In m/s^2, cut to the shortest component.

    Raises
    ------
    ValueError
        If a file is missing, empty or not readable as numbers, its unit is unknown or contradicts
        `units`, its time steps are uneven, or the components have different time steps. The
        message names the file and the line.
    """
    if units is not None and units not in UNITS:
        raise ValueError(f"units must be one of {', '.join(UNITS)}, got {units!r}")
    paths = [Path(path) for path in (x_path, y_path, z_path) if path is not None]
    components = [_read_component(path) for path in paths]
    first = components[0]
    for other in components[1:]:
        if not math.isclose(other.time_step, first.time_step, rel_tol=1e-6):
            raise ValueError(
                f"the components of a record must have one time step, got {first.time_step:g} s in "
                f"{first.path.name} and {other.time_step:g} s in {other.path.name}"
            )
    length = min(len(component.values) for component in components)
    columns = [component.values[:length] * _factor(component, units) for component in components]
    return GroundMotion(np.column_stack(columns), first.time_step, paths[0].stem if name is None else name)


def _factor(component: _Component, units: str | None) -> float:
    unit = component.unit or units
    if unit is None:
        raise ValueError(
            f"{component.path.name} does not say its unit: give units, one of {', '.join(UNITS)}"
        )
    if units is not None and units != unit:
        raise ValueError(f"{component.path.name} says that it is in {unit}, but units is {units!r}")
    return _METRES_PER_SECOND_SQUARED[unit]


def _read_component(path: Path) -> _Component:
    try:
        # utf-8-sig drops the byte-order mark that spreadsheets write
        lines = path.read_text(encoding="utf-8-sig", errors="replace").splitlines()
    except OSError as error:
        raise ValueError(f"cannot read the record {path}: {error.strerror or error}") from None
    if not any(line.strip() for line in lines):
        raise ValueError(f"the record {path} is empty")
    if any("NPTS" in line.upper() for line in lines[:6]):
        return _read_at2(path, lines)
    return _read_columns(path, lines)


def _read_at2(path: Path, lines: list[str]) -> _Component:
    at = next(index for index, line in enumerate(lines) if "NPTS" in line.upper())
    count, time_step = _at2_counts(path, lines[at])
    title = " ".join(lines[:at]).upper()
    if "VELOCITY" in title or "DISPLACEMENT" in title:
        raise ValueError(f"{path.name} is not an acceleration record: {lines[at - 1].strip()}")
    stated = re.search(r"UNITS?\s*(?:OF|:|=)\s*([^\s,;]+)", title)
    unit = None if stated is None else _unit(path, stated.group(1))
    values: list[float] = []
    for number, line in enumerate(lines[at + 1 :], start=at + 2):
        if not line.strip():
            continue
        if not _NUMBERS_ONLY.fullmatch(line):
            raise ValueError(f"{path.name}, line {number}: expected accelerations, got {line.strip()[:60]!r}")
        values.extend(_float(token) for token in re.findall(_NUMBER, line))
    if len(values) < count:
        raise ValueError(f"{path.name} announces {count} samples and holds {len(values)}")
    return _component(path, np.array(values[:count]), time_step, unit)


def _at2_counts(path: Path, line: str) -> tuple[int, float]:
    """Number of samples and time step, from "NPTS= 4000, DT= .0100 SEC" or "4000 .0100 NPTS, DT"."""
    named = re.search(rf"NPTS\s*=\s*(\d+).*?DT\s*=\s*({_NUMBER})", line, re.IGNORECASE)
    bare = re.match(rf"\s*(\d+)[\s,]+({_NUMBER})\s*,?\s*NPTS", line, re.IGNORECASE)
    found = named or bare
    if found is None:
        raise ValueError(
            f"{path.name}: expected 'NPTS= n, DT= step SEC' or 'n step NPTS, DT', got {line.strip()[:60]!r}"
        )
    return int(found.group(1)), _float(found.group(2))


def _read_columns(path: Path, lines: list[str]) -> _Component:
    rows: list[tuple[float, float]] = []
    header: list[str] = []
    for number, line in enumerate(lines, start=1):
        text = line.strip()
        if not text:
            continue
        cells = [cell for cell in re.split(r"\s*[,;]\s*|\s+", text.rstrip(",;")) if cell]
        if not rows and (text[0] in "#%!" or not any(re.fullmatch(_NUMBER, cell) for cell in cells)):
            header.append(text)
            continue
        if len(cells) != 2 or not all(_is_number(cell) for cell in cells):
            raise ValueError(
                f"{path.name}, line {number}: expected two numbers, time [s] and acceleration, "
                f"got {text[:60]!r}"
            )
        rows.append((_float(cells[0]), _float(cells[1])))
    if len(rows) < 2:
        raise ValueError(f"{path.name} must hold at least two samples, got {len(rows)}")
    time, values = np.array(rows).T
    steps = np.diff(time)
    time_step = float(time[-1] - time[0]) / len(steps)
    # printed times are rounded: half a step in the last digit of five is still one time step
    if not time_step > 0.0 or float(np.abs(steps - time_step).max()) > 0.05 * time_step:
        raise ValueError(
            f"{path.name}: times must rise in even steps, got steps from {steps.min():g} to {steps.max():g} s"
        )
    return _component(path, values, float(f"{time_step:.9g}"), _header_unit(header))


def _header_unit(header: list[str]) -> str | None:
    """Unit of the acceleration in a header such as "time [s], acceleration [cm/s^2]"."""
    for line in header:
        for token in re.findall(r"[\[(]([^\])]*)[\])]", line) or re.split(r"[\s,;]+", line):
            unit = _UNIT_OF.get(token.strip().lower())
            if unit is not None:
                return unit
    return None


def _unit(path: Path, stated: str) -> str:
    unit = _UNIT_OF.get(stated.lower())
    if unit is None:
        raise ValueError(f"{path.name} is in {stated}, allowed are {', '.join(UNITS)}")
    return unit


def _component(path: Path, values: NDArray[np.float64], time_step: float, unit: str | None) -> _Component:
    if not time_step > 0.0:
        raise ValueError(f"{path.name}: the time step must be positive [s], got {time_step:g}")
    bad = np.flatnonzero(~np.isfinite(values))
    if len(bad):
        raise ValueError(f"{path.name}: sample {bad[0] + 1} must be finite, got {values[bad[0]]}")
    return _Component(path, values, time_step, unit)


def _is_number(cell: str) -> bool:
    return re.fullmatch(_NUMBER, cell) is not None or cell.lower().lstrip("+-") in ("nan", "inf", "infinity")


def _float(token: str) -> float:
    """Parse a number; Fortran writes D for the exponent of a double."""
    return float(re.sub("[Dd](?=[-+0-9])", "E", token))
