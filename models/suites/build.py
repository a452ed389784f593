"""From the tables of a suite file to cases and runs: one case for each combination of values."""

from __future__ import annotations

import itertools
import math
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import numpy as np
from pydantic import BaseModel

from ..case import Case, InitialState, Run, Suite
from ..cylinder import Cylinder, RockingBody, cylinder_of
from ..ground_motion import GroundMotion
from ..records.files import ZERO, el_centro_1940, read_record
from ..records.p695 import p695_far_field
from ..synthetic import MOST_STILL, SAMPLES_PER_PERIOD, pulse
from ..tendon import Tendon
from .tables import (
    WAYS_OF_READING,
    CaseTable,
    KeyedError,
    MotionTable,
    ReleaseTable,
    RunTable,
    SuiteTable,
    path_prefix,
)

# a slip in three ranges must not fill the memory
_MOST_CASES = 10_000
# digits of a value in a name: as few as distinguish all values of a key
_DIGITS = (3, 4, 6, 9, 12)

# keys that identify a record, besides its pair
_OF_A_RECORD = ("record", "vertical", "x", "y", "z", "files", *WAYS_OF_READING)

_Values = dict[tuple[str, str], float]


def build_suite(table: SuiteTable, folder: Path) -> Suite:
    """Suite of a file that was read from `folder`.

    Raises
    ------
    ValueError
        If a value is out of range or a record cannot be read; the message begins with the path of the key.
    """
    cases = [
        case for index, entry in enumerate(table.cases) for case in _cases(entry, f"cases[{index}]", folder)
    ]
    runs = [run for index, entry in enumerate(table.runs) for run in _runs(entry, f"runs[{index}]")]
    return Suite(cases, runs, table.bounds)


def _runs(table: RunTable, path: str) -> Iterator[Run]:
    for engine, support, step in itertools.product(table.engine, table.support, table.time_step or (None,)):
        with path_prefix(path):
            yield Run(engine, support, step, **table.settings)


def _cases(table: CaseTable, path: str, folder: Path) -> Iterator[Case]:
    numbers = list(_numbers(table))
    count = math.prod(len(values) for _, values in numbers)
    if count > _MOST_CASES:
        raise ValueError(f"{path}: must make at most {_MOST_CASES} cases, got {count}")
    varied = {key: _texts(values) for key, values in numbers if len(values) > 1}
    records: dict[object, GroundMotion] = {}
    for combination in itertools.product(*(range(len(values)) for _, values in numbers)):
        chosen = dict(zip((key for key, _ in numbers), combination, strict=True))
        values = {key: given[chosen[key]] for key, given in numbers}
        parts = [f"{key[1]} {texts[chosen[key]]}" for key, texts in varied.items()]
        name = table.name + (f": {', '.join(parts)}" if parts else "")
        yield _case(table, name, values, path, folder, records)


def _numbers(table: CaseTable) -> Iterator[tuple[tuple[str, str], tuple[float, ...]]]:
    """Pairs (table, key) and values of every number of the case, in the order of a name."""
    for part in ("cylinder", "motion", "release", "tendon", ""):
        holder: BaseModel | None = getattr(table, part) if part else table
        for key in type(holder).model_fields if holder is not None else ():
            values = getattr(holder, key)
            if isinstance(values, tuple):
                yield (part, key), values


def _texts(values: tuple[float, ...]) -> list[str]:
    texts: list[str] = []
    for digits in _DIGITS:
        texts = [f"{value:.{digits}g}" for value in values]
        if len(set(texts)) == len(texts):
            break
    return texts


def _case(
    table: CaseTable, name: str, values: _Values, path: str, folder: Path, records: dict[object, GroundMotion]
) -> Case:
    def of(part: str) -> dict[str, float]:
        return {key: value for (place, key), value in values.items() if place == part}

    with path_prefix(f"{path}.cylinder"):
        make = Cylinder if table.cylinder.semidiagonal is not None else Cylinder.from_dimensions
        cylinder = cylinder_of(of("cylinder"), make)
    case: dict[str, Any] = of("")
    motion = initial = None
    if table.motion is not None:
        with path_prefix(f"{path}.motion"):
            uplift = case.get("gravity", 9.81) * cylinder.tan_alpha
            motion = _motion(table.motion, of("motion"), folder, uplift, records)
    if table.release is not None:
        with path_prefix(f"{path}.release"):
            initial = _release(table.release, of("release"), cylinder)
    with path_prefix(f"{path}.tendon"):
        tendon = None if table.tendon is None else Tendon(**of("tendon"))
    with path_prefix(path):
        return Case(cylinder, motion, initial=initial, name=name, tendon=tendon, **case)


