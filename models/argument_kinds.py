"""Kinds of arguments: a public function refuses, by name and in one line, what its annotations do not allow.

    @with_argument_kinds
    def advise(case: Case, run: Run | None = None, ...) -> Advice

`advise(3.0)` is "case must be a Case, got 3.0". The annotations are read when the function is first called. A
name that is imported for type checkers alone allows everything, and so does an array: what it must hold is
checked where it is read. An iterable that is no sequence is read once, here.
"""

from __future__ import annotations

import builtins
import functools
import inspect
import sys
import types
from collections.abc import Callable, Iterable, Mapping, Sequence
from numbers import Integral, Real
from pathlib import Path
from typing import Any, Literal, TypeVar, Union, cast, get_args, get_origin

C = TypeVar("C", bound=Callable[..., Any])
_TEXTS = (str, bytes)


def with_argument_kinds(function: C) -> C:
    """Return the function, or the class, that raises ValueError for an argument its annotations exclude."""
    if isinstance(function, type):
        made: Any = function
        made.__init__ = with_argument_kinds(made.__init__)
        return function
    signature = inspect.signature(function)

    @functools.cache
    def kinds() -> dict[str, object]:
        return {
            name: _kind(parameter.annotation, function)
            for name, parameter in signature.parameters.items()
            if parameter.kind not in (parameter.VAR_POSITIONAL, parameter.VAR_KEYWORD)
        }

    @functools.wraps(function)
    def wrapper(*args: object, **kwargs: object) -> object:
        bound = signature.bind(*args, **kwargs)  # a TypeError of Python itself, which names the argument
        for name, kind in kinds().items():
            if name in bound.arguments:
                bound.arguments[name] = require_argument(name, bound.arguments[name], kind)
        return function(*bound.args, **bound.kwargs)

    return cast("C", wrapper)


def require_argument(name: str, value: object, kind: object) -> object:
    """Return an argument, an iterable as a tuple, or raise ValueError unless it is of a kind.

    Parameters
    ----------
    name : str
    value : object
    kind : type or typing construct
        As in an annotation.
    """
    if not _is(value, kind) and isinstance(value, Iterable) and not isinstance(value, (*_TEXTS, Sequence)):
        iterables = [each for each in _members(kind) if get_origin(each) in (Iterable, tuple)]
        if iterables and not isinstance(value, Mapping):
            value = tuple(value)
    if not _is(value, kind):
        from .number_checks import quoted  # with numpy, which help can do without

        wrong = _wrong_member(value, kind)
        got = quoted(value) if wrong is None else f"{quoted(wrong[0])} in it"
        raise ValueError(f"{name} must be {in_words(kind)}, got {got}")
    return value


def in_words(kind: object) -> str:
    """Return a kind in words, as "a Case or None"."""
    members = _members(kind)
    members = tuple(one for each in members for one in _concrete(each))
    words = dict.fromkeys(_name(each) for each in members if each is not type(None))
    if "a path" in words:
        words.pop("a text", None)
    *first, last = [*words, *(["None"] if type(None) in members else [])]
    return f"{', '.join(first)} or {last}" if first else last


class _Unknown:
    """A name that only type checkers know."""

    def __class_getitem__(cls, item: object) -> Any:
        return Any


class _Names(dict[str, Any]):
    """Names of a module, those of Python, and anything for others."""

    def __init__(self, known: Mapping[str, Any]) -> None:
        super().__init__(known)

    def __missing__(self, name: str) -> Any:
        return getattr(builtins, name, _Unknown)


def _kind(annotation: Any, function: Callable[..., Any]) -> Any:
    if annotation is inspect.Parameter.empty:
        return Any
    if not isinstance(annotation, str):
        return annotation
    return eval(annotation, {}, _Names(inspect.unwrap(function).__globals__))


def _members(kind: Any) -> tuple[Any, ...]:
    """The kinds that a union allows; the kind itself where it is none."""
    if get_origin(kind) in (Union, types.UnionType):
        return tuple(each for one in get_args(kind) for each in _members(one))
    return (type(None),) if kind is None else (kind,)


