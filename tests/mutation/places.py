"""Places in a source file by name: a function, an assignment in it, an argument.

What is changed is the tree of the parsed source, never its text: layout, comments and line numbers may
change, and a place that is gone is an error that lists what there is.
"""

from __future__ import annotations

import ast
from collections.abc import Callable, Iterator
from typing import TypeVar

Change = Callable[[ast.Module], None]
Named = TypeVar("Named")

ORIGINAL = "without_fault"


def function_in(tree: ast.AST, name: str) -> ast.FunctionDef:
    """Function of a dotted name, such as "make_driver.integrate"."""
    scope: ast.AST = tree
    for part in name.split("."):
        inside = {each.name: each for each in _below(scope)}
        scope = _of(inside, part, f"a function {name!r}")
    assert isinstance(scope, ast.FunctionDef)
    return scope


def assignment_in(function: ast.FunctionDef, target: str) -> tuple[list[ast.stmt], int]:
    """Block and index of the first assignment to `target`, written as in the source."""
    places: dict[str, tuple[list[ast.stmt], int]] = {}
    for block in _blocks(function):
        for index, statement in enumerate(block):
            if isinstance(statement, ast.Assign):
                for each in statement.targets:
                    parts = each.elts if isinstance(each, ast.Tuple) else [each]
                    for part in parts:
                        places.setdefault(ast.unparse(part), (block, index))
    return _of(places, target, f"an assignment to {target!r} in {function.name}")


def argument_in(function: ast.FunctionDef, call: str, keyword: str) -> ast.keyword:
    """Keyword argument in the first call of `call`."""
    calls = [node for node in ast.walk(function) if isinstance(node, ast.Call)]
    given = {each.arg: each for node in calls if ast.unparse(node.func) == call for each in node.keywords}
    named = {name: each for name, each in given.items() if name is not None}
    return _of(named, keyword, f"an argument {keyword!r} of {call} in {function.name}")


def at_assignment(function: str, target: str, statement: str, *, after: bool = False) -> Change:
    """Insert a statement before the first assignment to `target`, or after it."""

    def change(tree: ast.Module) -> None:
        block, index = assignment_in(function_in(tree, function), target)
        block[index + after : index + after] = ast.parse(statement).body

    return change


def scaled_argument(function: str, call: str, keyword: str, factor: float) -> Change:
    """Multiply an argument of a call."""

    def change(tree: ast.Module) -> None:
        argument = argument_in(function_in(tree, function), call, keyword)
        argument.value = ast.BinOp(ast.Constant(factor), ast.Mult(), argument.value)

    return change


def wrapped(function: str, text: str) -> Change:
    """Wrap a function by the definition `text`, which calls the original as `without_fault`."""

    def change(tree: ast.Module) -> None:
        original = function_in(tree, function)
        original.name = ORIGINAL
        place = tree.body.index(original) + 1
        tree.body[place:place] = ast.parse(text).body

    return change


def appended(text: str) -> Change:
    """Append statements to the module."""

    def change(tree: ast.Module) -> None:
        tree.body += ast.parse(text).body

    return change


def _of(named: dict[str, Named], name: str, wanted: str) -> Named:
    if name not in named:
        raise ValueError(f"the source must have {wanted}, got {', '.join(named) or 'none'}")
    return named[name]


def _below(node: ast.AST) -> Iterator[ast.FunctionDef | ast.ClassDef]:
    for child in ast.iter_child_nodes(node):
        if isinstance(child, ast.FunctionDef | ast.ClassDef):
            yield child
        else:
            yield from _below(child)


def _blocks(function: ast.FunctionDef) -> Iterator[list[ast.stmt]]:
    for node in ast.walk(function):
        for name in ("body", "orelse", "finalbody"):
            block = getattr(node, name, None)
            if isinstance(block, list):
                yield block