def _release(table: ReleaseTable, values: dict[str, float], cylinder: RockingBody) -> InitialState:
    tilt = values.get("tilt", math.radians(values.get("tilt_deg", 0.0)))
    if table.tilt_over_alpha is not None:
        tilt = values["tilt_over_alpha"] * cylinder.alpha
    return InitialState(
        tilt=tilt,
        tilt_rate=values.get("tilt_rate", 0.0),
        rolling_angle=math.radians(values.get("rolling_angle_deg", 0.0)),
        rolling_rate=values.get("rolling_rate", 0.0),
    )


# a shift is a whole number of time steps up to the rounding of decimal fractions
_ROUNDING = 1e-6


def _motion(
    table: MotionTable,
    values: dict[str, float],
    folder: Path,
    uplift: float,
    records: dict[object, GroundMotion],
) -> GroundMotion:
    """Motion for one value of each number; `uplift`: g tan alpha, `records`: motions read so far."""
    if table.pulse is not None:
        return _pulse(table.pulse, values, uplift)
    source = (values.get("pair"), *(getattr(table, key) for key in _OF_A_RECORD))
    if source not in records:
        records[source] = _record(table, values, folder)
    motion = records[source]
    if "times_uplift" in values:
        if motion.peak == 0.0:
            raise KeyedError("times_uplift", "needs a horizontal acceleration to scale, got none")
        motion = motion.scaled(values["times_uplift"] * uplift / motion.peak)
    motion = motion.scaled(values.get("scale", 1.0))
    if "rotation_deg" in values:
        motion = motion.rotated(math.radians(math.fmod(values["rotation_deg"], 360.0)))
    return _shift(motion, values.get("time_shift", 0.0))


def _record(table: MotionTable, values: dict[str, float], folder: Path) -> GroundMotion:
    if table.record == "p695":
        number = values["pair"]
        try:
            return p695_far_field(int(number))
        except ValueError as error:
            raise KeyedError("pair", str(error)) from None
    if table.record is not None:
        return el_centro_1940(vertical=bool(table.vertical))
    names = {"record_columns": "columns", "record_step": "time_step"}
    ways: dict[str, Any] = {
        names.get(key, key): getattr(table, key) for key in table.present(*WAYS_OF_READING)
    }
    if table.files is not None:
        return read_record(folder / table.files, **ways)
    x, y, z = (name if name in (None, ZERO) else folder / name for name in (table.x, table.y, table.z))
    assert x is not None
    assert y is not None
    return read_record(x, y, z, **ways)


def _pulse(kind: str, values: dict[str, float], uplift: float) -> GroundMotion:
    amplitude = values["amplitude"] if "amplitude" in values else values["times_uplift"] * uplift
    shift = values.get("time_shift", 0.0)
    if shift < 0.0:
        raise KeyedError("time_shift", f"must not be negative with a pulse, got {shift:g}")
    if shift > MOST_STILL * values["period"] / SAMPLES_PER_PERIOD:
        raise KeyedError("time_shift", f"must leave at most {MOST_STILL:g} samples before, got {shift:g} s")
    azimuth = math.radians(values.get("azimuth_deg", 0.0))
    return pulse(kind, amplitude=amplitude, period=values["period"], azimuth=azimuth, start=shift)


def _shift(motion: GroundMotion, shift: float) -> GroundMotion:
    """Motion delayed by still ground, or advanced without its first samples."""
    if shift > MOST_STILL * motion.time_step:
        raise KeyedError("time_shift", f"must leave at most {MOST_STILL:g} samples before, got {shift:g} s")
    count = round(shift / motion.time_step)
    if abs(shift / motion.time_step - count) > _ROUNDING * max(1, abs(count)):
        raise KeyedError(
            "time_shift",
            f"must be a whole number of the record's time steps of {motion.time_step:g} s, got {shift:g}",
        )
    if count == 0:
        return motion
    samples = motion.acceleration
    if -count > len(samples) - 2:
        raise KeyedError(
            "time_shift", f"must leave a part of the record, which lasts {motion.duration:g} s, got {shift:g}"
        )
    if count < 0:
        samples = samples[-count:]
    else:
        samples = np.concatenate([np.zeros((count, samples.shape[1])), samples])
    return motion.with_samples(samples, f"shifted by {shift:g} s")
