"""Where the two-degree-of-freedom model may be trusted: measured maps, and limits drawn from them."""

from .extent import FULL, QUICK, Extent, Ring
from .limits import limits_of
from .parts import PARTS
from .study import KIND, Validity, measure_all, read_validity, validity_of

__all__ = [
    "FULL",
    "KIND",
    "PARTS",
    "QUICK",
    "Extent",
    "Ring",
    "Validity",
    "limits_of",
    "measure_all",
    "read_validity",
    "validity_of",
]
