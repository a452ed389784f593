"""Distance of the contact points."""

from __future__ import annotations

import numpy as np

from .pair import Pair
from .tilt import rms

# share of the reference peak below which a contact point is too poorly defined to compare
TILTED = 0.05


def contact_rms(pair: Pair) -> float:
    """Return the RMS distance of the two contact points, in units of b.

    Counted where both tilts exceed 5 % of the reference's peak: near upright the whole base is
    close to the ground, and where the rim touches says nothing.

    Returns
    -------
    float
        NaN where no sample counts.
    """
    least = TILTED * float(pair.reference_tilt.max())
    distance = np.linalg.norm(pair.contact_point - pair.reference_contact_point, axis=1)
    counts = (pair.tilt > least) & (pair.reference_tilt > least) & np.isfinite(distance)
    return rms(distance[counts]) / pair.cylinder.base_radius
