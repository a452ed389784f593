"""Options of a study, stated once: names, defaults, ranges and help, for callers and for the command line."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass, field, fields
from functools import partial
from numbers import Integral, Real
from typing import Any, TypeVar, get_type_hints

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
    group: str
    least: float = -math.inf
    most: float = math.inf
    above: float = -math.inf
    below: float = math.inf
    choices: tuple[str, ...] = ()
    form: str = ""
    flag: str = ""

    def range_words(self) -> str:
        """Return the range in words."""
        low = f"at least {self.least:g}" if self.least > -math.inf else ""
        low = f"above {self.above:g}" if self.above > -math.inf else low
        high = f"at most {self.most:g}" if self.most < math.inf else ""
        high = f"below {self.below:g}" if self.below < math.inf else high
        return " and ".join(part for part in (low, high) if part) or "finite"


def option(default: T, text: str, *, group: str = "Method", **more: Any) -> T:
    """Return the field of a plan that is an option; `text` is its help, `more` are attributes of `Option`."""
    return field(default=default, metadata={_KEY: Option(help=text, group=group, **more)})


def options_in(group: str) -> Callable[..., Any]:
    """Return `option` for the options of one group."""
    return partial(option, group=group)


class Plan:
    """Base of the plans: frozen dataclasses whose fields are options, checked when one is made.

    Raises
    ------
    ValueError
        If a number is none or out of its range, or a word is none of the choices.
    """

    def __post_init__(self) -> None:
        from rockwobble.models.number_checks import quoted  # with numpy, which help can do without

        kinds = get_type_hints(type(self))
        for name, stated in options_of(type(self)).items():
            kind, value = kinds[name], getattr(self, name)
            if stated.choices and value is not None:
                words = [value] if isinstance(value, str) else value
                wrong = [word for word in words if word not in stated.choices]
                if wrong:
                    allowed = ", ".join(stated.choices)
                    raise ValueError(f"{name} must be one of {allowed}, got {quoted(wrong[0])}")
            whole = kind in (int, int | None)
            if value is None or not (whole or kind in (float, float | None)):
                continue
            number = isinstance(value, Integral if whole else Real) and not isinstance(value, bool)
            if not (number and stated.least <= value <= stated.most and stated.above < value < stated.below):
                what = "a whole number, " if whole else ""
                raise ValueError(f"{name} must be {what}{stated.range_words()}, got {quoted(value)}")


def options_of(plan: type) -> dict[str, Option]:
    """Return the options of a plan by name."""
    return {each.name: each.metadata[_KEY] for each in fields(plan) if _KEY in each.metadata}
