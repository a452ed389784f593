"""Commands for verification: `rockwobble check`, `certify` and `verify`."""

from __future__ import annotations

import datetime
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

import rockwobble as rw
import rockwobble.compare as rc
from rockwobble.compare.runs.plan import OptionsIn, Plan

from ..console import (
    FAILED,
    command_line,
    complain,
    echo,
    interruptible,
    save_with_page,
    shown_progress,
    user_input,
)
from ..pages.cases import case_warnings, record_lines
from . import options
from .command import takes_options
from .outputs import claim_folder, plan_of, require_own_file
from .problem import excludes, needs

if TYPE_CHECKING:
    from rockwobble.compare.check import Checks
    from rockwobble.compare.check import Subject as CheckSubject
    from rockwobble.compare.check.baseline import Baseline
    from rockwobble.compare.check.verdict import Entry

_subject = OptionsIn("Subject (default: the reduced models, and the engines that are installed)")
_output = OptionsIn("Output for programs")
Subject = dict[str, Any]  # arguments of `rockwobble.check`
_STEP = "Time step of the engine, in s. Default: its default."


@dataclass(frozen=True, kw_only=True)
class SubjectOptions(Plan):
    """Options that name the subject of a check."""

    engine: str | None = _subject(None, "Engine to check, with its protocol.")
    time_step: float | None = _subject(None, _STEP)
    model: str | None = _subject(
        None,
        "Model to check, as MODULE:FUNCTION of a rockwobble.Case and a support, to time, tilt and azimuth.",
    )
    trajectory: Path | None = _subject(
        None, "Trajectory to check (CSV with time, tilt, azimuth); --suite states its case."
    )
    suite: str | None = _subject(
        None, f"Suite whose engine runs are compared with the models: {options.SUITES}."
    )
    support: str | None = _subject(
        None, "Support of the model or trajectory: recess or flat. Default: recess."
    )
    tolerance: float | None = _subject(
        None, "Claimed relative accuracy of the model or trajectory. Default: 0.001."
    )
    workers: options.Workers = None

    def subject(self) -> Subject:
        """Arguments of `rockwobble.check` for the subject.

        Raises
        ------
        ValueError
            If two are given, or an option that another leaves without a meaning.
        """
        from rockwobble.compare.check.subject import load_model
        from rockwobble.multibody.engines.registry import find_engine

        excludes(self, ["engine"], "model", "trajectory", "suite")
        excludes(self, ["model"], "trajectory", "suite")
        needs(self, ["support", "tolerance"], "model", "trajectory")
        needs(self, ["time_step"], "engine")
        needs(self, ["workers"], "suite")
        excludes(self, ["workers"], "trajectory")
        if self.engine is not None:
            find_engine(self.engine)  # an unknown engine is refused before anything runs
        names = ("engine", "time_step", "workers", "support", "tolerance")
        subject: Subject = {name: getattr(self, name) for name in names}
        if self.model is not None:
            subject["model"] = load_model(self.model)
        elif self.trajectory is not None:
            cases = rw.read_suite(self.suite or "quick").cases
            if len(cases) != 1:
                raise ValueError(f"--trajectory needs a --suite with one case, got {len(cases)}")
            subject["trajectory"] = rc.read_trajectory(self.trajectory, cases[0])
        elif self.suite is not None:
            subject["suite"] = rw.read_suite(self.suite)
        return {name: value for name, value in subject.items() if value is not None}


