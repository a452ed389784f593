"""Faults in every term of the equations of the recess model, generated from the source.

`reduced/integration/taylor.py` builds (18) and (19) from sums with names of their own. Each term of each
of these sums, at the start of a step and in its series, is one place for a fault: a factor of 1.01, or -1. A
rewritten kernel keeps its faults, as long as it keeps these names.
"""

from __future__ import annotations

import ast
from collections.abc import Iterator, Mapping
from dataclasses import dataclass

from .mutant import Fault, source_folder
from .places import Change

FILE = "integration/taylor.py"
# name of a sum, and the equations that a wrong term shows in; B of (19) is the one whose B' stands in (18)
SUMS: Mapping[str, tuple[str, ...]] = {
    "Q0": ("(18)",),  # B'/2A
    "Q_k": ("(18)",),
    "X0": ("(18)",),  # cos(alpha - theta), of a_r
    "X_k": ("(18)",),
    "Y0": ("(18)",),  # sin(alpha - theta), of g + az
    "Y_k": ("(18)",),
    "r0": ("(18)",),  # a_r
    "r_k": ("(18)",),
    "per_B": ("(18)", "(19)"),  # B of L = B phi'
    "B_k": ("(18)", "(19)"),
    "D0": ("(19)",),  # of a_t
    "D_k": ("(19)",),
    "t0": ("(19)",),  # a_t
    "t_k": ("(19)",),
}


@dataclass(frozen=True, slots=True, kw_only=True)
class TermFault:
    """One wrong term."""

    name: str  # the sum, and the term as the source has it
    equations: tuple[str, ...]  # "(18)", "(19)" or both
    fault: Fault


def term_faults(factor: float) -> Iterator[TermFault]:
    """Yield a fault for each term of each sum, multiplied by `factor`.

    Raises
    ------
    ValueError
        If the source lacks one of the sums.
    """
    tree = ast.parse((source_folder() / FILE).read_text(encoding="utf-8"))
    missing = set(SUMS)
    for index, statement in enumerate(_assignments(tree)):
        for target, value in statement:
            if target in SUMS:
                missing.discard(target)
                for place, term in enumerate(_terms(value)):
                    name = f"{ast.unparse(term)} of {target}, times {factor:g}"
                    fault = Fault(file=FILE, change=_scaled_term(index, target, place, factor))
                    yield TermFault(name=name, equations=SUMS[target], fault=fault)
    if missing:
        raise ValueError(
            f"reduced/{FILE} must have the sums {', '.join(SUMS)}, got none of {sorted(missing)}"
        )


def _assignments(tree: ast.Module) -> list[list[tuple[str, ast.expr]]]:
    """Names and values of every assignment, tuples split."""
    assignments = []
    for node in ast.walk(tree):
        if isinstance(node, ast.Assign) and len(node.targets) == 1:
            target, value = node.targets[0], node.value
            if isinstance(target, ast.Name):
                assignments.append([(target.id, value)])
            elif isinstance(target, ast.Tuple) and isinstance(value, ast.Tuple):
                pairs = zip(target.elts, value.elts, strict=True)
                assignments.append([(each.id, part) for each, part in pairs if isinstance(each, ast.Name)])
    return assignments


def _terms(value: ast.expr) -> list[ast.expr]:
    """Operands of all sums and differences in an expression, without nested sums."""
    terms = []
    for node in ast.walk(value):
        if isinstance(node, ast.BinOp) and isinstance(node.op, ast.Add | ast.Sub):
            terms += [operand for operand in (node.left, node.right) if not _is_sum(operand)]
    return terms


def _is_sum(node: ast.expr) -> bool:
    return isinstance(node, ast.BinOp) and isinstance(node.op, ast.Add | ast.Sub)


def _scaled_term(index: int, target: str, place: int, factor: float) -> Change:
    """Change that multiplies one term of one sum by a factor."""

    def change(tree: ast.Module) -> None:
        value = dict(_assignments(tree)[index])[target]
        wanted = _terms(value)[place]
        for node in ast.walk(value):
            if isinstance(node, ast.BinOp):
                for side in ("left", "right"):
                    if getattr(node, side) is wanted:
                        setattr(node, side, ast.BinOp(ast.Constant(factor), ast.Mult(), wanted))

    return change
