"""One quantity of a comparison with an external trajectory: size, bound, and from when it differs."""

from __future__ import annotations

import math
from dataclasses import dataclass


@dataclass(frozen=True, slots=True, kw_only=True)
class Part:
    """One quantity, compared.

    Parameters
    ----------
    first_time : float
        The first difference above the bound, in the time of the run [s]; NaN where it does not differ.
    size : float
        Root mean square of the difference; alpha for the tilt, rad for the azimuth, b for the path.
    bound : float
        What the size may be, in its unit; of the tilt, what each difference may be.
    """

    first_time: float
    size: float
    bound: float

    @property
    def differs(self) -> bool:
        """Whether there is a difference above the bound."""
        return math.isfinite(self.first_time)
