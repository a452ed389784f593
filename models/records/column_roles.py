"""Roles of the columns of a table: time and accelerations, by their names or as the user says."""

from __future__ import annotations

import re
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from .column_names import ColumnName, column_list, comparison_key, plain, without_unit
from .component import STEP_OPTION, Direction, ReadingOptions, RecordFile
from .table import Table
from .times import is_counting, rises_evenly, since_epoch, stated_step

OPTION = "--record-columns (columns=)"
_ROLES = ("time", "x", "y", "z")
_SKIPPED = "-"
_CLOCKS, _SAME_SPAN = (1.0, 1e3, 1e6, 1e9), 0.01  # units of a clock in those of the other times


@dataclass(frozen=True, slots=True)
class Value:
    """A column of accelerations."""

    place: int
    direction: Direction | None = None
    sign: float = 1.0
    azimuth: float | None = None


@dataclass(frozen=True, slots=True)
class Roles:
    """The column of times, None without one, and the columns of accelerations."""

    time: int | None
    values: list[Value]


@dataclass(frozen=True, slots=True)
class Columns:
    """The columns of a file, to be given their roles."""

    file: RecordFile
    table: Table
    names: list[ColumnName] | None
    texts: list[ColumnName] | None = None  # for messages: names that may be words of a sentence

    @property
    def width(self) -> int:
        """Number of columns."""
        return int(self.table.values.shape[1])

    def doubt(self, why: str, example: str = "") -> ValueError:
        """Return the refusal of columns that names do not settle."""
        return ValueError(
            f"{self.file.name}: {why}: name them by {OPTION}{example or ', such as time,x,y'}; "
            f"it has {column_list(self.names or self.texts, self.width)}"
        )

    def by_names(self, options: ReadingOptions) -> Roles:
        """Return the roles by the names, and where there are none by what the columns hold."""
        time = self._time(options)
        if self.names is None:
            places = [place for place in range(self.width) if place != time]
            if len(places) != 1:
                raise self.doubt("which column is which is not said", self._example(time))
            return Roles(time, [Value(places[0])])
        values, doubtful = [], []
        for place, name in enumerate(self.names):
            if place == time:
                continue
            if name.direction is not None or name.azimuth is not None:
                values.append(Value(place, name.direction, name.sign, name.azimuth))
            elif name.kind in ("acceleration", "unknown"):
                doubtful.append(place)
        if not values and len(doubtful) == 1:
            return Roles(time, [Value(doubtful[0])])
        directions = [value.direction for value in values if value.direction]
        twice = len(set(directions)) < len(directions)
        several = [place for place in doubtful if self.names[place].kind == "acceleration" or len(values) < 3]
        if not values and not doubtful:
            raise ValueError(f"{self.file.name}: no column is an acceleration, it has {self._kinds()}")
        if twice or several or not values:
            raise self.doubt(self._why(values, doubtful), self._example(time))
        return Roles(time, values)

    def _kinds(self) -> str:
        """Return the columns with what their names say they hold."""
        names = self.names or []
        return ", ".join(f"{name.text[:30]!r} ({name.kind})" for name in names)[:160]

    def _why(self, values: Sequence[Value], doubtful: Sequence[int]) -> str:
        names = self.names or []
        if doubtful:
            return f"which direction {names[doubtful[0]].text[:20]!r} has is not known"
        return "two columns have one direction"

    def _example(self, time: int | None) -> str:
        axes = ("x", "y", "z")[: max(self.width - (time is not None), 1)]
        words = [*(["time"] if time is not None else []), *axes]
        step = "" if time is not None else " (without times: with --record-step)"
        return f", such as {','.join(words)} or {','.join(str(i + 1) for i in range(len(words)))}{step}"

    def _time(self, options: ReadingOptions) -> int | None:
        """Return the column of times: by its name, or where none has one the only one that rises evenly."""
        values, names = self.table.values, self.names
        named = [place for place, name in enumerate(names or ()) if name.kind == "time"]
        if len(named) > 1:
            named = self._one_time(names or [], named)
        if named:
            return named[0]
        rising = [
            place
            for place in range(self.width)
            if rises_evenly(values[:, place]) and (names is None or names[place].kind in ("unknown", "index"))
        ]
        counting = [place for place in rising if is_counting(values[:, place])]
        times = [place for place in rising if place not in counting]
        if names is None and self.width == 2 and rising[:1] != [0] and _runs_one_way(values[:, 0]):
            return 0  # times, but uneven ones: refused with their line
        if names is None and self.width == 2 and times[:1] == [0]:
            return 0  # whatever the other does
        if len(times) > 1 or (names is None and counting and times and counting[0] < times[0]):
            pair = times[:2] if len(times) > 1 else [counting[0], times[0]]
            raise self.doubt(f"columns {pair[0] + 1} and {pair[1] + 1} both rise evenly")
        if times:
            return times[0]
        if self.width == 2 and counting[:1] == [0] and (names is None or names[0].kind == "unknown"):
            if options.time_step is not None:
                return 0
            raise ValueError(
                f"{self.file.name}: column 1 rises by 1, as sample numbers do: give the time step by "
                f"{STEP_OPTION}, or say that it is time [s] by {OPTION}, as 1,2"
            )
        return None

    def _one_time(self, names: Sequence[ColumnName], places: Sequence[int]) -> list[int]:
        """Return the one of several columns of time that gives seconds, or whose unit is that of no clock."""
        exact = [place for place in places if names[place].seconds == 1.0]
        values = self.table.values
        if len(exact) == 1 or (exact and all((values[:, at] == values[:, exact[0]]).all() for at in exact)):
            return exact[:1]  # several may be the same
        spans = {place: float(self.table.values[-1, place] - self.table.values[0, place]) for place in places}
        # times since an epoch and since the start are the same times: spans of a power of 1000
        begun = [
            place
            for place in places
            if not since_epoch(self.table.values[:, place], names[place].seconds or 1.0)
        ]
        if len(begun) == 1 and spans[begun[0]] > 0.0:
            parts = [spans[place] / spans[begun[0]] for place in places]
            if all(any(abs(part / ratio - 1.0) < _SAME_SPAN for ratio in _CLOCKS) for part in parts):
                return begun
        raise self.doubt("two columns are named after time")

    def by_option(self, options: ReadingOptions) -> Roles:
        """Return the roles as the user states them."""
        given = options.columns
        places = [self._place(text) for text in given]
        words = [plain(text).strip() for text in given]
        if None in places:
            if not all(word in (*_ROLES, "t", _SKIPPED) for word in words):
                missing = given[places.index(None)]
                raise ValueError(
                    f"{self.file.name} has no column {missing[:30]!r} of {OPTION}; it has "
                    f"{column_list(self.names or self.texts, self.width)}"
                )
            return self._in_order(["time" if word == "t" else word for word in words])
        known = [place for place in places if place is not None]
        if len(set(known)) < len(known):
            raise ValueError(f"{OPTION} names a column twice, got {','.join(given)}")
        if len(known) > 4:
            raise ValueError(f"{OPTION} names time, x, y and z, got {','.join(given)}")
        timeless = options.time_step is not None or stated_step(self.file, self.table.header) is not None
        has_time = self._may_be_time(known[0]) and len(known) > 1
        if not has_time and (not timeless or len(known) > 3):
            has_time = len(known) > 1
        time, of_values = (known[0], known[1:]) if has_time else (None, known)
        for place in of_values:
            name = self.names[place] if self.names else None
            if name and name.kind in ("time", "index", "velocity", "displacement", "other"):
                raise ValueError(
                    f"{self.file.name}: column {place + 1} {name.text[:30]!r} of {OPTION} is no acceleration"
                )
        if len(of_values) == 1:
            return Roles(time, [Value(of_values[0])])
        axes: tuple[Direction, ...] = ("x", "y", "z")
        return Roles(time, [Value(place, axis) for place, axis in zip(of_values, axes, strict=False)])

    def _may_be_time(self, place: int) -> bool:
        name = self.names[place].kind if self.names else "unknown"
        return name == "time" or (name in ("unknown", "index") and rises_evenly(self.table.values[:, place]))

    def _in_order(self, words: Sequence[str]) -> Roles:
        """Return the roles of a file whose columns are told in their order."""
        if len(words) != self.width or any(words.count(role) > 1 for role in _ROLES):
            raise ValueError(
                f"{self.file.name}: {OPTION} must name each of its {self.width} columns once, in their "
                f"order, as time, x, y, z or {_SKIPPED}, got {','.join(words)}"
            )
        time = words.index("time") if "time" in words else None
        axes: tuple[Direction, ...] = ("x", "y", "z")
        return Roles(time, [Value(words.index(axis), axis) for axis in axes if axis in words])

    def _place(self, text: str) -> int | None:
        """Return the column of a number or a name; None where there is none."""
        if re.fullmatch(r"\d{1,4}", text.strip()) and not any(
            name.text.strip() == text.strip() for name in self.names or ()
        ):
            place = int(text) - 1
            if not 0 <= place < self.width:
                raise ValueError(
                    f"{self.file.name} has no column {text} of {OPTION}; it has "
                    f"{column_list(self.names or self.texts, self.width)}"
                )
            return place
        for form in (
            lambda name: name.strip(),
            comparison_key,
            lambda name: comparison_key(without_unit(name)),
        ):
            matches = [at for at, name in enumerate(self.names or ()) if form(name.text) == form(text)]
            if len(matches) == 1:
                return matches[0]
        return None


def _runs_one_way(values: NDArray[np.float64]) -> bool:
    steps = np.diff(values)
    return bool((steps >= 0.0).all() or (steps <= 0.0).all())
