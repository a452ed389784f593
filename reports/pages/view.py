"""The page that plays one case of a comparison in three dimensions."""

from __future__ import annotations

from rockwobble.compare.comparison.result import View

from ..figures.case_view import case_views
from ..figures.playback import playback, require_motion
from .cases import case_lines
from .comparison import headline, run_diagnostics
from .page import Page, fragment


def page_of(results: View) -> Page:
    """Page of a view.

    Raises
    ------
    ValueError
        If nothing moves.
    """
    (view,) = case_views(results.comparison)
    require_motion(view.case.name, results.comparison.traces.values())
    spec = playback(view)
    return Page(
        name="view",
        template="comparison/view",
        values={
            "name": view.case.name,
            "headline": headline(results.comparison.findings()),
            "diagnostics": run_diagnostics(view),
            "lines": case_lines(view.case),
            "about": results.manifest,
        },
        blocks={"player": fragment("comparison/player.html.j2", name="player", spec=spec)},
        outputs=["html"],  # nothing to see without the player
    )
