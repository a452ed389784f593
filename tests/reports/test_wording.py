"""Word file: one line for each key in code, one key for each line, and value formats."""

from __future__ import annotations

import ast
import math
import re
from functools import cache
from pathlib import Path

import pytest

from rockwobble.models import Diagnostic
from rockwobble.models.diagnostic import CODES, REASONS
from rockwobble.models.finding import QUANTITIES, Finding, Findings, Value, unit_of
from rockwobble.reports.pages.diagnostics import sentence as diagnosed
from rockwobble.reports.pages.wording import filled, lines_of, sentence, words

ROOT = Path(__file__).parents[2]
PARTS = ("models", "compare", "studies", "reports")
TEXTS = ("code", "name", "names", "reason", "detail")  # quantities that are no numbers
_FIELD = re.compile(r"\{(\w+)(?::[^}]*)?\}")
SENTENCES = {
    f"{group}.{name}": line
    for group, lines in words().items()
    if group not in ("word", "diagnostic")
    for name, line in lines.items()
}


@cache
def modules() -> list[ast.Module]:
    """Syntax trees of the package."""
    return [ast.parse(path.read_text("utf-8")) for part in PARTS for path in (ROOT / part).rglob("*.py")]


def keys_in_code() -> set[str]:
    """Constants given as `key` to a `Finding`, or to a function that passes its `key` on."""
    shared = {name: begin for tree in modules() for name, begin in passing(tree).items() if name[0] != "_"}
    keys = set()
    for tree in modules():
        before = {"Finding": "", **shared, **passing(tree)}
        for call in calls(tree):
            if (name := getattr(call.func, "id", "")) in before:
                given = [each.value for each in call.keywords if each.arg == "key"] or call.args[:1]
                keys |= {before[name] + text for key in given for text in texts(key)}
    return {key for key in keys if re.fullmatch(r"\w+\.\w+", key)}


def passing(tree: ast.Module) -> dict[str, str]:
    """Functions whose argument `key` becomes that of a `Finding`, each with the text put before it."""
    return {
        function.name: "".join(texts(key.values[0])) if isinstance(key, ast.JoinedStr) else ""
        for function in tree.body
        if isinstance(function, ast.FunctionDef) and ast.unparse(function.args).startswith("key: str")
        for call in calls(function)
        for key in (each.value for each in call.keywords if each.arg == "key")
        if getattr(call.func, "id", "") == "Finding"
    }


def calls(tree: ast.AST) -> list[ast.Call]:
    return [node for node in ast.walk(tree) if isinstance(node, ast.Call)]


def texts(node: ast.AST) -> set[str]:
    """Texts that an expression may be, without those that are put together, compared or computed."""
    if isinstance(node, ast.Constant) and isinstance(node.value, str):
        return {node.value}
    parts = () if isinstance(node, ast.JoinedStr | ast.Compare | ast.Call) else ast.iter_child_nodes(node)
    return {text for part in parts for text in texts(part)}


def texts_of_code() -> set[object]:
    """All string constants of the code, as a key may come from a table."""
    return {node.value for tree in modules() for node in ast.walk(tree) if isinstance(node, ast.Constant)}


def test_keys_in_code_equal_keys_of_the_word_file():
    lines = {key.partition(":")[0] for key in SENTENCES}
    assert keys_in_code() <= lines
    stated = texts_of_code()

    def parts(key: str) -> set[str]:
        """String constants in code that may form a key, such as "mode." or a criterion name."""
        group, _, name = key.partition(".")
        return {key, f"{group}.", name, key.removeprefix("limit_")}

    assert not [key for key in lines if not stated & parts(key)]


def values_of(line: str, number: Value, text: Value) -> dict[str, Value]:
    """Values of the quantities in a line, each of its type."""
    values = {name: text if name.partition("_")[0] in TEXTS else number for name in _FIELD.findall(line)}
    return values | ({"names": ("slip", "tolerance")} if "{names:diagnosed}" in line else {})


@pytest.mark.parametrize("number", [2.0, 0, -0.5, math.nan, math.inf, (0.4, 0.26, math.inf), None])
@pytest.mark.parametrize("text", ["words", ("a", "b"), ()])
def test_each_wording_line_formats_every_value_type(number: Value, text: Value):
    for key, both in SENTENCES.items():
        for short, line in enumerate([both] if isinstance(both, str) else reversed(both)):
            finding = Finding(key=key, values=values_of(line, number, text))
            said = sentence(finding, short=bool(short))
            assert not re.search(r"[{}[\]]|\bnan\b|\binf\b|None", said), (key, said)
            for name in finding.values:  # what is unknown leaves no gap
                values = {each: value for each, value in finding.values.items() if each != name}
                said = sentence(Finding(key=key, values=values), short=bool(short))
                assert "  " not in said, (key, name, said)


@pytest.mark.parametrize("code", CODES)
def test_each_diagnostic_is_worded_with_its_values(code: str):
    for detail in REASONS.get(code, ("",)):
        for number in (2.0, math.nan, math.inf):
            fact = Diagnostic(code=code, time=number, duration=2.0, size=number, bound=1.0, detail=detail)
            assert not set("{}[]") & set(diagnosed(fact))


@pytest.mark.parametrize(
    ("line", "text"),
    [
        ("{tilt} and {share}", "11.5° and 40 % (26 % to 71 %)"),
        ("{runs:copy/copies} of {names}[ at {time}][ over {tilt:.1f}]", "1 copy of a, b and c over 11.5°"),
        ("{difference:added|dissipated} {time}", "dissipated –"),
        ("{difference:size percent}", "50 %"),
        ("{reason:word}", "the runs diverge there"),
    ],
)
def test_values_are_formatted_by_unit(line: str, text: str):
    values = {
        "tilt": 0.2,
        "share": (0.4, 0.26, 0.71),
        "runs": 1,
        "names": ("a", "b", "c"),
        "time": math.nan,
        "difference": -0.5,
        "reason": "diverged",
    }
    assert filled(line, values, {name: unit_of(name) for name in values}) == text


def test_a_value_without_a_known_quantity_is_refused():
    with pytest.raises(ValueError, match="QUANTITIES"):
        Finding(key="any", values={"speed": 1.0})


def test_findings_convert_to_table_file_and_text():
    finding = Finding(key="diagnostic.slip", level="caution", values={"time": 1.5}, runs="mujoco")
    findings = Findings([finding, Finding(key="diagnostic.side")])
    assert repr(findings).splitlines()[0] == "diagnostic: caution, contact slipped from 1.5 s on"
    assert list(findings.to_frame()["unit"]) == ["s", ""]
    assert b'"unit": "s"' in findings.to_json("trial")
    assert findings.of("diagnostic") == findings


def test_every_quantity_has_a_description():
    assert all(meaning for _, meaning in QUANTITIES.values())
    assert lines_of("diagnostic.slip") == ("slipped", "contact slipped[ from {time} on]")


def test_the_title_of_every_figure_names_its_case():
    of_limits = list(words()["figure"]).index("records")  # from there on, of all cases of one study
    titles = {key: lines_of(f"figure.{key}")[0] for key in list(words()["figure"])[:of_limits]}
    assert [key for key, title in titles.items() if not re.search(r"\{names?\}", title)] == [
        "trace"
    ]  # its own
