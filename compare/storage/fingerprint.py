"""Fingerprint of inputs, as one short name: the same inputs give the same name, in any process."""

from __future__ import annotations

import dataclasses
import hashlib
from collections.abc import Mapping
from typing import Protocol

import numpy as np

# 128 bits: two different inputs of 10^9 results share a name with a probability of 10^-21
_DIGITS = 32


class _Hash(Protocol):
    def update(self, data: bytes, /) -> None: ...


def fingerprint(value: object) -> str:
    """Return the hash of a value: numbers by their bits, containers and dataclasses by what they hold.

    Parameters
    ----------
    value : object
        None, numbers, text, arrays, sequences, mappings with text as keys, and dataclasses of these.

    Returns
    -------
    str
        32 hexadecimal digits.

    Raises
    ------
    ValueError
        If the value holds something else.

    Examples
    --------
    >>> fingerprint({"a": 1.0, "b": [2]}) == fingerprint({"b": [2], "a": 1.0})
    True
    >>> fingerprint(0.1 + 0.2) == fingerprint(0.3)
    False
    """
    digest = hashlib.sha256()
    _feed(digest, value)
    return digest.hexdigest()[:_DIGITS]


def _feed(digest: _Hash, value: object) -> None:
    """Feed a value with its kind and length in front, so that no two values feed the same bytes."""
    if isinstance(value, np.generic):
        value = value.item()
    if value is None or isinstance(value, bool | int | str):
        _tagged(digest, type(value).__name__, str(value).encode())
    elif isinstance(value, float):
        _tagged(digest, "float", value.hex().encode())
    elif isinstance(value, np.ndarray):
        _tagged(digest, f"array {value.dtype.str} {value.shape}", np.ascontiguousarray(value).tobytes())
    elif isinstance(value, Mapping):
        _tagged(digest, "mapping", str(len(value)).encode())
        for key in sorted(value):
            _feed(digest, key)
            _feed(digest, value[key])
    elif isinstance(value, list | tuple):
        _tagged(digest, "sequence", str(len(value)).encode())
        for item in value:
            _feed(digest, item)
    elif dataclasses.is_dataclass(value) and not isinstance(value, type):
        _tagged(digest, "dataclass", type(value).__name__.encode())
        _feed(digest, {field.name: getattr(value, field.name) for field in dataclasses.fields(value)})
    else:
        raise ValueError(
            f"a result cannot be named by an input of type {type(value).__name__}, got {value!r}"
        )


def _tagged(digest: _Hash, kind: str, content: bytes) -> None:
    digest.update(f"{kind} {len(content)}:".encode() + content)
