"""Every listed fault is detected by the check, and is present in the tested copy."""

from __future__ import annotations

import re

import pytest

from mutation.listed import Mutation, false_alarm, first_failure, mutations, run
from mutation.mutant import Fault, mutated
from mutation.places import Change, appended, at_assignment, scaled_argument, wrapped
from mutation.term_faults import SUMS, term_faults
from rockwobble import reduced
from rockwobble.compare.check import lagrange
from rockwobble.models import Case, Cylinder, InitialState

# its inertias are no function of its shape, so that its motions alone tell all terms apart
ONE = "own inertias, tan alpha = 0.5"
PLAIN = Case(Cylinder(semidiagonal=6.0, tan_alpha=0.2), initial=InitialState(0.1), duration=0.5)


@pytest.fixture(autouse=True)
def short_motions(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(lagrange, "CYLINDERS", {ONE: lagrange.CYLINDERS[ONE]})
    monkeypatch.setattr(lagrange, "RUNS", 4)


@pytest.mark.parametrize("mutation", mutations(), ids=lambda mutation: mutation.name)
def test_every_listed_fault_is_detected(mutation: Mutation) -> None:
    failure = first_failure(mutation)
    assert failure is not None
    assert failure.group == mutation.group


def test_a_copy_without_a_fault_passes() -> None:
    assert false_alarm() is None


def test_mutated_copy_leaves_no_modules_loaded() -> None:
    import sys

    with mutated() as copy:
        assert copy is not reduced
        name = copy.__name__
        assert name in sys.modules
    assert not [module for module in sys.modules if module.startswith(name)]
    assert reduced.simulate.__module__ == "rockwobble.reduced.simulation"


def test_every_sum_of_the_equations_has_named_term_faults() -> None:
    names = [each.name for each in term_faults(1.01)]
    assert len(set(names)) == len(names) > 40
    assert all(any(f" of {target}," in name for name in names) for target in SUMS)


@pytest.mark.parametrize(
    ("change", "message"),
    [
        (
            at_assignment("body_of", "no_such", "pass"),
            "reduced/body.py: the source must have an assignment to 'no_such' in body_of, got b, h, height, "
            "I1, I2, gamma, w, mu, A, R, p2",
        ),
        (
            at_assignment("no_such", "A", "pass", after=True),
            "reduced/body.py: the source must have a function 'no_such', got Body, body_of",
        ),
        (
            scaled_argument("body_of", "Body", "no_such", 1.01),
            "reduced/body.py: the source must have an argument 'no_such' of Body in body_of, got b, h, I1",
        ),
    ],
)
def test_fault_without_its_place_in_the_source_is_an_error(change: Change, message: str) -> None:
    with pytest.raises(ValueError, match=re.escape(message)), mutated(Fault(file="body.py", change=change)):
        pass


def test_undetected_faults_are_reported(
    capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    harmless = Mutation(
        name="nothing wrong",
        faults=(Fault(file="integration/taylor.py", change=appended("_SAFETY = 0.8")),),
        group="equations",
    )
    monkeypatch.setattr("mutation.listed.mutations", lambda: (harmless,))
    monkeypatch.setattr("mutation.listed.INTERPRETED", ("equations", "exact"))
    assert run() == 1
    assert "nothing wrong: MISSED" in capsys.readouterr().out


def test_fault_whose_code_raises_does_not_count_as_detected(
    capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    """A wrapper with a missing parameter ends every run in a TypeError, which is no detection."""
    wrapper = "def body_of(cylinder): return without_fault(cylinder)"
    stale = Mutation(
        name="stale signature",
        faults=(Fault(file="body.py", change=wrapped("body_of", wrapper)),),
        group="exact",
    )
    with mutated(*stale.faults) as copy, pytest.raises(TypeError, match=r"^body_of\(\) takes 1 positional"):
        copy.simulate(PLAIN)
    monkeypatch.setattr("mutation.listed.mutations", lambda: (stale,))
    monkeypatch.setattr("mutation.listed.INTERPRETED", ("equations", "exact"))
    assert run() == 1
    assert "stale signature: MISSED" in capsys.readouterr().out
