"""Faults are generated where something is computed, each under a name of its own, and can be shown."""

from __future__ import annotations

import ast
from pathlib import Path

import pytest

from mutation.names import signatures_of
from mutation.sites import GeneratedFault, faults_of
from mutation.targets import GROUPS, all_faults, files_of, group_of, sample

CHECKOUT = Path(__file__).parents[2]


def generated(source: str) -> list[GeneratedFault]:
    return list(faults_of("a.py", source, signatures_of([ast.parse(source)])))


def changes(source: str, kind: str) -> list[str]:
    """What stands in the last line of the source under each fault of a kind."""
    found = [fault.applied(source) for fault in generated(source) if fault.kind == kind]
    return [each.splitlines()[-1].strip() for each in found]


@pytest.mark.parametrize(
    ("line", "kind", "expected"),
    [
        ("y = a + b", "operator", ["y = a - b"]),
        ("y = a * (b - c)", "operator", ["y = a / (b - c)", "y = a * (b + c)"]),
        ("a -= b", "operator", ["a += b"]),
        ("y = a - b * c", "term-left", ["y = -(b * c)"]),
        ("y = a * (b - c)", "term-right", ["y = a * (b)"]),
        ("y = b * -a", "sign", ["y = b * a"]),
        ("y = a * 2.0", "number-scaled", ["y = a * 2.02"]),
        ("y = a * 2", "number-plus", ["y = a * 3"]),
        ("y = a * 2", "number-zero", ["y = a * 0"]),
        ("y = a - 2.0", "number-sign", ["y = a - -2.0"]),
        ("y = 0.0 <= a < b", "direction", ["y = 0.0 >= a < b", "y = 0.0 <= a > b"]),
        ("y = 0.0 <= a < b", "strictness", ["y = 0.0 < a < b", "y = 0.0 <= a <= b"]),
        ("y = a is None", "direction", ["y = a is not None"]),
        ("y = (a > b) & c", "and-or", ["y = (a > b) | c"]),
        ("y = a and not b", "and-or", ["y = a or not b"]),
        ("y = a and not b", "not", ["y = a and b"]),
        ("y = not (a or b) and c", "not", ["y = (a or b) and c"]),
        ("y = c if a else b", "not", ["y = c if not a else b"]),
        ("y = g(a, wide=True)", "true-false", ["y = g(a, wide=False)"]),
        ("y = np.maximum(a, b)", "extreme", ["y = np.minimum(a, b)"]),
        ("y = math.sin(a)", "trigonometry", ["y = math.cos(a)"]),
        ("y = a[2:, b]", "index-plus", ["y = a[3:, b]", "y = a[2:, b + 1]"]),
        ("y = a[-1]", "index-minus", ["y = a[-2]"]),
        ("y = a[g(1)]", "index-plus", []),  # a number in a call is an argument
        ("y = a['x'] + b['y']", "key", ["y = a['y'] + b['y']", "y = a['x'] + b['x']"]),
        ("y = a.x + b(a.z)", "attribute", ["y = a.z + b(a.z)", "y = a.x + b(a.x)"]),
        ("y = a * b", "name", ["y = b * b", "y = a * a"]),
        ("y = g(b, a)", "arguments", ["y = g(a, b)"]),
        ("y = g(a=b, b=c)", "arguments", ["y = g(a=c, b=b)"]),
        ("y = h(b, a)", "arguments", []),  # no slip would go unseen: they are of two types
        ("y = math.atan2(a, b)", "arguments", ["y = math.atan2(b, a)"]),
        ("y, z = g(a, b)", "results", ["z, y = g(a, b)"]),
        ("a = g(b, c)", "assignment", ["pass"]),
        ("y = g(b, c)", "assignment", []),  # without it y would have no value at all
        ("a.append(b)", "call", ["pass"]),
    ],
)
def test_each_kind_changes_what_it_says(line: str, kind: str, expected: list[str]) -> None:
    head = "def g(a: float, b: float): ...\ndef h(a: float, b: str): ...\ndef f(a, b, c):\n    "
    assert changes(head + line, kind) == expected


def test_an_assignment_is_lost_only_where_the_name_has_a_value_on_every_way() -> None:
    source = "def f(a):\n    if a:\n        x = a\n    else:\n        x = 2\n    x = a\n"
    lost = [fault for fault in generated(source) if fault.kind == "assignment"]
    assert [source.encode()[fault.start : fault.end] for fault in lost] == []
    source = "def f(a):\n    x = 1\n    if a:\n        x = a\n"
    assert changes(source, "assignment") == ["pass"]


