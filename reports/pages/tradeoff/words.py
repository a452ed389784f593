"""What the points of a trade-off say, in sentences and tables: every number is computed from them."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Any

from rockwobble.compare.studies.tradeoff import Fastest, Tradeoff, fastest, plateaus, rest_tilt_price
from rockwobble.multibody.engines.registry import engine_facts, engine_packages

from .charts import WHERE, records

if TYPE_CHECKING:
    import pandas as pd

# in the unit of each problem
TARGETS = {"turn": (0.1, 0.01, 1e-3), "shaken": (1e-2, 1e-3, 1e-4), "peaks": (0.05, 1e-2, 1e-3)}
UNITS = {"turn": "deg", "shaken": "α", "peaks": "α"}
_ENGINES = tuple(engine_packages())
# what a method family is called in a table
_FAMILIES = {"reduced": "reduced model", "scipy": "scipy"} | {
    name: engine_facts(name).title for name in _ENGINES
}
COST_HEADINGS = ("problem", "error at most", *(_FAMILIES[name] for name in _FAMILIES))
PLATEAU_HEADINGS = ("problem", "line", "error stops falling at", "its level")
SCENE_HEADINGS = ("engine", "support", "scene", "contacts", "constraint rows", "time / cheapest", "µs a step")


def headline(found: Tradeoff) -> str:
    """Return the main finding: what the engines cost at equal error."""
    factors = [
        (each.ratio / best[0].ratio, each)
        for *_, best in _all_fastest(found)
        if best and best[0].family == "reduced"
        for each in best[1:]
        if each.family in _ENGINES
    ]
    if not factors:
        return "No engine reaches an error that the table asks for."
    cheapest, dearest = (choose(factors, key=lambda each: each[0]) for choose in (min, max))
    return (
        f"At equal error an engine takes {cheapest[0]:,.0f} to {dearest[0]:,.0f} times the computing time of "
        f"the reduced model, by problem, error and engine."
    )


def statements(found: Tradeoff) -> list[str]:
    """Return the conclusions, the most useful first."""
    lines = [*_by_problem(found), *_scipy(found), *_rest_tilt(found), *_flat(found), *_chance(found)]
    return [*lines, *_scenes(found), *_failures(found)]


def _all_fastest(found: Tradeoff) -> list[tuple[dict[str, Any], float, list[Fastest]]]:
    return [
        (row, target, fastest(found.points, row["problem"], row["model"], target))
        for row in records(found.problems)
        for target in TARGETS[row["problem"]]
    ]


def cost_rows(found: Tradeoff) -> list[tuple[str, ...]]:
    """Return for each problem and error the cheapest way of each family, see `COST_HEADINGS`."""
    rows = []
    for row, target, best in _all_fastest(found):
        by_family = {each.family: each for each in best}
        cells = [_way(by_family.get(family)) for family in _FAMILIES]
        rows.append((f"{row['title']}, {WHERE[row['model']]}", f"{target:g} {UNITS[row['problem']]}", *cells))
    return rows


def _way(best: Fastest | None) -> str:
    if best is None:
        return "–"
    # the name of the family stands above
    line = best.line.split(" ", 1)[1] if " " in best.line else best.line
    return f"{_times(best.ratio)}: {line}, {best.knob} {best.value:g}"


def _times(ratio: float) -> str:
    return f"{ratio:.2g} ×" if ratio < 10.0 else f"{float(f'{ratio:.2g}'):,.0f} ×"


def _by_problem(found: Tradeoff) -> list[str]:
    lines = []
    for row in records(found.problems):
        for target in sorted(TARGETS[row["problem"]]):
            best = fastest(found.points, row["problem"], row["model"], target)
            own = next((each for each in best if each.family == "reduced"), None)
            engine = next((each for each in best if each.family in _ENGINES), None)
            if own is None or engine is None:
                continue
            lines.append(
                f"{row['title']}, {WHERE[row['model']]}: the engines get below {target:g} "
                f"{UNITS[row['problem']]}. {engine.line} at a {engine.knob} of {engine.value:g} s is the "
                f"fastest there and takes {engine.ratio / own.ratio:,.0f} times the time of the reduced "
                f"model ({_milliseconds(engine)} against {_milliseconds(own)} a run)."
            )
            break
    return lines


def _milliseconds(best: Fastest) -> str:
    size = best.milliseconds
    return f"{size:,.0f} ms" if size >= 100.0 else f"{size:.2g} ms"


def _scipy(found: Tradeoff) -> list[str]:
    factors = []
    for _, _, best in _all_fastest(found):
        by_family = {each.family: each for each in best}
        if "reduced" in by_family and "scipy" in by_family:
            factors.append(by_family["scipy"].ratio / by_family["reduced"].ratio)
    if not factors:
        return []
    return [
        f"The best of scipy's solvers on the same equations takes {min(factors):,.0f} to {max(factors):,.0f} "
        "times the time of the reduced model at equal error."
    ]


def _rest_tilt(found: Tradeoff) -> list[str]:
    prices = rest_tilt_price(found.points)
    titles = _titles(found)
    lines = []
    for (problem, line), rows in prices.groupby(["problem", "line"], sort=False):
        tight = rows.sort_values("tolerance").iloc[0]
        changed = tight["error"] > 2.0 * tight["error_without"]
        name = "of the default" if line == "reduced, recess" else str(line).removeprefix("reduced, ")
        effect = f"costs {tight['error']:.2g} α" if changed else "costs no accuracy that shows"
        lines.append(
            f"Rest threshold {name.removeprefix('rest threshold ')} {effect} in “{titles[str(problem)]}”, "
            f"and runs at {rows['speed_up'].median():.2f} times the speed of a rule that hardly ever acts."
        )
    return lines


def _flat(found: Tradeoff) -> list[str]:
    titles = _titles(found)
    flat = [each for each in plateaus(found.points) if math.isfinite(each.begins)]
    falling = [each for each in plateaus(found.points) if not math.isfinite(each.begins)]
    lines = []
    if flat:
        worst = max(flat, key=lambda each: each.level)
        lines.append(
            f"Smaller steps stop helping {len(flat)} of {len(flat) + len(falling)} lines of an engine: the "
            "table of plateaus says where. The highest is that of "
            f"{worst.line} in “{titles[worst.problem]}”, {worst.level:.2g} {UNITS[worst.problem]} from a "
            f"step of {worst.begins:g} s on."
        )
    return lines


def _chance(found: Tradeoff) -> list[str]:
    lines = []
    for row in records(found.problems):
        if not math.isfinite(row["chance"]):
            continue
        points = found.points
        engines = points[
            (points["problem"] == row["problem"])
            & (points["model"] == row["model"])
            & points["family"].isin(_ENGINES)
        ]
        good = engines[engines["error"] <= row["chance"]]
        lines.append(
            f"Two ensembles of {row['members']} motions differ by {row['chance']:.2g} α by chance "
            f"({WHERE[row['model']]}); {len(good)} of {len(engines)} points of the engines err less"
            + _cheapest(good)
        )
    return lines


def _cheapest(good: pd.DataFrame) -> str:
    if good.empty:
        return "."
    least = records(good.sort_values("ratio"))[0]
    return (
        f", the cheapest of them is {least['line']} at {least['value']:g} s: for a distribution no smaller "
        "step is worth its time."
    )


def _scenes(found: Tradeoff) -> list[str]:
    lines = []
    for engine, rows in found.scenes.groupby("engine", sort=False):
        ordered = records(rows.sort_values("ratio"))
        cheapest, dearest = ordered[0], ordered[-1]
        lines.append(
            f"The least scene of {_FAMILIES.get(str(engine), str(engine))} is "
            f"{_scene(cheapest)}; the dearest, {_scene(dearest)}, takes "
            f"{dearest['ratio']:.1f} times its time a step."
        )
    return lines


def _scene(row: dict[str, Any]) -> str:
    return f"{row['support']}, {row['option']}"


def _failures(found: Tradeoff) -> list[str]:
    titles = _titles(found)
    lost = found.points[found.points["error"].isna()]
    return [
        f"No answer from {row['line']} at a {row['knob']} of {row['value']:g} in “{titles[row['problem']]}”: "
        f"{row['message']}."
        for row in records(lost)
    ]


def _titles(found: Tradeoff) -> dict[str, str]:
    return dict(zip(found.problems["problem"], found.problems["title"], strict=True))


def plateau_rows(found: Tradeoff) -> list[tuple[str, ...]]:
    """Return where each line of an engine stops gaining, see `PLATEAU_HEADINGS`."""
    titles = _titles(found)
    return [
        (
            f"{titles[each.problem]}, {WHERE[each.model]}",
            each.line,
            f"{each.begins:g} s" if math.isfinite(each.begins) else f"not until {each.smallest:g} s",
            f"{each.level:.1e} {UNITS[each.problem]}",
        )
        for each in plateaus(found.points)
    ]


def scene_rows(found: Tradeoff) -> list[tuple[str, ...]]:
    """Return what each part of a scene costs, see `SCENE_HEADINGS`."""
    return [
        (
            row["engine"],
            row["support"],
            row["option"],
            str(row["contacts"]),
            str(row["constraint_rows"]),
            f"{row['ratio']:.2f}",
            f"{row['microseconds']:.1f}",
        )
        for row in records(found.scenes)
    ]


def closing(found: Tradeoff) -> str:
    """Return how times were taken, and beside what else the machine did."""
    load = (
        f" The load of the machine was {found.load[0]:.1f} before and {found.load[1]:.1f} after."
        if all(math.isfinite(each) for each in found.load)
        else ""
    )
    return (
        f"Times are processor times, medians of {found.rounds} rounds in which all methods run in turn (in "
        "the ensemble: of its members); ratios are taken inside a round." + load + " A run includes all "
        "that its method does by default: sampling, passes, guards."
    )
