"""Engines by name; each is imported only when it is asked for.

Those of this package stand in `_ENGINES`, with what each needs to run: an engine is known by name where its
package has no wheel. Another package declares its own as an entry point of the group `rockwobble.engines`.
"""

from __future__ import annotations

import importlib
import importlib.util
import platform
import sys
from collections.abc import Mapping
from dataclasses import dataclass, fields
from functools import cache
from types import MappingProxyType
from typing import TYPE_CHECKING, cast

from rockwobble.models import Case
from rockwobble.models.shown import brief
from rockwobble.models.support import SUPPORTS

from ..protocol import MEMBERS, Engine, EngineFacts

if TYPE_CHECKING:
    from importlib.metadata import EntryPoint

GROUP = "rockwobble.engines"
# default engine: it comes with every installation, and has every support
DEFAULT_ENGINE = "mujoco"


class EngineNotInstalledError(ValueError):
    """A known engine whose package, or a library that it needs, is not installed here or does not load."""


class BrokenEngineError(ValueError):
    """Error of an engine declared by another package whose entry point does not load."""


@dataclass(frozen=True, slots=True)
class _Entry:
    package: str
    remedy: str
    loads: str = ""  # module that loads only in a complete installation of the package; by default its own
    standard: bool = True  # whether it comes with every installation of this package, where it has a wheel

    @property
    def module(self) -> str:
        return self.loads or self.package


_UNITS = {"rolling_resistance": " m"}  # units of terms of a case, for refusals
# platforms of PyBullet; elsewhere DART takes its place in a default run
_WHEEL = sys.version_info < (3, 12) and sys.platform == "linux" and platform.machine() == "x86_64"
_WHEELS = "pip install pybullet, which has wheels for Python 3.11 and older on Linux x86-64 only"
# module here by name, with a class of that name
_ENGINES: Mapping[str, _Entry] = MappingProxyType(
    {
        # an uninstalled mujoco-core leaves an empty folder that can be imported
        "mujoco": _Entry("mujoco", "pip install 'mujoco>=4.0,<5'", loads="mujoco.rollout"),
        "pybullet": _Entry("pybullet", _WHEELS, standard=_WHEEL),
        "dart": _Entry("dartpy", "pip install 'dartpy>=6.20,<7'", standard=not _WHEEL),
        "drake": _Entry("drake", "pip install 'drake>=1.51'", "pydrake.multibody.plant", standard=False),
        "exudyn": _Entry("exudyn", "pip install 'exudyn>=1.13.6,<2'", standard=False),
        "rapier": _Entry("rapier3d", "pip install 'rapier3d>=0.36'", standard=False),
    }
)


def engine_names() -> tuple[str, ...]:
    """Return the names of all known engines, installed or not: of this package, then of others.

    Returns
    -------
    tuple of str

    Examples
    --------
    >>> "mujoco" in engine_names()
    True
    """
    return (*_ENGINES, *_declarations())


def standard_engines() -> tuple[str, ...]:
    """Return the names of the engines that every installation is meant to have."""
    return tuple(name for name, entry in _ENGINES.items() if entry.standard)


def stand_in(name: str) -> str | None:
    """Engine that replaces one without a wheel here, in a default run or a suite."""
    return "dart" if name == "pybullet" and not _WHEEL else None


def own_engines() -> tuple[str, ...]:
    """Names of our engines that run here: their packages are installed, and load."""
    return tuple(name for name in _ENGINES if not engine_fault(name))


def available_engines() -> tuple[str, ...]:
    """Return the names of all engines that are installed here: of this package, then of others.

    Nothing is imported: one whose package is damaged is among them, and is refused when it is asked for.

    Returns
    -------
    tuple of str

    Examples
    --------
    >>> "mujoco" in available_engines()
    True
    """
    return (*(name for name in _ENGINES if not _lack(name)), *_declarations())


def _lack(name: str) -> str:
    """Missing package of one of our engines and how to install it, worded to follow its name; or empty."""
    entry = _ENGINES[name]
    there = importlib.util.find_spec(entry.module.partition(".")[0]) is not None
    return "" if there else f"is not installed here: {entry.remedy}"


def engine_fault(name: str) -> str:
    """Reason why an engine does not run here, worded to follow its name; empty if it does.

    Its package is imported, which takes some tenths of a second once. One that another package declares is
    installed, and loaded by that package.
    """
    return (_lack(name) or _load_failure(name)) if name in _ENGINES else ""


@cache
def _load_failure(name: str) -> str:
    from .pybullet import quiet  # it prints as it loads

    try:
        with quiet():
            importlib.import_module(_ENGINES[name].module)
    # any exception of a damaged package, as it must not stop the other engines
    except Exception as error:
        reason = " ".join(str(error).split()) or type(error).__name__
        return f"is installed and does not load: {reason}"
    return ""


