"""Reduced models and engines on the same problem: differences, and how long they agree.

The names stand in `__init__.pyi`, and each is imported when it is first used.
"""

import sys
from types import ModuleType
from typing import Any

import lazy_loader

__getattr__, __dir__, __all__ = lazy_loader.attach_stub(__name__, __file__)


class _Callable(ModuleType):
    """A package that may be called: `rockwobble.compare` is both the function and the part of that name.

    The import system binds the name to the package as soon as anything in it is imported, so that no
    function of the same name would stay beside it.
    """

    def __call__(self, *arguments: Any, **options: Any) -> Any:
        """Run engines and reduced models on the same problem; see the function `compare`."""
        return self.compare(*arguments, **options)

    @property
    def __signature__(self) -> Any:
        from inspect import signature

        return signature(self.compare)


sys.modules[__name__].__class__ = _Callable
