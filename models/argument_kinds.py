"""Kinds of arguments: a public function refuses, by name and in one line, what its annotations do not allow.

    @with_argument_kinds
    def advise(case: Case, run: Run | None = None, ...) -> Advice

`advise(3.0)` is "case must be Case, got 3.0". pydantic compares a value with the annotation, which is read
when the function is first called. A name that is imported for type checkers alone allows everything, and a
literal every text: which words are allowed is said where they are used. An iterable that is no sequence is
read once, here.
"""

from __future__ import annotations

import builtins
import functools
import inspect
import sys
from collections.abc import Callable, Iterable, Mapping, Sequence
from pathlib import Path
from typing import Any, Literal, TypeVar, cast

C = TypeVar("C", bound=Callable[..., Any])


def with_argument_kinds(function: C) -> C:
    """Decorator of a function or a class: ValueError for an argument that its annotations exclude."""
    if isinstance(function, type):
        made: Any = function
        made.__init__ = with_argument_kinds(made.__init__)
        return function
    signature = inspect.signature(function)
    checks = functools.cache(
        lambda: {name: _check(each, function) for name, each in signature.parameters.items()}
    )

    @functools.wraps(function)
    def wrapper(*args: object, **kwargs: object) -> object:
        bound = signature.bind(*args, **kwargs)  # a TypeError of Python itself, which names the argument
        for name, value in bound.arguments.items():
            bound.arguments[name] = checks()[name](value)
        return function(*bound.args, **bound.kwargs)

    return cast("C", wrapper)


class _AnyKind:
    """Stand-in for a name that only type checkers know, which allows every argument."""

    def __class_getitem__(cls, item: object) -> Any:
        return Any


class _AnyText:
    def __class_getitem__(cls, item: object) -> Any:
        return str


class _Names(dict[str, Any]):
    """Namespace of a module and of Python for pydantic, in which a class stands for its instances."""

    def __missing__(self, name: str) -> Any:
        return getattr(builtins, name, _AnyKind)

    def __getitem__(self, name: str) -> Any:
        known = super().__getitem__(name)
        if known is Path:
            return str | Path
        if known in (Literal, Iterable):
            return _AnyText if known is Literal else Sequence
        if hasattr(known, "__array_function__"):
            return _AnyKind  # elements of an array are checked where it is read
        if known in (Any, object) or isinstance(known, TypeVar):
            return Any
        if isinstance(known, type) and known.__module__.startswith("rockwobble"):
            from pydantic import InstanceOf

            return InstanceOf[known]  # type: ignore[misc, valid-type]
        return known


def _check(parameter: inspect.Parameter, function: Callable[..., Any]) -> Callable[[object], object]:
    """Checker that returns an argument, an iterable as a tuple, or raises ValueError."""
    name, stated = parameter.name, parameter.annotation
    if parameter.kind in (parameter.VAR_POSITIONAL, parameter.VAR_KEYWORD) or not isinstance(stated, str):
        return lambda value: value
    from pydantic import TypeAdapter, ValidationError

    from .number_checks import quoted  # imports numpy, which the help of a command does not need

    kind = eval(stated, {}, _Names(inspect.unwrap(function).__globals__))
    if kind is _AnyKind:
        return lambda value: value
    adapter: TypeAdapter[object] = TypeAdapter(kind)

    def check(value: object) -> object:
        if "Iterable" in stated and isinstance(value, Iterable) and not isinstance(value, _READ_TWICE):
            value = tuple(value)
        too_large = isinstance(value, int) and abs(value) > sys.float_info.max  # but by mistake
        for each in () if too_large else (value, _plain(value)):
            try:
                adapter.validate_python(each, strict=True)
            except ValidationError:
                continue
            return value
        raise ValueError(f"{name} must be {stated}, got {quoted(value)}")

    return check


_READ_TWICE = (str, bytes, Sequence, Mapping)


def _plain(value: Any) -> object:
    """Lists and Python numbers in place of arrays, table columns and numpy scalars."""
    if hasattr(value, "dtype") and hasattr(value, "tolist"):
        return value.tolist()
    return [_plain(each) for each in value] if isinstance(value, list | tuple | range) else value
