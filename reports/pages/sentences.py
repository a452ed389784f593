"""Sentences and pieces of pages from templates, and numbers as sentences have them."""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import TYPE_CHECKING

from rockwobble.models.case import REDUCED

from .cases import conditions, source_lines
from .diagnostics import warnings

if TYPE_CHECKING:
    import jinja2

_SUPERSCRIPTS = str.maketrans("-0123456789", "⁻⁰¹²³⁴⁵⁶⁷⁸⁹")


def fragment(template: str, **values: object) -> str:
    """Return a piece of a page, in which values are text and no markup."""
    return environment(autoescape=True).get_template(template).render(**values)


def seconds(value: float) -> str:
    """Return a time with as many digits as say something."""
    return f"{value:.2f} s" if value < 1.0 else f"{value:.1f} s"


def small(value: float) -> str:
    """Return a positive number with one digit, as a power of ten where it is small."""
    if value >= 1e-3 or value <= 0.0:
        return f"{value:.1g}"
    digit, exponent = f"{value:.0e}".split("e")
    # spaces that do not break
    return f"{digit}\u00a0×\u00a010{str(int(exponent)).translate(_SUPERSCRIPTS)}"


def the(label: str, engine: str) -> str:
    """Return the label of a run of an engine, or of a reduced model, as a sentence names it."""
    return f"the {label}" if engine == REDUCED else label


# filters of templates besides those of jinja2
_FILTERS = {
    "degrees": math.degrees,
    "warnings": warnings,
    "conditions": conditions,
    "sources": source_lines,
}


def environment(autoescape: bool | Callable[[str | None], bool] = False) -> jinja2.Environment:
    """Environment of the templates."""
    import jinja2

    found = jinja2.Environment(
        loader=jinja2.PackageLoader("rockwobble.reports.pages", "templates"),
        undefined=jinja2.StrictUndefined,
        trim_blocks=True,
        lstrip_blocks=True,
        autoescape=autoescape,
    )
    found.filters |= _FILTERS
    found.tests["known"] = math.isfinite
    return found
