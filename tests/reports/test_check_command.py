"""`rockwobble check`: output, files and exit codes."""

from __future__ import annotations

import dataclasses
import io
import json
import math
import re
from collections.abc import Iterator
from functools import partial
from pathlib import Path
from typing import Any
from xml.etree import ElementTree

import pytest
from rich.console import Console
from showing import call as command_line
from showing import is_golden, loads_as_it_was

from rockwobble.compare.check import FAILED, NOT_RUN, PASSED, Checks, Result, Subject, baseline, groups
from rockwobble.compare.check.measurement import Bound, at_most, not_run
from rockwobble.compare.storage.files import replace_files
from rockwobble.reports.pages.check import as_junit, print_checks
from rockwobble.reports.pages.wording import sentence

run = partial(command_line, "check")

FAST = ["--only", "rest", "--only", "equations"]
MADE = (
    at_most("a period", 1e-12, Bound(1e-9, "rounding"), "equation (18)"),
    at_most("El | Centro", 0.5, Bound(0.1, "contact <2 h>", "alpha"), "contact of x", "why"),
    at_most("a run", math.nan, Bound(0.1, "must end")),
    not_run("a case", "nothing moves"),
)
GOOD, BAD, NONE, LEFT = (
    dataclasses.replace(result, group=group, subject="one")
    for result, group in zip(MADE, ("exact", "agreement", "agreement", "agreement"), strict=True)
)


def checks(*results: Result) -> Checks:
    return Checks.of(results, seconds=3.0)


def check_of(measure: Any) -> tuple[groups.Check, ...]:
    return (groups.Check(measure=measure, supports=("recess",)),)


def test_page_matches_golden_file() -> None:
    made = checks(GOOD, BAD, NONE, LEFT)
    is_golden(dataclasses.replace(made, facts={**made.facts, "versions": {}}))


