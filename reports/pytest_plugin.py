"""Suites of cases as tests: pytest collects every NAME.suite.toml, each case and run as one item.

It works wherever rockwobble is installed; `pytest -p no:rockwobble` leaves it out. A repository that holds
its model of a structure, its records and its suites may look like this:

    my-bridge/
      pyproject.toml            # [project.optional-dependencies] test = ["pytest", "rockwobble"]
      tests/
        pier.suite.toml
        records/EW.AT2, NS.AT2
      .github/workflows/ci.yml  # pip install '.[test]', then pytest

with a suite (what it may hold is said in the docstring of `rockwobble.models.suites`):

    [bounds]                     # without this table: what the time step leaves, measured on each run
    tilt_rms = 2e-3              # alpha
    agreement_time = 10          # s, at least

    [[runs]]
    engine = ["mujoco", "pybullet"]

    [[cases]]
    name = "pier"
    cylinder = { base_radius = 1.2, height = 11.8 }
    motion = { x = "records/EW.AT2", y = "records/NS.AT2", scale = [1, 1.5] }
    duration = 20

`pytest tests/pier.suite.toml -k "scale 1.5"` runs a part. An item fails where a bound is exceeded, and then
names a likely cause where a second engine or step tells it, and what the difference is made of: model form,
numerics, and what stays unexplained. That repeats the run at finer steps; `--no-rockwobble-budget` leaves it
out. An engine that is not installed is skipped.

`pytest --rockwobble-certificate FILE` adds an item that fails where this installation changed since the
certificate was made (`rockwobble certify`).
"""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path
from typing import TYPE_CHECKING, Any

import pytest

import rockwobble as rw
import rockwobble.compare as rc

if TYPE_CHECKING:
    from _pytest._code.code import TerminalRepr, TracebackStyle

    from rockwobble.compare.check import Result
# copy of a constant of models.suites, whose import would slow every pytest run
ENDING = ".suite.toml"
_OPTION = "--no-rockwobble-budget"
_CERTIFICATE = "--rockwobble-certificate"


def pytest_addoption(parser: pytest.Parser) -> None:
    """Add the options of this plugin."""
    group = parser.getgroup("rockwobble")
    group.addoption(
        _OPTION,
        action="store_true",
        default=False,
        help="do not repeat a failed run of a suite at finer time steps to explain its difference",
    )
    group.addoption(
        _CERTIFICATE,
        type=Path,
        metavar="FILE",
        help="fail if this installation changed since the certificate was made",
    )


def pytest_collection_modifyitems(
    session: pytest.Session, config: pytest.Config, items: list[pytest.Item]
) -> None:
    """Add the item of the certificate."""
    path = config.getoption(_CERTIFICATE)
    if path is not None:
        items.append(CertificateItem.from_parent(session, name=path.name, certificate=path))


class CertificateItem(pytest.Item):
    """Check that this installation reproduces a certificate."""

    def __init__(self, *, certificate: Path, **common: Any) -> None:
        super().__init__(**common)
        self.certificate = certificate

    def runtest(self) -> None:
        """Repeat the fingerprint, and raise if it changed."""
        from rockwobble.compare.check.baseline import certificate_findings, verify
        from rockwobble.compare.check.verdict import read_certificate

        from .pages.wording import joined

        stated = read_certificate(self.certificate)
        verdict = verify(stated)
        text = joined(certificate_findings(stated, verdict))
        if verdict.exit_code:
            raise ChangedError(text)
        self.add_report_section("call", "certificate", text)

    def repr_failure(
        self, excinfo: pytest.ExceptionInfo[BaseException], style: TracebackStyle | None = None
    ) -> str | TerminalRepr:
        """Report of a change; other errors as pytest formats them."""
        if isinstance(excinfo.value, ChangedError | ValueError):
            return str(excinfo.value)
        return super().repr_failure(excinfo, style)

    def reportinfo(self) -> tuple[Path, int, str]:
        """Path, line and name in the head of a failure."""
        return self.certificate, 0, f"certificate {self.name}"


class ChangedError(Exception):
    """Error: the installation contradicts its certificate."""


def pytest_collect_file(file_path: Path, parent: pytest.Collector) -> SuiteFile | None:
    """Collect suite files."""
    if file_path.name.endswith(ENDING):
        suite_file: SuiteFile = SuiteFile.from_parent(parent, path=file_path)
        return suite_file
    return None


class SuiteFile(pytest.File):
    """A suite: one item for each case and run."""

    def collect(self) -> Iterator[SuiteItem]:
        """Yield the items."""
        from rockwobble.compare.runs.choice import run_labels, runs_here
        from rockwobble.multibody.engines.registry import engine_fault

        try:
            suite = rw.read_suite(self.path)
        except ValueError as error:
            raise self.CollectError(str(error)) from None
        runs = suite.runs or rc.default_runs(cases=suite.cases)
        here, _ = runs_here(runs)
        for case in suite.cases:
            for run, label in zip(runs, run_labels(runs), strict=True):
                item: SuiteItem = SuiteItem.from_parent(
                    self, name=f"{case.name}, {label}", suite=suite, case=case, run=run, label=label
                )
                if run not in here:
                    item.add_marker(pytest.mark.skip(reason=f"{run.engine} {engine_fault(run.engine_name)}"))
                yield item


class SuiteItem(pytest.Item):
    """One engine run of one case, compared with the reduced model."""

    def __init__(self, *, suite: rw.Suite, case: rw.Case, run: rw.Run, label: str, **common: Any) -> None:
        super().__init__(**common)
        self.suite, self.case, self.run, self.label = suite, case, run, label

    def runtest(self) -> None:
        """Run engine and model, and raise on exceeded bounds."""
        from rockwobble.compare.check.suite import SuiteRuns, check_run, reference_of
        from rockwobble.compare.runs.execution import Job

        from .pages.wording import statement

        runs, bounds = SuiteRuns(workers=1), self.suite.bounds
        job = Job(case=self.case, run=self.run, label=self.label)
        (trace,) = runs.traces([job])
        failed = [result for result in check_run(runs, job, trace, bounds) if result.failed]
        if failed:
            wanted = trace.outcome != "failed" and not self.config.getoption(_OPTION)
            reference = reference_of(self.run, bounds)
            budget = rw.comparison(self.case, runs=[self.run], budget=True) if wanted else None
            parts = budget.parts_findings(self.run, reference) if budget else ()
            lines = [statement(each) for each in parts]
            raise DisagreementError(failed, lines)

    def repr_failure(
        self, excinfo: pytest.ExceptionInfo[BaseException], style: TracebackStyle | None = None
    ) -> str | TerminalRepr:
        """Report of the exceeded bounds with the budget; other errors as pytest formats them."""
        if isinstance(excinfo.value, DisagreementError):
            return str(excinfo.value)
        if isinstance(excinfo.value, ValueError):
            return f"{self.path.name}: {excinfo.value}"
        return super().repr_failure(excinfo, style)

    def reportinfo(self) -> tuple[Path, int, str]:
        """Path, line and name in the head of a failure."""
        # not the end of the item's name, in which pytest would replace the dots of numbers
        return self.path, 0, f"{self.path.name}: {self.name}"


class DisagreementError(Exception):
    """Error: an engine run differs from the reduced model by more than its bounds.

    Parameters
    ----------
    failed : list of Result
    budget : list of str
        Lines that say what the difference is made of.
    """

    def __init__(self, failed: list[Result], budget: list[str]) -> None:
        from .pages.check import in_words

        super().__init__("\n".join([*(in_words(result) for result in failed), *budget]))
        self.failed = failed
