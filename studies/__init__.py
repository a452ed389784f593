"""Studies built on the comparison: advice, ensemble, fragility, spectrum, sweep, and limits of validity.

The names stand in `__init__.pyi`, and each is imported when it is first used.
"""

import lazy_loader

__getattr__, __dir__, __all__ = lazy_loader.attach_stub(__name__, __file__)
