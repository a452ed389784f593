"""Options of a study, stated once: names, defaults, ranges and help, for callers and for the command line."""

from __future__ import annotations

import math
from dataclasses import dataclass, field, fields
from numbers import Integral, Real
from typing import TypedDict, TypeVar, Unpack, get_type_hints

T = TypeVar("T")
_KEY = "option"


@dataclass(frozen=True, slots=True, kw_only=True)
class Option:
    """Help, range and form of an option; name, type and default are those of its field.

    Attributes
    ----------
    help : str
        A sentence or two, with the unit.
    group : str
        Under which help lists it.
    least, most : float
        Range of a number, both ends included.
    above, below : float
        A number must be larger, or smaller.
    choices : tuple of str
        Words, one of which a word is; where there are several words, each of them.
    form : str
        How a text is read that is neither a number nor a word: "numbers" (a list, or an even range),
        "levels" (a list, or a range even in the logarithm) or "restitution".
    flag : str
        Name on the command line, where it is not that of the field.
    """

    help: str
    group: str = ""
    least: float = -math.inf
    most: float = math.inf
    above: float = -math.inf
    below: float = math.inf
    choices: tuple[str, ...] = ()
    form: str = ""
    flag: str = ""


class _Stated(TypedDict, total=False):
    group: str
    least: float
    most: float
    above: float
    below: float
    choices: tuple[str, ...]
    form: str
    flag: str


@dataclass(frozen=True, slots=True)
class OptionsIn:
    """Factory of plan fields that are options under one heading of the help text."""

    group: str

    def __call__(self, default: T, text: str, **stated: Unpack[_Stated]) -> T:
        """Plan field of an option: its help, and attributes of `Option`."""
        stated.setdefault("group", self.group)
        return field(default=default, metadata={_KEY: Option(help=text, **stated)})


option = OptionsIn("Method")


class Plan:
    """Base of the plans: frozen dataclasses whose fields are options, checked at construction.

    Raises
    ------
    ValueError
        If a number is none or out of its range, or a word is none of the choices.
    """

    def __post_init__(self) -> None:
        # imports numpy, which the help of a command does not need
        from rockwobble.models.number_checks import require_in_range, require_one_of

        kinds = get_type_hints(type(self))
        for name, stated in options_of(type(self)).items():
            kind, value = kinds[name], getattr(self, name)
            if stated.choices and value is not None:
                for word in [value] if isinstance(value, str) else value:
                    require_one_of(name, word, stated.choices)
            whole = kind in (int, int | None)
            if value is not None and (whole or kind in (float, float | None)):
                ends = {end: getattr(stated, end) for end in ("least", "most", "above", "below")}
                require_in_range(name, value, Integral if whole else Real, **ends)


def options_of(plan: type) -> dict[str, Option]:
    """Options of a plan by name."""
    return {each.name: each.metadata[_KEY] for each in fields(plan) if _KEY in each.metadata}
