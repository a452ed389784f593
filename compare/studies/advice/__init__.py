"""What to make of one case: which of its results to trust, and what the support must supply."""

from .advice import Advice
from .demands import Demands, demands_of
from .drive import advise
from .grades import Trust, overall, trust_of
from .planar import PlanarView, planar_view
from .scales import ScaleScan, scan_scales
from .spread import Spread, spread_of_starts
from .verification import Verification

__all__ = [
    "Advice",
    "Demands",
    "PlanarView",
    "ScaleScan",
    "Spread",
    "Trust",
    "Verification",
    "advise",
    "demands_of",
    "overall",
    "planar_view",
    "scan_scales",
    "spread_of_starts",
    "trust_of",
]
