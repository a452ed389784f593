"""All parts of the report, in the order in which it shows them."""

from __future__ import annotations

from . import (
    contact,
    following,
    free_response,
    peaks,
    records,
    rings,
    slip,
    verification,
)
from .part import Part

PARTS: tuple[Part, ...] = (
    free_response.PART,
    verification.PART,
    peaks.PART,
    slip.PART,
    rings.PART,
    contact.PART,
    following.PART,
    records.PART,
)


def part_named(name: str) -> Part:
    """Return a part by its name."""
    return next(part for part in PARTS if part.name == name)
