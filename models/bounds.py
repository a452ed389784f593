"""Bounds on differences of motions: end of an agreement, and limits that a suite sets for its runs."""

from __future__ import annotations

import math
from dataclasses import dataclass, fields

from .number_checks import require_one_of, require_positive
from .shown import CompactRepr
from .support import MODELLED

# tilt difference that ends an agreement [alpha]
AGREEMENT = 0.01
# tilt below which the base counts as closed, without demands [alpha]. The rim has lifted by two thousandths
# of alpha b or less, which ground and joint absorb before they meet the edge of a rigid body
CLOSED_TILT = 1e-3
# tilt at which the side lies on the ground: the end and the peak of a run that overturns [rad]
OVERTURNED_TILT = 0.5 * math.pi
REFERENCES = ("own", *MODELLED)


@dataclass(frozen=True, slots=True, kw_only=True, repr=False)
class Bounds(CompactRepr):
    """Bounds on columns of the summary of a comparison; None asks nothing.

    Parameters
    ----------
    tilt_rms, peak_tilt_difference : float, optional
        At most, in alpha.
    tilt_rms_relative, energy_loss : float, optional
        At most [-].
    contact_rms, residual_displacement : float, optional
        At most, in b.
    turn_difference, residual_twist : float, optional
        At most [deg].
    uplift_time_difference : float, optional
        At most [s].
    agreement_time : float, optional
        At least [s], unless the traces agree to the end of the run.
    reference : {"own", "recess", "flat"}
        Reduced model that each run is compared with; "own": that of its support.

    Raises
    ------
    ValueError
        If a bound is not positive, or the reference is unknown.

    Examples
    --------
    >>> Bounds(tilt_rms=1e-3).as_dict()
    {'tilt_rms': 0.001}
    """

    tilt_rms: float | None = None
    tilt_rms_relative: float | None = None
    peak_tilt_difference: float | None = None
    contact_rms: float | None = None
    turn_difference: float | None = None
    uplift_time_difference: float | None = None
    residual_displacement: float | None = None
    residual_twist: float | None = None
    energy_loss: float | None = None
    agreement_time: float | None = None
    reference: str = "own"

    def __post_init__(self) -> None:
        for name, value in self.as_dict().items():
            object.__setattr__(self, name, require_positive(name, value, ""))
        require_one_of("reference", self.reference, REFERENCES)

    def as_dict(self) -> dict[str, float]:
        """Bounds other than None, by column."""
        names = (field.name for field in fields(self) if field.name != "reference")
        return {name: value for name in names if (value := getattr(self, name)) is not None}
