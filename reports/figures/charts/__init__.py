"""Interactive figures of a comparison, one concept a module."""

from .budget import budget_bars, budget_charts
from .contact import azimuth_chart, drift_charts
from .excitation import excitation_chart
from .orbits import orbit_charts
from .residuals import residual_chart
from .tilt import difference_chart, tilt_chart
from .turns import turn_chart

__all__ = [
    "azimuth_chart",
    "budget_bars",
    "budget_charts",
    "difference_chart",
    "drift_charts",
    "excitation_chart",
    "orbit_charts",
    "residual_chart",
    "tilt_chart",
    "turn_chart",
]
