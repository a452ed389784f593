"""Provenance of a result: fingerprint of its inputs, versions of the packages, and digests of the code."""

from __future__ import annotations

import dataclasses
import hashlib
import importlib.metadata
import importlib.util
import inspect
import platform
import subprocess
import sys
from collections.abc import Callable, Iterable, Iterator, Mapping
from functools import cache
from pathlib import Path
from types import ModuleType

import numpy as np

from rockwobble.models.cpus import usable_cpus
from rockwobble.multibody.engines.registry import engine_packages

# 128 bits: two different inputs of 10^9 results share a name with a probability of 10^-21
_DIGITS = 32


def fingerprint(value: object) -> str:
    """Hash of a value: numbers by their bits, containers and dataclasses by their contents.

    Parameters
    ----------
    value : object
        None, numbers, text, arrays, sequences, mappings with text as keys, and dataclasses of these.

    Returns
    -------
    str
        32 hexadecimal digits.

    Raises
    ------
    ValueError
        If the value holds something else.

    Examples
    --------
    >>> fingerprint({"a": 1.0, "b": [2]}) == fingerprint({"b": [2], "a": 1.0})
    True
    >>> fingerprint(0.1 + 0.2) == fingerprint(0.3)
    False
    """
    digest = hashlib.sha256()
    for kind, content in _kinds_and_bytes(value):
        digest.update(f"{kind} {len(content)}:".encode() + content)
    return digest.hexdigest()[:_DIGITS]


def _kinds_and_bytes(value: object) -> Iterator[tuple[str, bytes]]:
    """The parts of a value with their kinds: with their lengths, too, no two values have the same bytes."""
    if isinstance(value, np.generic):
        value = value.item()
    parts: Iterable[object] = ()
    if isinstance(value, str):
        yield "str", value.encode()  # a support is a str, too
    elif value is None or isinstance(value, bool | int):
        yield type(value).__name__, str(value).encode()
    elif isinstance(value, float):
        yield "float", value.hex().encode()
    elif isinstance(value, np.ndarray):
        yield f"array {value.dtype.str} {value.shape}", np.ascontiguousarray(value).tobytes()
    elif isinstance(value, Mapping):
        yield "mapping", str(len(value)).encode()
        parts = (part for key in sorted(value) for part in (key, value[key]))
    elif isinstance(value, list | tuple):
        yield "sequence", str(len(value)).encode()
        parts = value
    elif dataclasses.is_dataclass(value) and not isinstance(value, type):
        yield "dataclass", type(value).__name__.encode()
        parts = ({field.name: getattr(value, field.name) for field in dataclasses.fields(value)},)
    else:
        raise ValueError(
            f"a result cannot be named by an input of type {type(value).__name__}, got {value!r}"
        )
    for part in parts:
        yield from _kinds_and_bytes(part)


PACKAGES = ("rockwobble", "numpy", "scipy", "numba", "pandas", "pyarrow", *engine_packages().values())
_REDUCED = ("rockwobble", "numpy", "numba")


def package_versions(packages: tuple[str, ...] = PACKAGES) -> dict[str, str]:
    """Versions of Python, packages and engines on which results depend."""
    versions = {"python": platform.python_version(), "platform": f"{platform.system()} {platform.machine()}"}
    return versions | {package: _version(package) for package in packages}


def other_versions(then: Mapping[str, str], engine: str | None = None) -> tuple[str, ...]:
    """Versions that differ from `then`, as "numpy 1.26 -> 2.0"; of the engines only that of `engine`."""
    now, engines = package_versions(), engine_packages()
    for name, package in engines.items():
        if name != engine:
            now.pop(package, None)
    return tuple(f"{name} {old} -> {now[name]}" for name, old in then.items() if now.get(name, old) != old)


@cache
def _version(package: str) -> str:
    try:
        return importlib.metadata.version(package)
    except importlib.metadata.PackageNotFoundError:
        return "not installed"


def processor() -> str:
    """Name of the processor and number of its cores that this process may use."""
    name = platform.processor() or platform.machine()
    information = Path("/proc/cpuinfo")
    if information.exists():
        lines = information.read_text().splitlines()
        name = next((line.split(":", 1)[1].strip() for line in lines if line.startswith("model name")), name)
    return f"{name}, {usable_cpus()} cores"


@cache
def commit() -> str:
    """Commit of the checkout with this file; empty without one.

    With "+" after changes of anything but published results, which code does not rest on.
    """
    here = Path(__file__).resolve()

    def git(*arguments: str) -> str:
        done = subprocess.run(
            ["git", "-C", str(here.parent), *arguments], capture_output=True, text=True, check=True
        )
        return done.stdout.strip()

    try:
        git("ls-files", "--error-unmatch", here.name)  # else it is another repository
        code = (":(top)", ":(top,exclude)reports/published")
        return git("rev-parse", "HEAD") + ("+" if git("status", "--porcelain", "-uno", "--", *code) else "")
    except (OSError, subprocess.CalledProcessError):
        return ""


def code_digests() -> dict[str, str]:
    """Hash of the sources of each folder with numerical code."""
    return {name: _source_digest(name) for name in ("models", "reduced", "multibody", "compare", "studies")}


def result_fingerprint(inputs: object, made_with: Mapping[str, str]) -> str:
    """Hash of the inputs of a result, and of its versions and code.

    Parameters
    ----------
    inputs : object
        As of `fingerprint`, without names that are for people alone.
    made_with : mapping
        As of `reduced_makers` or `engine_makers`.
    """
    return fingerprint({"inputs": inputs, "made with": made_with})


def reduced_makers() -> dict[str, str]:
    """Versions and code on which the runs of the reduced models depend."""
    return _makers(_REDUCED, "reduced")


def engine_makers(*engines: str) -> dict[str, str]:
    """Versions and code on which runs of engines depend."""
    packages = engine_packages()
    own = _makers(
        ("rockwobble", "numpy", *(packages[name] for name in engines if name in packages)), "multibody"
    )
    return own | {f"engine {name}": _of_another_package(name) for name in engines if name not in packages}


@cache
def _of_another_package(name: str) -> str:
    """Version of an engine of another package, and a hash of the folder of its module."""
    from rockwobble.multibody.engines.registry import find_engine

    engine = find_engine(name)
    module = sys.modules[type(engine).__module__]
    place = Path(str(module.__file__))
    return f"{engine.version()}, {_digest_of(place.parent if module.__package__ else place)}"


def _makers(packages: tuple[str, ...], folder: str) -> dict[str, str]:
    code = {f"code of {name}": _source_digest(name) for name in (folder, "models")}
    return package_versions(packages) | code


@cache
def _source_digest(folder: str) -> str:
    """Hash of the sources of one folder: in a checkout they change without a change of version."""
    spec = importlib.util.find_spec(f"rockwobble.{folder}")  # an import would load the compiler
    assert spec is not None
    return _digest_of(Path(str(spec.origin)).parent)


def source_digest(*parts: ModuleType | type | Callable[..., object]) -> str:
    """Hash of the sources of modules, functions and classes."""
    return hashlib.sha256("".join(map(inspect.getsource, parts)).encode()).hexdigest()[:16]


def _digest_of(place: Path) -> str:
    digest = hashlib.sha256()
    # the scenes of an engine are sources, too
    paths = (
        [place] if place.is_file() else [path for path in place.rglob("*") if path.suffix in (".py", ".xml")]
    )
    for path in sorted(paths):
        digest.update(f"{path.relative_to(place.parent).as_posix()}\0".encode() + path.read_bytes())
    return digest.hexdigest()[:16]
