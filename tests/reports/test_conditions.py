"""Every page states the conditions that differ from the defaults."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import pytest

import rockwobble as rw
from rockwobble.compare.storage.results import Results
from rockwobble.models import synthetic_motions
from rockwobble.reports.pages import page_of
from rockwobble.reports.pages.cases import case_lines, conditions

BODY = rw.Cylinder(semidiagonal=6.0, tan_alpha=0.2)
FRAME = rw.WobblingFrame(BODY, slab_mass_ratio=0.3)
MOTIONS = synthetic_motions(3, peak=1.5, seed=2, duration=4.0)
TENDON = {"tendon_prestress": 0.25, "tendon_stiffness": 1.75}
# two that stand in one plane are not compared: all pages have gravity, and one of the others
STATED = {
    "slab": ({"slab_mass_ratio": 0.3}, ["0.3 times"]),
    "resistance": ({"rolling_resistance": 0.0625}, ["0.0625"]),
    "tendon": (TENDON, ["restress 0.25", "stiffness 1.75"]),
}


def case_of(options: dict[str, float], motion: rw.GroundMotion) -> rw.Case:
    tendon = rw.Tendon(prestress=0.25, stiffness=1.75) if "tendon_prestress" in options else None
    return rw.Case(
        FRAME if "slab_mass_ratio" in options else BODY,
        motion,
        gravity=options["gravity"],
        rolling_resistance=options.get("rolling_resistance", 0.0),
        tendon=tendon,
        name=motion.name,
    )


def a_fragility(options: dict[str, Any]) -> Results:
    body = {"pier": FRAME if options.pop("slab_mass_ratio", 0.0) else BODY}
    return rw.fragility(body, MOTIONS, levels=[1.0, 2.0], methods=["recess"], workers=1, **options)


def a_sweep(options: dict[str, Any]) -> Results:
    size = {"semidiagonals": [6.0], "tan_alphas": [0.2], "scales": [1.0], "motions": MOTIONS}
    return rw.sweep(rw.Grid(**size, **options), workers=1)


def a_spectrum(options: dict[str, Any]) -> Results:
    size = {"semidiagonals": [5.0, 6.0], "intensities": [1.0, 2.0]}
    return rw.spectrum(0.2, MOTIONS[0], **size, workers=1, **options)


def an_ensemble(options: dict[str, Any]) -> Results:
    return rw.ensemble([case_of(options, motion) for motion in MOTIONS], runs=[], workers=1)


def an_advice(options: dict[str, Any]) -> Results:
    return rw.advise(case_of(options, MOTIONS[0]), copies=20)


STUDIES = (a_fragility, a_sweep, a_spectrum, an_ensemble, an_advice)
# an advice takes long: it is asked of a frame with a tendon at once; a grid has no resistance
BOTH = ({**STATED["slab"][0], **STATED["tendon"][0]}, [*STATED["slab"][1], *STATED["tendon"][1]])
ASKED = [
    *(
        (each, *STATED[name])
        for each in STUDIES[:-1]
        for name in STATED
        if (each, name) != (a_sweep, "resistance")
    ),
    (an_advice, *BOTH),
    (an_advice, *STATED["resistance"]),
]


@pytest.mark.slow
@pytest.mark.usefixtures("six_records")
@pytest.mark.parametrize(("study", "options", "words"), ASKED)
def test_every_page_states_unusual_conditions(
    study: Callable[[dict[str, Any]], Results], options: dict[str, float], words: list[str]
) -> None:
    text = page_of(study({"gravity": 3.75, **options}).made_by("rockwobble")).markdown()
    for each in [*words, "ravity", "3.75 m/s²"]:
        assert each in text, each


def test_only_nondefault_conditions_are_stated() -> None:
    for options, words in STATED.values():
        text = "\n".join(case_lines(case_of({"gravity": 3.75, **options}, MOTIONS[0])))
        assert [each for each in [*words, "3.75 m/s²"] if each not in text] == []
    members = [rw.Case(BODY, MOTIONS[0], gravity=gravity, name=str(gravity)) for gravity in (9.81, 3.75)]
    ensemble = rw.ensemble(members, runs=[], workers=1)
    assert "Gravity: differs" in page_of(ensemble.made_by("rockwobble")).markdown()
    for usual in ({}, {"gravity": 9.81, "tendon_prestress": 0.0, "slab_mass_ratio": 0.0}):
        assert conditions(usual) == []
