"""Strong-motion records from files: PEER AT2, two-column text, CSV."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from functools import cache
from importlib.resources import as_file, files
from pathlib import Path

import numpy as np

from ..ground_motion import GroundMotion
from ..number_checks import require_one_of
from .component import Component, ReadingOptions, open_record
from .formats import read_components
from .units import UNITS, factor

ZERO = "zero"  # in the place of a file: planar motion
# components may differ in length by this part, and by more where what is left out is below this part of
# the peak
_LEFT_OUT, _STILL = 0.01, 0.05
# over a whole record two components may drift apart by this part of a step, the rounding of printed times
_DRIFT = 0.05
_MOST_PARTS = 20  # of the smallest step: a record of more samples by that is a mistake, not a common step


def read_record(
    x_path: str | Path,
    y_path: str | Path | None = None,
    z_path: str | Path | None = None,
    *,
    units: str | None = None,
    name: str | None = None,
    resample: bool = False,
) -> GroundMotion:
    r"""Read a ground motion, one file for each component or one for all.

    The file of a component may be PEER AT2 (in each form of its header line), text of two columns, time [s]
    and acceleration, or the same as CSV with or without a header line. One file for all is text or CSV of
    time, x, y and, where there is one, z. 1 g is 9.81 m/s^2. The first sample is at time 0 of a run, whatever
    time its file gives it.

    Parameters
    ----------
    x_path, y_path : str or Path
        East-west and north-south component; without the second the first holds all. "zero" in the place of
        one is a component of zeros, for planar motion along the other.
    z_path : str or Path, optional
        Vertical component.
    units : {"g", "m/s2", "cm/s2"}, optional
        Required where a file does not say its unit; where it does, both must agree.
    name : str, optional
        Default: the name of the x file without its ending.
    resample : bool, optional
        Take components of different time steps at the largest step that divides all of them. Records are
        linear between samples, all of which stay, so no component changes.

    Returns
    -------
    GroundMotion
        In m/s^2, cut to the shortest component where the others are as good as over by then.

    Raises
    ------
    ValueError
        If a file is missing, empty or not readable as numbers, its unit is unknown or contradicts
        `units`, its times are uneven, or the components have different time steps, starts or lengths. The
        message names the file, and the line where there is one.

    Examples
    --------
    >>> from tempfile import mkdtemp
    >>> from pathlib import Path
    >>> path = Path(mkdtemp()) / "pulse.csv"
    >>> _ = path.write_text("time,x,y\n0.00,0.0,0.0\n0.01,0.2,0.1\n0.02,0.0,0.0\n")
    >>> motion = read_record(path, units="g")
    >>> motion.name, motion.acceleration.shape, round(float(motion.acceleration[1, 0]), 3)
    ('pulse', (3, 2), 1.962)
    """
    if units is not None:
        require_one_of("units", units, UNITS)
    if y_path is None:
        if z_path is not None:
            raise ValueError(f"a file of all components has no other beside it, got {z_path} beside {x_path}")
        components = _read_all(Path(x_path))
    else:
        components = _read_each(x_path, y_path, z_path)
    if resample:
        components = _resampled(components)
    length = min(len(component.values) for component in components)
    first = max(components, key=lambda part: part.path.name != ZERO)
    for other in components:
        _require_same_clock(first, other, length)
    with np.errstate(over="ignore"):  # GroundMotion refuses what is not finite
        columns = [part.values[:length] * _factor(part, units) for part in components]
    _require_still_beyond(components, length)
    return GroundMotion(np.column_stack(columns), first.time_step, first.path.stem if name is None else name)


def _read_each(x: str | Path, y: str | Path, z: str | Path | None) -> list[Component]:
    """Read the file of each component; one of zeros has the clock of the other."""
    if str(x) == str(y) == ZERO:
        raise ValueError("one horizontal component must be a file, got zero for both")
    found = [
        None if str(path) == ZERO else _read_component(Path(path)) for path in (x, y, z) if path is not None
    ]
    given = next(part for part in found if part is not None)
    zero = replace(given, path=Path(ZERO), values=np.zeros_like(given.values))
    return [part or zero for part in found]


def _factor(part: Component, units: str | None) -> float:
    return 1.0 if part.path.name == ZERO else factor(part.path, part.unit, units)


def _read_component(path: Path) -> Component:
    (component,) = read_components(open_record(path), ReadingOptions())
    return component


def _read_all(path: Path) -> list[Component]:
    return read_components(open_record(path), ReadingOptions(alone=True))


def _resampled(components: Sequence[Component]) -> list[Component]:
    """Return components at the largest time step that divides the steps of all, linear between samples.

    That changes no record: each is linear between its samples, and all of them stay.

    Raises
    ------
    ValueError
        If no such step is at least a twentieth of the smallest one.
    """
    finest = min(components, key=lambda each: each.time_step)
    for parts in range(1, _MOST_PARTS + 1):
        step = finest.time_step / parts
        counts = [round(each.time_step / step) for each in components]
        drifts = [
            abs(each.time_step - count * step) * len(each.values)
            for each, count in zip(components, counts, strict=True)
        ]
        if max(drifts) <= _DRIFT * step:
            return [_refined(each, count, step) for each, count in zip(components, counts, strict=True)]
    coarsest = max(components, key=lambda each: each.time_step)
    raise ValueError(
        f"components are resampled to a step that divides all, at least 1/{_MOST_PARTS} of the smallest: "
        f"{finest.time_step:g} s in {finest.path.name} and {coarsest.time_step:g} s in {coarsest.path.name} "
        "have none"
    )


def _refined(component: Component, count: int, step: float) -> Component:
    """Return a component with each of its time steps cut into `count` of `step` [s]."""
    values = component.values
    places = np.arange((len(values) - 1) * count + 1) / count
    return replace(component, values=np.interp(places, np.arange(len(values)), values), time_step=step)


def _require_still_beyond(components: Sequence[Component], length: int) -> None:
    """Refuse a component that is cut short in the middle of its motion: half a record is another record."""
    for part in components:
        rest, peak = np.abs(part.values[length:]), np.abs(part.values).max()
        if len(rest) > _LEFT_OUT * len(part.values) and rest.max() > _STILL * peak:
            raise ValueError(
                f"the components of a record must be equally long, got {len(part.values)} samples in "
                f"{part.path.name} and {length} in another: what would be left out has "
                f"{100.0 * rest.max() / peak:.0f} % of its peak"
            )


def _require_same_clock(first: Component, other: Component, length: int) -> None:
    tolerance = _DRIFT * first.time_step
    if abs(other.time_step - first.time_step) * length > tolerance:
        raise ValueError(
            f"the components of a record must have one time step, got {first.time_step:g} s in "
            f"{first.path.name} and {other.time_step:g} s in {other.path.name}: resample (--resample) takes "
            "both at a step that divides them, which changes neither"
        )
    # an AT2 file gives no times: its first sample is taken as that of the others
    if first.start is not None and other.start is not None and abs(other.start - first.start) > tolerance:
        raise ValueError(
            f"the components of a record must start at one time, got {first.start:g} s in "
            f"{first.path.name} and {other.start:g} s in {other.path.name}"
        )


# provenance and orientation: records/README.md
_EAST_WEST = "RSN6_IMPVALL.I_I-ELC270-hor2.AT2"
_NORTH_SOUTH = "RSN6_IMPVALL.I_I-ELC180-hor1.AT2"
_UP = "RSN6_IMPVALL.I_I-ELC-UP.AT2"


@cache
def el_centro_1940(vertical: bool = False) -> GroundMotion:
    """Return the record of El Centro Array #9, Imperial Valley, 18 May 1940 (PEER RSN6).

    Parameters
    ----------
    vertical : bool, optional
        Whether to include the vertical component.

    Returns
    -------
    GroundMotion
        5346 samples of 0.01 s; x is the 270 (east-west) and y the 180 (north-south) component.
        The peak of the horizontal resultant is 0.28648 g.

    Examples
    --------
    >>> motion = el_centro_1940()
    >>> motion.acceleration.shape, round(motion.peak / 9.81, 5)
    ((5346, 2), 0.28648)
    """
    with as_file(files("rockwobble.models") / "records") as folder:
        motion = read_record(folder / _EAST_WEST, folder / _NORTH_SOUTH, folder / _UP if vertical else None)
    # both horizontal components reach to the shortest of them, 5346 samples, with or without z
    return GroundMotion(motion.acceleration, motion.time_step, "El Centro 1940")
