"""Comparison: results of runs beside reference models, or beside one another."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from typing import Any, Self

import numpy as np

from rockwobble.models import Case, Run, Trace, plain_json
from rockwobble.models.finding import Findings
from rockwobble.models.frames import pd
from rockwobble.models.number_checks import require_one_of
from rockwobble.models.plain_json import plain
from rockwobble.models.support import EXTERNAL
from rockwobble.models.trace_file import case_facts, case_from_plain

from ..external.verdict import VERDICT_COLUMNS, lists_in_words, lists_of_file
from ..metrics.pair import first_unresolved_pass, start_of
from ..metrics.statistics import value_if_enough
from ..runs.execution import case_inputs
from ..storage.manifest import Number, Stored
from ..storage.provenance import fingerprint
from ..storage.results import Results
from .budget import BUDGET_COLUMNS, ErrorBudget
from .findings import case_findings, causes_of, overview, parts_finding
from .summary import KEYS, SUMMARY_COLUMNS, agreement_matrix

_FACTS = "comparison.json"
_SEPARATOR = "\n"  # names of cases and runs are single lines, so none contains it
Key = tuple[str, str]
BudgetKey = tuple[str, str, str]


@dataclass(frozen=True, kw_only=True, eq=False, repr=False)
class Comparison(Results, kind="comparison", findings_file="report.json"):
    """Runs compared with reference models, or with one another.

    Attributes
    ----------
    tables : mapping of str to DataFrame
        summary: a row for each run and reference, see `SUMMARY_COLUMNS`; samples of all `traces`, their
        passes, excitation: the ground motions. Where there are any, budget: the samples of `budgets`, and
        external: verdicts on external trajectories, whose lists are tuples.
    facts : mapping
        inputs, versions, until, and of cases, traces and budgets what the tables do not hold.

    Examples
    --------
    >>> import rockwobble as rw
    >>> pier = rw.Cylinder(semidiagonal=6.0, tan_alpha=0.2)
    >>> release = rw.InitialState(0.5 * pier.alpha, rolling_rate=0.5)
    >>> case = rw.Case(pier, initial=release, duration=4.0)
    >>> comparison = rw.comparison(case, runs=[rw.Run(None, "flat")], workers=1)
    >>> comparison.summary[["run", "reference", "diverged"]].to_dict("records")[0]
    {'run': 'flat-ground model', 'reference': 'recess model', 'diverged': False}
    >>> sorted(comparison.traces)
    [('free response', 'flat-ground model'), ('free response', 'recess model')]
    """

    @property
    def versions(self) -> Mapping[str, str]:
        """Version of each package and engine in use."""
        return dict(self.facts["versions"])

    @property
    def until(self) -> float | None:
        """End of the window of the RMS columns, in the time of the run [s]; None is the whole run."""
        until: float | None = self.facts["until"]
        return until

    @cached_property
    def cases(self) -> Mapping[str, Case]:
        """Case of each name."""
        excitation = dict(iter(self.tables["excitation"].groupby("case", sort=False)))
        return {name: _case(given, excitation.get(name)) for name, given in self.facts["cases"].items()}

    @cached_property
    def traces(self) -> Mapping[Key, Trace]:
        """Trace of each run and reference, such as ("El Centro 1940", "mujoco recess").

        One whose process died has no samples.
        """
        samples = self.tables["traces"]
        tables, none = dict(iter(samples.groupby(["case", "run"], sort=False))), samples.iloc[:0]
        keys = {key: tuple(key.split(_SEPARATOR)) for key in self.facts["traces"]}
        return {
            (case, run): Trace.from_plain(
                self.facts["traces"][key], tables.get((case, run), none), self.cases[case]
            )
            for key, (case, run) in keys.items()
        }

    @cached_property
    def budgets(self) -> Mapping[BudgetKey, ErrorBudget]:
        """Error budget for each (case, run, reference), if requested."""
        entries = {}
        for key, facts in self.facts["budgets"].items():
            case, run, reference = key.split(_SEPARATOR)
            samples = self.tables["budget"]
            chosen = (samples["case"] == case) & (samples["run"] == run) & (samples["reference"] == reference)
            columns = {name: column.to_numpy() for name, column in samples[chosen].items()}
            start = start_of(self.traces[case, reference])
            entries[case, run, reference] = ErrorBudget(
                **{name: columns[name] for name in ErrorBudget.__dataclass_fields__ if name in columns},
                covered=facts["covered"],
                steps=tuple(facts["steps"]),
                order=facts["order"],
                unresolved=first_unresolved_pass(self.traces[case, run], start=start),
            )
        return entries

    @cached_property
    def budget_rms(self) -> pd.DataFrame:
        """RMS of the parts of each budget: `BUDGET_COLUMNS` of case, run and reference."""
        rows = [[*key, *budget.columns().values()] for key, budget in self.budgets.items()]
        return pd.DataFrame(rows, columns=[*KEYS, *BUDGET_COLUMNS])

    @cached_property
    def matrix(self) -> pd.DataFrame:
        """Differences of each motion from every other on its support, where two engines have run.

        The columns are those of `MATRIX_COLUMNS`.
        """
        return agreement_matrix(self.cases, self.traces, until=self.until)

    @cached_property
    def causes(self) -> Mapping[str, Sequence[str]]:
        """Cause of the divergence in each row of a case, "" without one: see `findings.cause`."""
        return {
            name: causes_of(case, self.rows(name), self._traces(name)) for name, case in self.cases.items()
        }

    def findings(self) -> Findings:
        """Findings of the comparison: an overview of many cases, then those of each case (with `runs`)."""
        if len(self.cases) == 1:
            return self.case_findings(*self.cases)
        each = (replace(one, runs=name) for name in self.cases for one in self.case_findings(name))
        return Findings([*overview(self.summary, self.budget_rms), *each])

    def parts_findings(self, run: Run, reference: Run) -> Findings:
        """Findings of the parts of the difference between one run of a single case and one reference."""
        labels = {trace.run: label for (_, label), trace in self.traces.items()}
        pair = labels[run], labels.get(reference)
        budget = next((each for key, each in self.budgets.items() if key[1:] == pair), None)
        not_split = (each for each in self.findings() if each.key == "comparison.not_split")
        return Findings([parts_finding(budget, str(pair[1])), *not_split])

    def case_findings(self, name: str) -> Findings:
        """Findings of one case."""
        budgets = self.budget_rms[self.budget_rms["case"] == name]
        return Findings(
            case_findings(self.cases[name], self.rows(name), self._traces(name), self.causes[name], budgets)
        )

    def rows(self, name: str) -> pd.DataFrame:
        """Rows of the summary of a case, with the verdicts on external trajectories where there are any."""
        rows = self.summary[self.summary["case"] == name]
        return rows.merge(self.external, how="left", on=KEYS) if "external" in self.tables else rows

    def _traces(self, name: str) -> Mapping[str, Trace]:
        return {label: trace for (case, label), trace in self.traces.items() if case == name}

    def of_case(self, name: str) -> Comparison:
        """Part of the comparison on one case.

        Raises
        ------
        ValueError
            If there is no such case.
        """
        require_one_of("case", name, self.facts["cases"])

        def facts_of(part: str) -> Mapping[str, object]:
            facts: Mapping[str, object] = self.facts[part]
            return {key: fact for key, fact in facts.items() if key.split(_SEPARATOR)[0] == name}

        return Comparison(
            tables={
                table: rows[rows["case"] == name].reset_index(drop=True)
                for table, rows in self.tables.items()
            },
            facts={**self.facts, **{part: facts_of(part) for part in ("cases", "traces", "budgets")}},
        )

    def headline(self) -> Mapping[str, Number]:
        """Numbers of cases, rows and divergences, and the agreement time."""
        rows = self.summary
        agreed = rows["agreement_time"]
        median = value_if_enough(agreed.median(), len(agreed))
        return {
            "cases": len(self.facts["cases"]),
            "rows": len(rows),
            "diverged": int(rows["diverged"].sum()),
            "failed": int((rows["outcome"] == "failed").sum()),
            "median agreement time [s]": float(median) if math.isfinite(median) else None,
        }

    def _about(self) -> Mapping[str, object]:
        """No facts here: those of all runs have a file of their own."""
        return {}

    def sheets(self) -> Mapping[str, bytes]:
        """Facts, and the small tables as CSV."""
        sheets = {"summary": self.summary, "matrix": self.matrix, "budget": self.budget_rms}
        if "external" in self.tables:
            sheets["external"] = lists_in_words(self.external)
        return {_FACTS: (plain_json.dumps(self.facts, indent=1) + "\n").encode()} | {
            f"{name}.csv": table.to_csv(index=False).encode() for name, table in sheets.items() if len(table)
        }

    @classmethod
    def of_stored(cls, stored: Stored) -> Self:
        """Comparison from files that are all undamaged.

        Raises
        ------
        ValueError
            If they cannot be read.
        """
        try:
            comparison = cls(
                tables=_of_today(stored.tables(), stored.manifest.versions.get("rockwobble", "(not stated)")),
                facts={"inputs": stored.manifest.inputs} | plain_json.loads(stored.content(_FACTS)),
                manifest=stored.manifest,
            )
            # loaded to show that each is undamaged
            _ = comparison.budgets if comparison.facts["budgets"] else comparison.traces
        except (ValueError, KeyError) as error:
            why = str(error).partition("\n")[0]
            raise ValueError(f"{stored.folder} holds a comparison that cannot be read: {why}") from None
        return comparison

    def _repr_html_(self) -> str:
        names = ["case", "run", "reference", "outcome", "peak_tilt", "tilt_rms_relative", "agreement_time"]
        return str(self.summary[[*names, "diverged", "diagnostics"]].to_html(index=False))


@dataclass(frozen=True, kw_only=True, eq=False, repr=False)
class View(Comparison, kind="view"):
    """Motion for the player, with tables and facts of the comparison of one case.

    Examples
    --------
    >>> import rockwobble as rw
    >>> pier = rw.Cylinder(semidiagonal=6.0, tan_alpha=0.2)
    >>> case = rw.Case(pier, initial=rw.InitialState(0.5 * pier.alpha), duration=1.0, name="release")
    >>> found = rw.comparison(case, runs=[rw.Run(None, "flat")], workers=1)
    >>> list(View.of(found, "release").comparison.cases)
    ['release']
    """

    @classmethod
    def of(cls, comparison: Comparison, name: str) -> Self:
        """View of one case of a comparison.

        Raises
        ------
        ValueError
            If there is no such case.
        """
        part = comparison.of_case(name)
        return cls(tables=part.tables, facts=part.facts)

    @cached_property
    def comparison(self) -> Comparison:
        """Comparison of the case, which has the findings."""
        return Comparison(tables=self.tables, facts=self.facts, manifest=self.manifest)

    def findings(self) -> Findings:
        """No findings of its own."""
        return Findings()


def comparison_of(
    summary: pd.DataFrame,
    *,
    cases: Mapping[str, Case],
    traces: Mapping[Key, Trace],
    versions: Mapping[str, str],
    until: float | None = None,
    budgets: Mapping[BudgetKey, ErrorBudget] | None = None,
    external: pd.DataFrame | None = None,
) -> Comparison:
    """Comparison of these traces, with their summary.

    Parameters
    ----------
    summary : DataFrame
    cases, traces, budgets : mapping
        As those of `Comparison`.
    versions : mapping
    until : float, optional
    external : DataFrame, optional
    """
    known = {key: trace for key, trace in traces.items() if len(trace.time)}  # the others died
    tables = {
        "summary": summary,
        "traces": _stack({key: trace.to_frame() for key, trace in known.items()}, "case", "run"),
        "passes": _stack({key: trace.passes for key, trace in known.items()}, "case", "run"),
        "excitation": _excitation(cases),
    }
    if external is not None and len(external):
        tables["external"] = external
    if budgets:
        parts = {key: budget.to_frame() for key, budget in budgets.items()}
        tables["budget"] = _stack(parts, "case", "run", "reference")
    facts = {
        "inputs": fingerprint([case_inputs(case) for case in cases.values()]),
        "versions": dict(versions),
        "until": until,
        "cases": {name: _facts_with_source(case) for name, case in cases.items()},
        "traces": {_SEPARATOR.join(key): trace.to_plain() for key, trace in traces.items()},
        "budgets": {
            _SEPARATOR.join(key): {"covered": each.covered, "steps": each.steps, "order": each.order}
            for key, each in (budgets or {}).items()
        },
    }
    return Comparison(tables=tables, facts=plain(facts))


def _of_today(tables: Mapping[str, pd.DataFrame], release: str) -> Mapping[str, pd.DataFrame]:
    """Tables of a folder in the present form: 0.3 had the verdicts in the summary, and fewer columns.

    Raises
    ------
    ValueError
        If they are of an older release.
    """
    summary = tables["summary"]
    texts = ("mode", "reference_mode", "error_source")
    numbers = (
        "displacement_difference",
        "error",
        *(f"largest_{each}_difference" for each in ("tilt", "contact", "turn")),
    )
    new = dict.fromkeys(texts, "") | dict.fromkeys(numbers, math.nan)
    if lacking := {*SUMMARY_COLUMNS} - {*summary, *new}:
        raise ValueError(f"its summary has no {min(lacking)}; the release that made it reads it, {release}")
    external = tables.get("external", summary[summary["support"] == EXTERNAL])
    summary = summary.assign(**{name: value for name, value in new.items() if name not in summary})
    today = {**tables, "summary": summary[list(SUMMARY_COLUMNS)]}
    if len(external):
        today["external"] = lists_of_file(external.reindex(columns=[*KEYS, *VERDICT_COLUMNS]))
    return today


def _facts_with_source(case: Case) -> Mapping[str, object]:
    """Facts of a case whose samples are in a table, sufficient to rebuild it."""
    facts, motion = case_facts(case), case.motion
    if motion is not None and motion.source:
        facts["motion"]["source"] = motion.source
    return facts


def _case(given: Mapping[str, Any], excitation: pd.DataFrame | None) -> Case:
    motion = given["motion"]
    if motion is not None and excitation is not None:
        samples = excitation[[f"acceleration_{axis}" for axis in motion["components"]]].to_numpy()
        motion = {
            "acceleration": samples,
            **{key: motion.get(key) for key in ("time_step", "name", "source")},
        }
    return case_from_plain({**given, "motion": motion})


def _excitation(cases: Mapping[str, Case]) -> pd.DataFrame:
    tables = []
    for name, case in cases.items():
        if case.motion is not None:
            a = case.motion.acceleration
            columns = {"case": name, "time": np.arange(len(a)) * case.motion.time_step}
            columns |= {f"acceleration_{axis}": a[:, i] for i, axis in enumerate("xyz"[: a.shape[1]])}
            tables.append(pd.DataFrame(columns))
    return pd.concat(tables, ignore_index=True) if tables else pd.DataFrame({"case": [], "time": []})


def _stack(tables: Mapping[Any, pd.DataFrame], *names: str) -> pd.DataFrame:
    """Tables one below the other, each with its key in the first columns."""
    if not tables:
        return pd.DataFrame(columns=list(names))
    table: pd.DataFrame = pd.concat(tables, names=list(names)).reset_index(list(names)).reset_index(drop=True)
    return table
