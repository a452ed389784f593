"""Findings of a check: in a terminal, on the page of a CI job, and for programs as JSON and JUnit."""

from __future__ import annotations

import math
from collections import Counter
from collections.abc import Mapping, Sequence

from rich.console import Console

from rockwobble.compare.check import Finding

from .page import Page
from .table import NONE, Row, Table, columns_of, number

LAYER_WORDS = {
    "records": "Records: files of every form, records that ship, pulses, values that are refused",
    "equations": "Equations: Lagrange's, (18) and (19) on computed motions; accelerations in the engines",
    "conserved": "Conserved: energy and L in free motion, and the work of the ground",
    "exact": "Exact solutions: uplift, periods, angles of turn, steady wobble",
    "rest": "Rest: uplift at once, rest, landings, and what comes after the end of a record",
    "invariance": "Invariance: mirror, size, rotation, delay, gravity, sampling",
    "properties": "Properties: one motion stated in several ways; turning points, peaks and passes",
    "order": "Order: error against tolerance and time step",
    "residual": "Residual: no displacement and no twist is left",
    "metrics": "Metrics: differences, agreement times, external trajectories, intervals, on made-up traces",
    "studies": "Studies: peak_tilts, suites, sweeps and spectra against single runs",
    "traces": "Traces: every field of an engine's trace",
    "agreement": "Agreement: engines against the reduced models",
    "baseline": "Baseline: the numbers that were kept",
}
_COLUMNS = columns_of(
    [
        ["name", "check", "words"],
        ["measured", "measured", "words"],
        ["bound", "bound", "words"],
        ["outcome", "outcome", "words"],
        ["reason", "reason of the bound", "words", "wide"],
    ]
)
_LEAST_WIDTH = 150  # where there is no terminal


def print_layer(console: Console, layer: str, findings: Sequence[Finding]) -> None:
    """Print one layer, and below it what is wrong."""
    if not console.is_terminal:
        console.width = max(console.width, _LEAST_WIDTH)
    console.print(f"\n{LAYER_WORDS[layer]}", style="bold", highlight=False)
    console.print(Table(columns=_COLUMNS, rows=[_row(each) for each in findings]).rich(console.width))
    for finding in findings:
        if finding.failed:
            note = f" ({finding.note})" if finding.note else ""
            said = f" - {finding.name}: {_measured(finding)}, at most {_bound(finding)}{note}"
            console.print(f"wrong: {finding.part}", style="bold red", highlight=False, markup=False, end="")
            console.print(said, highlight=False, markup=False)
        elif finding.outcome != "passed":
            console.print(f"{finding.name}: {finding.note}", style="yellow", highlight=False, markup=False)


def check_page(findings: Sequence[Finding], versions: Mapping[str, str], seconds: float) -> Page:
    """Return the report: what failed first, then every check, layer by layer."""

    def rows(chosen: Sequence[Finding]) -> list[Row]:
        # as Markdown, where an angle bracket begins a tag
        return [{key: str(cell).replace("<", "&lt;") for key, cell in _row(f).items()} for f in chosen]

    layers = []
    for layer, found in _by_layer(findings).items():
        bad = sum(finding.failed for finding in found)
        state = f"{bad} of {len(found)} failed" if bad else f"{len(found)} checks"
        layers.append((f"{layer}: {state}", rows(found)))
    values = {
        "headline": headline(findings, seconds),
        "failed": rows([finding for finding in findings if finding.failed]),
        "layers": layers,
        "versions": ", ".join(f"{name} {version}" for name, version in versions.items()),
    }
    return Page(name="check", template="check", values=values)


def as_json(findings: Sequence[Finding], versions: Mapping[str, str], seconds: float) -> str:
    """Return everything, with the floats to the last bit."""
    from rockwobble.models.plain_json import dumps

    content = {
        "passed": not any(finding.failed for finding in findings),
        "counts": Counter(finding.outcome for finding in findings),
        "seconds": seconds,
        "versions": versions,
        "findings": list(findings),
    }
    return dumps(content, indent=1) + "\n"


def as_junit(findings: Sequence[Finding], seconds: float) -> str:
    """Return a JUnit report with one test case for each check, in a suite for each layer."""
    from xml.etree import ElementTree

    root = ElementTree.Element("testsuites", name="rockwobble check", time=f"{seconds:.3f}")
    for layer, found in _by_layer(findings).items():
        outcomes = Counter(_kind(finding) for finding in found)
        counts = {"tests": len(found), "failures": outcomes["failure"], "skipped": outcomes["skipped"]}
        said = {"name": layer, "errors": "0", **{key: str(value) for key, value in counts.items()}}
        suite = ElementTree.SubElement(root, "testsuite", said)
        for finding in found:
            kind = _kind(finding)
            case = ElementTree.SubElement(
                suite, "testcase", classname=f"rockwobble.{layer}", name=_printable(finding.name)
            )
            told = ElementTree.SubElement(case, kind)
            if kind == "skipped":
                told.set("message", _printable(f"{finding.outcome}: {finding.note}"))
                continue
            told.text = _printable(in_words(finding))
            if kind == "failure":
                told.set("message", _printable(f"wrong: {finding.part}"))
    ElementTree.indent(root)
    return ElementTree.tostring(root, encoding="unicode", xml_declaration=True) + "\n"


def headline(findings: Sequence[Finding], seconds: float) -> str:
    """Return the result of all checks, in one sentence."""
    found = Counter(finding.outcome for finding in findings)
    failed, passed = found.pop("FAILED", 0), found.pop("passed", 0)
    rest = f" ({', '.join(f'{count} {outcome}' for outcome, count in found.items())})" if found else ""
    first = f"{failed} of {len(findings)} checks FAILED" if failed else f"{passed} checks passed"
    return f"{first}{rest}, in {seconds:.0f} s."


def in_words(finding: Finding) -> str:
    """Return a finding in one sentence."""
    note = f"; {finding.note}" if finding.note else ""
    return (
        f"{finding.name}: measured {_measured(finding)}, at most {_bound(finding)} "
        f"({finding.reason}){note}. Suspect where it fails: {finding.part}."
    )


def _by_layer(findings: Sequence[Finding]) -> dict[str, list[Finding]]:
    layers = dict.fromkeys(finding.layer for finding in findings)
    return {layer: [finding for finding in findings if finding.layer == layer] for layer in layers}


def _row(finding: Finding) -> Row:
    said = {name: getattr(finding, name) for name in ("name", "outcome", "reason", "part", "note")}
    return {**said, "measured": _measured(finding), "bound": _bound(finding)}


def _measured(finding: Finding) -> str:
    known = math.isfinite(finding.value)
    return f"{number(finding.value, '.2g')} {finding.unit}".strip() if known else "none"


def _bound(finding: Finding) -> str:
    return number(finding.bound, ".2g").replace(NONE, "")


def _kind(finding: Finding) -> str:
    return {"FAILED": "failure", "passed": "system-out"}.get(finding.outcome, "skipped")


def _printable(text: str) -> str:
    """Return a text without characters that XML forbids, such as those of a terminal's colours."""
    return "".join(
        c if c in "\t\n" or 0x20 <= ord(c) <= 0xD7FF or 0xE000 <= ord(c) <= 0xFFFD else "?" for c in text
    )
