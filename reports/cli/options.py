"""Parsers of the options of a method: from text to numbers."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any, Literal

import typer

from rockwobble.studies.plans import SUPPORT_WORDS

if TYPE_CHECKING:
    from rockwobble.models.case import TimeStep as Step

_MOST_VALUES = 100_000


def time_step(text: str) -> Step:
    """Time step [s], "auto" or "extrapolated"; the engine checks the number later.

    Raises
    ------
    BadParameter
        If the text is neither.
    """
    from rockwobble.models.case import WAYS_TO_A_STEP

    for way in WAYS_TO_A_STEP:
        if text == way:
            return way
    return _number(text, 'a number [s], "auto" or "extrapolated"')


def restitution(text: str) -> float | Literal["momentum"]:
    """Coefficient of restitution, or "momentum".

    Raises
    ------
    BadParameter
        If the text is neither.
    """
    return "momentum" if text == "momentum" else _number(text, 'a number or "momentum"')


def numbers(text: str) -> list[float]:
    """Numbers of "6", "1,2,6" or "0.5:30:100", a range with both ends.

    Raises
    ------
    BadParameter
        If the text is none of these.
    """
    try:
        if ":" not in text:
            return [float(part) for part in text.split(",")]
        first, last, count = text.split(":")
        low, high, number = float(first), float(last), int(count)
    except ValueError:
        low = high = number = 0
    if not (2 <= number <= _MOST_VALUES and math.isfinite(low - high)):
        allowed = "a number, a list such as 1,2,6 or a range FROM:TO:COUNT"
        raise typer.BadParameter(f"must be {allowed}, got {text!r}")
    import numpy as np

    return [float(value) for value in np.linspace(low, high, number)]


def levels(text: str) -> list[float]:
    """Numbers of a list, or of a logarithmically even range."""
    values = numbers(text)
    if ":" not in text or not 0.0 < values[0] < values[-1]:
        return values
    ratio, last = math.log(values[-1] / values[0]), len(values) - 1
    return [values[0] * math.exp(ratio * place / last) for place in range(len(values))]


def _number(text: str, allowed: str) -> float:
    try:
        return float(text)
    except ValueError:
        raise typer.BadParameter(f"must be {allowed}, got {text!r}") from None


def settings(given: Sequence[str] | None) -> dict[str, int | float | str]:
    """Settings from texts name=value: an integer, a float, or the text.

    Raises
    ------
    ValueError
        If a text has another form, or a name comes twice.

    Examples
    --------
    >>> settings(["ring_facets=64", "ring_clearance=1e-2", "cone=pyramidal"])
    {'ring_facets': 64, 'ring_clearance': 0.01, 'cone': 'pyramidal'}
    """
    entries: dict[str, int | float | str] = {}
    for text in given or ():
        name, sign, value = (part.strip() for part in text.partition("="))
        if not (name and sign and value):
            raise ValueError(f"--set must be NAME=VALUE, got {text!r}")
        if name in entries:
            raise ValueError(f"--set {name} is given twice")
        entries[name] = _value(value)
    return entries


def _value(text: str) -> int | float | str:
    for kind in (int, float):
        try:
            return kind(text)
        except ValueError:
            continue
    return text


def panel(title: str) -> Callable[..., object]:
    """Factory of options under a help panel; without names an option is named like its parameter."""

    def option(help_text: str, *names: str, **more: Any) -> object:
        return typer.Option(*names, help=help_text, rich_help_panel=title, **more)

    return option


body, method, work, output = map(panel, ("Cylinder", "Method", "Work", "Output"))

SLENDERNESS = "Slenderness b/h: radius / half the height."
UNITS = (
    "Unit of the accelerations in the files, such as g, m/s2 or cm/s2; required if the files do not state it."
)
RECORD_COLUMNS = (
    "Columns of time, x, y, z in this order: Zeit,Ost,Nord or 1,4,3. values: all numbers are one component."
)
RECORD_STEP = "Time step of files without times, in s."
LENGTHS = "Components of different length: pad (fill the shorter with zeros) or cut (shorten the longer)."
REMOVE_MEAN = "Subtract the mean (sensor offset) of each component."
ROTATE = (
    "Rotation of the record [deg], counter-clockwise from above. north: x east, y north, by its azimuths."
)
RESAMPLE = (
    "Resample components to a common time step by linear interpolation (all original samples are kept)."
)
SUITES = "a TOML file, or a shipped one (canon, p695, quick)"
ALL, NO_ENGINE = "all", "none"  # accepted in place of engine names


def _standing_alone(names: list[str] | None) -> list[str] | None:
    word = next((word for word in (ALL, NO_ENGINE) if word in (names or ())), None)
    if names and word and len(names) > 1:
        raise typer.BadParameter(f"{word} stands alone, got {' and '.join(names)}")
    return names


def engine_names(names: list[str] | None) -> list[str] | None:
    """Names of engines, or no engine.

    Raises
    ------
    typer.BadParameter
        If all are meant, or none and others.
    """
    if names and ALL in names:
        raise typer.BadParameter("all is for compare; name each engine here, or none")
    return _standing_alone(names)


ENGINE = "Engine: mujoco, pybullet, dart, drake, exudyn, rapier or another that is installed"
ENGINES = f"{ENGINE}; may be repeated"
_SUPPORTS = f"Support: {SUPPORT_WORDS}; a support with walls needs an engine"
_DEFAULT = "Default: MuJoCo and PyBullet (DART where PyBullet is missing)"
Engines = Annotated[list[str] | None, method(f"{ENGINES}. {_DEFAULT}.", callback=engine_names)]
EnginesOrAll = Annotated[
    list[str] | None, method(f"{ENGINES}. {_DEFAULT}. all: every installed engine.", callback=_standing_alone)
]
Support = Annotated[str, method(f"{_SUPPORTS}.")]
Supports = Annotated[list[str] | None, method(f"{_SUPPORTS}; may be repeated. Default: recess and flat.")]
TimeStep = Annotated[
    Any,  # a number, a word or None: typer knows no type for that, `time_step` makes it
    method(
        "Time step, in s. Default: 1e-4 s at R = 6 m, scaled with sqrt(R). auto: halved until the tilt "
        "converges; extrapolated: Richardson extrapolation from three steps; both state the remaining error.",
        parser=time_step,
        metavar="FLOAT|auto|extrapolated",
    ),
]
Settings = Annotated[
    list[str] | None,
    method(
        "Setting of an engine or model, such as ring_clearance=0.01, integrator=discrete or rtol=1e-10; "
        "applied to every run that has it. May be repeated.",
        "--set",
        metavar="NAME=VALUE",
    ),
]
SuiteName = Annotated[
    str | None,
    typer.Argument(metavar="[SUITE]", help=f"Suite of cases and runs: {SUITES}.", show_default=False),
]
Workers = Annotated[
    int | None, work("Number of processes on this machine. Default: one per processor.", min=1)
]
Scheduler = Annotated[
    str | None,
    work(
        "Address of a Dask scheduler, such as tcp://10.0.0.1:8786 (start it by dask scheduler, and on "
        "each machine dask worker tcp://10.0.0.1:8786). Needs the extra distributed."
    ),
]
Out = Annotated[Path, output("Folder for the results.")]
Overwrite = Annotated[
    bool, output("Overwrite results of another command or of other options. Default: refused.", "--overwrite")
]
Open = Annotated[
    bool | None, output("Open the page in the browser. Default: yes in a terminal.", "--open/--no-open")
]
