"""Strong-motion records from files: components of one or several files as one ground motion."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import replace
from functools import cache
from importlib.resources import as_file, files
from pathlib import Path

import numpy as np

from ..argument_kinds import with_argument_kinds
from ..doubts import doubts_as_read
from ..ground_motion import GroundMotion
from ..record_source import METRES_PER_SECOND_SQUARED, ComponentSource, RecordSource
from .component import Component, Direction, open_record
from .directions import NORTH, at_the_surface, for_place, in_order, turned_to_north
from .formats import read_components
from .reading import Reading
from .units import settled_unit

ZERO = "zero"  # in place of a file: planar motion
_G = METRES_PER_SECOND_SQUARED["g"]
# largest drift between two components over a record, in steps: the rounding of printed times
_DRIFT = 0.05
_MOST_PARTS = 20  # samples per smallest step; a longer resampled record indicates a mistake in the time steps
# share by which the lengths of components may differ, and share of the peak below which more may be cut
_LEFT_OUT, _STILL = 0.01, 0.05


@with_argument_kinds
def read_record(
    x_path: str | Path | Sequence[str | Path],
    y_path: str | Path | None = None,
    z_path: str | Path | None = None,
    *,
    units: str | None = None,
    columns: str | Sequence[str | int] | None = None,
    time_step: float | None = None,
    lengths: str | None = None,
    remove_mean: bool = False,
    rotate: float | str | None = None,
    resample: bool = False,
    name: str | None = None,
) -> GroundMotion:
    r"""Read a ground motion, one file for each component or one file or folder for all.

    The formats are those of `models.records.formats`: PEER AT2, what the networks give out, text and CSV of
    columns, and values without times. In one file of several columns their names say which is x (east), y
    (north) and z (up), in any order. 1 g is 9.81 m/s^2. The first sample is at time 0 of a run, whatever time
    its file gives it. `GroundMotion.source` says what was read, in one line.

    Parameters
    ----------
    x_path, y_path : str or Path
        East-west and north-south component; without the second the first holds all, and may be a folder of
        the files of one station, or a list of them. "zero" in the place of one is a component of zeros, for
        planar motion along the other.
    z_path : str or Path, optional
        Vertical component.
    units, columns, time_step, lengths, remove_mean, rotate, resample
        As of `Reading`.
    name : str, optional
        Default: the name of the x file without its ending.

    Returns
    -------
    GroundMotion
        In m/s^2.

    Raises
    ------
    ValueError
        If a file is missing, empty or not readable as numbers, its unit is unknown or contradicts
        `units`, its columns cannot be told apart, its times are uneven, or the components have different time
        steps, starts or lengths. The message names the file, and the line where there is one.

    Examples
    --------
    >>> from tempfile import mkdtemp
    >>> from pathlib import Path
    >>> path = Path(mkdtemp()) / "pulse.csv"
    >>> _ = path.write_text("time,NS,EW\n0.00,0.0,0.0\n0.01,0.1,0.2\n0.02,0.0,0.0\n0.03,-0.1,-0.2\n")
    >>> motion = read_record(path, units="g")
    >>> motion.name, motion.acceleration.shape, round(float(motion.acceleration[1, 0]), 3)
    ('pulse', (4, 2), 1.962)
    >>> motion.source
    pulse.csv: columns, 4 samples of 0.01 s, 0.03 s; x: EW [g] 0.2 g; y: NS [g] 0.1 g
    """
    reading = Reading(
        units=units,
        columns=columns,
        time_step=time_step,
        lengths=lengths,
        remove_mean=remove_mean,
        rotate=rotate,
        resample=resample,
    )
    return record_of(x_path, y_path, z_path, reading, name)


def record_of(
    x_path: str | Path | Sequence[str | Path],
    y_path: str | Path | None,
    z_path: str | Path | None,
    reading: Reading,
    name: str | None,
) -> GroundMotion:
    """Ground motion of files, as `read_record` reads them."""
    if y_path is None:
        if z_path is not None:
            raise ValueError(f"a file of all components has no other beside it, got {z_path} beside {x_path}")
        if isinstance(x_path, str | Path):
            components, notes = _read_all(Path(x_path), reading)
        else:
            components, notes = _read_station([Path(each) for each in x_path], "the list of files", reading)
    elif not isinstance(x_path, str | Path):
        raise ValueError("a list of files of one station has no other beside it")
    else:
        components, notes = _read_each(x_path, y_path, z_path, reading), ()
    if reading.resample:
        components = _resampled(components)
    first = max(components, key=lambda part: part.path.name != ZERO)
    _require_same_clock([first, *(part for part in components if part is not first)])
    units_used = ["" if each.path.name == ZERO else settled_unit(each, reading.units) for each in components]
    components, changes = _equally_long(components, reading.lengths)
    with np.errstate(over="ignore"):  # GroundMotion refuses infinite samples
        samples = np.column_stack(
            [
                part.values * METRES_PER_SECOND_SQUARED.get(unit, 1.0)
                for part, unit in zip(components, units_used, strict=True)
            ]
        )
    if name is None:
        one = y_path is None and isinstance(x_path, str | Path)
        name = Path(str(x_path)).stem if one else first.path.stem
    motion = GroundMotion(samples, first.time_step, name)  # refuses samples that are not finite
    source = _source(motion, components, units_used, (*notes, *changes))
    if reading.remove_mean:
        means = ", ".join(f"{mean / _G:.3g}" for mean in samples.mean(axis=0))
        samples = samples - samples.mean(axis=0)
        removed = f"means of {means} g removed"
        source = replace(
            _source(GroundMotion(samples, first.time_step), components, units_used, source.notes),
            changes=(removed,),
        )
    motion = GroundMotion(samples, first.time_step, name, source)
    if reading.rotate == NORTH:
        azimuths = [_azimuth(part, axis) for part, axis in zip(components, "xy", strict=False)]
        return motion.with_samples(turned_to_north(samples, azimuths), "turned: x is east, y north")
    if reading.rotate is None:
        return motion
    return motion.rotated(math.radians(math.fmod(float(reading.rotate), 360.0)))


def _azimuth(part: Component, axis: str) -> float | None:
    if part.azimuth is not None or part.direction != axis:
        return part.azimuth
    return {"x": 90.0, "y": 0.0}[axis]


def _source(
    motion: GroundMotion, components: Sequence[Component], units: Sequence[str], notes: Sequence[str]
) -> RecordSource:
    samples = motion.acceleration
    parts = [
        ComponentSource(axis=axis, file=ZERO)
        if part.path.name == ZERO
        else ComponentSource(
            axis=axis,
            file=part.path.name,
            label=part.label,
            unit=unit,
            peak=float(np.abs(column).max()) / _G,
            mean=float(column.mean()) / _G,
            azimuth=part.azimuth,
        )
        for axis, part, unit, column in zip("xyz", components, units, samples.T, strict=False)
    ]
    known = [part for part in components if part.path.name != ZERO]
    formats = dict.fromkeys(part.format for part in known)
    said = dict.fromkeys([note for part in known for note in part.notes] + list(notes))
    return RecordSource(
        format=" and ".join(formats),
        time_step=motion.time_step,
        samples=len(samples),
        components=tuple(parts),
        notes=tuple(said),
        doubts=doubts_as_read(samples, motion.time_step, [part.direction for part in components], units),
    )


def _read_each(x: str | Path, y: str | Path, z: str | Path | None, reading: Reading) -> list[Component]:
    """Components of one file each; a component of zeros has the clock of the other."""
    if str(x) == str(y) == ZERO:
        raise ValueError("one horizontal component must be a file, got zero for both")
    axes: tuple[Direction, ...] = ("x", "y", "z")
    parts = [
        None
        if str(path) == ZERO
        else for_place(read_components(open_record(Path(path)), reading), axis, Path(path).name)
        for path, axis in zip((x, y, z), axes, strict=True)
        if path is not None
    ]
    known = next(part for part in parts if part is not None)
    zero = replace(known, path=Path(ZERO), values=np.zeros_like(known.values), direction=None, azimuth=None)
    return [part or zero for part in parts]


def _read_all(path: Path, reading: Reading) -> tuple[list[Component], tuple[str, ...]]:
    """Components of a file or a folder, and the files of the folder that were not read."""
    try:
        is_folder = path.is_dir()
    except (OSError, ValueError):  # null byte in the name
        is_folder = False
    if not is_folder:
        return in_order(read_components(open_record(path), reading), path.name), ()
    return _read_folder(path, reading)


_MOST_FILES = 60  # limit for the folder of a station; more files are those of many stations


def _read_folder(folder: Path, reading: Reading) -> tuple[list[Component], tuple[str, ...]]:
    paths = sorted(path for path in folder.iterdir() if path.is_file() and not path.name.startswith("."))
    if not 0 < len(paths) <= _MOST_FILES:
        raise ValueError(
            f"the folder {folder} must hold the files of one station, got {len(paths)} files: a folder of "
            "many records is for --records"
        )
    return _read_station(paths, folder.name, reading, others=True)


def _read_station(
    paths: Sequence[Path], name: str, reading: Reading, *, others: bool = False
) -> tuple[list[Component], tuple[str, ...]]:
    """Components from the files of one station; `others` allows files that are no records."""
    components: list[Component] = []
    refusals: list[tuple[str, ValueError]] = []
    for path in paths:
        try:
            components += read_components(open_record(path), reading)
        except ValueError as error:
            if not others:
                raise
            refusals.append((path.name, error))
    if not components:
        raise refusals[0][1] if refusals else ValueError(f"{name} holds no record")
    try:
        components, notes = at_the_surface(components)
        placed = in_order(components, name)
    except ValueError:
        if refusals:  # a missing component is probably a refused file
            raise refusals[0][1] from None
        raise
    left = ", ".join(each for each, _ in refusals)
    return placed, (*notes, *((f"not read: {left[:80]}",) if left else ()))


def _require_same_clock(components: Sequence[Component]) -> None:
    """Refuse components of different time steps, or that start at different times.

    Raises
    ------
    ValueError
        Naming two files that differ.
    """
    length = min(len(part.values) for part in components)
    first = components[0]
    tolerance = _DRIFT * first.time_step
    for other in components[1:]:
        if abs(other.time_step - first.time_step) * length > tolerance:
            raise ValueError(
                f"the components of a record must have one time step, got {first.time_step:g} s in "
                f"{first.path.name} and {other.time_step:g} s in {other.path.name}: resample (--resample) "
                "takes both at a step that divides them, which changes neither"
            )
        # an AT2 file has no times: its first sample is at the time of the others' first
        if first.start is not None and other.start is not None and abs(other.start - first.start) > tolerance:
            raise ValueError(
                f"the components of a record must start at one time, got {first.start:g} s in "
                f"{first.path.name} and {other.start:g} s in {other.path.name}"
            )


def _equally_long(
    components: Sequence[Component], lengths: str | None
) -> tuple[list[Component], tuple[str, ...]]:
    """Components of one length, and a note of the change.

    Parameters
    ----------
    components : sequence of Component
    lengths : {"pad", "cut"} or None
        Fill the shorter with zeros, or cut the longer. None: cut where what is left out is as good as over.

    Raises
    ------
    ValueError
        If one would be cut in the middle of its motion and `lengths` does not say so: half a record is
        another record.
    """
    counts = [len(part.values) for part in components]
    shortest, longest = min(counts), max(counts)
    if shortest == longest:
        return list(components), ()
    if lengths == "pad":
        padded = [
            replace(part, values=np.pad(part.values, (0, longest - len(part.values)))) for part in components
        ]
        return padded, (f"components of {shortest} samples filled with zeros",)
    for part in components if lengths is None else ():
        rest, peak = np.abs(part.values[shortest:]), np.abs(part.values).max()
        if len(rest) > _LEFT_OUT * len(part.values) and rest.max() > _STILL * peak:
            raise ValueError(
                f"the components of a record must be equally long, got {len(part.values)} samples in "
                f"{part.path.name} and {shortest} in another: what would be left out has "
                f"{100.0 * rest.max() / peak:.0f} % of its peak; --lengths pad (lengths=) fills the shorter "
                "with zeros, --lengths cut cuts the longer"
            )
    cut = [replace(part, values=part.values[:shortest]) for part in components]
    return cut, (f"components of up to {longest} samples cut to {shortest}",)


def _resampled(components: Sequence[Component]) -> list[Component]:
    """Components at the largest time step that divides the steps of all, linear between samples.

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
        pairs = list(zip(components, counts, strict=True))
        if all(abs(each.time_step - n * step) * len(each.values) <= _DRIFT * step for each, n in pairs):
            return [_refine(each, count, step) for each, count in pairs]
    coarsest = max(components, key=lambda each: each.time_step)
    raise ValueError(
        f"components are resampled to a step that divides all, at least 1/{_MOST_PARTS} of the smallest: "
        f"{finest.time_step:g} s in {finest.path.name} and {coarsest.time_step:g} s in {coarsest.path.name} "
        "have none"
    )


def _refine(component: Component, count: int, step: float) -> Component:
    """Component with each of its time steps divided into `count` of `step` [s]."""
    values = component.values
    places = np.arange((len(values) - 1) * count + 1) / count
    return replace(component, values=np.interp(places, np.arange(len(values)), values), time_step=step)


# provenance and orientation: records/README.md
_EAST_WEST = "RSN6_IMPVALL.I_I-ELC270-hor2.AT2"
_NORTH_SOUTH = "RSN6_IMPVALL.I_I-ELC180-hor1.AT2"
_UP = "RSN6_IMPVALL.I_I-ELC-UP.AT2"


@with_argument_kinds
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
        # both horizontal components are cut to the shortest, 5346 samples, with or without z
        return read_record(
            folder / _EAST_WEST,
            folder / _NORTH_SOUTH,
            folder / _UP if vertical else None,
            name="El Centro 1940",
        )
