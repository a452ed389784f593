"""Names of the studies at the top, from the registry; without Sphinx, which the tests may lack."""

from __future__ import annotations

import rockwobble
from rockwobble import compare
from rockwobble.reports.registry import COMMANDS

GROUP = "many"


def public_studies() -> dict[str, tuple[str, str]]:
    """Return the full names of function and class of each study of the group, by its name at the top."""
    found = {}
    for name, entry in COMMANDS.items():
        if entry.group == GROUP and name in rockwobble.__all__:
            made = entry.results_class()
            function = f"rockwobble.compare.{name}" if name in compare.__all__ else f"rockwobble.{name}"
            public = made.__name__ in compare.__all__
            module = "rockwobble.compare" if public else made.__module__
            found[name] = function, f"{module}.{made.__name__}"
    return found
