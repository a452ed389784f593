"""Errors in a suite file, in one line: the path of the key, what was given, what is allowed."""

from __future__ import annotations

import difflib
from collections.abc import Iterable, Iterator, Mapping, Sequence
from contextlib import contextmanager
from types import MappingProxyType

from pydantic import BaseModel, ValidationError
from pydantic_core import ErrorDetails

# messages of pydantic, in the words of the other messages
_WORDS: Mapping[str, str] = MappingProxyType(
    {
        "missing": "must be given",
        "string_type": "must be text, got {given}",
        "bool_type": "must be true or false, got {given}",
        "list_type": "must be a list, got {given}",
        "tuple_type": "must be a list, got {given}",
        "dict_type": "must be a table of keys and values, got {given}",
        "model_type": "must be a table of keys and values, got {given}",
    }
)


class KeyedError(ValueError):
    """Something wrong at a key below the one that was being read.

    Parameters
    ----------
    key : str
        Relative to the table or value being read, such as "tilt" or "[2]".
    message : str
    """

    def __init__(self, key: str, message: str) -> None:
        super().__init__(message)
        self.key = key


@contextmanager
def path_prefix(path: str) -> Iterator[None]:
    """Put the path of a key before the message of any ValueError of the block."""
    try:
        yield
    except KeyedError as error:
        raise ValueError(f"{join(path, error.key)}: {error}") from None
    except ValueError as error:
        raise ValueError(f"{path}: {error}") from None


def join(path: str, key: str) -> str:
    """Return the path of a key below another."""
    return f"{path}{'' if key.startswith('[') or not path else '.'}{key}"


def nearest(key: str, allowed: Iterable[str]) -> str:
    """Words on a key that is not allowed: the nearest one, or all."""
    names = list(allowed)
    close = difflib.get_close_matches(key, names, n=1, cutoff=0.65)
    if key in ("slab_mass_ratio", "columns") and "cylinder" in names:
        return "is not known here, it belongs into cylinder = { ... }"
    hint = f"did you mean {close[0]}?" if close else f"allowed are {', '.join(names)}"
    return f"is not known here, {hint}"


def first_line(error: ValidationError, tables: Mapping[str, type[BaseModel]]) -> str:
    """Return the first error in one line, and how many more there are.

    Parameters
    ----------
    error : ValidationError
    tables : mapping
        Model of each table by its key, "" for the whole file.
    """
    errors = error.errors(include_url=False)
    more = len(errors) - 1
    also = f" (and {more} more error{'s' if more > 1 else ''})" if more else ""
    return f"{_line(errors[0], tables)}{also}"


def _line(error: ErrorDetails, tables: Mapping[str, type[BaseModel]]) -> str:
    place: Sequence[str | int] = error["loc"]
    path = ""
    for part in place:
        path = join(path, f"[{part}]" if isinstance(part, int) else part)
    if error["type"] == "extra_forbidden":
        table = next((part for part in reversed(place[:-1]) if isinstance(part, str)), "")
        fields = (field.alias or name for name, field in tables[table].model_fields.items())
        return f"{path}: {nearest(str(place[-1]), fields)}"
    cause = error.get("ctx", {}).get("error")
    if isinstance(cause, KeyedError):
        return f"{join(path, cause.key)}: {cause}"
    if isinstance(cause, ValueError):
        return f"{path}: {cause}"
    words = _WORDS.get(error["type"])
    return f"{path}: {words.format(given=brief(error['input'])) if words else error['msg']}"


def brief(value: object) -> str:
    """Return a value for a message, short."""
    text = repr(value)
    return text if len(text) <= 60 else f"{text[:57]}..."
