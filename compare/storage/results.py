"""Results: the common base of the values that studies return, with save, load and display."""

from __future__ import annotations

import dataclasses
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, ClassVar, Self, cast

from rockwobble.models import plain_json
from rockwobble.models.finding import Findings
from rockwobble.models.plain_json import Facts
from rockwobble.models.shown import Shown, brief

from .claim import claim_on
from .manifest import Manifest, Number, Stored, read_results, with_provenance, write_results

if TYPE_CHECKING:
    import pandas as pd


@dataclass(frozen=True, kw_only=True, eq=False, repr=False)
class Results(Shown):
    """Results of a study; a subclass states its kind by `class Ensemble(Results, kind="ensemble")`.

    Attributes
    ----------
    tables : mapping of str to DataFrame
        A table is an attribute, too: `found.members` is `found.tables["members"]`.
    facts : mapping
        What the tables do not hold: numbers, texts, lists and mappings alone, as `plain_json.plain` makes
        them. "inputs" is the hash of all that the results depend on, "seed" that of whatever random numbers
        were drawn.
    manifest : Manifest or None
        What made results that were loaded, or are about to be saved.
    """

    kind: ClassVar[str]
    findings_file: ClassVar[str]
    tables: Mapping[str, pd.DataFrame]
    facts: Facts
    manifest: Manifest | None = None

    def __init_subclass__(cls, *, kind: str, findings_file: str = "") -> None:
        cls.kind, cls.findings_file = kind, findings_file or f"{kind}.json"

    def __getattr__(self, name: str) -> pd.DataFrame:
        # other names alone: a copy or a pickle asks for fields before they exist
        if name.startswith("_") or name in ("tables", "facts", "manifest") or name not in self.tables:
            raise AttributeError(f"{type(self).__name__} has no attribute {name!r}")
        return self.tables[name]

    def __dir__(self) -> list[str]:
        return sorted({*super().__dir__(), *self.tables})

    def headline(self) -> Mapping[str, Number]:
        """Main numbers, by name."""
        return {}

    def _main_facts(self) -> Mapping[str, str]:
        return {name: brief(value) for name, value in self.headline().items()}

    def findings(self) -> Findings:
        """Findings of the results, in order of weight: see `rockwobble.models.finding`."""
        return Findings()

    def sheets(self) -> Mapping[str, bytes]:
        """Files of data besides the tables, by name, such as tables as CSV."""
        return {}

    def made_by(self, command: str = "") -> Self:
        """Results with the manifest of this machine and version, and of the `command`."""
        facts = self.facts
        manifest = Manifest(
            kind=self.kind,
            inputs=str(facts.get("inputs", "")),
            command=command,
            versions=facts.get("versions", {}),
            seeds={"seed": int(facts["seed"])} if "seed" in facts else {},
            headline=dict(self.headline()),
            about=dict(self._about()),
        )
        return dataclasses.replace(self, manifest=with_provenance(manifest))

    def _about(self) -> Mapping[str, object]:
        """Facts for the manifest."""
        return self.facts

    def save(self, folder: str | Path, *, pages: Mapping[str, bytes] | None = None) -> None:
        """Write tables, facts, findings (`findings_file`) and manifest to `folder`: whole or not at all.

        Parameters
        ----------
        folder : str or Path
        pages : mapping, optional
            Content of what was drawn of the results, by name of the file.

        Raises
        ------
        ValueError
            If the folder cannot be written.
        TypeError
            If a fact would be another value when it is loaded.
        """
        if changed := plain_json.first_not_plain(self.facts, "facts"):
            raise TypeError(
                f"{self.kind} must have facts that plain_json.plain does not change, got {changed}"
            )
        manifest = cast("Manifest", self.manifest or self.made_by().manifest)
        if claim := claim_on(folder):
            manifest = dataclasses.replace(manifest, plan=claim.plan)
        findings = self.findings()
        said = {self.findings_file: findings.to_json(self.kind)} if findings else {}
        write_results(folder, manifest, self.tables, files={**self.sheets(), **said}, pages=pages)

    @classmethod
    def load(cls, folder: str | Path) -> Self:
        """Results of this kind from `folder`, as saved; nothing runs.

        Raises
        ------
        ValueError
            If there are none, or a file is missing or damaged: the first such file is named.
        """
        return cls.of_stored(read_results(folder, cls.kind))

    @classmethod
    def of_stored(cls, stored: Stored) -> Self:
        """Results from files that are all undamaged."""
        return cls(tables=stored.tables(), facts=stored.manifest.about, manifest=stored.manifest)
