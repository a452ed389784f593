"""Peak tilts over many records: whether the statistics of the model are those of the engine."""

from __future__ import annotations

import math

from ....metrics.distributions import MARGIN, Contrast
from ...ensemble.tables import pairs
from ..motions import source_of
from .limit import Limit, Tables, percent

# the first two are those of the places below
METHODS = ("engine, recess", "engine, flat", "flat")
_PLACES = {"recess": "in an ideal recess", "open": "on open ground"}


def contrasts(tables: Tables) -> dict[tuple[float, str], Contrast]:
    """Return each other method against the recess model, by level."""
    found = {}
    for level, runs in tables["statistics"].groupby("level"):
        for method in METHODS:
            item = pairs(runs, method, "recess", member="motion", peak="peak").contrast()
            if item is not None:
                found[float(str(level)), method] = item
    return found


def distribution(tables: Tables) -> Limit:
    """Draw the limit from the ensemble."""
    found = contrasts(tables)
    by_place = {
        "recess": [item for (_, method), item in found.items() if method == "engine, recess"],
        "open": [item for (_, method), item in found.items() if method == "engine, flat"],
    }
    numbers = {"members": float(max((item.count for item in found.values()), default=0))}
    for place, items in by_place.items():
        numbers |= {f"{place}_{name}": value for name, value in _worst(items).items()}
    opened = by_place["open"]
    numbers |= {
        "recess_fell": float(sum(item.against_overturned for item in opened)),
        "open_fell": float(sum(item.overturned for item in opened)),
        "both_fell": float(sum(item.both_overturned for item in opened)),
    }
    records = f"{numbers['members']:.0f} {source_of(tables['statistics']['motion'])}"
    return Limit(
        subject="Distributions of peak tilt",
        use=f"For statistics over records ({records}; the engine's peak of each against the model's): "
        f"{'; '.join(_verdict(numbers, place) for place in _PLACES)}.",
        error=f"Nine in ten records have a ratio of the two peaks {'; '.join(_spreads(found))} (0 and ∞: by "
        "the model or by the engine alone it overturns).",
        avoid=f"To name the records that overturn: {numbers['recess_fell']:.0f} do in the model, "
        f"{numbers['open_fell']:.0f} on open ground, {numbers['both_fell']:.0f} in both.",
        numbers=numbers,
    )


def _verdict(numbers: dict[str, float], place: str) -> str:
    """Return whether the median ratio is within the margin, with its interval."""
    low, high = (_ratio(numbers[f"{place}_{end}"], ".3f") for end in ("low", "high"))
    known, between = f"within {percent(MARGIN)} in the median", f"95 %: a ratio from {low} to {high}"
    if numbers[f"{place}_within"]:
        return f"{_PLACES[place]} they agree {known} ({between})"
    if numbers[f"{place}_beyond"]:
        return f"{_PLACES[place]} they do not agree {known} ({between})"
    reach = numbers[f"{place}_reach"]
    tell = percent(reach - 1.0) if math.isfinite(reach) else "no difference"
    return (
        f"{_PLACES[place]} it is undecided whether they agree {known} "
        f"({between}; so many records, so scattered, tell {tell})"
    )


def _spreads(found: dict[tuple[float, str], Contrast]) -> list[str]:
    """Return the 5th to 95th percentile of the ratios, level by level."""
    said = []
    for level in sorted({level for level, _ in found}):
        parts = [
            f"from {_ratio(item.ratio_05.value)} to {_ratio(item.ratio_95.value)} {place}"
            for method, place in zip(METHODS, _PLACES.values(), strict=False)
            if (item := found.get((level, method))) is not None
        ]
        said.append(f"{' and '.join(parts)} at {level:g} g tan α")
    return said


def _worst(items: list[Contrast]) -> dict[str, float]:
    """Return what holds at every level: the widest of each."""
    nothing = math.nan
    return {
        "low": min((item.ratio.low for item in items), default=nothing),
        "high": max((item.ratio.high for item in items), default=nothing),
        "05": min((item.ratio_05.value for item in items), default=nothing),
        "95": max((item.ratio_95.value for item in items), default=nothing),
        "reach": max((item.within_reach for item in items), default=math.inf),
        "within": float(bool(items) and all(item.verdict == "within" for item in items)),
        "beyond": float(any(item.verdict == "beyond" for item in items)),
    }


def _ratio(value: float, form: str = ".2g") -> str:
    if math.isnan(value):
        return "an unknown one"
    return "0" if value == 0.0 else "∞" if value == math.inf else f"{value:{form}}"
