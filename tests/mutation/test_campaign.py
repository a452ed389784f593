"""The table of a campaign is taken up again where it still holds, and the page says what was found."""

from __future__ import annotations

import dataclasses
from collections.abc import Sequence
from pathlib import Path

import pytest

from mutation import campaign
from mutation.campaign import BrokenCheckoutError, Row, read_rows, write_rows
from mutation.score import page, read_reasons, stale
from mutation.sites import GeneratedFault
from mutation.trial import NOTHING, Limits, Verdict

SOURCE = "def f(x):\n    return x + 1\n"
FILE = "compare/metrics/tilt.py"


@pytest.fixture
def checkout(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """A checkout of one file with faults, whose names begin as said."""
    root = tmp_path / "checkout"
    (root / FILE).parent.mkdir(parents=True)
    (root / FILE).write_text(SOURCE)
    (root / "reduced").mkdir()
    (root / "reduced/kernels.py").write_text("@kernel\ndef f(): ...\n")
    monkeypatch.setattr(campaign, "all_faults", lambda root: {FILE: faults((root / FILE).read_text())})
    return root


def faults(source: str) -> list[GeneratedFault]:
    from mutation.sites import faults_of

    return list(faults_of(FILE, source, {}))


class Check:
    """Stands for the check: finds what is said, and counts what it is asked."""

    def __init__(self, finds: str) -> None:
        self.finds, self.asked = finds, 0

    def __call__(self, root: Path, layers: Sequence[str], limits: Limits, **_: object) -> Verdict:
        text = (root / FILE).read_text()
        self.asked += text != SOURCE
        return Verdict(found_by="exact" if self.finds in text else NOTHING, detail="", seconds=1.0)


def tried(checkout: Path, check: Check, monkeypatch: pytest.MonkeyPatch, **options: bool) -> list[Row]:
    monkeypatch.setattr(campaign, "ask_check", check)
    given = {"tests": False, "survivors_only": False} | options
    return campaign.run(
        checkout,
        lambda found: found[FILE],
        checkout.parent / "table.csv",
        workers=2,
        tell=lambda _: None,
        **given,
    )


def test_a_table_is_taken_up_where_fault_and_sources_are_the_same(
    checkout: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    rows = tried(checkout, check := Check("x - 1"), monkeypatch)
    assert check.asked == len(rows) > 3
    assert [row.fault for row in rows if row.found] == [f"{FILE}:f:operator:1"]
    assert read_rows(checkout.parent / "table.csv") == rows
    write_rows(checkout.parent / "table.csv", rows[1:])
    assert tried(checkout, check := Check("x - 1"), monkeypatch) == rows
    assert check.asked == 1
    write_rows(checkout.parent / "table.csv", [dataclasses.replace(rows[0], change="another"), *rows[1:]])
    assert tried(checkout, check := Check("x - 1"), monkeypatch) == rows
    assert check.asked == 1
    (checkout / "compare/other.py").write_text("")  # other sources may find other faults
    tried(checkout, check := Check("x - 1"), monkeypatch)
    assert check.asked == len(rows)


def test_only_survivors_are_tried_again_where_that_is_asked(
    checkout: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    rows = tried(checkout, Check("x - 1"), monkeypatch)
    (checkout / "compare/other.py").write_text("")
    tried(checkout, check := Check("x - 1"), monkeypatch, survivors_only=True)
    assert check.asked == len(rows) - 1


def test_survivors_that_were_never_put_to_the_tests_are_tried_again_with_them(
    checkout: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    asked = []

    def tests(root: Path, folder: str, limits: Limits, *, module: str = "") -> Verdict:
        asked.append(folder)
        return Verdict(found_by=NOTHING, detail="", seconds=1.0)

    monkeypatch.setattr(campaign, "ask_tests", tests)
    rows = tried(checkout, Check("x - 1"), monkeypatch)
    again = tried(checkout, Check("x - 1"), monkeypatch, tests=True)
    assert asked == ["compare"] * len(rows)  # all but the one that was found, and first the unchanged copy
    assert {row.tests for row in again} == {"", NOTHING}


def test_a_checkout_that_fails_without_a_fault_is_refused(
    checkout: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    with pytest.raises(BrokenCheckoutError, match="the check must pass without a fault, got exact"):
        tried(checkout, Check(SOURCE), monkeypatch)


def row(name: str, check: str, tests: str = "", detail: str = "") -> Row:
    return Row(
        fault=name, change="a => b | c", check=check, tests=tests, seconds="1", detail=detail, tree="t"
    )


def test_the_page_counts_and_names_what_was_not_found() -> None:
    rows = [
        row("compare/metrics/tilt.py:f:operator:1", "metrics"),
        row("compare/metrics/tilt.py:f:operator:2", NOTHING),
        row("compare/metrics/tilt.py:f:operator:3", NOTHING, NOTHING),
        row("compare/metrics/tilt.py:f:operator:4", NOTHING, NOTHING),
        row("models/case.py:f:sign:1", NOTHING, "tests", "tests/models/test_a.py::test_a"),
        row("reduced/integration/driver.py:f:sign:1", "timeout", detail="out of time in exact"),
        row("reduced/integration/driver.py:f:sign:2", "crash", detail="SIGSEGV in exact"),
    ]
    reasons = {(rows[2].fault, rows[2].change): "a factor of one", (rows[0].fault, rows[0].change): "wrong"}
    text = page(rows, reasons, "python tests/mutation generated")
    assert "| metrics | 4 | 1 | 1 | 0 | 2 | 33 % |" in text
    assert "| sign | 3 | 0 | 2 | 1 | 0 | 67 % |" in text
    assert "| all | 7 | 1 | 3 | 1 | 2 | 50 % |" in text
    code = "`a => b \\| c`"
    assert f"| `{rows[1].fault}` | {code} | not found by the check; the tests were not asked |" in text
    assert f"| `{rows[3].fault}` | {code} | not found |" in text
    assert f"## Equivalent: 1\n\n| fault | change | |\n|---|---|---|\n| `{rows[2].fault}` |" in text
    assert f"| `{rows[4].fault}` | {code} | tests/models/test_a.py::test_a |" in text
    assert "## Out of time: 1" in text
    assert "## Crashed: 1" in text
    known = {(each.fault, each.change) for each in rows}
    assert stale(rows, reasons, known) == [rows[0].fault]
    assert stale(rows, reasons, known - {(rows[2].fault, rows[2].change)}) == [rows[2].fault, rows[0].fault]
    assert stale([], reasons, known) == []  # a small sample says nothing of the others


def test_every_reason_is_one(tmp_path: Path) -> None:
    read_reasons(Path(__file__).with_name("equivalent.toml"))
    path = tmp_path / "equivalent.toml"
    entry = '[[equivalent]]\nfault = "f"\nchange = "c"\nreason = "{}"\n'
    path.write_text(entry.format("none"))
    assert read_reasons(path) == {("f", "c"): "none"}
    for text in (entry.format(" "), entry.format("one") + entry.format("two")):
        path.write_text(text)
        with pytest.raises(ValueError, match=r"equivalent.toml must give one reason for each fault"):
            read_reasons(path)
