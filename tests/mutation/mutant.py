"""Copies of the reduced models with one fault in them, run by the interpreter.

A copy is imported from the sources of `rockwobble.reduced` under a name of its own, with a change in the
tree of one of its files. Compiling it would take ten seconds; the interpreter takes milliseconds for the
short runs in which a fault shows. Nothing is written.
"""

from __future__ import annotations

import ast
import importlib
import sys
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from functools import cache
from importlib.abc import InspectLoader, MetaPathFinder
from importlib.machinery import ModuleSpec
from importlib.util import find_spec, spec_from_loader
from itertools import count
from pathlib import Path
from types import CodeType
from typing import Any

from .places import Change

_NUMBERS = count(1)
_MOST_STEPS = 4000  # what the longest run of a check takes, twice

# in place of reduced/_compile.py: nothing is compiled
_INTERPRETED = """
def jit(function):
    return function

inlined = once = kernel = borrowed = jit

def by_body(plain, tied):
    def function(body, *arguments):
        return (tied if hasattr(body, "prestress") else plain)(body, *arguments)
    return function

def in_memory(entry):
    return True

def on_disk(entry):
    return True

def announce(entry, model, load):
    pass
"""


@dataclass(frozen=True, slots=True, kw_only=True)
class Fault:
    """A change in the sources of the reduced models."""

    file: str  # such as "body.py"
    change: Change  # of its tree in place; a ValueError says that its place is gone

    def applied(self, text: str) -> str:
        """Text of the file with the fault applied.

        Raises
        ------
        ValueError
            If the sources no longer have what is changed: the fault must follow them.
        """
        tree = ast.parse(text)
        try:
            self.change(tree)
        except ValueError as error:
            raise ValueError(f"reduced/{self.file}: {error}") from error
        return ast.unparse(ast.fix_missing_locations(tree))


def source_folder() -> Path:
    """Folder of the sources of the reduced models."""
    spec = find_spec("rockwobble.reduced")
    assert spec is not None
    assert spec.origin is not None
    return Path(spec.origin).parent


@contextmanager
def mutated(*faults: Fault) -> Iterator[Any]:
    """Yield a copy of the package `rockwobble.reduced` with these faults; without any, the model itself.

    Raises
    ------
    ValueError
        If a fault does not fit the sources.
    """
    sources = _Sources(f"rockwobble_mutant_{next(_NUMBERS)}", source_folder(), faults)
    sources.require_faults()
    sys.meta_path.insert(0, sources)
    try:
        package = importlib.import_module(sources.name)
        # a motion that a fault has made endless must end while somebody waits
        problem: Any = sys.modules[f"{sources.name}.problem"]
        problem._BUDGET, problem._BUDGET_PER_SAMPLE, problem._BUDGET_PER_TIME = _MOST_STEPS, 0, 0
        yield package
    finally:
        sys.meta_path.remove(sources)
        for name in [name for name in sys.modules if name.split(".")[0] == sources.name]:
            del sys.modules[name]


@cache  # all files but those with a fault are the same in each copy
def _compiled(source: str, place: str) -> CodeType:
    return compile(source, place, "exec", dont_inherit=True)


class _Sources(MetaPathFinder, InspectLoader):
    """Import hook for the modules of one copy."""

    def __init__(self, name: str, folder: Path, faults: tuple[Fault, ...]) -> None:
        self.name, self._folder, self._faults = name, folder, faults
        self._texts: dict[Path, str] = {}  # with the faults, each made once

    def require_faults(self) -> None:
        for fault in self._faults:
            place = self._folder / fault.file
            self._texts[place] = fault.applied(self._text(place))

    def find_spec(self, fullname: str, path: Any = None, target: Any = None) -> ModuleSpec | None:
        if fullname.split(".")[0] != self.name:
            return None
        place = self._place(fullname)
        if not place.is_file():
            return None
        return spec_from_loader(fullname, self, origin=str(place), is_package=place.name == "__init__.py")

    def is_package(self, fullname: str) -> bool:
        return self._place(fullname).name == "__init__.py"

    def get_source(self, fullname: str) -> str:
        place = self._place(fullname)
        if place.name == "_compile.py":
            return _INTERPRETED
        return self._text(place)

    def get_code(self, fullname: str) -> CodeType:
        return _compiled(self.get_source(fullname), str(self._place(fullname)))

    def _text(self, place: Path) -> str:
        return self._texts.get(place) or place.read_text(encoding="utf-8")

    def _place(self, fullname: str) -> Path:
        inside = self._folder.joinpath(*fullname.split(".")[1:])
        package = inside / "__init__.py"
        return package if package.is_file() else inside.with_suffix(".py")
