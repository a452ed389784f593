"""Source of a ground motion: its files, and the changes since it was read."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from .diagnostic import Diagnostic
from .plain_json import Facts

# a mean above this share of the peak is stated and doubted: an offset that was not removed
LARGEST_MEAN = 0.05
# 1 g is 9.81 m/s^2, the default gravity of every model here, so that a/g stays what the file says
STANDARD_GRAVITY = 9.81
_USUAL = {"g": STANDARD_GRAVITY, "m/s2": 1.0, "cm/s2": 0.01}
METRES_PER_SECOND_SQUARED = _USUAL | {
    **{"mm/s2": 1e-3, "µm/s2": 1e-6, "mgal": 1e-5},
    **{unit: part * STANDARD_GRAVITY for unit, part in {"%g": 1e-2, "mg": 1e-3, "µg": 1e-6}.items()},
    **{"ft/s2": 0.3048, "in/s2": 0.0254},
}
UNITS = tuple(METRES_PER_SECOND_SQUARED)
USUAL_UNITS = tuple(_USUAL)
ALLOWED_UNITS = ", ".join(UNITS)
SYNTHETIC, PULSE = "synthetic", "pulse"  # formats of motions that were not recorded


@dataclass(frozen=True, slots=True, kw_only=True)
class ComponentSource:
    """Source of one component.

    Attributes
    ----------
    axis : str
        "x", "y" or "z".
    file : str
        Name of the file; empty where the record has none, "zero" of a component of zeros.
    label : str
        Column or channel, as the file names it.
    unit : str
        Unit of the numbers in the file.
    peak, mean : float
        As read [g].
    azimuth : float or None
        Azimuth of the positive sense, where the file gives it [deg, clockwise from north].
    """

    axis: str
    file: str = ""
    label: str = ""
    unit: str = ""
    peak: float = 0.0
    mean: float = 0.0
    azimuth: float | None = None


@dataclass(frozen=True, slots=True, kw_only=True, repr=False)
class RecordSource:
    """Source of a ground motion; its repr is the line that commands print.

    Attributes
    ----------
    format : str
        Format of the file, or of the files, as "PEER AT2".
    time_step : float
        As read [s].
    samples : int
        Number of samples as read.
    components : tuple of ComponentSource
    notes : tuple of str
        How it was read, where that is not plain.
    doubts : tuple of Diagnostic
        What makes it improbable as it was read.
    changes : tuple of str
        What was done to it since, as "scaled by 2".

    Examples
    --------
    >>> x = ComponentSource(axis="x", file="a.csv", label="E", unit="cm/s2", peak=0.25)
    >>> y = ComponentSource(axis="y", file="zero")
    >>> source = RecordSource(format="columns", time_step=0.01, samples=301, components=(x, y))
    >>> source.with_change("scaled by 2")
    a.csv: columns, 301 samples of 0.01 s, 3 s; x: E [cm/s2] 0.25 g; y: zero; scaled by 2
    """

    format: str
    time_step: float
    samples: int
    components: tuple[ComponentSource, ...]
    notes: tuple[str, ...] = ()
    doubts: tuple[Diagnostic, ...] = ()
    changes: tuple[str, ...] = ()

    def __repr__(self) -> str:
        return self.line

    @property
    def synthetic(self) -> bool:
        """Whether the motion was not recorded."""
        return self.format in (SYNTHETIC, PULSE)

    @property
    def from_files(self) -> bool:
        """Whether the motion is from a file of the user."""
        return any(part.file for part in self.components)

    @property
    def duration(self) -> float:
        """Time from the first to the last sample as read [s]."""
        return (self.samples - 1) * self.time_step

    @property
    def line(self) -> str:
        """Description of the source in one line."""
        files = {each.file for each in self.components if each.file not in ("", "zero")}
        one = f"{next(iter(files))}: " if len(files) == 1 else ""
        facts = f"{one}{self.format}, {self.samples} samples of {self.time_step:.6g} s, {self.duration:.5g} s"
        parts = [_component(each, named=len(files) > 1) for each in self.components]
        return "; ".join((facts, *parts, *self.notes, *self.changes))

    def with_change(self, change: str) -> RecordSource:
        """Source of a motion derived from this one by `change`."""
        return replace(self, changes=(*self.changes, change))


def source_of_samples(
    kind: str, acceleration: NDArray[np.float64], time_step: float, *, labels: Sequence[str] = ("", "", "")
) -> RecordSource:
    """Source of samples that are not from a file of the user.

    Parameters
    ----------
    kind : str
        What they are: "synthetic", "pulse", or a data set.
    acceleration : ndarray, shape (n, 2) or (n, 3)
        [m/s^2]
    time_step : float
        [s]
    labels : sequence of str
        Labels of the components.
    """
    values = acceleration / STANDARD_GRAVITY
    parts = [
        ComponentSource(axis=axis, label=label, peak=float(np.abs(part).max()), mean=float(part.mean()))
        for axis, label, part in zip("xyz", labels, values.T, strict=False)
    ]
    return RecordSource(format=kind, time_step=time_step, samples=len(acceleration), components=tuple(parts))


def _component(part: ComponentSource, *, named: bool) -> str:
    if part.file == "zero":
        return f"{part.axis}: zero"
    words = [f"{part.axis}:"]
    words += [part.file] if named and part.file else []
    words += [part.label] if part.label else []
    words += [f"[{part.unit}]"] if part.unit else []
    words += [f"{part.peak:.4g} g"]
    words += [f"(mean {part.mean:.3g} g)"] if abs(part.mean) > LARGEST_MEAN * part.peak else []
    words += [f"at {part.azimuth:g} deg"] if part.azimuth is not None else []
    return " ".join(words)


def source_from_plain(given: Facts | None) -> RecordSource | None:
    """Source from its fields, as read from JSON."""
    if given is None:
        return None
    fields = {
        **given,
        "components": tuple(ComponentSource(**each) for each in given["components"]),
        "doubts": tuple(Diagnostic(**each) for each in given["doubts"]),
        **{name: tuple(given[name]) for name in ("notes", "changes")},
    }
    return RecordSource(**fields)
