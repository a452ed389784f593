"""JSON with every float to the last bit, also NaN and infinities, which JSON lacks."""

from __future__ import annotations

import dataclasses
import json
import math
from collections.abc import Iterable, Mapping
from typing import TYPE_CHECKING, Any

import numpy as np

if TYPE_CHECKING:
    from _typeshed import DataclassInstance

#: JSON object whose members are known where it was stored.
JsonObject = dict[str, Any]
#: Facts of results or of a motion besides their tables, as read from JSON.
Facts = Mapping[str, Any]
_FLOAT = "float"
JsonValue = Any  # an object, a list, a text, a number, a bool or None


def dumps(value: object, *, indent: int | None = None) -> str:
    """Return strict JSON; nan and the infinities become ``{"float": "nan"}`` and the like.

    Dataclasses and mappings become objects, arrays and tuples lists, and what JSON does not know text.
    """
    return json.dumps(_in_words(plain(value)), indent=indent, allow_nan=False)


def loads(text: str | bytes) -> JsonValue:
    """Inverse of `dumps`, with mappings and lists in place of dataclasses and tuples."""
    return json.loads(text, object_hook=_float)


def fields_of(value: DataclassInstance) -> JsonObject:
    """Return the fields of a dataclass by name."""
    return {field.name: getattr(value, field.name) for field in dataclasses.fields(value)}


def plain(value: object) -> JsonValue:
    """Value as `loads` returns it: mappings, lists, texts, numbers and None only.

    Examples
    --------
    >>> import numpy as np
    >>> plain({"steps": (1, np.float64(0.5)), 3: math.inf})
    {'steps': [1, 0.5], '3': inf}
    """
    if isinstance(value, np.generic | np.ndarray):
        value = value.tolist()
    if value is None or isinstance(value, bool | int | float):
        return value
    if dataclasses.is_dataclass(value) and not isinstance(value, type):
        value = fields_of(value)
    if isinstance(value, Mapping):
        return {str(key): plain(item) for key, item in value.items()}
    if isinstance(value, list | tuple):
        return [plain(item) for item in value]
    return str(value)


def first_not_plain(value: object, place: str) -> str | None:
    """Place and type of the first value that `plain` changes; None if there is none.

    Examples
    --------
    >>> first_not_plain({"order": 2, "steps": [1, (2, 3)]}, "facts")
    'facts.steps.1, tuple'
    """
    items: Iterable[tuple[object, object]]
    if type(value) is dict and all(type(key) is str for key in value):
        items = value.items()
    elif type(value) is list:
        items = enumerate(value)
    else:
        same = value is None or type(value) in (bool, int, float, str)
        return None if same else f"{place}, {type(value).__name__}"
    return next((first for name, each in items if (first := first_not_plain(each, f"{place}.{name}"))), None)


def _in_words(value: JsonValue) -> JsonValue:
    """Plain value with a word for each float that JSON lacks."""
    if isinstance(value, dict):
        return {key: _in_words(item) for key, item in value.items()}
    if isinstance(value, list):
        return [_in_words(item) for item in value]
    return {_FLOAT: str(value)} if isinstance(value, float) and not math.isfinite(value) else value


def _float(members: dict[str, object]) -> object:
    word = members.get(_FLOAT)
    return float(word) if len(members) == 1 and isinstance(word, str) else members