def _concrete(kind: Any) -> tuple[Any, ...]:
    """What may be given for a kind: of an abstract class those that it stands for."""
    return tuple(kind.__subclasses__()) if inspect.isabstract(kind) else (kind,)


def _is(value: Any, kind: Any) -> bool:
    return any(_is_one(value, each) for each in _members(kind))


def _is_one(value: Any, kind: Any) -> bool:
    """Whether a value is of one kind that is no union."""
    origin, inner = get_origin(kind), get_args(kind)
    if kind in (Any, object, _Unknown) or isinstance(kind, TypeVar):
        return True
    if origin is Literal:
        # which words are allowed is said where they are used
        return any(isinstance(value, type(each)) for each in inner)
    if kind in (float, int, bool):
        # of numpy's scalars and arrays without a dimension their letter
        letter = value.dtype.kind if hasattr(value, "dtype") and getattr(value, "ndim", 1) == 0 else ""
        if kind is bool:
            return isinstance(value, bool) or letter == "b"
        letters, number = ("iuf", Real) if kind is float else ("iu", Integral)
        if isinstance(value, int) and not isinstance(value, bool):
            return abs(value) <= sys.float_info.max  # none is so large but by mistake
        return (isinstance(value, number) and not isinstance(value, bool)) or letter in (*letters,)
    if origin in (Sequence, Iterable, tuple, list):
        # an array, or a column of a table, is a sequence of its rows
        array = hasattr(value, "dtype") and getattr(value, "ndim", 0) > 0
        if isinstance(value, _TEXTS) or not (isinstance(value, Sequence) or array):
            return False
        return all(_is(each, inner[0]) for each in value) if inner else True
    if origin in (Mapping, dict):
        return isinstance(value, Mapping) and all(
            _is(key, inner[0]) and _is(each, inner[1]) for key, each in value.items()
        )
    if isinstance(origin, type) and hasattr(origin, "__array_function__"):
        return True  # what an array may be made of is checked where it is read
    if origin is not None:
        return callable(value) if origin is Callable else isinstance(value, origin)
    if kind is Path:
        return isinstance(value, (str, Path))
    if isinstance(kind, type):
        return isinstance(value, kind)
    return callable(value) if kind is Callable else True


def _wrong_member(value: Any, kind: Any) -> tuple[Any] | None:
    """The first member of a sequence that is not of the kind of its members, where a sequence is allowed."""
    if isinstance(value, _TEXTS) or not isinstance(value, Sequence):
        return None
    for each in _members(kind):
        if get_origin(each) in (Sequence, Iterable) and get_args(each):
            return next(((one,) for one in value if not _is(one, get_args(each)[0])), None)
    return None


def _name(kind: Any) -> str:
    origin, inner = get_origin(kind), get_args(kind)
    simple = {float: "a number", int: "a whole number", bool: "True or False", str: "a text", Path: "a path"}
    if kind in simple:
        return simple[kind]
    if origin is Literal:
        return " or ".join(repr(each) for each in inner)
    if origin in (Sequence, Iterable, tuple, list):
        return f"a sequence of {_plural(inner[0])}"
    if origin in (Mapping, dict):
        return f"a mapping of {_plural(inner[0])} to {_plural(inner[1])}"
    if kind is Callable or origin is Callable:
        return "a function"
    name = getattr(kind, "__name__", str(kind))
    return f"{'an' if name[0] in 'AEIOU' else 'a'} {name}"


def _plural(kind: Any) -> str:
    plurals = {float: "numbers", int: "whole numbers", str: "texts", Path: "paths"}
    words = dict.fromkeys(
        plurals.get(each) or (_name(each) if get_origin(each) else getattr(each, "__name__", str(each)))
        for member in _members(kind)
        for each in _concrete(member)
        if each is not type(None)
    )
    return " or ".join(words)
