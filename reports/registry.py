"""Registry of commands and of the results that they write.

An entry is found by its name: its page is `page_of` of `pages/NAME.py`, its figures are `pictures` of
`figures/NAME.py`, its command is the function NAME in the module of its group in `cli`, and its results state
NAME as their kind. What is called otherwise says so. Everything is imported when it is asked for: a command
must not wait for the imports of the others.
"""

from __future__ import annotations

import importlib
from collections.abc import Mapping
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from rockwobble.compare.storage.results import Results
    from rockwobble.studies.study import Study

# heading in the help of the command line for each module of commands, in the order of the headings
HEADINGS: Mapping[str, str] = {
    "case": "One problem",
    "explore": "One problem",
    "batch": "Many problems",
    "results": "Results",
    "verification": "Trust",
    "published": "Published studies",
}


@dataclass(frozen=True, slots=True, kw_only=True)
class Entry:
    """A command, the results that it writes, or both.

    Attributes
    ----------
    name : str
        Name of the page and the figures.
    group : str
        Module of `cli` with the command, a key of `HEADINGS`; empty without a command.
    results : str
        Class of the results below `rockwobble`, such as "studies.ensemble.Ensemble"; empty where the
        command writes none.
    study : str
        Class of a `Study` whose fields are its options, in place of a module with its command; then `results`
        is what it yields, and page and figures are those of its tables where there are none.
    command, kind : str
        Name of the command, and kind of the results. Default: the name.
    """

    name: str
    group: str = ""
    results: str = ""
    study: str = ""
    command: str = ""
    kind: str = ""

    def __post_init__(self) -> None:
        for field, default in (("command", self.name), ("kind", self.name)):
            object.__setattr__(self, field, getattr(self, field) or default)

    def results_class(self) -> type[Results]:
        """Class of the results."""
        cls: type[Results] = self.study_class().yields if self.study else _named(self.results)
        return cls

    def study_class(self) -> type[Study[Any, Any]]:
        """Class of the study."""
        cls: type[Study[Any, Any]] = _named(self.study)
        return cls


def _named(path: str) -> Any:
    module, _, name = path.rpartition(".")
    return getattr(importlib.import_module(f"rockwobble.{module}"), name)


# entries in the order of the help
ENTRIES = (
    Entry(name="comparison", command="compare", group="case", results="compare.comparison.result.Comparison"),
    Entry(name="advice", command="advise", group="case", results="studies.advice.advice.Advice"),
    Entry(name="run", command="simulate", group="case", results="studies.single_run.SingleRun"),
    Entry(name="explore", group="explore"),
    Entry(
        name="spectrum",
        kind="overturning spectrum",
        group="batch",
        results="studies.spectrum.study.OverturningSpectrum",
    ),
    Entry(name="sweep", group="batch", results="studies.sweep.Sweep"),
    Entry(name="ensemble", group="batch", results="studies.ensemble.Ensemble"),
    Entry(name="fragility", group="batch", results="studies.fragility.study.Fragility"),
    Entry(name="show", group="results"),
    Entry(name="report", group="results"),
    Entry(name="view", group="results", results="compare.comparison.result.View"),
    Entry(name="check", group="verification", results="compare.check.groups.Checks"),
    Entry(name="certify", group="verification"),
    Entry(name="verify", group="verification"),
    Entry(name="validity", group="published", results="studies.validity.study.Validity"),
)
COMMANDS: Mapping[str, Entry] = {entry.command: entry for entry in ENTRIES if entry.group}
KINDS: Mapping[str, Entry] = {entry.kind: entry for entry in ENTRIES if entry.results or entry.study}
