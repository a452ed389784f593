"""Supports: strings with attributes."""

from __future__ import annotations

import copy
import json
import pickle

import pytest

from rockwobble.compare.storage.provenance import fingerprint
from rockwobble.models.plain_json import plain
from rockwobble.models.support import EXTERNAL, MODELLED, SUPPORTS, Support, support_named
from rockwobble.studies.plans import SUPPORT_WORDS

ALL = [*SUPPORTS.values(), EXTERNAL]


@pytest.mark.parametrize("support", ALL)
def test_a_support_is_a_string_with_its_name(support: Support) -> None:
    name = str(support)
    assert type(name) is str
    assert (support, hash(support), repr(support)) == (name, hash(name), repr(name))
    assert json.dumps({"support": support}) == json.dumps({"support": name})
    assert type(plain(support)) is str
    assert fingerprint([support]) == fingerprint([name])


@pytest.mark.parametrize("support", ALL)
@pytest.mark.parametrize("moved", [copy.deepcopy, lambda each: pickle.loads(pickle.dumps(each))])
def test_a_copy_keeps_every_fact(support: Support, moved) -> None:
    other = moved(support)
    assert [getattr(other, fact) for fact in Support.__slots__] == [
        getattr(support, fact) for fact in Support.__slots__
    ]


def test_attributes_of_a_support_are_immutable() -> None:
    with pytest.raises(AttributeError, match="does not change"):
        SUPPORTS["ring"].walls = False


@pytest.mark.parametrize("support", ALL)
def test_the_models_of_a_support_exist(support: Support) -> None:
    assert {support.own_model, *support.compared_with} <= set(MODELLED)
    assert support.has_model == (support in MODELLED) == (support.own_model == support)


def test_an_external_trajectory_is_refused_as_a_support() -> None:
    with pytest.raises(ValueError, match=f"support must be one of {', '.join(SUPPORTS)}, got 'external'"):
        support_named("external")


@pytest.mark.parametrize("support", SUPPORTS.values())
def test_the_help_of_every_command_has_the_words_of_a_support(support: Support) -> None:
    assert f"{support} ({support.words})" in SUPPORT_WORDS
