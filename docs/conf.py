"""How the site is built: `python -m sphinx -W --keep-going -n docs docs/_build/html`."""

from __future__ import annotations

import re
import sys
import warnings
from importlib.metadata import version as version_of
from pathlib import Path

from docutils import nodes
from sphinx.application import Sphinx

from rockwobble.models import Cylinder
from rockwobble.reports.pages.explore import State, explore_page, standard_shakings

HERE = Path(__file__).parent
sys.path.insert(0, str(HERE / "_extensions"))
NOTEBOOKS = [f"notebooks/{path.stem}" for path in (HERE / "notebooks").glob("*.ipynb")]
_CITATION = (HERE.parent / "CITATION.cff").read_text(encoding="utf-8")

project = "rockwobble"
author = "The rockwobble developers"
copyright = f"{author}, MIT license"  # noqa: A001 - the name that Sphinx reads
version = release = version_of("rockwobble")

extensions = [
    "sphinx.ext.autodoc",
    "sphinx.ext.autosummary",
    "numpydoc",
    "myst_nb",
    "sphinx_design",
    "gallery",  # these six are in _extensions
    "mathml",
    "mapping_table",
    "command_help",
    "studies",
    "first_use",
]
exclude_patterns = ["_build", "_extensions", "figures", "scenes", "**.ipynb_checkpoints"]

myst_enable_extensions = ["amsmath", "attrs_block", "attrs_inline", "colon_fence", "deflist", "dollarmath"]
myst_heading_anchors = 3
nb_execution_mode = "force"
nb_execution_raise_on_error = True
# [s] a cell takes some seconds, the first of a model waits for the compiler, and a loaded machine is slower
nb_execution_timeout = 300
nb_merge_streams = True
# a figure is drawn once: SVG where the notebook gives it, a picture where not
nb_mime_priority_overrides = [("html", "image/svg+xml", 5)]

# a name is documented where a user imports it from
add_module_names = False
autodoc_member_order = "bysource"
autodoc_typehints = "none"  # numpydoc says them with shapes and units
autodoc_default_options = {"members": True}
autosummary_generate = False
numpydoc_show_class_members = False
default_role = "literal"
smartquotes_action = "qe"  # two dashes begin an option

html_theme = "pydata_sphinx_theme"
html_title = "rockwobble"
html_static_path = ["_static"]
html_css_files = ["site.css"]
html_math_renderer = "mathml"
html_show_sourcelink = False
# no list of sections where there is none, and the whole width where a table or code needs it
_PLAIN = ("start", "glossary", "other-software", "references", "citing", "guide/limits")
html_sidebars = {name: [] for name in _PLAIN}
toc_object_entries_show_parents = "hide"
html_context = {"default_mode": "auto"}
html_theme_options = {
    "logo": {"text": f"rockwobble {version}"},
    "header_links_before_dropdown": 6,  # the reference, too
    "navigation_depth": 2,
    "show_toc_level": 2,
    "secondary_sidebar_items": {"**": ["page-toc"], **{name: [] for name in (*NOTEBOOKS, "guide/limits")}},
    "footer_start": ["copyright"],
    "footer_end": [],
    "navbar_end": ["theme-switcher"],
    "search_as_you_type": False,
}
# the one place that knows the address of the repository is CITATION.cff; until it does, nothing links there
if found := re.search(r"^repository-code:\s*(\S+)", _CITATION, re.MULTILINE):
    place = {"name": "Repository", "url": found.group(1), "icon": "fa-brands fa-git"}
    html_theme_options["icon_links"] = [place]

# the debugger of the notebooks' kernel warns that its files are frozen; no notebook is debugged here
warnings.filterwarnings("ignore", message=".*frozen modules.*")


def setup(app: Sphinx) -> None:
    """Put the page of `rockwobble explore` beside the others; label the cells of stacked tables."""

    def write_explore(app: Sphinx) -> None:
        if app.builder.format == "html":
            pier = Cylinder(semidiagonal=6.0, tan_alpha=0.2)
            state = State(height=2.0 * pier.half_height, diameter=2.0 * pier.base_radius)
            page = explore_page(standard_shakings(), state)
            (Path(app.outdir) / "explore.html").write_text(page, encoding="utf-8")

    def label_cells(app: Sphinx, doctree: nodes.document) -> None:
        """Put its head before each cell of a table that a phone shows row by row."""
        for table in doctree.findall(nodes.table):
            if "stacked" not in table["classes"]:
                continue
            heads, *rows = ([*row.findall(nodes.entry)] for row in table.findall(nodes.row))
            for row in rows:
                for cell, head in zip(row[1:], heads[1:], strict=True):
                    for paragraph in [*cell.findall(nodes.paragraph)][:1]:
                        paragraph.insert(0, nodes.inline("", f"{head.astext()}: ", classes=["head-of-cell"]))

    app.connect("builder-inited", write_explore)
    app.connect("doctree-read", label_cells)
