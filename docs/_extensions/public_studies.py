"""Names of the studies at the top, from the registry; without Sphinx, which the tests may lack."""

from __future__ import annotations

import rockwobble
from rockwobble import studies
from rockwobble.reports.registry import COMMANDS

GROUP = "batch"


def public_studies() -> dict[str, tuple[str, str]]:
    """Return the full names of function and class of each study of the group, by its name at the top."""
    found = {}
    for name, entry in COMMANDS.items():
        if entry.group == GROUP and name in rockwobble.__all__:
            made = entry.results_class()
            public = made.__name__ in studies.__all__
            module = "rockwobble.studies" if public else made.__module__
            found[name] = f"rockwobble.{name}", f"{module}.{made.__name__}"
    return found
