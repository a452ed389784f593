"""Every fault is found, in the layer concerned, and the failure names the part that is wrong."""

from __future__ import annotations

import re

import numpy as np
import pytest

from mutation.listed import Mutation, failures, false_alarm, mutations, names_it, run
from mutation.mutant import Fault, mutated
from mutation.places import Change, after_assignment, appended, before_assignment, scaled_argument, wrapped
from mutation.term_faults import SUMS, term_faults
from rockwobble import reduced
from rockwobble.compare.check import Bench, run_checks
from rockwobble.compare.check.engines import engine_equations
from rockwobble.compare.check.measures import exact_functions
from rockwobble.compare.check.models import equations, short_motions
from rockwobble.compare.check.models.short_motions import CYLINDERS
from rockwobble.models import read_suite

ALL = mutations()
# the command tries all: here each tenth of the signs, since a wrong sign shows more than 1 %, and each third
# of the terms at the start of a step, since the same term of its series shows in the same coefficient
SIGNS = [m for m in ALL if m.name.startswith("sign")]
STARTS = [m for m in ALL if re.match(r"1 % off: .* of \w+0,", m.name)]
CHOSEN = [m for m in ALL if m not in SIGNS + STARTS] + SIGNS[::10] + STARTS[::3]
# those that the faults in a copy are held against; the command asks it the others, too
HELD = list(dict.fromkeys(mutation.layer for mutation in ALL if mutation.faults))
# its inertias are no function of its shape, so that its motions alone tell all terms apart
ONE = "own inertias, tan alpha = 0.5"
# of its nine runs: the fit of nine coefficients has sixty states of them
RUNS = 4


@pytest.mark.parametrize("mutation", CHOSEN, ids=lambda mutation: mutation.name)
def test_fault_is_found_and_named(mutation: Mutation, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(equations, "CYLINDERS", {ONE: CYLINDERS[ONE]})
    monkeypatch.setattr(short_motions, "_RUNS", RUNS)
    found = failures(mutation, [mutation.layer], first=True)
    assert found, "no check failed"
    assert names_it(mutation, found[0]), f"{found[0].name}: {found[0].part}"


def test_a_copy_without_a_fault_passes(monkeypatch: pytest.MonkeyPatch) -> None:
    # in the interpreter each release takes long, and so do engines that compute the same copy's states again
    monkeypatch.setattr(exact_functions, "RATES", exact_functions.RATES[::4])
    monkeypatch.setattr(engine_equations, "STATES", 1)
    monkeypatch.setattr(short_motions, "_RUNS", RUNS)
    assert set(HELD) == {"equations", "conserved", "exact", "residual"}
    assert false_alarm(HELD) is None


def test_a_copy_leaves_nothing_behind() -> None:
    import sys

    with mutated() as copy:
        assert copy is not reduced
        name = copy.__name__
        assert name in sys.modules
    assert not [module for module in sys.modules if module.startswith(name)]
    assert reduced.simulate.__module__ == "rockwobble.reduced.simulation"


def test_every_sum_has_faults_in_both_senses() -> None:
    names = [each.name for each in term_faults(1.01)]
    assert len(set(names)) == len(names) > 40
    assert all(any(f" of {target}," in name for name in names) for target in SUMS)


@pytest.mark.parametrize(
    ("change", "message"),
    [
        (
            before_assignment("body_of", "no_such", "pass"),
            "reduced/body.py: the source must have an assignment to 'no_such' in body_of, got b, h, height, "
            "I1, I2, A, R, p2",
        ),
        (
            after_assignment("no_such", "A", "pass"),
            "reduced/body.py: the source must have a function 'no_such', got Body, body_of",
        ),
        (
            scaled_argument("body_of", "Body", "no_such", 1.01),
            "reduced/body.py: the source must have an argument 'no_such' of Body in body_of, got b, h, I1",
        ),
    ],
)
def test_a_fault_whose_place_is_gone_is_an_error(change: Change, message: str) -> None:
    with pytest.raises(ValueError, match=re.escape(message)), mutated(Fault(file="body.py", change=change)):
        pass


@pytest.mark.parametrize(
    ("change", "expected"),
    [
        (before_assignment("f.g", "y", "x += 1"), ["x += 1", "y = x"]),
        (after_assignment("f.g", "y", "y += 1"), ["y = x", "y += 1"]),
        (scaled_argument("f", "dict", "a", 2.0), ["dict(a=2.0 * x)"]),
        (
            wrapped("f", "def f(x): return -without_fault(x)"),
            ["def without_fault", "def f", "-without_fault(x)"],
        ),
        (appended("f = abs"), ["return g(x)", "f = abs"]),
    ],
)
def test_a_change_finds_its_place_by_names(change: Change, expected: list[str]) -> None:
    source = "def f(x):\n    def g(x):\n        y = x\n        return dict(a=x), y\n    return g(x)\n"
    changed = Fault(file="any.py", change=change).applied(source)
    places = [changed.find(text) for text in expected]
    assert -1 not in places, changed
    assert places == sorted(places), changed


def test_a_fault_that_nothing_finds_is_said(
    capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    harmless = Mutation(
        name="nothing wrong",
        faults=(Fault(file="integration/taylor.py", change=appended("_SAFETY = 0.8")),),
        layer="invariance",
        named=("",),
    )
    monkeypatch.setattr("mutation.listed.mutations", lambda: (harmless,))
    assert run(first=True) == 1
    assert "MISSED   nothing wrong" in capsys.readouterr().out


def test_a_model_that_raises_fails_its_check() -> None:
    class Broken:
        @staticmethod
        def simulate(*_: object, **__: object) -> None:
            raise ZeroDivisionError("division by zero")

    found, *_ = run_checks(Bench(reduced=Broken, suite=read_suite("quick")), ["residual"])
    assert found.failed
    assert found.note == "division by zero"
    assert np.isnan(found.value)
