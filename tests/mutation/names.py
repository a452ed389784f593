"""Faults of names and places: an index beside, a neighbouring name, arguments exchanged, a statement lost.

Each function yields the faults of one family at one spot, as in `expressions`. A neighbouring name is one
that stands in the same statement, or for an attribute in the same function, so that it is of the same sort.
"""

from __future__ import annotations

import ast
from collections.abc import Callable, Iterable, Iterator, Mapping
from dataclasses import dataclass
from itertools import pairwise

from .expressions import Found, in_index
from .scopes import Scope, Spot, spots

# functions of libraries that take two values of one sort: places of these
_LIBRARY = {"atan2": (0, 1), "arctan2": (0, 1), "copysign": (0, 1), "remainder": (0, 1), "interp": (1, 2)}
_LIBRARY |= {"clip": (1, 2), "where": (1, 2), "cross": (0, 1)}
_MODULES = frozenset({"np", "math", "pd", "os", "mujoco", "pybullet"})
Signatures = Mapping[str, tuple[tuple[str, str], ...]]
Block = tuple[int, str]  # identity of what holds it, and where there


@dataclass(frozen=True, slots=True, kw_only=True)
class Around:
    """What the faults of a function need to know of it.

    Parameters
    ----------
    signatures : mapping
        By the name of a function or class: (name, annotation) of each parameter or field.
    parameters : frozenset of str
    blocks : mapping
        By the identity of a statement: the block that it stands in.
    values : mapping
        By name: (line, block) of each statement that gives it a value.
    attributes : mapping
        By the name of an object: its attributes that are read, in the order of the source.
    keys : tuple of str
        Texts that stand as an index, in the order of the source.
    """

    signatures: Signatures
    parameters: frozenset[str]
    blocks: Mapping[int, Block]
    values: Mapping[str, list[tuple[int, Block]]]
    attributes: Mapping[str, tuple[str, ...]]
    keys: tuple[str, ...]


def around(scope: Scope, signatures: Signatures) -> Around:
    """Return what the faults of a scope need to know of it."""
    found = list(spots(scope))
    called = {id(spot.node.func) for spot in found if isinstance(spot.node, ast.Call)}
    blocks: dict[int, Block] = {}
    values: dict[str, list[tuple[int, Block]]] = {}
    attributes: dict[str, dict[str, None]] = {}
    keys: dict[str, None] = {}
    for spot in found:
        node = spot.node
        if isinstance(node, ast.stmt):
            blocks[id(node)] = (id(spot.parent), spot.role)
        if isinstance(node, ast.Name) and isinstance(node.ctx, ast.Store):
            block = blocks.get(id(_statement(spot)), (0, ""))
            values.setdefault(node.id, []).append((node.lineno, block))
        if (read := _read(node)) is not None and id(node) not in called:
            attributes.setdefault(read[0], {})[read[1]] = None
        if isinstance(node, ast.Subscript) and (key := _text(node.slice)) is not None:
            keys[key] = None
    return Around(
        signatures=signatures,
        parameters=_parameters(scope),
        blocks=blocks,
        values=values,
        attributes={name: tuple(each) for name, each in attributes.items()},
        keys=tuple(keys),
    )


def index(spot: Spot, known: Around) -> Found:
    """Yield an index one more and one less, and another name or key in its place."""
    node = spot.node
    if isinstance(spot.parent, ast.Subscript) and (key := _text(node)) is not None:
        if (other := _next(known.keys, key)) is not None:
            yield "key", node, repr(other)
        return
    if not in_index(spot) or isinstance(spot.parent, ast.BinOp | ast.UnaryOp):
        return
    if isinstance(node, ast.Name | ast.BinOp | ast.UnaryOp) or (
        isinstance(node, ast.Constant) and type(node.value) is int
    ):
        text = ast.unparse(node)
        number = ast.literal_eval(text) if not isinstance(node, ast.Name) and _is_literal(node) else None
        yield "index-plus", node, f"{text} + 1" if number is None else repr(number + 1)
        yield "index-minus", node, f"{text} - 1" if number is None else repr(number - 1)


def neighbour(spot: Spot, known: Around) -> Found:
    """Yield another attribute of the same object, and another name of the same statement."""
    node = spot.node
    if (read := _read(node)) is not None:
        other = _next(known.attributes.get(read[0], ()), read[1])
        if other is not None and spot.role != "func":
            yield "attribute", node, f"{read[0]}.{other}"
    elif isinstance(node, ast.Name) and isinstance(node.ctx, ast.Load) and isinstance(spot.parent, ast.BinOp):
        statement = _statement(spot)
        other = None if statement is None else _next(_operands(statement), node.id)
        if other is not None:
            yield "name", node, other


def exchanged(spot: Spot, known: Around) -> Found:
    """Yield two arguments of one type exchanged, and two results taken for each other."""
    node = spot.node
    if isinstance(node, ast.Call):
        for first, second in _alike(node, known.signatures):
            arguments = [*node.args, *(each.value for each in node.keywords)]
            one, two = ast.unparse(arguments[first]), ast.unparse(arguments[second])
            if one != two:
                yield (
                    "arguments",
                    node,
                    _call_with(node, {first: arguments[second], second: arguments[first]}),
                )
    elif isinstance(node, ast.Tuple) and isinstance(node.ctx, ast.Store):
        names = [ast.unparse(each) for each in node.elts]
        for place in range(len(names) - 1):
            if "_" not in names[place : place + 2]:
                other = [*names[:place], names[place + 1], names[place], *names[place + 2 :]]
                yield "results", node, ", ".join(other)


