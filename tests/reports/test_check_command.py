"""`rockwobble check`: what it prints and writes, and how it ends."""

from __future__ import annotations

import dataclasses
import json
import math
import re
from collections.abc import Iterator
from pathlib import Path
from xml.etree import ElementTree

import pytest

from rockwobble.compare.check import FAILED, NOT_RUN, PASSED, layers
from rockwobble.compare.check.finding import Bound, Finding, at_most, not_run
from rockwobble.compare.storage.files import replace_files
from rockwobble.reports.cli.main import main
from rockwobble.reports.pages.check import as_junit, check_page, headline

FAST = ["--only", "conserved", "--only", "residual"]

MADE = (
    at_most("a period", 1e-12, Bound(1e-9, "rounding"), "equation (18)"),
    at_most("El | Centro", 0.5, Bound(0.1, "contact <2 h>", "alpha"), "contact of x", "why"),
    at_most("a run", math.nan, Bound(0.1, "must end"), "contact of y"),
    not_run("a case", "x", "nothing moves"),
)
GOOD, BAD, NONE, LEFT = (
    dataclasses.replace(finding, layer=layer)
    for finding, layer in zip(MADE, ("exact", "agreement", "agreement", "agreement"), strict=True)
)


def run(*arguments: str) -> int:
    with pytest.raises(SystemExit) as ended:
        main(["check", *arguments])
    return int(ended.value.code or 0)


def test_layers_that_hold(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    paths = [tmp_path / name for name in ("check.json", "check.xml", "check.md")]
    options = ["--json", str(paths[0]), "--junit", str(paths[1]), "--markdown", str(paths[2])]
    assert run(*FAST, *options) == 0
    out, err = capsys.readouterr()
    assert "energy in free motion, spin 1 rad/s" in out
    assert "twist phi + psi" in out
    assert out.splitlines()[-1].endswith("s.")
    assert "FAILED" not in out
    assert err.splitlines() == ["checking conserved ...", "checking residual ..."]
    found = json.loads(paths[0].read_text())
    assert found["passed"] is True
    assert {finding["layer"] for finding in found["findings"]} == {"conserved", "residual"}
    assert all(finding["reason"] and finding["part"] for finding in found["findings"])
    assert {suite.get("name") for suite in ElementTree.parse(paths[1]).iter("testsuite")} == {
        "conserved",
        "residual",
    }
    assert paths[2].read_text().startswith("# rockwobble check\n\n")
    assert [path.name for path in tmp_path.iterdir() if path not in paths] == []


def test_a_failure_names_the_part_and_ends_with_1(
    monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.setitem(layers.PARTS, "agreement", (lambda _: iter(MADE),))
    assert run("--only", "agreement") == 1
    out = capsys.readouterr().out
    assert "wrong: contact of x - El | Centro: 0.5 alpha, at most 0.1 (why)" in out
    assert "wrong: contact of y - a run: none, at most 0.1" in out
    assert "a case: nothing moves" in out
    assert out.splitlines()[-1].startswith("2 of 4 checks FAILED (1 not run), in ")


@pytest.mark.parametrize(
    ("arguments", "line"),
    [
        (["--only", "equation"], "--only must be one of records, equations, conserved, "),
        (["--suite", "nothing"], "cannot read the suite nothing: "),
        (["--reason", "because"], "--reason belongs to --update-baseline"),
        (["--tolerance", "1e-5"], "--tolerance belongs to --model or --trajectory, got it without either"),
        (["--support", "flat", "--only", "exact"], "--support belongs to --model or --trajectory"),
        (["--model", "a:b", "--suite", "canon"], "--suite does not go with --model"),
        (["--trajectory", "a.csv", "--workers", "2"], "--workers belongs to the engines"),
        (["--update-baseline", "--only", "exact"], "--update-baseline goes with neither --suite nor --only"),
        (["--json", "no/such/folder/a.json"], "a report must be a file in a folder that exists, got no/such"),
        (["--only", "exact", "--json", "/proc/a.json"], "the output folder /proc cannot be written"),
        (["--only", "exact", "--markdown", "/proc/a.md"], "the output folder /proc cannot be written"),
    ],
)
def test_bad_input_is_one_line(arguments: list[str], line: str, capsys: pytest.CaptureFixture[str]) -> None:
    assert run(*arguments) == 2
    (said,) = capsys.readouterr().err.splitlines()
    assert said.startswith(f"rockwobble: {line}")


@pytest.mark.parametrize("option", ["--json", "--junit", "--markdown"])
def test_a_report_that_cannot_be_written_in_the_end_is_one_line_after_the_result(
    option: str, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str], tmp_path: Path
) -> None:
    def in_the_way(_: object) -> Iterator[Finding]:
        (tmp_path / "a").mkdir()
        yield GOOD

    monkeypatch.setitem(layers.PARTS, "exact", (in_the_way,))
    assert run("--only", "exact", option, str(tmp_path / "a")) == 2
    out, err = capsys.readouterr()
    assert out.splitlines()[-1].startswith("1 checks passed, in ")
    assert re.fullmatch(r"checking exact \.\.\.\nrockwobble: [^\n]*/a\b[^\n]*\n", err)


def test_interrupted(
    monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str], tmp_path: Path
) -> None:
    def interrupted(_: object) -> object:
        raise KeyboardInterrupt

    monkeypatch.setitem(layers.PARTS, "exact", (interrupted,))
    assert run("--only", "exact", "--json", str(tmp_path / "a.json")) == 130
    assert capsys.readouterr().err.splitlines()[-1] == "rockwobble: interrupted, nothing was written"
    assert list(tmp_path.iterdir()) == []


