"""From options that may be repeated, or name many, to cylinders, ground motions and methods."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any, Literal

import rockwobble as rw
import rockwobble.compare as rc

DEFAULT_COUNT = 100  # of made-up motions, where the user does not say


def cylinders_of(
    given: Sequence[str] | None, semidiagonal: float, tan_alpha: float
) -> dict[str, rw.Cylinder]:
    """Return the cylinders of texts NAME=R,TAN_ALPHA; without any the one of the two numbers.

    Raises
    ------
    ValueError
        If a text has another form, or a name comes twice.
    """
    if not given:
        body = rw.Cylinder(semidiagonal=semidiagonal, tan_alpha=tan_alpha)
        return {f"R = {semidiagonal:g} m, tan α = {tan_alpha:g}": body}
    found: dict[str, rw.Cylinder] = {}
    for text in given:
        name, sign, numbers = (part.strip() for part in text.partition("="))
        sizes = numbers.split(",")
        try:
            size, slenderness = map(float, sizes)
        except ValueError:
            name = ""
        if not (name and sign):
            raise ValueError(f"--cylinder must be NAME=R,TAN_ALPHA such as pier=6,0.2, got {text!r}")
        if name in found:
            raise ValueError(f"--cylinder {name} is given twice")
        found[name] = rw.Cylinder(semidiagonal=size, tan_alpha=slenderness)
    return found


def motions_of(
    p695: bool, records: Path | None, synthetic: int | None, units: str | None, seed: int
) -> tuple[list[rw.GroundMotion], str]:
    """Return the ground motions and what they are.

    Raises
    ------
    ValueError
        If two sources are asked for, or one cannot be read.
    """
    from rockwobble.compare.studies.ensemble.members import recorded_far_field
    from rockwobble.models.records.folder import read_records

    if p695 + (records is not None) + (synthetic is not None) > 1:
        raise ValueError("the motions are those of --p695, of --records or --synthetic, got more than one")
    if units is not None and records is None:
        raise ValueError("--units belongs to --records")
    if p695:
        return recorded_far_field(), "far-field pairs of FEMA P-695"
    if records is not None:
        return read_records(records, units=units), f"records of {records.name}"
    count = DEFAULT_COUNT if synthetic is None else synthetic
    return rc.synthetic_motions(count, peak=1.0, seed=seed), f"made-up ground motions, seed {seed}"


def methods_of(
    body: rw.Cylinder,
    models: Sequence[str] | None,
    engines: Sequence[str] | None,
    supports: Sequence[str] | None,
    given: Mapping[str, Any],
    time_step: float | Literal["auto"] | None,
) -> list[str | rw.Run]:
    """Return reduced models by name, and each engine with those of the supports that it has.

    Parameters
    ----------
    body : Cylinder
        On which the settings are tried.
    models, engines, supports : sequence of str, optional
        Models: all without any, none for "none". Engines: none without any.
    given : mapping
        Settings, each of every run that has one of that name.
    time_step : float or "auto", optional
        [s]

    Raises
    ------
    ValueError
        If an engine has none of the supports, or nothing has a setting.
    """
    from rockwobble.compare.studies.fragility.methods import MODELS
    from rockwobble.multibody.engines.registry import find_engine

    chosen: list[str | rw.Run] = [] if models == ["none"] else list(models or MODELS)
    if not engines:
        if supports or given or time_step is not None:
            raise ValueError("--support, --set and --time-step are for engines, give --engine as well")
        return chosen
    runs: list[rw.Run] = []
    for name in engines:
        able = [each for each in supports or () if each in find_engine(name).supports]
        if supports and len(able) < len(supports):
            lacks = [each for each in supports if each not in able]
            if not able:
                raise ValueError(f"{name} has no support {', '.join(lacks)}")
            print(f"{name} has no support {', '.join(lacks)} and is left out there")
        runs += rc.default_runs([name], able or None)
    if time_step is not None:
        runs = [rw.Run(run.engine, run.support, time_step) for run in runs]
    if given:
        runs = list(rc.with_settings(rw.Case(body, rw.el_centro_1940()), runs, given))
    return [*chosen, *runs]
