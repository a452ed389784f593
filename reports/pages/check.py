"""Results of checks: in a terminal, on the page of a CI job, and for programs as JSON and JUnit."""

from __future__ import annotations

import math
from collections import Counter
from collections.abc import Sequence

from rich.console import Console

from rockwobble.compare.check import NOT_RUN, PASSED, Checks, Result
from rockwobble.compare.check.groups import TITLES
from rockwobble.models.finding import Finding

from .page import Page
from .table import NONE, Row, number
from .wording import sentence, statement


def print_checks(console: Console, checks: Checks) -> None:
    """Print failures, missing baselines, skipped checks, and one line per group."""
    for result in checks.results:
        if result.outcome not in (PASSED, NOT_RUN):
            style = "bold red" if result.failed else "yellow"
            text = f"{result.outcome}: {result.subject}, {in_words(result)}"
            console.print(text, style=style, highlight=False, markup=False, soft_wrap=True)
    reasons = dict.fromkeys(f"{each.name}: {each.note}" for each in checks.results if each.outcome == NOT_RUN)
    for text in reasons:
        console.print(f"not run: {text}", highlight=False, markup=False, soft_wrap=True)
    for group, of_group in _by_group(checks.results).items():
        counts = Counter(result.outcome for result in of_group)
        words = ", ".join(f"{count} {outcome}" for outcome, count in counts.items())
        console.print(f"{TITLES.get(group, 'engines')}: {words}", highlight=False, markup=False)
        if group == "baseline":  # no failure: another version, or different last digits
            for note in dict.fromkeys(each.note for each in of_group if each.outcome == PASSED and each.note):
                console.print(f"  {note}", highlight=False, markup=False, soft_wrap=True)


def page_of(checks: Checks) -> Page:
    """Report of checks: failures first, then every check by group."""

    def rows(chosen: Sequence[Result]) -> list[Row]:
        # as Markdown, where an angle bracket begins a tag
        return [{key: str(cell).replace("<", "&lt;") for key, cell in _row(f).items()} for f in chosen]

    groups = []
    for group, of_group in _by_group(checks.results).items():
        bad = sum(result.failed for result in of_group)
        counts = {"count": bad or math.nan, "count_all": len(of_group)}
        state = Finding(key="check.group", values=counts | {"name": TITLES.get(group, "engines")})
        groups.append((sentence(state), rows(of_group)))
    values = {
        "headline": headline(checks),
        "failed": rows(checks.failures),
        "groups": groups,
        "about": checks.manifest,
    }
    return Page(name="check", template="check", values=values)


def as_json(checks: Checks, plan: str = "") -> str:
    """All results as JSON, with exact floats and the hash of the command."""
    from rockwobble.models.plain_json import dumps

    content = {
        "passed": checks.passed,
        "counts": checks.headline(),
        **({"plan": plan} if plan else {}),
        **checks.facts,
        "results": checks.results,
    }
    return dumps(content, indent=1) + "\n"


def as_junit(checks: Checks, plan: str = "") -> str:
    """JUnit report with one test case for each check, in a suite for each group.

    The hash of the command is a property of each suite.
    """
    from xml.etree import ElementTree

    root = ElementTree.Element("testsuites", name="rockwobble check", time=f"{checks.facts['seconds']:.3f}")
    for group, of_group in _by_group(checks.results).items():
        outcomes = Counter(_kind(result) for result in of_group)
        counts = {"tests": len(of_group), "failures": outcomes["failure"], "skipped": outcomes["skipped"]}
        said = {
            "name": group or "engines",
            "errors": "0",
            **{key: str(value) for key, value in counts.items()},
        }
        suite = ElementTree.SubElement(root, "testsuite", said)
        if plan:
            properties = ElementTree.SubElement(suite, "properties")
            ElementTree.SubElement(properties, "property", name="plan", value=plan)
        for result in of_group:
            kind = _kind(result)
            case = ElementTree.SubElement(
                suite,
                "testcase",
                classname=f"rockwobble.{group}",
                name=_printable(f"{result.subject}, {result.name}"),
            )
            detail = ElementTree.SubElement(case, kind)
            if kind == "skipped":
                detail.set("message", _printable(f"{result.outcome}: {result.note}"))
                continue
            detail.text = _printable(in_words(result))
            if kind == "failure":
                detail.set("message", _printable(sentence(result.finding(), short=True)))
    ElementTree.indent(root)
    return ElementTree.tostring(root, encoding="unicode", xml_declaration=True) + "\n"


def headline(checks: Checks) -> str:
    """Result of all checks, in one sentence."""
    return statement(checks.findings()[0])


def in_words(result: Result) -> str:
    """One check result as a sentence."""
    return sentence(result.finding())


def _by_group(results: Sequence[Result]) -> dict[str, list[Result]]:
    groups = dict.fromkeys(result.group for result in results)
    return {group: [result for result in results if result.group == group] for group in groups}


def _row(result: Result) -> Row:
    said = {name: getattr(result, name) for name in ("subject", "name", "outcome", "reason", "cause", "note")}
    return {**said, "measured": _measurement(result), "bound": _bound(result)}


def _measurement(result: Result) -> str:
    return f"{number(result.value, '.2g')} {result.unit}".strip()


def _bound(result: Result) -> str:
    return number(result.bound, ".2g").replace(NONE, "")


def _kind(result: Result) -> str:
    return {"FAILED": "failure", "passed": "system-out"}.get(result.outcome, "skipped")


def _printable(text: str) -> str:
    """Text without characters forbidden in XML, such as terminal colour codes."""
    return "".join(
        c if c in "\t\n" or 0x20 <= ord(c) <= 0xD7FF or 0xE000 <= ord(c) <= 0xFFFD else "?" for c in text
    )
