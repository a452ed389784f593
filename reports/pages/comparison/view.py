"""The page that plays a comparison of one case: its words are in comparison/view.md.j2."""

from __future__ import annotations

from rockwobble.compare.comparison.comparison import View

from ...figures.comparison.playback import playback
from ...figures.comparison.view import case_views
from ..page import Page
from ..words.cases import describe
from ..words.sentences import fragment
from .findings import headline, notes


def page_of(found: View) -> Page:
    """Return the page of a comparison of one case.

    Raises
    ------
    ValueError
        If nothing moves.
    """
    (view,) = case_views(found)
    spec = playback(view)
    if spec is None:
        raise ValueError(f"there is nothing to play in {view.case.name!r}: the cylinder never uplifts")
    return Page(
        name="view",
        template="comparison/view",
        values={
            "name": view.case.name,
            "headline": headline(view.rows, view.case.length),
            "notes": notes(view),
            "lines": describe(view.case),
            "about": found.manifest,
        },
        blocks={"player": fragment("comparison/player.html.j2", name="player", spec=spec)},
        outputs=["html"],  # without the player there is nothing to see
    )
