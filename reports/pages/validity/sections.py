"""The report as sections: a limit, and the pictures that it is drawn from."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass

from rockwobble.compare.studies.validity.limits import (
    Limit,
    Tables,
    couple,
    distribution,
    friction,
    horizon,
    loss_of_contact,
    model_form,
    peak_tilt,
    real_recess,
    soft_contact,
    vertical,
)

from ...figures.picture import Picture
from . import lines
from .maps import free_maps, shaken_maps


@dataclass(frozen=True, slots=True, kw_only=True)
class Section:
    """One limit and what it rests on."""

    limit: Limit
    pictures: Sequence[Picture]


def sections_of(tables: Tables) -> list[Section]:
    """Return the sections in the order of the report, those that matter most first."""
    free, shaken = free_maps(tables["free_response"]), shaken_maps(tables["shaking"])
    found: list[tuple[Callable[[Tables], Limit], Sequence[Picture]]] = [
        (peak_tilt, [shaken["flat"], shaken["twin"]]),
        (distribution, lines.distribution_pictures(tables["statistics"])),
        (horizon, [lines.horizon_picture(tables["following"])]),
        (model_form, [free["turn"], free["period"], lines.verification_picture(tables["verification"])]),
        (friction, [free["friction"], shaken["friction"], lines.slip_picture(tables["slip"])]),
        (loss_of_contact, [shaken["normal"]]),
        (couple, [shaken["couple"]]),
        (real_recess, lines.ring_pictures(tables["real_recess"])),
        (soft_contact, lines.contact_pictures(tables["contact"])),
        (vertical, [shaken["vertical"]]),
    ]
    return [Section(limit=limit(tables), pictures=tuple(pictures)) for limit, pictures in found]