@dataclass(frozen=True, kw_only=True)
class OutputOptions(Plan):
    """Options that name machine-readable output files."""

    json: Path | None = _output(None, "File for all results, as JSON.")
    junit: Path | None = _output(None, "File for a JUnit report (XML).")
    markdown: Path | None = _output(
        None, "File to which a summary for a CI job is appended, such as $GITHUB_STEP_SUMMARY."
    )

    out: Path | None = _output(None, "Folder for the results and their page. Default: none is written.")
    overwrite: options.Overwrite = False

    def require_writable(self, context: typer.Context) -> None:
        """Refuse an unwritable file, or one of another plan, by a ValueError."""
        from rockwobble.compare.storage.files import require_file

        for option, path in (("--json", self.json), ("--junit", self.junit)):
            if path is not None:
                require_own_file(context, option, path)
        if self.markdown is not None:  # file to which the page is appended
            require_file("--markdown", self.markdown)

    def write(self, results: Checks, plan: str) -> None:
        """Write the results folder and the output files.

        Raises
        ------
        ValueError
            If one cannot be written.
        """
        from rockwobble.compare.storage.files import replace_files

        from ..pages import page_of
        from ..pages.check import as_json, as_junit

        if self.out is not None:
            save_with_page(results, self.out)
            print(f"Written to {self.out}: check.html, manifest.json, results.parquet")
        for path, text_of in ((self.json, as_json), (self.junit, as_junit)):
            if path is not None:
                replace_files(path.parent, {path.name: text_of(results, plan).encode()})
        if self.markdown is not None:
            try:  # appended, as the summary of a CI job may hold pages of other steps
                with self.markdown.open("a", encoding="utf-8") as file:
                    file.write(page_of(results.made_by(command_line())).markdown())
            except OSError as error:
                raise ValueError(f"{self.markdown} cannot be written: {error.strerror or error}") from None


@takes_options
def check(
    context: typer.Context,
    subject: SubjectOptions,
    output: OutputOptions,
    only: Annotated[
        list[str] | None,
        typer.Option(
            metavar="GROUP",
            help="Group of checks, may be repeated: equations, exact, conserved, rest, invariance, "
            "tendon, order, trace, agreement, protocol, baseline. Default: all.",
        ),
    ] = None,
    update_baseline: Annotated[
        bool,
        typer.Option(
            "--update-baseline", help="Show the changes of new baselines; written only with --reason."
        ),
    ] = False,
    reason: Annotated[str | None, typer.Option(help="Reason for new baselines, kept in their file.")] = None,
) -> None:
    """Physical checks of reduced models and engines, and comparison with their baselines.

    The groups, tightest first: residuals of the equations of motion, exact solutions, conserved quantities,
    rest and uplift, invariance, tendon, order of convergence, consistency of a trace, agreement with the
    independent model, protocol of an engine, baseline (stored results of short motions). Prints failures with
    value and bound, and one line per group.

    The runs of a suite are compared within the bounds that it states; without bounds, within the error of
    their time step, estimated by a second run at twice the step.

    Exit code 0 if all checks hold, 1 if one does not, 2 for bad input.

    Example: rockwobble check --only equations --only conserved
    """
    with interruptible(), user_input():
        from rich.console import Console

        from rockwobble.compare.check import GROUPS
        from rockwobble.compare.check import check as checks_of
        from rockwobble.models.number_checks import require_one_of

        from ..pages.check import headline, print_checks

        if reason is not None and not update_baseline:
            raise ValueError("--reason belongs to --update-baseline, got it alone")
        output.require_writable(context)
        given = subject.subject()
        if update_baseline:
            if given or only or output.out:
                raise ValueError("--update-baseline goes with no subject and not with --only or --out")
            update(reason)
            return
        if output.out is not None:
            claim_folder(context)
        if "suite" in given:
            cases = given["suite"].cases
            echo([*record_lines(case.motion for case in cases), *case_warnings(cases)])
        for group in only or ():
            require_one_of("--only", group, tuple(GROUPS))
        with shown_progress("checks") as progress:
            checks = checks_of(**given, only=only, progress=progress)
        print_checks(Console(), checks)
        print(headline(checks))
        output.write(checks, plan_of(context))
    if not checks.passed:
        raise typer.Exit(FAILED)


def update(reason: str | None) -> None:
    """Measure, print the changes, and rewrite the baselines of changed subjects.

    Raises
    ------
    ValueError
        If there is no reason, or a file cannot be written.
    """
    from rockwobble.compare.check import baseline
    from rockwobble.compare.check.groups import baseline_subjects
    from rockwobble.compare.storage.files import replace_files

    date = datetime.datetime.now(tz=datetime.UTC).date().isoformat()
    changed: list[tuple[CheckSubject, Baseline, tuple[Entry, ...]]] = []
    for subject in baseline_subjects():
        with shown_progress(f"cases of {subject.label}") as progress:
            new = baseline.new_fingerprint(subject, progress)
        old = baseline.read_baseline(subject)
        changes = baseline.baseline_changes(old, new, subject)
        print(*(f"{subject.label}: {each}" for each in changes or ["same"]), sep="\n")
        if changes:
            changed.append((subject, old, new))
    if changed and not (reason or "").strip():
        raise ValueError("nothing was changed: a new baseline needs a --reason, got none")
    for subject, old, new in changed:
        path = baseline.baseline_path(subject)
        text = baseline.updated_baseline(old, new, subject, reason=reason or "", date=date)
        replace_files(path.parent, {path.name: text.encode()})
        print(f"Written: {path}")