def engine_named(name: str) -> Engine:
    """Engine called `name`, with its facts, whether it runs here or not.

    Raises
    ------
    ValueError
        If there is no such engine; BrokenEngineError if it is of another package and does not load.
    """
    if name in _ENGINES:
        module = importlib.import_module(f".{name}", __package__)
        return cast(Engine, getattr(module, f"{name.title()}Engine")())
    declared = _declarations()
    if name not in declared:
        raise ValueError(f"engine must be one of {', '.join((*_ENGINES, *declared))}, got {name!r}")
    return _load(name, declared[name])


def find_engine(name: str) -> Engine:
    """Engine called `name`, if it runs here.

    Parameters
    ----------
    name : str

    Returns
    -------
    Engine

    Raises
    ------
    ValueError
        If there is no such engine.
    EngineNotInstalledError
        If its package is not installed or does not load; a ValueError that says how to get it, or why.
    BrokenEngineError
        If another package declares it and it does not load, or is no engine; a ValueError that says why.
    """
    engine = engine_named(name)
    _require_installed(name)
    return engine


def engine_for(case: Case, name: str, support: str) -> Engine:
    """Return the engine called `name`, which has the support and can run the case.

    What it cannot do is said before what it lacks, so that nobody installs it in vain.

    Raises
    ------
    ValueError
        Saying what is allowed, and as `find_engine` does.
    """
    engine = engine_named(name)
    _require_able(engine, name, case, support)
    _require_installed(name)
    return engine


def _require_able(engine: Engine, name: str, case: Case, support: str) -> None:
    supports = engine.supports
    if support not in supports:
        allowed = f"one of {', '.join(supports)}" if len(supports) > 1 else supports[0]
        raise ValueError(f"support must be {allowed} in {name}, got {support!r}")
    if case.cylinder.slab_mass_ratio > 0.0:
        if not engine.facts.carries_slab:
            raise ValueError(f"{name} has no scene of a frame, got {case.cylinder!r}")
        if SUPPORTS[support].walls:
            raise ValueError(f"support must have no walls under a slab, got {support!r}")
    if not engine.uplifts and (case.initial is None or case.initial.tilt == 0.0):
        raise ValueError(
            f"{name} cannot uplift a cylinder that stands: give a release with a tilt, got a start at rest"
        )
    none = {each.name: brief(each.default) for each in fields(case)}
    for term, value in case.terms.items():
        if term not in engine.facts.terms:
            words, unit = term.replace("_", " "), _UNITS.get(term, "")
            raise ValueError(f"{name} has no {words}: {term} must be {none[term]}, got {value!r}{unit}")


def engine_facts(name: str) -> EngineFacts:
    """Return the facts known of the engine called `name`, installed or not.

    Raises
    ------
    ValueError
        If there is no such engine; BrokenEngineError if it is of another package and does not load.
    """
    return engine_named(name).facts


def engine_packages() -> dict[str, str]:
    """Return the package of each of our engines, by the name of the engine."""
    return {name: entry.package for name, entry in _ENGINES.items()}


def _require_installed(name: str) -> None:
    fault = engine_fault(name)
    if fault:
        raise EngineNotInstalledError(f"engine {name!r} {fault}")


def _declarations() -> dict[str, list[EntryPoint]]:
    """Entry points of other packages by name, in alphabetical order, without the names of our engines."""
    from importlib.metadata import entry_points

    entries: dict[str, list[EntryPoint]] = {}
    for point in sorted(entry_points(group=GROUP), key=lambda point: (point.name, point.value)):
        # one installation may be on the path twice
        if point.name not in _ENGINES and point not in entries.get(point.name, []):
            entries.setdefault(point.name, []).append(point)
    return entries


def _load(name: str, points: list[EntryPoint]) -> Engine:
    packages = ", ".join(sorted(point.dist.name if point.dist else point.value for point in points))
    if len(points) > 1:
        raise BrokenEngineError(f"engine {name!r} is declared more than once, by {packages}: uninstall one")
    try:
        engine = points[0].load()()
    # any exception of a foreign engine, as it must not stop the others
    except Exception as error:
        reason = (str(error).splitlines() or [""])[0]
        raise BrokenEngineError(
            f"engine {name!r} of the package {packages} does not load: {type(error).__name__}: {reason}"
        ) from error
    missing = [member for member in MEMBERS if not hasattr(engine, member)]
    if missing:
        raise BrokenEngineError(
            f"engine {name!r} of the package {packages} is no engine: it has no {', '.join(missing)}"
        )
    return cast(Engine, engine)
