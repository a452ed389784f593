"""Rocking and wobbling cylinders: a two-degree-of-freedom model compared with multibody engines.

models, reduced, multibody and compare are the core; studies and reports are built on it. The names stand in
`__init__.pyi`; each is imported when it is first used, so that `import rockwobble` costs nothing.

>>> import rockwobble as rw
>>> pier = rw.Cylinder(semidiagonal=6.0, tan_alpha=0.2)
>>> trace = rw.simulate(rw.Case(pier, rw.el_centro_1940(), duration=5.0))
>>> trace.outcome
'stands'
"""

import lazy_loader

_stated, _, _names = lazy_loader.attach_stub(__name__, __file__)
__all__ = sorted(_names)


def __getattr__(name: str) -> object:
    if name == "__version__":
        from importlib.metadata import version

        return version("rockwobble")
    return _stated(name)


def __dir__() -> list[str]:
    return [*__all__, "__version__"]
