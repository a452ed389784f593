"""Values for the page that plays a comparison of one case: its words are in comparison/view.md.j2."""

from __future__ import annotations

from rockwobble.compare import Comparison
from rockwobble.compare.comparison.file import load_fields
from rockwobble.compare.storage.manifest import Manifest, Results

from ...figures.comparison.playback import playback
from ...figures.comparison.view import case_views
from ..page import Page
from ..words.cases import describe
from ..words.sentences import fragment
from .findings import finding_sentences

KIND = "view"


def view_page(comparison: Comparison, manifest: Manifest) -> Page:
    """Return the page of a comparison of one case.

    Raises
    ------
    ValueError
        If nothing moves.
    """
    (view,) = case_views(comparison)
    spec = playback(view)
    if spec is None:
        raise ValueError(f"there is nothing to play in {view.case.name!r}: the cylinder never uplifts")
    return Page(
        name="view",
        template="comparison/view",
        values={
            "name": view.case.name,
            "lines": describe(view.case),
            "findings": finding_sentences(view),
            "about": manifest,
        },
        blocks={"player": fragment("comparison/player.html.j2", name="player", spec=spec)},
        outputs=["html"],  # without the player there is nothing to see
    )


def stored_page(results: Results) -> Page:
    """Return the page of the view that is stored."""
    return view_page(Comparison(**load_fields(results)), results.manifest)
