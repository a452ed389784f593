"""Rocking and wobbling cylinders: a two-degree-of-freedom model held against multibody engines.

Every name is imported when it is first used, so that `import rockwobble` costs nothing.

>>> import rockwobble as rw
>>> pier = rw.Cylinder(semidiagonal=6.0, tan_alpha=0.2)
>>> trace = rw.simulate(rw.Case(pier, rw.el_centro_1940(), duration=5.0))
>>> trace.outcome
'completed'
"""

import importlib

_PARTS = ("compare", "models", "multibody", "reduced", "reports")
_NAMES = {
    **dict.fromkeys(
        (
            *("Case", "Cylinder", "Diagnostic", "GroundMotion", "InitialState", "Run", "Suite", "Trace"),
            *("el_centro_1940", "p695_far_field", "pulse", "read_record", "read_suite", "shipped_suites"),
        ),
        "rockwobble.models",
    ),
    **dict.fromkeys(
        ("Comparison", "External", "ensemble", "fragility", "simulate", "sweep"),
        "rockwobble.compare",
    ),
}
# the part `compare` may be called: that is its function `compare`
__all__ = sorted([*_NAMES, *_PARTS])


def __getattr__(name: str) -> object:
    if name == "__version__":
        from importlib.metadata import version

        return version("rockwobble")
    if name in _NAMES:
        return getattr(importlib.import_module(_NAMES[name]), name)
    if name in _PARTS:
        return importlib.import_module(f"rockwobble.{name}")
    raise AttributeError(f"module 'rockwobble' has no attribute {name!r}")


def __dir__() -> list[str]:
    return [*__all__, "__version__"]
