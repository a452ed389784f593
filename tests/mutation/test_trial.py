"""A fault is really in the copy that is tried, the copy is mended, and an ending is called what it is."""

from __future__ import annotations

import os
import subprocess
import sys
from pathlib import Path

import pytest

from mutation.names import signatures_of
from mutation.sites import GeneratedFault, faults_of
from mutation.trees import Tree, compiled_files, copy_tree, digest
from mutation.trial import CRASH, NOTHING, TESTS, TIMEOUT, Limits, ask_check, ask_tests

CHECKOUT = Path(__file__).parents[2]
KERNELS = "from .steps import one\n@kernel\ndef entry(x):\n    return one(x)\n"


@pytest.fixture
def checkout(tmp_path: Path) -> Path:
    """A checkout of three files, one of which is not compiled."""
    root = tmp_path / "checkout"
    for name, text in (
        ("kernels.py", KERNELS),
        ("steps.py", "def one(x):\n    return x + 1\n"),
        ("plain.py", "def two(x):\n    return x + 2\n"),
    ):
        (root / "reduced" / name).parent.mkdir(parents=True, exist_ok=True)
        (root / "reduced" / name).write_text(text)
    (root / "reduced/__pycache__").mkdir()
    (root / "reduced/__pycache__/kernels.entry-2.py311.nbi").write_text("machine code")
    return root


def operator_of(root: Path, file: str) -> GeneratedFault:
    source = (root / file).read_text()
    return next(fault for fault in faults_of(file, source, signatures_of([])) if fault.kind == "operator")


def tree_of(checkout: Path, tmp_path: Path) -> Tree:
    copy_tree(checkout, tmp_path / "copy")
    return Tree(tmp_path / "copy", checkout)


def value(root: Path, call: str) -> str:
    command = [sys.executable, "-P", "-c", f"import {call.split('.')[0]} as m; print(m.{call.split('.')[1]})"]
    environment = os.environ | {"PYTHONPATH": str(root / "reduced"), "PYTHONDONTWRITEBYTECODE": ""}
    return subprocess.run(command, env=environment, check=True, capture_output=True, text=True).stdout.strip()


def test_a_fault_of_the_same_length_and_time_is_really_run(checkout: Path, tmp_path: Path) -> None:
    tree = tree_of(checkout, tmp_path)
    time = (tree.root / "reduced/plain.py").stat().st_mtime_ns
    assert value(tree.root, "plain.two(5)") == "7"  # Python keeps its compiled file
    with tree.holding(operator_of(checkout, "reduced/plain.py")) as root:
        assert value(root, "plain.two(5)") == "3"
        assert (root / "reduced/plain.py").stat().st_mtime_ns == time
        assert list((root / "reduced/__pycache__").glob("*.nbi")), "nothing compiled is concerned"
    assert value(tree.root, "plain.two(5)") == "7"


def test_a_fault_in_what_is_compiled_drops_the_machine_code_for_its_time(
    checkout: Path, tmp_path: Path
) -> None:
    tree = tree_of(checkout, tmp_path)
    assert {path.name for path in compiled_files(tree.root)} == {"kernels.py", "steps.py"}
    with tree.holding(operator_of(checkout, "reduced/steps.py")) as root:
        assert "x - 1" in (root / "reduced/steps.py").read_text()
        assert not list((root / "reduced/__pycache__").glob("*.nb?"))
        (root / "reduced/__pycache__/kernels.entry-2.py311.nbi").write_text("machine code of the fault")
    assert digest(tree.root) == digest(checkout)
    assert (tree.root / "reduced/__pycache__/kernels.entry-2.py311.nbi").read_text() == "machine code"


def test_the_compiled_files_of_this_checkout_are_known() -> None:
    names = {path.name for path in compiled_files(CHECKOUT)}
    assert {"kernels.py", "driver.py", "recurrences.py", "uplift.py", "forces.py"} <= names
    assert not {"simulation.py", "response.py", "batch.py"} & names


@pytest.mark.parametrize(
    ("probe", "found", "detail"),
    [
        ("import no_such_module", CRASH, "ModuleNotFoundError: No module named 'no_such_module' in start"),
        ("import os; os.kill(os.getpid(), 11)", CRASH, "SIGSEGV in start"),
        ("say(event='started', layer='exact'); while_true()", TIMEOUT, "out of time in exact"),
        ("say(event='failed', layer='exact', check='period', note='')", "exact", "period"),
        ("say(event='finished')", NOTHING, ""),
        ("say(event='finished'); raise SystemExit(3)", CRASH, "exit code 3 in the end"),
        ("say(event='passed', layer='exact', seconds=1.5)", CRASH, "exit code 0 in exact"),
    ],
)
def test_an_ending_is_called_what_it_is(tmp_path: Path, probe: str, found: str, detail: str) -> None:
    head = (
        "import json, sys\nfrom pathlib import Path\n"
        "report = open(json.loads(sys.argv[1])['report'], 'a', buffering=1)\n"
        "def say(**told): print(json.dumps(told), file=report)\n"
        "def while_true():\n    while True: pass\n"
    )
    (tmp_path / "tests/mutation").mkdir(parents=True)
    (tmp_path / "tests/mutation/probe.py").write_text(head + probe + "\n")
    verdict = ask_check(tmp_path, (), Limits(other=0.3))
    assert (verdict.found_by, verdict.detail) == (found, detail)


@pytest.mark.parametrize(
    ("test", "seconds", "found", "detail"),
    [
        ("assert 1 == 2", 60.0, TESTS, "tests/models/test_a.py::test_a"),
        ("assert 1 == 1", 60.0, NOTHING, ""),
        ("while True: pass", 0.5, TIMEOUT, "out of time in tests/models"),
    ],
)
def test_tests_are_asked(tmp_path: Path, test: str, seconds: float, found: str, detail: str) -> None:
    (tmp_path / "tests/models").mkdir(parents=True)
    (tmp_path / "tests/models/test_a.py").write_text(f"def test_a():\n    {test}\n")
    verdict = ask_tests(tmp_path, "models", Limits(tests={"models": seconds}))
    assert (verdict.found_by, verdict.detail) == (found, detail)


def test_tests_that_name_the_module_are_asked_first(tmp_path: Path) -> None:
    (tmp_path / "tests/models").mkdir(parents=True)
    for name, module in (("a", "case"), ("b", "cylinder"), ("c", "case")):
        (tmp_path / f"tests/models/test_{name}.py").write_text(f"# {module}\ndef test(): assert False\n")
    assert ask_tests(tmp_path, "models", Limits(), module="cylinder").detail == "tests/models/test_b.py::test"


def test_the_check_finds_a_fault_in_a_copy_and_no_other_package(tmp_path: Path) -> None:
    copy_tree(CHECKOUT, tmp_path / "copy")
    tree = Tree(tmp_path / "copy", CHECKOUT)
    source = (CHECKOUT / "compare/metrics/energy.py").read_text(encoding="utf-8")
    faults = faults_of("compare/metrics/energy.py", source, {})
    fault = next(each for each in faults if each.name.startswith("compare/metrics/energy.py:_work:operator"))
    with tree.holding(fault) as root:
        assert ask_check(root, ("conserved",), Limits()).found_by == "conserved"
    # without its link nothing is tried, least of all in the name of what is installed
    (tree.root / ".editable/rockwobble/compare").unlink()
    verdict = ask_check(tree.root, ("exact",), Limits())
    assert verdict.found_by == CRASH
    assert "No module named 'rockwobble.compare'" in verdict.detail
