"""The parts of a source file in which faults are sought, and the nodes of each that say something.

A scope is a function, a class with the values of its fields, or a named value of the module. Faults are
told apart by the name of their scope, so that a change in one leaves the names of the others alone.
Left out is what no run can show: annotations, decorators, docstrings, texts, messages of errors, and the
conditions under which bad input is refused.
"""

from __future__ import annotations

import ast
from collections.abc import Iterator
from dataclasses import dataclass, field

# arguments by which a run does not change, only what it refuses or how it is kept
_IRRELEVANT = frozenset(
    {"strict", "copy", "encoding", "maxsize", "dtype", "eq", "frozen", "slots", "kw_only"}
    | {"wait", "cancel_futures"}
)
# functions in a scope are scopes of their own; a message is made where something is refused
_SILENT = (ast.FunctionDef, ast.ClassDef, ast.Import, ast.ImportFrom, ast.Raise, ast.Assert, ast.JoinedStr)
_WORDS = frozenset({"__repr__", "__str__", "__reduce__", "__all__"})


@dataclass(frozen=True, slots=True, kw_only=True)
class Scope:
    """A part of a file.

    Parameters
    ----------
    name : str
        Dotted, such as "make_driver.integrate", or that of a value of the module.
    roots : tuple of ast.AST
        Statements and values to look at.
    function : ast.FunctionDef, optional
        None for the fields of a class and for a value of the module.
    """

    name: str
    roots: tuple[ast.AST, ...]
    function: ast.FunctionDef | None = None


@dataclass(frozen=True, slots=True)
class Spot:
    """A node with what surrounds it.

    Parameters
    ----------
    node : ast.AST
    parent : ast.AST, optional
        None at the root of a scope.
    role : str
        The field of the parent that holds the node.
    above : tuple of ast.AST
        All that hold it, from the root on.
    """

    node: ast.AST
    parent: ast.AST | None = None
    role: str = ""
    above: tuple[ast.AST, ...] = field(default=(), repr=False)


def scopes(tree: ast.Module) -> Iterator[Scope]:
    """Yield the scopes of a file in the order of the source."""
    yield from _scopes(tree.body, "", inside_function=False)


def spots(scope: Scope) -> Iterator[Spot]:
    """Yield the nodes of a scope that say something, in the order of the source."""
    for root in scope.roots:
        yield from _spots(Spot(root))


def _scopes(body: list[ast.stmt], prefix: str, *, inside_function: bool) -> Iterator[Scope]:
    for statement in body:
        if isinstance(statement, ast.FunctionDef):
            name = prefix + statement.name
            if statement.name in _WORDS or "require" in statement.name:
                continue
            defaults = [each for each in statement.args.defaults + statement.args.kw_defaults if each]
            yield Scope(name=name, roots=(*defaults, *statement.body), function=statement)
            yield from _scopes(statement.body, f"{name}.", inside_function=True)
        elif isinstance(statement, ast.ClassDef):
            name = prefix + statement.name
            values = [each.value for each in statement.body if isinstance(each, ast.Assign | ast.AnnAssign)]
            if any(values):
                yield Scope(name=name, roots=tuple(value for value in values if value is not None))
            yield from _scopes(statement.body, f"{name}.", inside_function=False)
        elif isinstance(statement, ast.Assign | ast.AnnAssign) and not prefix and statement.value is not None:
            target = statement.targets[0] if isinstance(statement, ast.Assign) else statement.target
            if ast.unparse(target) not in _WORDS:
                yield Scope(name=ast.unparse(target), roots=(statement.value,))
        elif inside_function:
            # a function may be defined under a condition
            for block in ("body", "orelse"):
                yield from _scopes(getattr(statement, block, []), prefix, inside_function=True)


def _spots(spot: Spot) -> Iterator[Spot]:
    node = spot.node
    if isinstance(node, _SILENT) or (isinstance(node, ast.keyword) and node.arg in _IRRELEVANT):
        return
    if isinstance(node, ast.Expr) and isinstance(node.value, ast.Constant):
        return
    yield spot
    for role, value in ast.iter_fields(node):
        if role == "annotation" or (role == "test" and _refuses(node)):
            continue
        for child in value if isinstance(value, list) else [value]:
            if isinstance(child, ast.AST):
                yield from _spots(Spot(child, node, role, (*spot.above, node)))


def _refuses(node: ast.AST) -> bool:
    return isinstance(node, ast.If) and all(isinstance(each, ast.Raise) for each in node.body)
