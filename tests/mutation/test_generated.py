"""Generated faults: where they are made, and that each is really in the copy that is tried."""

from __future__ import annotations

import os
import subprocess
import sys
from pathlib import Path

import pytest

from mutation import generated
from mutation.generated import applied, faults_of, sample, tried
from mutation.reach import Reach, near, read

CHECKOUT = Path(__file__).parents[2]
SOURCE = '''"""Text 1."""
def f(x: int = 3) -> float:
    if x < 0:
        raise ValueError(f"it must be at least {0 + 1}")
    return -g(x, 2.0) * x if x <= 2 else 0.5
'''


@pytest.mark.parametrize(
    ("kind", "expected"),
    [
        ("operator", "-g(x, 2.0) / x"),
        ("comparison", "if x < 2"),
        ("number", "x: int=4"),
        ("condition", "if not x <= 2"),
        ("sign", "+g(x, 2.0)"),
        ("arguments", "g(2.0, x)"),
    ],
)
def test_a_fault_is_one_change_outside_of_refusals_and_messages(kind: str, expected: str) -> None:
    faults = faults_of("f.py", SOURCE)
    assert not [fault for fault in faults if "line 3" in fault.change or "line 4" in fault.change]
    assert expected in applied(next(each for each in faults if f", {kind}: " in each.change), SOURCE)


def test_a_fault_is_known_by_the_innermost_function() -> None:
    inner = "ONE = 1\n\n@cache\ndef f(x=2):\n    def g():\n        return 3\n    return 4\n"
    places = {fault.change[-1]: fault.function for fault in faults_of("f.py", inner)}
    assert places == {"1": None, "2": None, "3": 5, "4": 3}


def test_tests_that_call_the_function_are_nearest_and_the_fastest_first() -> None:
    def reach(test: str, seconds: float, *calls: str) -> Reach:
        return Reach(test=test, seconds=seconds, calls=frozenset(calls))

    other = reach("tests/compare/test_a.py::test_other", 0.1, "models/a.py:3")
    slow, fast = (reach(f"tests/models/test_a.py::test_{t}", t, "models/a.py:3") for t in (9.0, 1.0))
    beside, far = (
        reach("tests/models/test_a.py::test_b", 2.0, "models/a.py:7"),
        reach("tests/models/t.py::t", 1.0),
    )
    tests = [other, slow, fast, beside, far]
    assert near(tests, "models/a.py", 3) == [fast, slow, other]
    assert near(tests, "models/a.py", None) == [fast, beside, slow, other]
    assert near(tests, "models/b.py", 3) == [fast, far, beside, slow]


def test_what_tests_and_shared_fixtures_call_is_recorded(tmp_path: Path) -> None:
    (tmp_path / "models").mkdir()
    (tmp_path / "models/a.py").write_text("def one():\n    return 1\n\ndef two():\n    return 2\n")
    (tmp_path / "test_a.py").write_text(
        "import pytest\nfrom models.a import one, two\n"
        "@pytest.fixture(scope='module')\ndef shared():\n    return two()\n"
        "def test_a(shared):\n    one()\ndef test_b(shared):\n    pass\ndef test_c():\n    pass\n"
    )
    command = [sys.executable, "-m", "pytest", "-q", "-p", "mutation.reach", "--rootdir", ".", "test_a.py"]
    paths = {
        "PYTHONPATH": f"{tmp_path}{os.pathsep}{CHECKOUT / 'tests'}",
        "REACH": str(tmp_path / "reach.json"),
    }
    # of a process of its own, also where this one is a worker of many
    alone = {name: value for name, value in os.environ.items() if not name.startswith("PYTEST_")}
    subprocess.run(command, cwd=tmp_path, env=alone | paths, check=True, capture_output=True)
    calls = {each.test.split("::")[1]: sorted(each.calls) for each in read(tmp_path / "reach.json")}
    assert calls == {"test_a": ["models/a.py:1", "models/a.py:4"], "test_b": ["models/a.py:4"], "test_c": []}


def test_a_sample_is_spread_over_the_files_and_always_the_same() -> None:
    first = sample(CHECKOUT, 40, 1)
    assert len({fault.file for fault in first}) == 40
    assert first == sample(CHECKOUT, 40, 1) != sample(CHECKOUT, 40, 2)
    only = sample(CHECKOUT, 5, 1, "reduced/integration/uplift.py")
    assert {fault.file for fault in only} == {"reduced/integration/uplift.py"}


@pytest.mark.parametrize(
    ("checked", "test", "found_by"), [(1, 2, "check"), (2, 1, "tests"), (1, 1, "tests"), (2, 2, "nothing")]
)
def test_tests_are_asked_first_and_then_check(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, checked: int, test: int, found_by: str
) -> None:
    (tmp_path / "models").mkdir()
    (tmp_path / "tests/models").mkdir(parents=True)
    (tmp_path / "models/a.py").write_text("ONE = 1\n")
    # "1" is what the right source says and 2 what the fault makes of it
    body = f"import models.a\ndef test_a():\n    assert models.a.ONE in (1, {test})\n"
    (tmp_path / "tests/models/test_a.py").write_text(f"import sys\nsys.path.insert(0, '.')\n{body}")
    check = (
        f"import sys; sys.path.insert(0, '.'); import models.a; sys.exit(models.a.ONE not in (1, {checked}))"
    )
    monkeypatch.setattr(generated, "_CHECK", check)
    (fault,) = faults_of("models/a.py", "ONE = 1\n")
    asked = Reach(test="tests/models/test_a.py::test_a", seconds=0.1, calls=frozenset())
    row = tried(tmp_path, fault, [asked])
    assert row.found_by == found_by, row.detail
    assert (tmp_path / "models/a.py").read_text() == "ONE = 1\n"