def test_junit_counts_failures_and_what_did_not_run() -> None:
    root = ElementTree.fromstring(as_junit([GOOD, BAD, NONE, LEFT], 1.5))
    agreement = root.find("testsuite[@name='agreement']")
    assert agreement is not None
    assert [agreement.get(key) for key in ("tests", "failures", "skipped")] == ["3", "2", "1"]
    failure = agreement.find("testcase/failure")
    assert failure is not None
    assert failure.get("message") == "wrong: contact of x"
    assert "measured 0.5 alpha, at most 0.1" in str(failure.text)


def test_junit_is_xml_whatever_an_engine_says() -> None:
    strange = at_most("a\x1b[0m<&>", 1.0, Bound(0.0, "\x00"), "\ud800", "\x08")
    assert ElementTree.fromstring(as_junit([strange], 0.0)) is not None


def test_markdown_has_what_is_wrong_first() -> None:
    text = check_page([GOOD, BAD, LEFT], {"numpy": "2"}, 3.0).markdown()
    lines = text.splitlines()
    assert lines[2] == "1 of 3 checks FAILED (1 not run), in 3 s."
    assert lines[6] == "| contact of x | El ∣ Centro | 0.5 alpha | 0.1 | why |"
    assert "<details><summary>exact: 1 checks</summary>" in text
    assert "contact &lt;2 h>" in text


def test_outcomes() -> None:
    assert [finding.outcome for finding in (GOOD, BAD, NONE, LEFT)] == [PASSED, FAILED, FAILED, NOT_RUN]
    assert headline([GOOD], 1.0) == "1 checks passed, in 1 s."


def test_an_update_needs_a_reason_and_keeps_it(
    monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str], tmp_path: Path
) -> None:
    from rockwobble.compare.check import baseline_file
    from rockwobble.compare.check.engines import engine_baseline
    from rockwobble.compare.check.models import reduced_baseline

    before = {path.name: path.read_bytes() for path in baseline_file.folder().glob("*.json")}
    replace_files(tmp_path, before)
    monkeypatch.setattr(baseline_file, "folder", lambda: tmp_path)
    monkeypatch.setattr(engine_baseline, "measure", lambda _: {"engine 1": {"x": 0.5}})
    name, value = next(iter(baseline_file.read_baseline("reduced").values["reduced models"].items()))
    monkeypatch.setattr(reduced_baseline, "measure", lambda _: {name: value + 0.25})
    assert run("--update-baseline") == 2
    out, err = capsys.readouterr()
    assert f"reduced models, {name}: {value:.12g} -> {value + 0.25:.12g} (+2.5e-01)" in out
    assert "engine 1: 1 new values, 0 that are no longer there" in out
    assert (
        err.splitlines()[-1] == "rockwobble: nothing was changed: a new baseline needs a --reason, got none"
    )
    assert {path.name: path.read_bytes() for path in tmp_path.iterdir()} == before
    assert run("--update-baseline", "--reason", "a better kernel") == 0
    written = json.loads((tmp_path / "engines.json").read_text())
    assert written["values"]["engine 1"] == {"x": 0.5}
    assert written["reasons"][-1]["reason"] == "a better kernel"
