"""Criteria of the validity study: which limits establish the model, and which contradict it."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Literal

from rockwobble.compare.metrics.statistics import MARGIN

from .limits import Numbers

Limits = Mapping[str, Numbers]
Verdict = Literal["contradicted", "established", "undecided"]


def model_verdict(limits: Limits) -> Verdict:
    """Return the verdict on the reduced model in an ideal recess, by an engine in one.

    It is contradicted where one release is that of another motion, or where the median ratio of the peaks at
    one point is known to be beyond the margin; established where the median is known to be within the margin
    at some point, and beyond it at none.
    """
    if limits["free_response"]["contradicted"] or limits["records"]["recess_beyond"]:
        return "contradicted"
    return "established" if limits["records"]["recess_within"] else "undecided"


def clearance_is_unconservative(limits: Limits) -> bool:
    """Whether one record in twenty tilts a cylinder in a recess with clearance more than the model says.

    False without such recesses, and of too few records to know.
    """
    return limits["records"].get("ring_95_largest", 0.0) > 1.0


def converges_by_record(limits: Limits) -> bool:
    """Whether runs in a recess with clearance have converged record by record.

    Nine in ten of them have the same peak at half the step, within the margin.
    """
    low, high = (limits["records"][name] for name in ("halved_05_least", "halved_95_largest"))
    return not (low < 1.0 / (1.0 + MARGIN) or high > 1.0 + MARGIN)
