"""Findings and diagnostics in English: the lines of `words.toml` with formatted values.

A line names values in braces. How a value looks follows its unit: an angle in degrees, a share in per cent,
a time in s, a number with its 95 % interval behind it, to the digits that
that leaves. `{runs:copy/copies}` adds the noun that fits the
count; `{size:added|dissipated}` is the first word above zero, the second below; `{reason:word}` looks its
value up in the table [word], `{names:diagnosed}` codes in [diagnostic]; `{peak:scattered}` has as many
digits as the value share_scatter leaves; any other format is one of `number`, as `{bound:.1e}`. What stands
in square brackets is left out where a value in it is not known. A line whose key ends in `:NAME unknown` or
`:NAME infinite` takes the place of the plain one where that value is.
"""

from __future__ import annotations

import math
import re
import tomllib
from collections.abc import Callable, Iterable, Mapping, Sequence
from functools import cache
from importlib.resources import files
from typing import TYPE_CHECKING

from .table import NONE, enumeration, interval_form, number, scattered

if TYPE_CHECKING:  # help, which needs these words, loads no models
    from rockwobble.models.finding import Finding, Value

_FIELD = re.compile(r"\{(\w+)(?::([^}]*))?\}")
_OPTIONAL = re.compile(r"\[([^\]]*)\]")
_UNKNOWN: Mapping[str, Value] = dict.fromkeys(("time", "duration", "size", "bound"), math.nan)
_SEPARATORS = (", ", "; ")
# unit: how a number looks
_BY_UNIT: Mapping[str, Callable[[float], str]] = {
    "s": lambda value: "the end" if math.isinf(value) else f"{number(value, '.4g')} s",
    "rad": lambda value: "no tilt below 90°" if math.isinf(value) else f"{number(math.degrees(value))}°",
    **{
        unit: lambda value, unit=unit: f"{number(value, '.4g')} {unit}"  # type: ignore[misc]
        for unit in ("rad/s", "t", "MPa")
    },
    "share": lambda value: number(value, "percent"),
    "count": lambda value: number(value, ".0f"),
    "alpha": lambda value: f"{number(value)} α",
    "weights": lambda value: f"{number(value)} weights",
    "m": lambda value: f"{number(value)} m",
    "1/a": lambda value: f"{number(value)} a year",
    "p": lambda value: (
        "p < 0.001" if value < 1e-3 else f"p = {number(value, '.3f' if value < 0.1 else '.2f')}"
    ),
    "a": lambda value: f"{number(float(format(value, '.2g')), ',.0f')} years",
}


@cache
def words() -> Mapping[str, Mapping[str, str | list[str]]]:
    """Tables of `words.toml` by the group of a key."""
    return tomllib.loads((files(__package__) / "words.toml").read_text(encoding="utf-8"))


def lines_of(key: str) -> tuple[str, str]:
    """Short form and sentence of a key; equal if only one is given.

    Raises
    ------
    KeyError
        If the file of words has no such key.
    """
    group, _, name = key.partition(".")
    line = words()[group][name]
    return (line, line) if isinstance(line, str) else (line[0], line[-1])


def sentence(finding: Finding, *, short: bool = False) -> str:
    """A finding in words, without capital and full stop."""
    units = {name: unit for name, _, unit in finding.quantities()}
    return written(finding.key, finding.values, units, short=short)


def statement(finding: Finding, *, short: bool = False) -> str:
    """A finding in words, with capital and full stop."""
    said = sentence(finding, short=short)
    return f"{said[0].upper()}{said[1:]}."


def joined(findings: Iterable[Finding]) -> str:
    """Findings in words, on one line."""
    return "; ".join(map(sentence, findings))


def text(findings: Iterable[Finding]) -> str:
    """Findings in words, one per line; a grade after its subject."""
    return "\n".join(f"{_level(each)}{sentence(each)}" for each in findings)


def _level(finding: Finding) -> str:
    return "" if finding.level == "note" else f"{finding.key.partition('.')[0]}: {finding.level}, "


def written(key: str, values: Mapping[str, Value], units: Mapping[str, str], *, short: bool = False) -> str:
    """The line of a key with values of the given units."""
    return filled(lines_of(_variant(key, values))[0 if short else 1], values, units)


def some_of(names: Sequence[str], more: int) -> str:
    """First names, and the number of the others."""
    return written("progress.names", {"names": tuple(names) or ("",), "count": more or None}, {})


def filled(line: str, values: Mapping[str, Value], units: Mapping[str, str]) -> str:
    """Line of words with its values filled in; see the module."""
    line = _OPTIONAL.sub(lambda part: part[1] if _all_known(part[1], values) else "", line)
    scatter = values.get("share_scatter")
    digits = scattered(scatter if isinstance(scatter, float) else math.nan)

    def value(each: re.Match[str]) -> str:
        form = digits if each[2] == "scattered" else each[2] or ""
        return _value(values.get(each[1]), units.get(each[1], ""), form)

    return _FIELD.sub(value, line)


def _variant(key: str, values: Mapping[str, Value]) -> str:
    group, _, line = key.partition(".")
    for name, value in values.items():
        state = "infinite" if value in (math.inf, -math.inf) else "unknown"
        variant = f"{line}:{name} {state}"
        if variant in words()[group] and (state == "infinite" or not _is_known(value)):
            return f"{group}.{variant}"
    return key


def _all_known(part: str, values: Mapping[str, Value]) -> bool:
    return all(_is_known(values.get(each[1])) for each in _FIELD.finditer(part))


def _is_known(value: Value) -> bool:
    return value not in (None, "", ()) and not (isinstance(value, float) and math.isnan(value))


def _value(value: Value, unit: str, form: str) -> str:
    if value is None or value == ():
        return NONE
    if form == "word":
        names = value if isinstance(value, tuple) else (value,)
        return enumeration([str(words()["word"].get(str(name), name)) for name in names])
    if form == "diagnosed":
        names = value if isinstance(value, tuple) else (value,)
        return "; ".join(written(f"diagnostic.{name}", _UNKNOWN, {}) for name in names)
    if isinstance(value, str):
        return value
    if isinstance(value, tuple):
        if isinstance(value[0], str):
            each = [str(one) for one in value]
            return form.join(each) if form in _SEPARATORS else enumeration(each)
        form = interval_form(form or ("" if unit else ".3g"), *value)
        middle, low, high = (_value(each, unit, form) for each in value)
        return middle if low == high == NONE else f"{middle} ({low} to {high})"
    if math.isnan(value):
        return NONE
    if "/" in form:
        one, many = form.split("/")
        return f"1 {one}" if value == 1 else f"{number(value, '.0f')} {many}"
    if "|" in form:
        above, below = form.split("|")
        return above if value > 0.0 else below
    if form == "mm":
        return f"{number(1e3 * value)} mm"
    if form.startswith("size "):
        return _value(abs(value), unit, form.removeprefix("size "))
    if form:
        return f"{number(math.degrees(value), form)}°" if unit == "rad" else number(value, form)
    return _BY_UNIT.get(unit, number)(value)
