"""JSON that keeps every float to the last bit, and those that JSON has no word for."""

from __future__ import annotations

import dataclasses
import json
import math
from collections.abc import Mapping
from typing import TYPE_CHECKING, Any

import numpy as np

if TYPE_CHECKING:
    from _typeshed import DataclassInstance

JsonObject = dict[str, Any]
"""An object of JSON: who stored it knows what its members are."""
Facts = Mapping[str, Any]
"""What results or a motion say beside their tables, as JSON gives it back."""
_FLOAT = "float"
JsonValue = Any  # an object, a list, a text, a number, a truth or None


def dumps(value: object, *, indent: int | None = None) -> str:
    """Return strict JSON; nan and the infinities become ``{"float": "nan"}`` and the like.

    Dataclasses and mappings become objects, arrays and tuples lists, and what JSON does not know text.
    """
    return json.dumps(_plain(value), indent=indent, allow_nan=False)


def loads(text: str | bytes) -> JsonValue:
    """Return what `dumps` was given, but for mappings and lists in place of dataclasses and tuples."""
    return json.loads(text, object_hook=_float)


def fields_of(value: DataclassInstance) -> JsonObject:
    """Return the fields of a dataclass by name."""
    return {field.name: getattr(value, field.name) for field in dataclasses.fields(value)}


def _plain(value: object) -> object:
    if isinstance(value, np.generic | np.ndarray):
        value = value.tolist()
    if isinstance(value, float) and not math.isfinite(value):
        return {_FLOAT: str(value)}
    if value is None or isinstance(value, bool | int | float | str):
        return value
    if dataclasses.is_dataclass(value) and not isinstance(value, type):
        value = fields_of(value)
    if isinstance(value, Mapping):
        return {str(key): _plain(item) for key, item in value.items()}
    if isinstance(value, list | tuple):
        return [_plain(item) for item in value]
    return str(value)


def _float(found: dict[str, object]) -> object:
    word = found.get(_FLOAT)
    return float(word) if len(found) == 1 and isinstance(word, str) else found
