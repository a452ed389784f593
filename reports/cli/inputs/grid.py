"""From the options of a grid to its axes, ground motions and models."""

from __future__ import annotations

import math
from pathlib import Path
from typing import Literal

import rockwobble as rw
import rockwobble.compare as rc

_MOST_VALUES = 100_000
Records = tuple[list[Path] | None, list[Path] | None, list[Path] | None, str | None, bool]


def grid_of(
    sizes: str,
    slendernesses: str,
    scales: str,
    records: Records,
    models: list[str] | None,
    *,
    gravity: float,
    plane: float | None,
    restitution: float | Literal["momentum"] | None,
) -> rc.Grid:
    """Return the grid that the options state.

    Raises
    ------
    ValueError
        If one is out of range, two do not go together, or a record cannot be read.
    """
    planar = {"plane": plane, "restitution": restitution}
    given = {name: value for name, value in planar.items() if value is not None}
    if given and models != ["planar"]:
        raise ValueError(f"--{next(iter(given))} belongs to planar motion, give --model planar and no other")
    if not 0.0 < gravity < math.inf:
        raise ValueError(f"--gravity must be positive and finite [m/s^2], got {gravity:g}")
    options = given if gravity == 9.81 else {**given, "gravity": gravity}  # the default of every case
    return rc.Grid(
        semidiagonals=values_of("--semidiagonal", sizes),
        tan_alphas=values_of("--tan-alpha", slendernesses),
        scales=values_of("--scale", scales),
        motions=_motions(*records),
        models=models or ("recess",),
        **options,
    )


def values_of(option: str, text: str) -> list[float]:
    """Return the numbers of "6", "1,2,6" or "0.5:30:100".

    Raises
    ------
    ValueError
        If the text is none of these.
    """
    try:
        if ":" not in text:
            return [float(part) for part in text.split(",")]
        first, last, count = text.split(":")
        number = int(count)
        if not (2 <= number <= _MOST_VALUES and math.isfinite(float(first) - float(last))):
            raise ValueError  # noqa: TRY301 - the same answer as for what is no number
        import numpy as np

        return [float(value) for value in np.linspace(float(first), float(last), number)]
    except ValueError:
        raise ValueError(
            f"{option} must be a number, a list such as 1,2,6 or a range FROM:TO:COUNT, got {text!r}"
        ) from None


def _motions(
    x: list[Path] | None, y: list[Path] | None, z: list[Path] | None, units: str | None, resample: bool
) -> list[rw.GroundMotion]:
    x, y, z = x or [], y or [], z or []
    if not x and not y:
        if lone := "--record-z" if z else "--units" if units else "--resample" if resample else "":
            raise ValueError(f"{lone} belongs to a record, give --record-x and --record-y as well")
        return [rw.el_centro_1940()]
    if len(x) != len(y) or len(z) not in (0, len(x)):
        raise ValueError(
            "each record needs both horizontal components (zero for one: planar motion), and all a vertical "
            f"one or none: got {len(x)}, {len(y)} and {len(z)} files"
        )
    ups: list[Path | None] = list(z) if z else [None] * len(x)
    return [
        rw.read_record(east, north, up, units=units, resample=resample)
        for east, north, up in zip(x, y, ups, strict=True)
    ]
