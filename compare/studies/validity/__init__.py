"""Where the two-degree-of-freedom model may be trusted: measured maps, and limits drawn from them."""

from .extent import FULL, QUICK, Extent, Ring
from .limits import limits_of
from .parts import PARTS
from .study import KIND, Validity, manifest_of, measure_validity, read_validity

__all__ = [
    "FULL",
    "KIND",
    "PARTS",
    "QUICK",
    "Extent",
    "Ring",
    "Validity",
    "limits_of",
    "manifest_of",
    "measure_validity",
    "read_validity",
]