@pytest.mark.parametrize(
    "source",
    [
        '"""Words - 1."""\nimport a.b\nfrom a import b\nF = TypeVar("F", bound=Callable[..., Any])\n',
        'def f(x: Literal[1, 2] | None) -> Array[3]:\n    """Words - 1."""\n    y: A[3] = x\n    return y\n',
        "@cache(3)\ndef f(x):\n    return x\n",
        'def f(x):\n    if x > 1:\n        raise Error(x - 1, f"{x + 1}")\n    return f"{x - 1} not"\n',
        "def require_positive(x):\n    return x > 0\n",
        "@dataclass(frozen=True)\nclass A:\n    x: float = field(repr=f'{1}')\n",
        "y = zip(a, b, strict=True)\n",
        "def f(x):\n    assert x > 1\n    return 'a' + x\n",
    ],
)
def test_no_fault_where_nothing_is_computed(source: str) -> None:
    assert [fault.name for fault in generated(source)] == []


def test_values_of_the_module_and_defaults_are_faulty_too() -> None:
    source = "TILTED = 0.05\ndef f(x, y=2.0):\n    return x\nclass A:\n    z: float = 3.0\n"
    assert {fault.scope for fault in generated(source)} == {"TILTED", "f", "A"}


def test_names_tell_scopes_apart_and_survive_a_change_elsewhere() -> None:
    source = "def f(x):\n    def g(x):\n        return x + 1\n    return g(x + 2)\n"
    names = [fault.name for fault in generated(source)]
    assert "a.py:f.g:number-plus:1" in names
    assert "a.py:f:number-plus:1" in names
    assert len(set(names)) == len(names)
    later = [fault.name for fault in generated("def e(x):\n    return x - 1\n\n\n" + source)]
    assert [name for name in later if ":e:" not in name] == names


def test_bytes_are_counted_and_layout_stays() -> None:
    source = "def f(x):\n    # μ stays\n    return ('μ', x +\n            1)  # one\n"
    (fault,) = [fault for fault in generated(source) if fault.kind == "operator"]
    assert fault.applied(source) == "def f(x):\n    # μ stays\n    return ('μ', x - 1)  # one\n"
    assert fault.change == "x + 1 => x - 1"


def test_a_diff_shows_the_change_alone() -> None:
    source = "def f(x):\n    y = 2 * x\n    return y + 1\n"
    (fault,) = [fault for fault in generated(source) if fault.kind == "operator" and "+" in fault.before]
    lines = [line for line in fault.diff(source).splitlines() if line[:1] in "+-"]
    assert lines[2:] == ["-    return y + 1", "+    return y - 1"]


def test_a_change_that_changes_nothing_is_refused() -> None:
    source = "def f(x):\n    return x + 1\n"
    fault = GeneratedFault(
        file="a.py", scope="f", kind="none", ordinal=1, start=21, end=26, before="x + 1", after="(x) + 1"
    )
    with pytest.raises(
        ValueError, match=r"a.py:f:none:1 must make another program, got x \+ 1 => \(x\) \+ 1"
    ):
        fault.applied(source)


def test_every_file_of_the_groups_is_there_and_in_one_group() -> None:
    of_files = [
        (path.relative_to(CHECKOUT).as_posix(), group)
        for group in GROUPS
        for path in files_of(group, CHECKOUT)
    ]
    assert len({file for file, _ in of_files}) == len(of_files) > 50
    assert all(group_of(file) is group for file, group in of_files)


def test_a_sample_is_spread_over_files_and_kinds_and_every_fault_in_it_can_be_made() -> None:
    faults = all_faults(CHECKOUT)
    names = {fault.name for of in faults.values() for fault in of}
    assert len(names) == sum(len(of) for of in faults.values()) > 5000
    chosen = sample(faults, 200, seed=1)
    assert len({fault.file for fault in chosen}) > 0.9 * len(faults)
    assert len({fault.kind for fault in chosen}) > 20
    for fault in chosen[:80]:
        fault.applied((CHECKOUT / fault.file).read_text(encoding="utf-8"))
    assert sample(faults, 50, seed=1) == chosen[:50]
    assert sample(faults, 50, seed=2) != chosen[:50]
