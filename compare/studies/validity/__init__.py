"""Where the two-degree-of-freedom model may be trusted: measured maps, and limits drawn from them."""

from .campaign import CampaignProgress, measure_all
from .extent import FULL, QUICK, Extent
from .limits import Limit, limits_of
from .parts import PARTS
from .store import Validity, planned, read_validity, validity_now, validity_tables

__all__ = [
    "FULL",
    "PARTS",
    "QUICK",
    "CampaignProgress",
    "Extent",
    "Limit",
    "Validity",
    "limits_of",
    "measure_all",
    "planned",
    "read_validity",
    "validity_now",
    "validity_tables",
]
