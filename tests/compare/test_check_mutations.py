"""Every fault is found, in the layer concerned, and the failure names the part that is wrong."""

from __future__ import annotations

import numpy as np
import pytest

from rockwobble import reduced
from rockwobble.compare.check import LAYERS, Bench, Finding, first_failure
from rockwobble.compare.check.mutant import Fault, mutated
from rockwobble.compare.check.mutations import Mutation, failures, main, mutations, names_it
from rockwobble.compare.check.term_faults import SUMS, term_faults
from rockwobble.models import read_suite

ALL = mutations()
# each tenth of the signs: a wrong sign shows more than 1 %, and the command tries all of them
CHOSEN = [m for m in ALL if not m.name.startswith("sign")] + [m for m in ALL if m.name.startswith("sign")][
    ::10
]
# too long for every run of the tests in the interpreter: solutions to 1e-13, and the engines of a suite
SHORT = [layer for layer in LAYERS if layer not in ("order", "agreement", "baseline")]


@pytest.mark.parametrize("mutation", CHOSEN, ids=lambda mutation: mutation.name)
def test_fault_is_found_and_named(mutation: Mutation) -> None:
    found = failures(mutation, [mutation.layer], first=True)
    assert found, "no check failed"
    assert names_it(mutation, found[0]), f"{found[0].name}: {found[0].part}"


def test_a_copy_without_a_fault_passes() -> None:
    with mutated() as copy:
        assert copy is not reduced
        assert first_failure(Bench(reduced=copy, suite=read_suite("quick"), workers=1), SHORT) is None


def test_a_copy_leaves_nothing_behind() -> None:
    import sys

    with mutated() as copy:
        name = copy.__name__
        assert name in sys.modules
    assert not [module for module in sys.modules if module.startswith(name)]
    assert reduced.simulate.__module__ == "rockwobble.reduced.simulation"


def test_every_sum_has_faults_in_both_senses() -> None:
    names = [each.name for each in term_faults(1.01)]
    assert len(set(names)) == len(names) > 40
    assert all(any(f" of {target}," in name for name in names) for target in SUMS)


def test_a_fault_that_no_longer_fits_is_an_error() -> None:
    gone = Fault(file="taylor.py", before="no such text", after="")
    with (
        pytest.raises(ValueError, match=r"'no such text' must occur once in reduced/taylor.py, got 0 times"),
        mutated(gone),
    ):
        pass


def test_a_fault_that_nothing_finds_is_said(capsys: pytest.CaptureFixture[str], monkeypatch) -> None:
    harmless = Mutation(
        name="nothing wrong",
        faults=(Fault(file="taylor.py", before="_SAFETY = 0.9 ", after="_SAFETY = 0.8 "),),
        layer="invariance",
        named=("",),
    )
    monkeypatch.setattr("rockwobble.compare.check.mutations.mutations", lambda: (harmless,))
    assert main(["--first"]) == 1
    assert "MISSED   nothing wrong" in capsys.readouterr().out


def test_a_model_that_raises_fails_its_check() -> None:
    class Broken:
        @staticmethod
        def simulate(*_: object, **__: object) -> None:
            raise ZeroDivisionError("division by zero")

    found: Finding | None = first_failure(Bench(reduced=Broken, suite=read_suite("quick")), ["residual"])
    assert found is not None
    assert found.note == "division by zero"
    assert np.isnan(found.value)