def lost(spot: Spot, known: Around) -> Found:
    """Yield a second assignment that is not made, and a call for its effect alone that is not made."""
    node = spot.node
    if isinstance(node, ast.AugAssign):
        yield "assignment", node, "pass"
    elif isinstance(node, ast.Assign):
        parts = [part for target in node.targets for part in _parts(target)]
        if all(not isinstance(part, ast.Name) or _has_value(part, spot, known) for part in parts):
            yield "assignment", node, "pass"
    elif isinstance(node, ast.Expr) and isinstance(node.value, ast.Call):
        yield "call", node, "pass"


Family = Callable[[Spot, Around], Found]
FAMILIES: tuple[Family, ...] = (index, neighbour, exchanged, lost)


def signatures_of(trees: Iterable[ast.Module]) -> dict[str, tuple[tuple[str, str], ...]]:
    """Return (name, annotation) of the parameters of each function and the fields of each class.

    Of two that have one name and other parameters neither is known.
    """
    found: dict[str, set[tuple[tuple[str, str], ...]]] = {}
    for tree in trees:
        for node in ast.walk(tree):
            if isinstance(node, ast.FunctionDef):
                given = [*node.args.posonlyargs, *node.args.args, *node.args.kwonlyargs]
                given = given[1:] if given and given[0].arg in ("self", "cls") else given
                found.setdefault(node.name, set()).add(
                    tuple((each.arg, _unparsed(each.annotation)) for each in given)
                )
            elif isinstance(node, ast.ClassDef):
                fields = [each for each in node.body if isinstance(each, ast.AnnAssign)]
                of_class = tuple((ast.unparse(each.target), _unparsed(each.annotation)) for each in fields)
                found.setdefault(node.name, set()).add(of_class)
    return {name: next(iter(each)) for name, each in found.items() if len(each) == 1}


def _alike(node: ast.Call, signatures: Signatures) -> Iterator[tuple[int, int]]:
    """Yield the places of neighbouring arguments that are of one type."""
    name = node.func.attr if isinstance(node.func, ast.Attribute) else ast.unparse(node.func)
    if any(isinstance(each, ast.Starred) for each in node.args):
        return
    if name in _LIBRARY and name not in signatures:
        if max(_LIBRARY[name]) < len(node.args):
            yield _LIBRARY[name]
        return
    parameters = signatures.get(name, ())
    types = [kind for _, kind in parameters[: len(node.args)]]
    types += ["" for _ in node.args[len(types) :]]
    types += [dict(parameters).get(each.arg or "", "") for each in node.keywords]
    for place, (one, two) in enumerate(pairwise(types)):
        if one == two != "":
            yield place, place + 1


def _call_with(node: ast.Call, changed: Mapping[int, ast.expr]) -> str:
    count = len(node.args)
    args = [changed.get(place, each) for place, each in enumerate(node.args)]
    keywords = [
        ast.keyword(each.arg, changed.get(count + place, each.value))
        for place, each in enumerate(node.keywords)
    ]
    return ast.unparse(ast.Call(node.func, args, keywords))


def _operands(statement: ast.stmt) -> tuple[str, ...]:
    nodes = (node for node in ast.walk(statement) if isinstance(node, ast.BinOp))
    sides = sorted(
        (side for node in nodes for side in (node.left, node.right) if isinstance(side, ast.Name)),
        key=lambda side: (side.lineno, side.col_offset),
    )
    return tuple(dict.fromkeys(side.id for side in sides))


def _next(names: tuple[str, ...], name: str) -> str | None:
    """Return the name after this one, the first after the last; None where there is no other."""
    if name not in names or len(names) < 2:
        return None
    return names[(names.index(name) + 1) % len(names)]


def _has_value(name: ast.Name, spot: Spot, known: Around) -> bool:
    """Return whether a name has a value before the statement at `spot`, whatever branches were taken."""
    around_it = {known.blocks[id(each)] for each in (*spot.above, spot.node) if isinstance(each, ast.stmt)}
    before = (block for line, block in known.values[name.id] if line < name.lineno)
    return name.id in known.parameters or any(block in around_it for block in before)


def _parameters(scope: Scope) -> frozenset[str]:
    if scope.function is None:
        return frozenset()
    given = scope.function.args
    return frozenset(each.arg for each in [*given.posonlyargs, *given.args, *given.kwonlyargs])


def _statement(spot: Spot) -> ast.stmt | None:
    """Return the innermost statement that holds a spot; none above the value of a field or of the module."""
    return next((each for each in reversed(spot.above) if isinstance(each, ast.stmt)), None)


def _read(node: ast.AST) -> tuple[str, str] | None:
    """Return the names of an object and of its attribute that is read; None for anything else."""
    if not (isinstance(node, ast.Attribute) and isinstance(node.ctx, ast.Load)):
        return None
    value = node.value
    return (value.id, node.attr) if isinstance(value, ast.Name) and value.id not in _MODULES else None


def _is_literal(node: ast.AST) -> bool:
    return all(isinstance(each, ast.Constant | ast.UnaryOp | ast.USub) for each in ast.walk(node))


def _text(node: ast.AST) -> str | None:
    return node.value if isinstance(node, ast.Constant) and isinstance(node.value, str) else None


def _parts(target: ast.expr) -> Iterator[ast.expr]:
    yield from target.elts if isinstance(target, ast.Tuple) else [target]


def _unparsed(node: ast.expr | None) -> str:
    return "" if node is None else ast.unparse(node)
