"""Settings of an engine and of walls: dataclasses whose fields are annotated with their checks."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping
from dataclasses import dataclass, fields
from functools import cache, partial
from typing import Annotated, Self, get_type_hints

from rockwobble.models.number_checks import quoted, require_in_range

GUIDE = 0.2  # 2 h sqrt(stiffness of the guide): see `MujocoSettings.guide_stiffness`

#: Refuses a value out of range, by its name.
Check = Callable[[str, object], None]


def positive(*, most: float = math.inf, or_zero: bool = False) -> Check:
    """Check of a positive number of at most `most`; `or_zero` allows 0, too."""
    least, above = (0.0, -math.inf) if or_zero else (-math.inf, 0.0)
    return partial(require_in_range, kind=(int, float), least=least, above=above, most=most)


def one_of(*allowed: object) -> Check:
    """Check of a value against those allowed."""

    def check(name: str, value: object) -> None:
        if value not in allowed:
            raise ValueError(f"{name} must be one of {', '.join(map(str, allowed))}, got {quoted(value)}")

    return check


def whole(*, least: int = 1, most: float = math.inf) -> Check:
    """Check of a whole number."""
    return partial(require_in_range, kind=int, least=least, most=most)


Positive = Annotated[float, positive()]
NotNegative = Annotated[float, positive(or_zero=True)]
Share = Annotated[float, positive(most=1.0)]
Small = Annotated[float, positive(most=1e-3)]
Count = Annotated[int, whole()]


@dataclass(frozen=True, slots=True, kw_only=True)
class EngineSettings:
    """Settings of an engine: a dataclass whose fields are annotated with their checks."""

    def __post_init__(self) -> None:
        for name, check in _checks(type(self)).items():  # type: ignore[arg-type]  # a class is hashable
            check(name, getattr(self, name))

    @staticmethod
    def defaults(time_step: float) -> dict[str, float]:
        """Return the defaults that depend on the time step [s]."""
        return {"guide_stiffness": (GUIDE / time_step) ** 2 / 4.0}

    @classmethod
    def resolve(cls, given: Mapping[str, object], time_step: float) -> Self:
        """Settings for a time step [s], with those `given` in place of the defaults.

        Raises
        ------
        ValueError
            If a setting is unknown or out of range.
        """
        names = [field.name for field in fields(cls)]
        for name in given:
            if name not in names:
                engine = cls.__name__.removesuffix("Settings").lower()
                raise ValueError(f"{name!r} is not a setting of {engine}; allowed are {', '.join(names)}")
        return cls(**{**cls.defaults(time_step), **given})


@cache
def _checks(kind: type) -> dict[str, Check]:
    hints = get_type_hints(kind, include_extras=True)
    return {name: hint.__metadata__[0] for name, hint in hints.items()}
