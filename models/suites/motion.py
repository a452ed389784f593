"""Ground motions of a suite file: from the keys of a table to samples."""

from __future__ import annotations

import math
from pathlib import Path

import numpy as np

from ..ground_motion import GroundMotion
from ..pulses import MOST_STILL, SAMPLES_PER_PERIOD, pulse
from ..records.el_centro import el_centro_1940
from ..records.files import ZERO, read_record
from ..records.p695 import p695_far_field
from .errors import KeyedError
from .tables import MotionTable

# a shift is a whole number of time steps up to the rounding of decimal fractions
_ROUNDING = 1e-6


def build_motion(
    table: MotionTable,
    values: dict[str, float],
    folder: Path,
    uplift: float,
    records: dict[object, GroundMotion],
) -> GroundMotion:
    """Return the motion of one combination of values.

    Parameters
    ----------
    table : MotionTable
    values : dict
        One value for each number that the table gives, by its key.
    folder : Path
        Where relative paths start.
    uplift : float
        Acceleration that uplifts the cylinder of the case, g tan alpha [m/s^2].
    records : dict
        Records that were read so far, so that none is read twice; gets more.

    Raises
    ------
    ValueError
        If a record cannot be read, or a value does not suit it.
    """
    if table.pulse is not None:
        return _pulse(table.pulse, values, uplift)
    source = (
        table.record,
        table.vertical,
        values.get("pair"),
        table.x,
        table.y,
        table.z,
        table.units,
        table.resample,
    )
    if source not in records:
        records[source] = _record(table, values, folder)
    motion = records[source]
    if "times_uplift" in values:
        if motion.peak == 0.0:
            raise KeyedError("times_uplift", "needs a horizontal acceleration to scale, got none")
        motion = motion.scaled(values["times_uplift"] * uplift / motion.peak)
    motion = motion.scaled(values.get("scale", 1.0))
    if "rotation_deg" in values:
        motion = motion.rotated(math.radians(values["rotation_deg"]))
    return _shifted(motion, values.get("time_shift", 0.0))


def _record(table: MotionTable, values: dict[str, float], folder: Path) -> GroundMotion:
    if table.record == "p695":
        number = values["pair"]
        try:
            return p695_far_field(int(number))
        except ValueError as error:
            raise KeyedError("pair", str(error)) from None
    if table.record is not None:
        return el_centro_1940(vertical=bool(table.vertical))
    x, y, z = (name if name in (None, ZERO) else folder / name for name in (table.x, table.y, table.z))
    assert x is not None
    assert y is not None
    return read_record(x, y, z, units=table.units, resample=bool(table.resample))


def _pulse(kind: str, values: dict[str, float], uplift: float) -> GroundMotion:
    amplitude = values["amplitude"] if "amplitude" in values else values["times_uplift"] * uplift
    shift = values.get("time_shift", 0.0)
    if shift < 0.0:
        raise KeyedError("time_shift", f"must not be negative with a pulse, got {shift:g}")
    if shift > MOST_STILL * values["period"] / SAMPLES_PER_PERIOD:
        raise KeyedError("time_shift", f"must leave at most {MOST_STILL:g} samples before, got {shift:g} s")
    azimuth = math.radians(values.get("azimuth_deg", 0.0))
    return pulse(kind, amplitude=amplitude, period=values["period"], azimuth=azimuth, start=shift)


def _shifted(motion: GroundMotion, shift: float) -> GroundMotion:
    """Return the motion begun later, after still ground, or earlier, without its first samples."""
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
    return GroundMotion(samples, motion.time_step, motion.name)
