"""Columns of text or CSV: accelerations beside times, by the names of the columns or as the user says."""

from __future__ import annotations

from collections.abc import Sequence

from ..column_names import (
    ColumnName,
    names_of,
    names_that_hold,
    refuse_other_quantity,
    refuse_scale,
    unit_of_time,
)
from ..column_roles import Columns, Roles
from ..component import ALLOWED_UNITS, Component, ReadingOptions, RecordFile
from ..table import Table, table_of, with_clock, without_bars
from ..times import even_step, is_counting, rises_evenly, since_epoch, stated_seconds, stated_step
from ..units import stated_unit, unit_of

NAME = "columns"
_NO_TIME = (
    "unknown",
    "index",
    "other",
)  # first columns that are none of times: a frequency or period of a spectrum


def recognizes(file: RecordFile) -> bool:
    """Return whether a file is text: what no other format claims is taken for columns."""
    return file.lines is not None


def read(file: RecordFile, options: ReadingOptions) -> list[Component]:
    """Read the components that the columns are named after, or those that the user names.

    Raises
    ------
    ValueError
        If names leave a doubt, or there are none for several columns; if a line holds something else than
        numbers, or the times do not rise in even steps.
    """
    table = table_of(with_clock(without_bars(file)))
    width = table.values.shape[1]
    names, others = names_of(table.header, width)
    texts = names
    if names and not any(name.kind == "time" for name in names) and names[0].kind not in _NO_TIME:
        time = table.values[:, 0]
        if rises_evenly(time) and not is_counting(time):
            texts, names, others = names, None, list(table.header)  # a sentence that looks like names
    if options.columns:
        names = names_that_hold(table.header, width, options.columns) or names
    columns = Columns(file, table, names, texts)
    roles = columns.by_option(options) if options.columns else columns.by_names(options)
    step, start, notes = _clock(file, table, names, others, roles.time, options)
    refuse_scale(file, others)
    units = _units(file, names, others, roles)
    return [
        Component(
            path=file.path,
            values=each.sign * table.values[:, each.place],
            time_step=step,
            unit=unit,
            start=start,
            format=NAME,
            label=(names[each.place].label if names else "") or f"column {each.place + 1}",
            direction=each.direction,
            azimuth=each.azimuth,
            notes=(*notes, *table.notes, *(("its sense is turned",) if each.sign < 0.0 else ())),
        )
        for each, unit in zip(roles.values, units, strict=True)
    ]


def _clock(
    file: RecordFile,
    table: Table,
    names: Sequence[ColumnName] | None,
    others: Sequence[str],
    place: int | None,
    options: ReadingOptions,
) -> tuple[float, float | None, tuple[str, ...]]:
    """Return the time step [s], the time of the first sample [s], and where the step comes from."""
    stated = stated_step(file, others, len(table.values))
    given = options.time_step
    if place is None:
        step = options.settled_step(file.name, stated)
        return step, None, ("time step as given" if stated is None else "time step as its header states it",)
    time, name = table.values[:, place], names[place] if names else None
    if name is not None and name.seconds is None and unit_of_time(name.unit):
        raise ValueError(f"{file.name} gives times in {name.unit[:20]}, allowed are s, ms, us and ns")
    seconds = (name.seconds if name else None) or stated_seconds(file, others) or 1.0
    counts = is_counting(time) and (name is None or name.seconds is None)
    if given is not None and (since_epoch(time, seconds) or (counts and given != 1.0)):
        return given, None, ("time step as given",)
    step = even_step(file, time, table.lines, seconds)
    if given is not None:
        options.settled_step(file.name, step)
    return step, float(time[0]) * seconds, ()


def _units(
    file: RecordFile, names: Sequence[ColumnName] | None, others: Sequence[str], roles: Roles
) -> list[str | None]:
    """Return the unit of each column of accelerations: its own, else that of the header or of the others."""
    words = [names[each.place].unit if names else "" for each in roles.values]
    own = [unit_of(word) if word else None for word in words]
    for word, unit in zip(words, own, strict=True):
        if word and unit is None:
            raise ValueError(f"{file.name} is in {word[:20]}, allowed are {ALLOWED_UNITS}")
    accelerates = any(own) or any(names[each.place].kind == "acceleration" for each in roles.values if names)
    if not accelerates:
        refuse_other_quantity(file, others)
    # a column in a unit of acceleration settles what the words of the header are about
    stated = stated_unit(file.path, [*others, "acceleration"] if accelerates else list(others))
    if stated is not None and any(unit not in (None, stated) for unit in own):
        raise ValueError(f"{file.name} states two units: {next(word for word in words if word)} and {stated}")
    alike = next(iter(known)) if len(known := {unit for unit in own if unit}) == 1 else None
    return [unit or stated or alike for unit in own]
