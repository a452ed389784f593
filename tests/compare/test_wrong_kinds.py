"""Arguments of the wrong kind are refused by name, in one line."""

import pytest

import rockwobble as rw
from rockwobble.models import Case, Cylinder

PIER = Cylinder(semidiagonal=6.0, tan_alpha=0.2)
WRONG = [None, 3.0, "case", PIER, object(), [PIER], {"a": 1}, rw.el_centro_1940()]


@pytest.mark.parametrize("wrong", WRONG, ids=lambda each: type(each).__name__)
def test_a_study_says_what_it_was_given_and_what_is_allowed(wrong: object) -> None:
    with pytest.raises(ValueError, match="case must be Case, got"):
        rw.advise(wrong)  # type: ignore[arg-type]
    with pytest.raises(ValueError, match=r"case_or_members must be Case \| Suite .*, got"):
        rw.ensemble(wrong)  # type: ignore[arg-type]
    with pytest.raises(ValueError, match=r"motions must be Sequence.GroundMotion. .*, got"):
        rw.fragility(PIER, wrong)  # type: ignore[arg-type]
    if wrong not in (PIER, [PIER]):
        with pytest.raises(ValueError, match=r"cylinders must be .*, got"):
            rw.fragility(wrong, [rw.el_centro_1940()])  # type: ignore[arg-type]


def test_the_run_of_an_advice_is_a_run() -> None:
    with pytest.raises(ValueError, match=r"run must be Run \| None, got 'mujoco'"):
        rw.advise(Case(PIER, rw.el_centro_1940()), "mujoco")  # type: ignore[arg-type]
