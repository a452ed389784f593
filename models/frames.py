"""pandas, imported when the first table is made or asked for: it takes a third of a second."""

from typing import TYPE_CHECKING

import lazy_loader

if TYPE_CHECKING:
    import pandas as pd
else:
    pd = lazy_loader.load("pandas")

__all__ = ["pd"]
