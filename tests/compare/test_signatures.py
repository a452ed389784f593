"""The public studies name each option of their plans, with the same type and default."""

from __future__ import annotations

import inspect
import re
from collections.abc import Callable
from typing import Any, get_type_hints

import pytest

import rockwobble as rw
from rockwobble.compare.runs.plan import Plan, options_of
from rockwobble.compare.studies.plans import AdvicePlan, Copies, FragilityPlan, SpectrumPlan

STUDIES = {
    rw.advise: AdvicePlan,
    rw.ensemble: Copies,
    rw.fragility: FragilityPlan,
    rw.spectrum: SpectrumPlan,
}


@pytest.mark.parametrize(("study", "plan"), STUDIES.items(), ids=[each.__name__ for each in STUDIES])
def test_a_study_names_the_options_of_its_plan(study: Callable[..., Any], plan: type[Plan]) -> None:
    parameters, own, types = inspect.signature(study).parameters, plan(), get_type_hints(plan)
    stated = get_type_hints(study)
    assert not [each for each in parameters.values() if each.kind is inspect.Parameter.VAR_KEYWORD]
    for name in options_of(plan):
        assert parameters[name].kind is inspect.Parameter.KEYWORD_ONLY, name
        if (study, name) == (rw.advise, "support"):  # that of the run, if there is one
            assert parameters[name].default is None
        else:
            assert parameters[name].default == getattr(own, name), name
            assert stated[name] == types[name], name
        assert re.search(rf"^(.*, )?{name}(, .*)? : ", inspect.getdoc(study) or "", re.MULTILINE), name
