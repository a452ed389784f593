"""Rocking and wobbling cylinders: a two-degree-of-freedom model held against multibody engines.

Every name is imported when it is first used, so that `import rockwobble` costs nothing.

>>> import rockwobble as rw
>>> pier = rw.Cylinder(semidiagonal=6.0, tan_alpha=0.2)
>>> trace = rw.simulate(rw.Case(pier, rw.el_centro_1940(), duration=5.0))
>>> trace.outcome
'stands'
"""

import importlib
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from rockwobble import models, multibody, reduced, reports
    from rockwobble.compare import (
        Comparison,
        External,
        Grid,
        advise,
        compare,
        ensemble,
        fragility,
        simulate,
        spectrum,
        sweep,
    )
    from rockwobble.compare.check import check
    from rockwobble.models import (
        Case,
        Cylinder,
        Diagnostic,
        GroundMotion,
        InitialState,
        Run,
        Suite,
        Trace,
        WobblingFrame,
        el_centro_1940,
        far_field_motions,
        p695_far_field,
        perturbed_copies,
        pulse,
        read_record,
        read_records,
        read_suite,
        shipped_suites,
        synthetic_motions,
        with_motions,
    )

    __version__: str

__all__ = [
    "Case",
    "Comparison",
    "Cylinder",
    "Diagnostic",
    "External",
    "Grid",
    "GroundMotion",
    "InitialState",
    "Run",
    "Suite",
    "Trace",
    "WobblingFrame",
    "advise",
    "check",
    "compare",  # the module, which may be called; to a type checker its function `compare`
    "el_centro_1940",
    "ensemble",
    "far_field_motions",
    "fragility",
    "models",
    "multibody",
    "p695_far_field",
    "perturbed_copies",
    "pulse",
    "read_record",
    "read_records",
    "read_suite",
    "reduced",
    "reports",
    "shipped_suites",
    "simulate",
    "spectrum",
    "sweep",
    "synthetic_motions",
    "with_motions",
]
_PARTS = ("compare", "models", "multibody", "reduced", "reports")
_OF_COMPARE = (
    *("Comparison", "External", "Grid", "advise", "ensemble", "fragility", "simulate", "spectrum", "sweep"),
)


def __getattr__(name: str) -> object:
    if name == "__version__":
        from importlib.metadata import version

        return version("rockwobble")
    if name in _PARTS:
        return importlib.import_module(f"rockwobble.{name}")
    if name == "check":
        return importlib.import_module("rockwobble.compare.check").check
    if name in __all__:
        return getattr(
            importlib.import_module(f"rockwobble.{'compare' if name in _OF_COMPARE else 'models'}"), name
        )
    raise AttributeError(f"module 'rockwobble' has no attribute {name!r}")


def __dir__() -> list[str]:
    return [*__all__, "__version__"]
