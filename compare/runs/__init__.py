"""Runs: their choice, the scheduler that carries them out, and the cache of finished ones."""

import lazy_loader

__getattr__, __dir__, __all__ = lazy_loader.attach_stub(__name__, __file__)
