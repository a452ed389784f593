"""Faults generated from a source file: what each is called, what it changes, and the file with it.

A fault is called file:scope:kind:ordinal, such as reduced/integration/uplift.py:uplift_in:strictness:2. It
keeps that name while nothing is added to, or taken from, the same kind in the same function.
"""

from __future__ import annotations

import ast
import difflib
from collections import Counter
from collections.abc import Iterator
from dataclasses import dataclass
from functools import lru_cache

from . import expressions, names
from .names import Signatures
from .scopes import scopes, spots


@dataclass(frozen=True, slots=True, kw_only=True)
class GeneratedFault:
    """One fault in one file.

    Parameters
    ----------
    file : str
        Path in the checkout, with slashes.
    scope : str
        Function, class or value of the module.
    kind : str
        Such as "strictness".
    ordinal : int
        Of this kind in this scope, from 1.
    start, end : int
        The bytes of the source that are replaced.
    before, after : str
        What is replaced, in the spelling of `ast.unparse`, and what takes its place.
    """

    file: str
    scope: str
    kind: str
    ordinal: int
    start: int
    end: int
    before: str
    after: str

    @property
    def name(self) -> str:
        """The stable name."""
        return f"{self.file}:{self.scope}:{self.kind}:{self.ordinal}"

    @property
    def change(self) -> str:
        """What is changed, in a line."""
        return " ".join(f"{self.before} => {self.after}".split())

    def applied(self, source: str) -> str:
        """Return the source with the fault in it.

        Brackets stand around the new text where it would mean something else without them.

        Raises
        ------
        ValueError
            If that is no other program.
        """
        text = source.encode()
        tried = [
            (text[: self.start] + new.encode() + text[self.end :]).decode()
            for new in (f"({self.after})", self.after)
        ]
        bracketed, plain = (_meaning(each) for each in tried)
        if bracketed is None or bracketed == plain:  # a statement takes no brackets
            found, meaning = tried[1], plain
        else:
            found, meaning = tried[0], bracketed
        if meaning is None or meaning == _meaning(source):
            raise ValueError(f"{self.name} must make another program, got {self.change}")
        return found

    def diff(self, source: str) -> str:
        """Return the unified diff of the fault, with two lines around it."""
        lines = difflib.unified_diff(
            source.splitlines(keepends=True),
            self.applied(source).splitlines(keepends=True),
            self.file,
            f"{self.file} ({self.scope}, {self.kind} {self.ordinal})",
            n=2,
        )
        return "".join(lines)


def faults_of(file: str, source: str, signatures: Signatures) -> Iterator[GeneratedFault]:
    """Yield all faults of a file in the order of the source.

    Parameters
    ----------
    file : str
        Its name in the faults.
    source : str
    signatures : mapping
        Parameters of functions, see `names.signatures_of`; calls of others keep their arguments.
    """
    starts = _starts_of_lines(source)
    ordinals: Counter[tuple[str, str]] = Counter()
    for scope in scopes(ast.parse(source)):
        known = names.around(scope, signatures)
        for spot in spots(scope):
            found = [each for family in expressions.FAMILIES for each in family(spot)]
            if scope.function is not None:
                found += [each for family in names.FAMILIES for each in family(spot, known)]
            for kind, node, after in found:
                ordinals[scope.name, kind] += 1
                start, end = _place(node, starts)
                yield GeneratedFault(
                    file=file,
                    scope=scope.name,
                    kind=kind,
                    ordinal=ordinals[scope.name, kind],
                    start=start,
                    end=end,
                    before=ast.unparse(node),
                    after=after,
                )


def _starts_of_lines(source: str) -> list[int]:
    starts = [0]
    for line in source.encode().splitlines(keepends=True):
        starts.append(starts[-1] + len(line))
    return starts


def _place(node: ast.AST, starts: list[int]) -> tuple[int, int]:
    assert isinstance(node, ast.expr | ast.stmt)
    assert node.end_lineno is not None
    assert node.end_col_offset is not None
    return starts[node.lineno - 1] + node.col_offset, starts[node.end_lineno - 1] + node.end_col_offset


@lru_cache(maxsize=4)  # the source without a fault is asked for with each
def _meaning(source: str) -> str | None:
    try:
        return ast.dump(ast.parse(source))
    except SyntaxError:
        return None
