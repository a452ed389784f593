"""Faults in one expression: operators, numbers, comparisons, conditions, terms of sums.

Each function yields the faults of one family at one spot: the kind of the fault, the node that is replaced,
and the text that takes its place.
"""

from __future__ import annotations

import ast
import copy
from collections.abc import Iterator
from typing import Any

from .scopes import Spot

Found = Iterator[tuple[str, ast.AST, str]]

_ARITHMETIC: dict[type[ast.operator], ast.operator] = {
    ast.Add: ast.Sub(),
    ast.Sub: ast.Add(),
    ast.Mult: ast.Div(),
    ast.Div: ast.Mult(),
    ast.FloorDiv: ast.Div(),
    ast.Mod: ast.FloorDiv(),
    ast.Pow: ast.Mult(),
}
_MASKS: dict[type[ast.operator], ast.operator] = {ast.BitAnd: ast.BitOr(), ast.BitOr: ast.BitAnd()}
_DIRECTIONS: dict[type[ast.cmpop], ast.cmpop] = {
    ast.Lt: ast.Gt(),
    ast.LtE: ast.GtE(),
    ast.Gt: ast.Lt(),
    ast.GtE: ast.LtE(),
    ast.Eq: ast.NotEq(),
    ast.NotEq: ast.Eq(),
    ast.Is: ast.IsNot(),
    ast.IsNot: ast.Is(),
    ast.In: ast.NotIn(),
    ast.NotIn: ast.In(),
}
_STRICTNESS: dict[type[ast.cmpop], ast.cmpop] = {
    ast.Lt: ast.LtE(),
    ast.LtE: ast.Lt(),
    ast.Gt: ast.GtE(),
    ast.GtE: ast.Gt(),
}
_PAIRS = {
    "extreme": (
        ("min", "max"),
        ("minimum", "maximum"),
        ("argmin", "argmax"),
        ("nanmin", "nanmax"),
        ("floor", "ceil"),
    ),
    "trigonometry": (("sin", "cos"), ("arcsin", "arccos"), ("asin", "acos"), ("sinh", "cosh")),
}
_OTHER = {
    name: (kind, other)
    for kind, pairs in _PAIRS.items()
    for pair in pairs
    for name, other in (pair, pair[::-1])
}


def arithmetic(spot: Spot) -> Found:
    """Yield another operator, a sign lost, and each term of a sum lost."""
    node = spot.node
    if isinstance(node, ast.BinOp) and type(node.op) in _ARITHMETIC and not is_text(node):
        yield "operator", node, _with(node, op=_ARITHMETIC[type(node.op)])
        if isinstance(node.op, ast.Add | ast.Sub):
            alone = node.right if isinstance(node.op, ast.Add) else ast.UnaryOp(ast.USub(), node.right)
            yield "term-left", node, ast.unparse(alone)
            yield "term-right", node, ast.unparse(node.left)
    elif isinstance(node, ast.AugAssign) and type(node.op) in _ARITHMETIC and not is_text(node.value):
        yield "operator", node, _with(node, op=_ARITHMETIC[type(node.op)])
    elif isinstance(node, ast.UnaryOp) and isinstance(node.op, ast.USub):
        yield "sign", node, ast.unparse(node.operand)


def number(spot: Spot) -> Found:
    """Yield a number 1 % off, one more, of the other sign, and zero; indices have faults of their own."""
    node = spot.node
    value = node.value if isinstance(node, ast.Constant) else None
    if not isinstance(value, int | float) or isinstance(value, bool) or in_index(spot):
        return
    yield "number-plus", node, repr(value + 1)
    if value == 0:
        return
    yield "number-zero", node, repr(type(value)(0))
    if isinstance(value, float):
        yield "number-scaled", node, repr(float(f"{1.01 * value:.12g}"))
    if not (isinstance(spot.parent, ast.UnaryOp) and isinstance(spot.parent.op, ast.USub)):
        yield "number-sign", node, repr(-value)


def comparison(spot: Spot) -> Found:
    """Yield each comparison the other way round, and with equality on the other side."""
    node = spot.node
    if not isinstance(node, ast.Compare):
        return
    for kind, others in (("direction", _DIRECTIONS), ("strictness", _STRICTNESS)):
        for place, operator in enumerate(node.ops):
            if type(operator) in others:
                ops = [*node.ops[:place], others[type(operator)], *node.ops[place + 1 :]]
                yield kind, node, _with(node, ops=ops)


def condition(spot: Spot) -> Found:
    """Yield and for or, masks alike, a lost or additional not, and the other truth value."""
    node = spot.node
    if isinstance(node, ast.BoolOp):
        yield "and-or", node, _with(node, op=ast.Or() if isinstance(node.op, ast.And) else ast.And())
    elif isinstance(node, ast.BinOp) and type(node.op) in _MASKS and not _is_type(node):
        yield "and-or", node, _with(node, op=_MASKS[type(node.op)])
    elif isinstance(node, ast.UnaryOp) and isinstance(node.op, ast.Not | ast.Invert):
        yield "not", node, ast.unparse(node.operand)
    elif isinstance(node, ast.Constant) and isinstance(node.value, bool):
        yield "true-false", node, repr(not node.value)
    # the other way round a comparison is turned already
    if spot.role in ("test", "ifs") and isinstance(node, ast.Name | ast.Attribute | ast.Call | ast.BoolOp):
        yield "not", node, ast.unparse(ast.UnaryOp(ast.Not(), node))


def counterpart(spot: Spot) -> Found:
    """Yield sine for cosine, the largest for the smallest, and the other way round."""
    node = spot.node
    if not (isinstance(node, ast.Call) and isinstance(node.func, ast.Name | ast.Attribute)):
        return
    name = node.func.id if isinstance(node.func, ast.Name) else node.func.attr
    if name in _OTHER:
        kind, other = _OTHER[name]
        yield (
            kind,
            node.func,
            _with(node.func, **{"id" if isinstance(node.func, ast.Name) else "attr": other}),
        )


FAMILIES = (arithmetic, number, comparison, condition, counterpart)


def in_index(spot: Spot) -> bool:
    """Return whether a spot is an index itself, or a term of one: in [ ], but in no call there."""
    chain = (*spot.above, spot.node)
    for holder, held in zip(reversed(spot.above), reversed(chain), strict=False):
        if isinstance(holder, ast.Subscript):
            return held is holder.slice
        if not isinstance(holder, ast.Tuple | ast.Slice | ast.BinOp | ast.UnaryOp):
            return False
    return False


def is_text(node: ast.AST) -> bool:
    """Return whether a sum puts texts or tuples together."""
    if isinstance(node, ast.BinOp):
        return is_text(node.left) or is_text(node.right)
    texts = ast.JoinedStr | ast.Tuple | ast.List | ast.ListComp
    return isinstance(node, texts) or (isinstance(node, ast.Constant) and isinstance(node.value, str))


def _is_type(node: ast.BinOp) -> bool:
    """Return whether | stands between classes, as in isinstance."""
    name = node.right.attr if isinstance(node.right, ast.Attribute) else ast.unparse(node.right)
    return name[:1].isupper() or name in ("int", "float", "str", "dict", "list", "tuple", "bool")


def _with(node: ast.AST, **changed: Any) -> str:
    other = copy.copy(node)
    for name, value in changed.items():
        setattr(other, name, value)
    return ast.unparse(other)
