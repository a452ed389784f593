"""From the tables of a suite file to cases and runs: one case for each combination of values."""

from __future__ import annotations

import itertools
import math
from collections.abc import Iterator
from pathlib import Path

from ..bounds import Bounds
from ..case import Case, Run, Suite
from ..cylinder import Cylinder, cylinder_of
from ..ground_motion import GroundMotion
from ..initial_state import InitialState
from .errors import located
from .motion import build_motion
from .tables import BoundsTable, CaseTable, CylinderTable, ReleaseTable, RunTable, SuiteTable

# a slip in three ranges must not fill the memory
_MOST_CASES = 10_000
# digits of a value in a name: as few as tell all values of a key apart
_DIGITS = (3, 4, 6, 9, 12)

_Values = dict[tuple[str, str], float]


def build_suite(table: SuiteTable, folder: Path) -> Suite:
    """Return the suite of a file that was read from `folder`.

    Raises
    ------
    ValueError
        If a value is out of range or a record cannot be read; the message begins with the path of the key.
    """
    cases: list[Case] = []
    first: dict[str, int] = {}
    for index, entry in enumerate(table.cases):
        if entry.name in first:
            raise ValueError(
                f"cases[{index}].name: must differ from cases[{first[entry.name]}].name, "
                f"got {entry.name!r} twice"
            )
        first[entry.name] = index
        cases += _cases(entry, f"cases[{index}]", folder)
    runs = [run for index, entry in enumerate(table.runs) for run in _runs(entry, f"runs[{index}]")]
    return Suite(cases, runs, None if table.bounds is None else _bounds(table.bounds))


def _bounds(table: BoundsTable) -> Bounds:
    with located("bounds"):
        return Bounds(**{name: value for name, value in table if value is not None})


def _runs(table: RunTable, path: str) -> Iterator[Run]:
    for engine, support, step in itertools.product(table.engine, table.support, table.time_step or (None,)):
        with located(path):
            yield Run(engine, support, step, **table.settings)


def _cases(table: CaseTable, path: str, folder: Path) -> Iterator[Case]:
    numbers = list(_numbers(table))
    count = math.prod(len(values) for _, values in numbers)
    if count > _MOST_CASES:
        raise ValueError(f"{path}: must make at most {_MOST_CASES} cases, got {count}")
    varied = {key: _texts(values) for key, values in numbers if len(values) > 1}
    records: dict[object, GroundMotion] = {}
    for combination in itertools.product(*(range(len(values)) for _, values in numbers)):
        chosen = dict(zip((key for key, _ in numbers), combination, strict=True))
        values = {key: given[chosen[key]] for key, given in numbers}
        parts = [f"{key[1]} {texts[chosen[key]]}" for key, texts in varied.items()]
        name = table.name + (f": {', '.join(parts)}" if parts else "")
        yield _case(table, name, values, path, folder, records)


def _numbers(table: CaseTable) -> Iterator[tuple[tuple[str, str], tuple[float, ...]]]:
    """Yield (table, key) and values of every number that the case gives, in the order of a name."""
    parts = [("cylinder", table.cylinder), ("motion", table.motion), ("release", table.release), ("", table)]
    for part, holder in parts:
        for key in type(holder).model_fields if holder is not None else ():
            values = getattr(holder, key)
            if isinstance(values, tuple):
                yield (part, key), values


def _texts(values: tuple[float, ...]) -> list[str]:
    texts: list[str] = []
    for digits in _DIGITS:
        texts = [f"{value:.{digits}g}" for value in values]
        if len(set(texts)) == len(texts):
            break
    return texts


def _case(
    table: CaseTable, name: str, values: _Values, path: str, folder: Path, records: dict[object, GroundMotion]
) -> Case:
    def of(part: str) -> dict[str, float]:
        return {key: value for (place, key), value in values.items() if place == part}

    with located(f"{path}.cylinder"):
        cylinder = _cylinder(table.cylinder, of("cylinder"))
    own = of("")
    motion = initial = None
    if table.motion is not None:
        with located(f"{path}.motion"):
            uplift = own.get("gravity", 9.81) * cylinder.tan_alpha
            motion = build_motion(table.motion, of("motion"), folder, uplift, records)
    if table.release is not None:
        with located(f"{path}.release"):
            initial = _release(table.release, of("release"), cylinder)
    with located(path):
        return Case(cylinder, motion, initial=initial, name=name, **own)


def _cylinder(table: CylinderTable, values: dict[str, float]) -> Cylinder:
    return cylinder_of(values, Cylinder if table.base_radius is None else Cylinder.from_dimensions)


def _release(table: ReleaseTable, values: dict[str, float], cylinder: Cylinder) -> InitialState:
    tilt = values.get("tilt", math.radians(values.get("tilt_deg", 0.0)))
    if table.tilt_over_alpha is not None:
        tilt = values["tilt_over_alpha"] * cylinder.alpha
    return InitialState(
        tilt=tilt,
        tilt_rate=values.get("tilt_rate", 0.0),
        rolling_angle=math.radians(values.get("rolling_angle_deg", 0.0)),
        rolling_rate=values.get("rolling_rate", 0.0),
    )
