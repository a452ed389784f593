"""Generated faults: their places, and their presence in the tested copy."""

from __future__ import annotations

from pathlib import Path

import pytest

from mutation import generated
from mutation.generated import applied, faults_of, near, sample, tried

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


def test_importing_test_files_come_first_by_package() -> None:
    asked = near(CHECKOUT, "models/hazard.py")
    assert asked[0] == "tests/models/test_hazard.py"
    asked = near(CHECKOUT, "studies/fragility/fit.py")
    assert asked[0] == "tests/studies/test_fragility_fit.py"
    assert "tests/studies/test_risk.py" in asked


def test_sample_of_faults_is_reproducible_and_spread_over_files() -> None:
    first = sample(CHECKOUT, 40, 1)
    assert len({fault.file for fault in first}) == 40
    assert first == sample(CHECKOUT, 40, 1) != sample(CHECKOUT, 40, 2)
    only = sample(CHECKOUT, 5, 1, "reduced/integration/uplift.py")
    assert {fault.file for fault in only} == {"reduced/integration/uplift.py"}


@pytest.mark.parametrize(
    ("checked", "test", "found_by"), [(1, 2, "check"), (2, 1, "tests"), (1, 1, "tests"), (2, 2, "nothing")]
)
def test_tests_run_before_the_check_on_each_fault(
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
    row = tried(tmp_path, fault)
    assert row.found_by == found_by, row.detail
    assert (tmp_path / "models/a.py").read_text() == "ONE = 1\n"