def certify(
    context: typer.Context,
    out: Annotated[Path, typer.Option(help="File of the certificate.")] = Path("certificate.json"),
    engine: Annotated[
        str | None, typer.Option(help="Engine to certify. Default: the reduced models.")
    ] = None,
    time_step: Annotated[float | None, typer.Option(help=_STEP)] = None,
    only: Annotated[
        list[str] | None,
        typer.Option(
            metavar="GROUP",
            help="Group whose checks become claims; may be repeated. Default: all but protocol, baseline.",
        ),
    ] = None,
    overwrite: options.Overwrite = False,
) -> None:
    """Certificate of a model or engine: claims with their evidence, and a fingerprint of short cases.

    A claim is verified (against exact solutions), cross-validated (between independent formulations) or
    validated (against an experiment, by the hash of its data; none yet). Nothing is written if a check
    fails.

    Exit code 0 if it is written, 1 if a check fails, 2 for bad input.

    Example: rockwobble certify --engine mujoco --out mujoco.json
    """
    with interruptible(), user_input():
        from rockwobble.compare.check import engine as engine_subject
        from rockwobble.compare.check import reduced_model, run_checks
        from rockwobble.compare.check.baseline import certify as make
        from rockwobble.compare.check.baseline import models, write_certificate
        from rockwobble.compare.check.groups import CLAIMING
        from rockwobble.models.number_checks import require_one_of
        from rockwobble.models.support import SUPPORTS

        needs(SubjectOptions(engine=engine, time_step=time_step), ["time_step"], "engine")
        for group in only or ():
            require_one_of("--only", group, CLAIMING)
        require_own_file(context, "--out", out)
        subject = models() if engine is None else engine_subject(engine, time_step)
        if not any(SUPPORTS[name].guided for name in subject.supports):
            given = f"{engine} with {', '.join(subject.supports)}"
            raise ValueError(f"--engine must have a recess, got {given}")
        checked = subject if engine else reduced_model()
        with shown_progress("checks") as progress:
            results = list(run_checks(checked, only or CLAIMING, progress=progress))
        if failed := [result.name for result in results if result.failed]:
            complain(f"a check failed, and nothing is certified: {failed[0]}")
            raise typer.Exit(FAILED)
        with shown_progress("cases") as progress:
            certificate = make(subject, results, progress)
        write_certificate({**certificate, "plan": plan_of(context)}, out)
    print(f"{out}: {len(certificate['claims'])} claims, {len(certificate['fingerprint'])} cases")


def verify(
    certificate: Annotated[
        Path, typer.Argument(help="Certificate written by rockwobble certify.", show_default=False)
    ],
    as_json: Annotated[bool, typer.Option("--json", help="Print the findings as JSON.")] = False,
) -> None:
    """Verdict on a certificate: same, chaotic or changed results on this installation.

    same: every number repeats. chaotic: traces differ only after the predicted end of agreement, and
    distributions agree. changed: traces differ before; the claim and the first term concerned are named, and
    versions that differ from those of the certificate.

    Exit code 0 for same and chaotic, 1 for changed, 2 for bad input.

    Example: rockwobble verify mujoco.json
    """
    with interruptible(), user_input():
        from rockwobble.compare.check.baseline import certificate_findings
        from rockwobble.compare.check.baseline import verify as verdict_on
        from rockwobble.compare.check.verdict import read_certificate

        from ..pages.wording import joined

        stated = read_certificate(certificate)
        with shown_progress("cases") as progress:
            verdict = verdict_on(stated, progress=progress)
        findings = certificate_findings(stated, verdict)
    print(findings.to_json("certificate").decode() if as_json else joined(findings))
    if verdict.exit_code:
        raise typer.Exit(verdict.exit_code)