def test_passing_groups_are_summarised_in_every_output(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    paths = [tmp_path / name for name in ("check.json", "check.xml", "check.md")]
    options = ["--json", str(paths[0]), "--junit", str(paths[1]), "--markdown", str(paths[2])]
    assert run(*FAST, *options) == 0
    # one line per group, and the result
    lines = capsys.readouterr().out.splitlines()
    assert [line.split(":")[0] for line in lines[:-1]] == ["equations of motion", "rest and uplift"]
    stored = json.loads(paths[0].read_text())
    assert stored["passed"] is True
    assert {result["group"] for result in stored["results"]} == {"rest", "equations"}
    assert all(result["reason"] and result["subject"] == "reduced model" for result in stored["results"])
    suites = {suite.get("name") for suite in ElementTree.parse(paths[1]).iter("testsuite")}
    assert suites == {"rest", "equations"}
    assert paths[2].read_text().startswith("# rockwobble check\n\n")
    assert [path.name for path in tmp_path.iterdir() if path not in paths] == []


def test_failed_checks_are_printed_singly_and_exit_with_1(
    monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.setattr(groups, "baseline_subjects", lambda: [groups.subjects.reduced_model()])
    monkeypatch.setattr(groups, "GROUPS", {"agreement": check_of(lambda *_: iter(MADE))})
    monkeypatch.setattr(groups, "GROUPS", groups.GROUPS)
    assert run("--only", "agreement") == 1
    lines = capsys.readouterr().out.splitlines()
    heads = ["FAILED", "FAILED", "not run", "agreement with the independent model", "2 of 4 checks FAILED"]
    assert all(line.startswith(head) for line, head in zip(lines, heads, strict=True))


def test_failure_finding_has_measure_bound_reason_and_cause() -> None:
    failed = dataclasses.replace(BAD, cause="axial inertia +5 %")
    summary, finding = checks(GOOD, failed).findings()
    values = {name: value for name, value, _ in finding.quantities()}
    assert (finding.level, values["demand"], values["bound"]) == ("not satisfied", failed.value, failed.bound)
    assert (values["detail_reason"], values["detail_cause"]) == (failed.reason, failed.cause)
    assert (summary.key, [value for _, value, _ in summary.quantities()][:2]) == ("check.failed", [1, 2])


def test_unchanged_baseline_states_its_version_once() -> None:
    note = "the baseline is of mujoco 3.9.9, this is 4.0.0"
    same = [dataclasses.replace(GOOD, group="baseline", name=name, note=note) for name in ("one", "two")]
    console = Console(file=io.StringIO(), record=True, width=100)
    print_checks(console, checks(*same))
    assert console.export_text().splitlines() == ["baseline: 2 passed", f"  {note}"]


@pytest.mark.parametrize("option", ["--json", "--junit", "--markdown"])
def test_unwritable_report_gives_one_line_after_the_result(
    option: str, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str], tmp_path: Path
) -> None:
    def in_the_way(subject: Subject, support: str) -> Iterator[Result]:
        (tmp_path / "a").mkdir(exist_ok=True)
        yield GOOD

    monkeypatch.setattr(groups, "baseline_subjects", lambda: [groups.subjects.reduced_model()])
    monkeypatch.setitem(groups.GROUPS, "exact", check_of(in_the_way))
    assert run("--only", "exact", option, str(tmp_path / "a")) == 2
    out, err = capsys.readouterr()
    assert out.splitlines()[-1].startswith("1 check passed")
    assert re.fullmatch(r"(\d of \d checks[^\n]*\n)*rockwobble: [^\n]*/a\b[^\n]*\n", err)


def test_junit_counts_failures_and_skipped_checks() -> None:
    root = ElementTree.fromstring(as_junit(checks(GOOD, BAD, NONE, LEFT)))
    agreement = root.find("testsuite[@name='agreement']")
    assert agreement is not None
    assert [agreement.get(key) for key in ("tests", "failures", "skipped")] == ["3", "2", "1"]
    failure = agreement.find("testcase/failure")
    assert failure is not None
    assert failure.get("message") == sentence(BAD.finding(), short=True)
    assert failure.text == sentence(BAD.finding())
    strange = at_most("a\x1b[0m<&>", 1.0, Bound(0.0, "\x00"), "\x07", "\x08")  # whatever an engine says
    assert ElementTree.fromstring(as_junit(checks(strange))) is not None


def test_check_results_are_saved_shown_and_redrawn(
    monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str], tmp_path: Path
) -> None:
    monkeypatch.setattr(groups, "baseline_subjects", lambda: [groups.subjects.reduced_model()])
    monkeypatch.setattr(groups, "GROUPS", {"agreement": check_of(lambda *_: iter(MADE))})
    out = tmp_path / "checks"
    assert run("--only", "agreement", "--out", str(out)) == 1
    assert capsys.readouterr().out.splitlines()[-1].startswith(f"Written to {out}: check.html, ")
    loads_as_it_was(checks(GOOD, BAD, NONE, LEFT), tmp_path / "others")
    stored = Checks.load(out)
    assert [each.outcome for each in stored.results] == [PASSED, FAILED, FAILED, NOT_RUN]
    assert stored.results[1].bound == MADE[1].bound
    page = (out / "check.html").read_text()
    (out / "check.html").unlink()
    assert [command_line(command, str(out)) for command in ("show", "report")] == [0, 0]
    assert (out / "check.html").read_text() == page
    assert run("--only", "exact", "--out", str(out)) == 2
    assert "holds check of `" in capsys.readouterr().err
    assert run("--update-baseline", "--out", str(out)) == 2


def test_baseline_update_requires_and_stores_a_reason(
    monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str], tmp_path: Path
) -> None:
    right = groups.subjects.reduced_model()
    place = tmp_path / "reduced_model.json"
    replace_files(tmp_path, {place.name: baseline.baseline_path(right).read_bytes()})
    kept = place.read_bytes()
    monkeypatch.setattr(baseline, "baseline_path", lambda _: place)
    monkeypatch.setattr(groups, "baseline_subjects", lambda: [right])
    assert run("--update-baseline") == 0
    assert capsys.readouterr().out == "reduced model: same\n"

    other = dataclasses.replace(right, supports=("flat",))
    monkeypatch.setattr(groups, "baseline_subjects", lambda: [other])
    assert run("--update-baseline") == 2
    out, err = capsys.readouterr()
    assert out.startswith("reduced model: gone: tilting, rolling, ")
    last = err.splitlines()[-1]
    assert "--reason" in last
    assert place.read_bytes() == kept
    assert [path.name for path in tmp_path.iterdir()] == [place.name]

    assert run("--update-baseline", "--reason", "a better kernel") == 0
    written = json.loads(place.read_text())
    assert [one["name"] for one in written["fingerprint"]] == ["flat-ground"]
    assert written["reasons"][-1]["reason"] == "a better kernel"
