"""Reduced models and engines on the same problem: differences, and how long they agree.

The names stand in `__init__.pyi`, and each is imported when it is first used.
"""

from __future__ import annotations

import sys
from collections.abc import Callable
from inspect import Signature, signature
from types import ModuleType
from typing import TYPE_CHECKING

import lazy_loader

if TYPE_CHECKING:
    from .comparison.comparison import Comparison

__getattr__, __dir__, __all__ = lazy_loader.attach_stub(__name__, __file__)


class _Callable(ModuleType):
    """A package that may be called: `rockwobble.compare` is both the function and the part of that name.

    The import system binds the name to the package as soon as anything in it is imported, so that no
    function of the same name would stay beside it.
    """

    @property
    def __call__(self) -> Callable[..., Comparison]:
        """The function `compare`, which runs engines and reduced models on the same problem."""
        found: Callable[..., Comparison] = self.compare
        return found

    @property
    def __signature__(self) -> Signature:
        return signature(self.compare)


sys.modules[__name__].__class__ = _Callable
