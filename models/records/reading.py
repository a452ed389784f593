"""Options for reading a record: facts missing from its files, and processing."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

from ..argument_kinds import with_argument_kinds
from ..number_checks import require_finite, require_one_of, require_positive
from .component import STEP_OPTION
from .directions import NORTH
from .units import given_unit

LENGTHS = ("pad", "cut")
_SAME_STEP = 3e-3  # relative: 0.0167 for 1/60


@with_argument_kinds
@dataclass(frozen=True, slots=True, kw_only=True)
class Reading:
    """Options of reading a record.

    Parameters
    ----------
    units : str, optional
        "g", "m/s2", "cm/s2" or another unit of acceleration in any usual spelling. Required where a file does
        not say its unit; where it does, both must agree.
    columns : str or sequence of str or int, optional
        Columns of time, x, y and z in this order, by name or number from 1, such as "Zeit,Ost,Nord" or
        [1, 4, 3, 2]. "values": all numbers are one component, row by row. Of a network's file of several
        channels: those of x, y and z.
    time_step : float, optional
        Time step of files that give no times [s].
    lengths : {"pad", "cut"}, optional
        Where components differ in length: fill the shorter with zeros, or cut the longer. Default: cut to the
        shortest where the others are as good as over by then.
    remove_mean : bool, optional
        Take its mean from each component, which is the offset of the sensor.
    rotate : float or "north", optional
        Turn the components by this angle, counter-clockwise from above [deg]; "north": so that x is east and
        y north, by the azimuths that the files state.
    resample : bool, optional
        Take components of different time steps at the largest step that divides all of them: records are
        linear between samples, all of which stay, so no component changes. Uneven times become even, at their
        median step, with samples linearly between those of the file.

    Raises
    ------
    ValueError
        If one is out of range.

    Examples
    --------
    >>> from rockwobble.models import Reading
    >>> Reading(units="cm/s^2", rotate=30.0).units
    'cm/s2'
    """

    units: str | None = None
    columns: str | Sequence[str | int] | None = None
    time_step: float | None = None
    lengths: str | None = None
    remove_mean: bool = False
    rotate: float | str | None = None
    resample: bool = False

    def __post_init__(self) -> None:
        if self.units is not None:
            object.__setattr__(self, "units", given_unit(self.units))
        if self.lengths is not None:
            require_one_of("lengths", self.lengths, LENGTHS)
        if self.time_step is not None:
            require_positive("time_step", self.time_step, "s")
        if self.rotate not in (None, NORTH):
            try:
                require_finite("rotate", float(self.rotate or 0.0), "deg")
            except ValueError:
                raise ValueError(f"rotate must be an angle [deg] or {NORTH!r}, got {self.rotate!r}") from None
        if self.columns is not None and not (self.column_texts and all(self.column_texts)):
            raise ValueError(f"columns must be names or numbers, as Zeit,E,N or 1,3,2, got {self.columns!r}")

    @property
    def column_texts(self) -> tuple[str, ...]:
        """Names or numbers of columns; none where the user names none."""
        columns = self.columns.split(",") if isinstance(self.columns, str) else self.columns or ()
        return tuple(str(each).strip() for each in columns)

    def settled_step(self, name: str, stated: float | None) -> float:
        """Time step of a file [s]: from the file, or from the user.

        Parameters
        ----------
        name : str
            Name of the file, for messages.
        stated : float or None
            Time step that the file states [s].

        Raises
        ------
        ValueError
            If there is neither, or the two differ.
        """
        if stated is None:
            if self.time_step is None:
                raise ValueError(f"{name} has no times and states no time step: give it [s] by {STEP_OPTION}")
            return self.time_step
        if self.time_step is not None and abs(stated - self.time_step) > _SAME_STEP * stated:
            raise ValueError(
                f"{name} has a time step of {stated:g} s, but {STEP_OPTION} is {self.time_step:g} s"
            )
        return stated
