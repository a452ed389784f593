"""Where the two-degree-of-freedom model may be trusted: measured maps, and limits drawn from them."""

from .campaign import CampaignProgress, measure_all, packed
from .extent import FULL, QUICK, Extent
from .limits import Limit, limits_of
from .motions import source_of_records
from .parts import PARTS

__all__ = [
    "FULL",
    "PARTS",
    "QUICK",
    "CampaignProgress",
    "Extent",
    "Limit",
    "limits_of",
    "measure_all",
    "packed",
    "source_of_records",
]
