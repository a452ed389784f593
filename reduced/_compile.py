"""Compilation of the numerical kernels, and keeping what was compiled on disk."""

from __future__ import annotations

import gc
import hashlib
import inspect
import os
import re
import stat
import sys
import tempfile
from collections.abc import Callable, Iterator
from contextlib import contextmanager, suppress
from functools import cache, update_wrapper
from importlib import import_module
from pathlib import Path
from typing import Any, Generic, ParamSpec, TypeVar, cast

import numba
import numpy as np
from numba.core.caching import IndexDataCacheFile
from numba.extending import intrinsic, overload
from numba.np import linalg
from numpy.typing import NDArray

F = TypeVar("F", bound=Callable[..., object])
A = TypeVar("A", bound=NDArray[np.generic])
P = ParamSpec("P")
R = TypeVar("R")

# a division by zero gives inf or NaN, which the step control rejects, instead of a Python exception;
# a multiply-add rounds once (contract), the one licence that keeps mirror and power-of-two scaling exact
_OPTIONS: dict[str, Any] = {"error_model": "numpy", "fastmath": {"contract"}}
_RELATIVE_IMPORT = re.compile(r"^from (\.+)([\w.]*) import", re.MULTILINE)


class _Part(Generic[P, R]):
    """Decorator of a function compiled into its callers, and by itself only where Python calls it.

    What Python needs to call it takes a fifth of the time to compile all. The callers find it by its
    ``_numba_type_``, and what is to become a part of them by ``targetoptions``, as numba has it.
    """

    def __init__(self, function: Callable[P, R], **options: Any) -> None:
        update_wrapper(self, function)
        self.py_func = function
        self._alone = numba.njit(**_OPTIONS)(function)
        options |= {"no_cpython_wrapper": True, "no_cfunc_wrapper": True}
        self._inner = numba.njit(**_OPTIONS, **options)(function)
        self._numba_type_ = numba.types.Dispatcher(self._inner)
        self.targetoptions = options

    def __call__(self, *arguments: P.args, **named: P.kwargs) -> R:
        return cast("R", self._alone(*arguments, **named))


def jit(function: F) -> F:
    """Compile a function that the kernels call; it is compiled into its callers."""
    return cast("F", _Part(function))


def once(function: F) -> F:
    """Compile a large function inline at its only call, without compiling it separately."""
    return cast("F", _Part(function, inline="always"))


def inlined(function: F) -> F:
    """Inline a function into its callers: for innermost functions, where a call costs time."""
    return cast("F", _Part(function, forceinline=True))


def kernel(function: F) -> F:
    """Compile an entry point without the interpreter lock, and keep the machine code on disk.

    It is kept under a digest of all sources that it is compiled from: numba knows the file of the entry point
    alone, and that by time and size.
    """
    compiled = numba.njit(cache=True, nogil=True, **_OPTIONS)
    try:
        entry = compiled(function)
    except RuntimeError:  # numba finds no folder to write to: neither beside the source nor in HOME
        _keep_in_temporary_folder()
        entry = compiled(function)
    entry.compile = _without_collector()(entry.compile)
    _keep_by_content(entry._cache, _digest(Path(function.__code__.co_filename)))
    return cast("F", entry)


def by_body(plain: F, tied: Callable[..., object]) -> F:
    """Dispatch by type at compile time: `plain` for a `Body`, `tied` for a body with a tendon.

    A kernel is compiled for each of the two kinds of bodies, and has the one that is meant in the place of
    the call: without a tendon nothing of it is compiled, which leaves the machine code, and its rounding, as
    it is. Both are functions of this module's decorators with the same parameters.
    """
    names = ", ".join(inspect.signature(plain.py_func).parameters)  # type: ignore[attr-defined]
    first = names.partition(",")[0]
    scope: dict[str, Any] = {"plain": plain, "tied": tied}
    # numba asks that an overload names its parameters as the function does
    exec(
        f"def function({names}): return (tied if hasattr({first}, 'prestress') else plain).py_func({names})\n"
        f"def choice({names}): return (tied if 'prestress' in {first}.fields else plain).py_func\n",
        scope,
    )
    function: F = scope["function"]
    function.__doc__ = plain.__doc__
    options: Any = _OPTIONS | {"no_cpython_wrapper": True, "no_cfunc_wrapper": True, "forceinline": True}
    overload(function, jit_options=options, strict=False)(scope["choice"])
    return function


