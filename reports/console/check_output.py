"""What a check found, for programs: JSON, JUnit XML, and Markdown for the page of a CI job."""

from __future__ import annotations

import math
from collections import Counter
from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from rockwobble.compare.check import Finding


def as_json(findings: Sequence[Finding], versions: Mapping[str, str], seconds: float) -> str:
    """Return everything, with the floats to the last bit."""
    from rockwobble.models.plain_json import dumps

    content = {
        "passed": not any(finding.failed for finding in findings),
        "counts": counts(findings),
        "seconds": seconds,
        "versions": versions,
        "findings": list(findings),
    }
    return dumps(content, indent=1) + "\n"


def as_junit(findings: Sequence[Finding], seconds: float) -> str:
    """Return a JUnit report with one test case for each check, in a suite for each layer."""
    from xml.etree import ElementTree

    root = ElementTree.Element("testsuites", name="rockwobble check", time=f"{seconds:.3f}")
    for layer in dict.fromkeys(finding.layer for finding in findings):
        of_layer = [finding for finding in findings if finding.layer == layer]
        suite = ElementTree.SubElement(
            root,
            "testsuite",
            name=layer,
            tests=str(len(of_layer)),
            failures=str(sum(finding.failed for finding in of_layer)),
            errors="0",
            skipped=str(sum(_skipped(finding) for finding in of_layer)),
        )
        for finding in of_layer:
            case = ElementTree.SubElement(
                suite, "testcase", classname=f"rockwobble.{layer}", name=printable(finding.name)
            )
            if finding.failed:
                failure = ElementTree.SubElement(case, "failure", message=printable(f"wrong: {finding.part}"))
                failure.text = printable(in_words(finding))
            elif _skipped(finding):
                ElementTree.SubElement(
                    case, "skipped", message=printable(f"{finding.outcome}: {finding.note}")
                )
            else:
                ElementTree.SubElement(case, "system-out").text = printable(in_words(finding))
    ElementTree.indent(root)
    return ElementTree.tostring(root, encoding="unicode", xml_declaration=True) + "\n"


def as_markdown(findings: Sequence[Finding], versions: Mapping[str, str], seconds: float) -> str:
    """Return a page: what failed first, then every check, layer by layer."""
    failed = [finding for finding in findings if finding.failed]
    lines = ["# rockwobble check", "", headline(findings, seconds), ""]
    if failed:
        lines += ["| what is wrong | check | measured | bound | |", "|---|---|---|---|---|"]
        lines += [
            _row(f"**{_cell(f.part)}**", _cell(f.name), measured(f), bound(f), _cell(f.note)) for f in failed
        ]
        lines.append("")
    for layer in dict.fromkeys(finding.layer for finding in findings):
        of_layer = [finding for finding in findings if finding.layer == layer]
        bad = sum(finding.failed for finding in of_layer)
        state = f"{bad} of {len(of_layer)} failed" if bad else f"{len(of_layer)} checks"
        lines += [f"<details><summary>{layer}: {state}</summary>", ""]
        lines += [
            "| check | outcome | measured | bound | reason of the bound | |",
            "|---|---|---|---|---|---|",
        ]
        lines += [
            _row(_cell(f.name), f.outcome, measured(f), bound(f), _cell(f.reason), _cell(f.note))
            for f in of_layer
        ]
        lines += ["", "</details>", ""]
    lines.append("Made with " + ", ".join(f"{name} {version}" for name, version in versions.items()) + ".")
    return "\n".join(lines) + "\n"


def counts(findings: Sequence[Finding]) -> dict[str, int]:
    """Return how many checks had each outcome."""
    return dict(Counter(finding.outcome for finding in findings))


def headline(findings: Sequence[Finding], seconds: float) -> str:
    """Return what it all came to, in one sentence."""
    found = counts(findings)
    failed = sum(finding.failed for finding in findings)
    others = [
        f"{number} {outcome}" for outcome, number in found.items() if outcome not in ("passed", "FAILED")
    ]
    rest = f" ({', '.join(others)})" if others else ""
    if failed:
        return f"{failed} of {len(findings)} checks FAILED{rest}, in {seconds:.0f} s."
    return f"{found.get('passed', 0)} checks passed{rest}, in {seconds:.0f} s."


def in_words(finding: Finding) -> str:
    """Return a finding in one sentence."""
    note = f"; {finding.note}" if finding.note else ""
    return (
        f"{finding.name}: measured {measured(finding)}, at most {bound(finding)} "
        f"({finding.reason}){note}. Suspect where it fails: {finding.part}."
    )


def measured(finding: Finding) -> str:
    """Return the measured value with its unit."""
    if not math.isfinite(finding.value):
        return "none"
    return f"{finding.value:.2g} {finding.unit}".strip()


def bound(finding: Finding) -> str:
    """Return the bound."""
    return "" if math.isnan(finding.bound) else f"{finding.bound:.2g}"


def printable(text: str) -> str:
    """Return a text without characters that XML forbids, such as those of a terminal's colours."""
    return "".join(
        c if c in "\t\n" or 0x20 <= ord(c) <= 0xD7FF or 0xE000 <= ord(c) <= 0xFFFD else "?" for c in text
    )


def _skipped(finding: Finding) -> bool:
    return finding.outcome in ("no baseline", "not run")


def _row(*cells: str) -> str:
    return f"| {' | '.join(cells)} |"


def _cell(text: str) -> str:
    return text.replace("|", "\\|").replace("<", "&lt;").replace("\n", " ")
