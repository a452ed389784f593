"""pandas, imported when the first table is made or asked for: it takes a third of a second."""

from typing import TYPE_CHECKING

if TYPE_CHECKING:
    import pandas as pd
else:

    class _Pandas:
        """The package by its names: a lazy module would show a second thread those that are there so far."""

        def __getattr__(self, name: str) -> object:
            import pandas

            return getattr(pandas, name)

    pd = _Pandas()

__all__ = ["pd"]