def _keep_by_content(kept: Any, digest: str) -> None:
    """Cache machine code under the digest of its sources, and remove the cache of other sources."""
    folder, base = Path(kept.cache_path), kept._impl.filename_base
    name = f"{base}.{digest[:16]}"
    kept._cache_file = IndexDataCacheFile(str(folder), name, digest)  # type: ignore[no-untyped-call]
    # the name of a file holds the line number of the function
    for path in folder.glob(re.sub(r"-\d+\.", "-*.", base) + ".*nb[ic]"):
        if not path.name.startswith(name):
            with suppress(OSError):  # a file of another user, or removed meanwhile
                path.unlink()


@cache  # shared by the entry points of one file
def _digest(source: Path) -> str:
    """Return a digest of a source and of all that it imports from this folder."""
    entries: dict[Path, bytes] = {}
    waiting = [source]
    while waiting:
        path = waiting.pop()
        if path in entries or not path.is_file():
            continue
        entries[path] = path.read_bytes()
        for dots, name in _RELATIVE_IMPORT.findall(entries[path].decode()):
            folder = path.parents[len(dots) - 1]
            waiting += [folder / f"{name.replace('.', '/')}.py"] if name else folder.glob("*.py")
    parts = (hashlib.sha256(entries[path]).digest() for path in sorted(entries))
    return hashlib.sha256(b"".join(parts)).hexdigest()


@contextmanager
def _without_collector() -> Iterator[None]:
    """Disable the garbage collector during a compilation, where it takes a fifth of the time.

    Nor is SciPy's linear algebra, which no kernel calls, imported to see whether it is there: a tenth of a
    short command.
    """
    collects = gc.isenabled()
    asks: Any = getattr(linalg, "ensure_blas", None)  # of the inside of numba, which may change
    gc.disable()
    linalg.ensure_blas = lambda: None
    try:
        with suppress(ImportError):
            import_module("numba.np.arraymath")  # it asks for SciPy when it is imported
        yield
    finally:
        linalg.ensure_blas = asks
        if collects:
            gc.enable()


def _keep_in_temporary_folder() -> None:
    """Move the cache of machine code, of child processes too, to a temporary folder, and say so."""
    folder = (
        Path(tempfile.gettempdir()) / f"rockwobble-compiled-{os.getuid() if hasattr(os, 'getuid') else ''}"
    )
    if not _is_ours(folder):
        folder = Path(tempfile.mkdtemp(prefix="rockwobble-compiled-"))
    os.environ["NUMBA_CACHE_DIR"] = str(folder)
    numba.config.reload_config()  # type: ignore[no-untyped-call]
    print(
        f"rockwobble: neither the installation nor HOME can be written: compiled code is kept in {folder}",
        file=sys.stderr,
    )


def _is_ours(folder: Path) -> bool:
    """Whether only this user can write to a folder of machine code, created where it is missing."""
    try:
        folder.mkdir(mode=0o700, exist_ok=True)
        place = folder.lstat()
    except OSError:
        return False
    if not hasattr(os, "getuid"):
        return folder.is_dir()
    return stat.S_ISDIR(place.st_mode) and place.st_uid == os.getuid() and not place.st_mode & 0o022


def _borrow(typing: Any, array: Any) -> Any:
    def generate(context: Any, builder: Any, signature: Any, arguments: Any) -> Any:
        view = context.make_array(signature.return_type)(context, builder, arguments[0])
        view.meminfo, view.parent = view.meminfo.type(None), view.parent.type(None)
        return view._getvalue()

    return array(array), generate


# A view of an array that counts no references, for as long as the array itself is used later. Counting
# takes a locked instruction each time the array is handed on: a tenth of a step.
borrowed = cast("Callable[[A], A]", intrinsic(_borrow))


def in_memory(entry: Callable[..., object]) -> bool:
    """Return whether `entry` is loaded, so that a call runs at once."""
    return bool(cast("Any", entry).overloads)


def on_disk(entry: Callable[..., object]) -> bool:
    """Return whether compiled code of `entry` is kept on disk."""
    return bool(cast("Any", entry)._cache._cache_file._load_index())


def announce(entry: Callable[..., object], model: str, load: Callable[[], object]) -> None:
    """Load the compiled code of `entry`, or compile it and say so on standard error: that takes seconds."""
    if not in_memory(entry):
        if not on_disk(entry):
            print(f"rockwobble: compiling the {model} model, once for this installation ...", file=sys.stderr)
        load()
