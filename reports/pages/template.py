"""How pages are made from templates: one set of rules for all of them."""

from __future__ import annotations

from typing import Any

PLOT_CONFIG = {"responsive": True, "displaylogo": False, "modeBarButtonsToRemove": ["select2d", "lasso2d"]}


def render(template: str, **values: Any) -> str:
    """Return a page that needs nothing else: `plotly_js` is in it wherever the template asks for it."""
    import jinja2
    from plotly.offline import get_plotlyjs

    environment = jinja2.Environment(
        loader=jinja2.PackageLoader("rockwobble.reports.pages", "templates"),
        autoescape=True,
        undefined=jinja2.StrictUndefined,
        trim_blocks=True,
        lstrip_blocks=True,
    )
    return environment.get_template(template).render(plotly_js=get_plotlyjs(), **values)
