"""The public studies name each option of their plans, with the same type and default."""

from __future__ import annotations

import inspect
import re
from collections.abc import Callable
from typing import Any, get_type_hints

import pytest

import rockwobble as rw
from rockwobble.compare.runs.plan import Plan, options_of
from rockwobble.studies.plans import AdvicePlan, Copies, FragilityPlan, SpectrumPlan

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


PARTS = (rw, rw.models, rw.reduced, rw.multibody, rw.compare)
# settings of an engine or a model as options, refused there by name
PASS_SETTINGS = {"Run", "check", "simulate"}


def public_functions() -> dict[str, Callable[..., object]]:
    """Every public function, and every method of a public class, by name."""
    functions: dict[str, Callable[..., object]] = {}
    for part in PARTS:
        for name in part.__all__:
            value = getattr(part, name)
            if inspect.isclass(value) and value.__module__.startswith("rockwobble"):
                if inspect.isfunction(value.__init__):
                    functions[name] = value.__init__
                functions |= {
                    f"{name}.{own}": each
                    for own, each in inspect.getmembers(value, inspect.isfunction)
                    if not own.startswith("_") and each.__module__.startswith("rockwobble")
                }
            elif inspect.isfunction(value):
                functions[f"{name} of {part.__name__}"] = value
    return functions


@pytest.mark.parametrize("name", public_functions())
def test_every_parameter_of_a_public_function_is_named_and_typed(name: str) -> None:
    function = public_functions()[name]
    for parameter in inspect.signature(function).parameters.values():
        if parameter.name == "self":
            continue
        annotation = str(parameter.annotation)
        assert parameter.annotation is not parameter.empty, parameter.name
        assert not re.search(r"\bAny\b", annotation), parameter
        if parameter.kind is parameter.VAR_KEYWORD:
            assert name.partition(" ")[0] in PASS_SETTINGS, parameter
