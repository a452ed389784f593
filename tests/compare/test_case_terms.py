"""A new field of a case is ignored nowhere: hashes include it, and code without it refuses it."""

from __future__ import annotations

import re
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np
import pytest

import rockwobble as rw
from rockwobble.compare.metrics.pair import balance_of
from rockwobble.compare.runs.execution import case_inputs
from rockwobble.compare.storage.provenance import fingerprint
from rockwobble.models import case as case_module
from rockwobble.multibody.engines.registry import engine_for, engine_named, engine_names
from rockwobble.reports.pages.cases import conditions
from rockwobble.studies.plans import SpectrumPlan
from rockwobble.studies.spectrum import parts


@dataclass(frozen=True, slots=True, repr=False)
class Padded(rw.Case):
    """A case with a term unknown to all models."""

    pad_stiffness: float = 0.0


ROOT = Path(__file__).parents[2]
PIER = rw.Cylinder(semidiagonal=6.0, tan_alpha=0.2)
RELEASE = rw.InitialState(0.1, rolling_rate=0.4)
PLAIN = rw.Case(PIER, initial=RELEASE, duration=2.0)
TENDON = rw.Tendon(prestress=0.5, stiffness=2.0)
PADDED = Padded(PIER, initial=RELEASE, duration=2.0, pad_stiffness=0.25)


def test_terms_are_the_fields_that_differ_from_their_default() -> None:
    assert case_module.TERMS == ("rolling_resistance", "tendon")
    assert PLAIN.terms == replace(PLAIN, gravity=1.6, friction=0.3, name="other").terms == {}
    both = replace(PLAIN, tendon=TENDON, rolling_resistance=0.01)
    assert both.terms == {"rolling_resistance": 0.01, "tendon": TENDON}
    assert PADDED.terms == {"pad_stiffness": 0.25}
    # a tendon is an anchor as well
    assert [replace(both, tendon=each).anchor for each in (None, TENDON)] == ["", "a tendon"]


def test_the_hash_of_a_case_depends_on_a_new_term() -> None:
    cases = PLAIN, PADDED, replace(PADDED, pad_stiffness=0.5)
    assert len({fingerprint(case_inputs(case)) for case in cases}) == len(cases)
    assert fingerprint(case_inputs(replace(PADDED, pad_stiffness=0.0))) == fingerprint(case_inputs(PLAIN))


# hashes of results stored by version 0.4.0: with others all are computed again
@pytest.mark.parametrize(
    ("terms", "digest"),
    [
        ({}, "3a6bd9b6bcd3bb9d25e58cd1d8fd624f"),
        ({"tendon": TENDON}, "fc2bde8fd5f206fea9ad761b55dcf884"),
        ({"rolling_resistance": 0.01}, "444da70fcea97bafcc45df61ca35c781"),
        ({"tendon": rw.Tendon(), "rolling_resistance": 0.02}, "0719fc27499f5487ef04e24c09dad5cc"),
    ],
)
def test_the_hashes_of_cases_are_unchanged(terms: dict[str, object], digest: str) -> None:
    assert fingerprint(case_inputs(replace(PLAIN, **terms))) == digest


def test_reduced_models_and_balance_refuse_an_unknown_term() -> None:
    case = replace(PADDED, initial=rw.InitialState(0.1))
    for options in ({}, {"support": "flat"}, {"plane": 0.0}):
        with pytest.raises(ValueError, match=r"^the reduced models know no pad_stiffness, got 0\.25$"):
            rw.simulate(case, **options)
    assert balance_of(replace(PLAIN, rolling_resistance=0.01)) == PIER.alpha  # to the bit
    with pytest.raises(ValueError, match="know no pad_stiffness"):
        balance_of(PADDED)


@pytest.mark.parametrize("engine", engine_names())
def test_engines_refuse_an_unknown_term(engine: str) -> None:
    assert engine_named(engine).facts.terms <= set(case_module.TERMS)
    with pytest.raises(
        ValueError, match=rf"^{engine} has no pad stiffness: pad_stiffness must be 0, got 0\.25$"
    ):
        engine_for(PADDED, engine, engine_named(engine).supports[0])


def test_a_page_states_an_unknown_term_by_its_name(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(case_module, "TERMS", (*case_module.TERMS, "pad_stiffness"))
    assert conditions({"pad_stiffness": 0.25}) == ["Pad stiffness: 0.25"]
    assert conditions({"pad_stiffness": 0.0}) == []


@dataclass(frozen=True, kw_only=True)
class PaddedPlan(SpectrumPlan):
    """Options of a spectrum with an unknown term."""

    pad_stiffness: float = 0.0


def test_the_hash_of_a_spectrum_depends_on_a_new_term() -> None:
    def key(plan: SpectrumPlan) -> str:
        one, still = np.ones(1), rw.GroundMotion(np.zeros((2, 2)), 0.1)
        runs = parts.SpectrumRuns(
            tan_alpha=0.2,
            motion=still,
            plan=plan,
            semidiagonals=6.0 * one,
            intensities=one,
            searched_from={"recess": 1.0},
        )
        return parts.SpectrumPart(series="recess", places=range(1), runs=runs).key()

    terms = {}, {"rolling_resistance": 0.01}, {"tendon_stiffness": 1.0}
    assert len({key(SpectrumPlan(**each)) for each in terms}) == len(terms)
    assert key(PaddedPlan(pad_stiffness=0.25)) != key(PaddedPlan())


def test_the_listed_places_of_a_term_exist() -> None:
    text = (ROOT / "docs" / "development" / "adding.md").read_text(encoding="utf-8")
    section = text.split("## A new term of the equations\n")[1].split("\n## ")[0]
    places = []
    for cell in re.findall(r"^\| (`[^|]*) \|", section, re.MULTILINE):
        first, *others = map(Path, re.findall(r"`([^`]+)`", cell))
        places += [first, *(first.parent / other for other in others)]
    assert len(places) == 10
    assert [place for place in places if not (ROOT / place).is_file()] == []
