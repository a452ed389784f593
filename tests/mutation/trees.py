"""Copies of the checkout, into which one fault at a time is put and from which it is taken again.

Compiled code is kept beside its sources: a copy that takes it along compiles again only what a fault
changes. Python tells its own compiled files from their sources by times and sizes, which a fault of the same
length need not change; so what a fault makes stale is removed here, by name.
"""

from __future__ import annotations

import ast
import hashlib
import shutil
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path

from .sites import GeneratedFault
from .targets import PACKAGES

_COMPILED = "reduced"  # the folder of the compiled kernels
_ENTRY = "kernel"  # the decorator of an entry point that is kept on disk, see reduced/_compile.py
_LEFT_OUT = shutil.ignore_patterns(
    ".git", ".venv", "*.egg-info", ".*_cache", "rockwobble-*", "dist", "build", "*.part"
)


@dataclass(frozen=True, slots=True)
class Tree:
    """A copy of the checkout.

    Parameters
    ----------
    root : Path
    pristine : Path
        A copy that is never changed, from which this one is mended.
    """

    root: Path
    pristine: Path

    @contextmanager
    def holding(self, fault: GeneratedFault) -> Iterator[Path]:
        """Put a fault into the copy for a while; yields its root."""
        path = self.root / fault.file
        compiled = path in compiled_files(self.root)
        path.write_text(fault.applied(path.read_text(encoding="utf-8")), encoding="utf-8")
        for stale in (path.parent / "__pycache__").glob(f"{path.stem}.*.pyc"):
            stale.unlink()
        if compiled:
            for kept in (self.root / _COMPILED / "__pycache__").glob("*.nb[ic]"):
                kept.unlink()
        try:
            yield self.root
        finally:
            shutil.copy2(self.pristine / fault.file, path)
            for cache in {path.parent, self.root / _COMPILED} if compiled else {path.parent}:
                kept_of = self.pristine / cache.relative_to(self.root) / "__pycache__"
                shutil.rmtree(cache / "__pycache__", ignore_errors=True)
                if kept_of.is_dir():
                    shutil.copytree(kept_of, cache / "__pycache__")


def copy_tree(source: Path, target: Path) -> None:
    """Copy a checkout with its links, its times and what was compiled."""
    shutil.copytree(source, target, symlinks=True, ignore=_LEFT_OUT)


def compiled_files(root: Path) -> frozenset[Path]:
    """Return the files that compiled code is made of: those of its entry points, and what they import.

    Raises
    ------
    ValueError
        If no function is marked as an entry point.
    """
    folder = root / _COMPILED
    trees = {path: ast.parse(path.read_text(encoding="utf-8")) for path in folder.rglob("*.py")}
    waiting = [path for path, tree in trees.items() if _has_entry(tree)]
    if not waiting:
        raise ValueError(f"{_COMPILED} must have functions marked with {_ENTRY}, got none")
    found: set[Path] = set()
    while waiting:
        path = waiting.pop()
        if path in trees and path not in found:
            found.add(path)
            waiting += _imported(path, trees[path])
    return frozenset(found)


def digest(root: Path) -> str:
    """Return a short hash of all sources and data of the packages in which faults are sought."""
    found = hashlib.sha256()
    for package in PACKAGES:
        for path in sorted((root / package).rglob("*")):
            if path.is_file() and "__pycache__" not in path.parts:
                found.update(path.relative_to(root).as_posix().encode())
                found.update(path.read_bytes())
    return found.hexdigest()[:12]


def _has_entry(tree: ast.Module) -> bool:
    functions = (node for node in tree.body if isinstance(node, ast.FunctionDef))
    return any(ast.unparse(each) == _ENTRY for node in functions for each in node.decorator_list)


def _imported(path: Path, tree: ast.Module) -> Iterator[Path]:
    """Yield the files that relative imports of the file `path` may name."""
    for node in ast.walk(tree):
        if isinstance(node, ast.ImportFrom) and node.level:
            place = path.parents[node.level - 1].joinpath(*(node.module or "").split("."))
            yield place.with_suffix(".py")
            yield from (place / f"{each.name}.py" for each in node.names)
