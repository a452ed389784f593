"""Where the two-degree-of-freedom model may be trusted: measured maps, and limits drawn from them."""

from .campaign import CampaignProgress, measure_all, packed
from .extent import FULL, QUICK, Extent
from .limits import Limit, limits_of
from .motions import ensemble_names, source_of
from .parts import PARTS

__all__ = [
    "FULL",
    "PARTS",
    "QUICK",
    "CampaignProgress",
    "Extent",
    "Limit",
    "ensemble_names",
    "limits_of",
    "measure_all",
    "packed",
    "source_of",
]
