"""From the options of a command to a case."""

from __future__ import annotations

import math
from pathlib import Path
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from rockwobble.models import Case, GroundMotion

# length of a free response where the user does not say [s]
FREE_DURATION = 10.0


def case_from_options(
    *,
    semidiagonal: float,
    tan_alpha: float,
    record_x: Path | None = None,
    record_y: Path | None = None,
    record_z: Path | None = None,
    units: str | None = None,
    scale: float = 1.0,
    release_tilt_deg: float | None = None,
    rolling_rate: float = 0.0,
    duration: float | None = None,
) -> Case:
    """Return the case that the common options state.

    Raises
    ------
    ValueError
        If an option is out of range, or two do not go together.
    """
    from rockwobble.models import Case, Cylinder, InitialState

    cylinder = Cylinder(semidiagonal=semidiagonal, tan_alpha=tan_alpha)
    released = release_tilt_deg is not None
    if rolling_rate and not released:
        raise ValueError("--rolling-rate needs a release, give --release-tilt-deg [deg] as well")
    motion = _motion(record_x, record_y, record_z, units, scale, still=released)
    initial = None
    if release_tilt_deg is not None:
        initial = InitialState(tilt=math.radians(release_tilt_deg), rolling_rate=rolling_rate)
    if motion is None and duration is None:
        duration = FREE_DURATION
    name = "free response" if motion is None else motion.name + (f" × {scale:g}" if scale != 1.0 else "")
    return Case(cylinder, motion, initial=initial, duration=duration, name=name)


def _motion(
    x: Path | None, y: Path | None, z: Path | None, units: str | None, scale: float, *, still: bool
) -> GroundMotion | None:
    from rockwobble.models import el_centro_1940, read_record

    if not (math.isfinite(scale) and scale > 0.0):
        raise ValueError(f"--scale must be positive and finite, got {scale:g}")
    if x is None and y is None:
        if z is not None or units is not None:
            raise ValueError(
                "--record-z and --units belong to a record, give --record-x and --record-y as well"
            )
        if still:
            if scale != 1.0:
                raise ValueError("--scale belongs to a record, give --record-x and --record-y as well")
            return None
        return el_centro_1940().scaled(scale)
    if x is None or y is None:
        given, missing = ("--record-y", "--record-x") if x is None else ("--record-x", "--record-y")
        raise ValueError(f"both horizontal components are needed, got {given} without {missing}")
    return read_record(x, y, z, units=units).scaled(scale)
