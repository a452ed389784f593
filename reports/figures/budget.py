"""Error budgets as pictures: shares of all parts, and the parts against time."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from rockwobble.compare import LARGEST_SHARE, WORTH_EXPLAINING, Comparison, ErrorBudget
from rockwobble.compare.comparison.summary import rows_of

from .case_view import CaseView
from .palette import Style, pale
from .picture import TIME, Axis, Bars, Layer, Line, Panel, Picture, Rule, Text, caption, list_axis, ticks_at
from .thinning import envelope

# colours of Okabe and Ito: distinct in all colour vision and in grey
PARTS = {
    "model_form": ("model form", Style(colour="#0072B2", dash="solid"), "/"),
    "numerics": ("numerics", Style(colour="#E69F00", dash="dash"), ""),
    "unexplained": ("unexplained", Style(colour="#D55E00", dash="dot"), "x"),
}
_WHOLE = ("whole", Style(colour="#000000", dash="solid"), "")
# least value on the logarithmic axis [alpha]
_SMALLEST = 1e-10
# most bars, so that the picture can be read; the table has all rows
_MOST = 60


Bar = tuple[str, ErrorBudget, bool]  # a difference: its name, its budget, and whether it is worth explaining


def part_shares(budget: ErrorBudget) -> dict[str, float]:
    """RMS of each part over the sum of the three RMS: signed parts could cancel."""
    sizes = {part: budget.rms(part) for part in PARTS}
    total = sum(sizes.values())
    return {part: size / total if total > 0.0 else 0.0 for part, size in sizes.items()}


def budget_picture(view: CaseView, name: str) -> Picture | None:
    """Stacked parts of each run and reference of a case; None if no difference is split."""
    bars = [
        (f"{run} − {model}", each, True) for (run, model), each in view.budgets.items() if not each.not_split
    ]
    return _stack(bars, name, view.case.name)


def all_budgets_picture(comparison: Comparison) -> Picture | None:
    """Bar for each split difference, findings first.

    The order is: rows above the bound, the worst first; then those worth explaining; then the rest, which
    is drawn pale.
    """
    split = comparison.budget_rms[comparison.budget_rms["not_split"] == ""]
    worth = split["whole_rms"] > WORTH_EXPLAINING
    finding = worth & (split["unexplained_share"] > LARGEST_SHARE)
    ordered = split.assign(worth=worth, finding=finding).sort_values(
        ["finding", "worth", "unexplained_share"], ascending=False
    )
    bars = [
        (
            f"{'▲ ' if row.finding else ''}{row.case}, {row.run} − {row.reference}",
            comparison.budgets[row.case, row.run, row.reference],
            row.worth,
        )
        for row in rows_of(ordered.head(_MOST))
    ]
    return _stack(bars, "budget")


def _stack(bars: Sequence[Bar], name: str, case: str | None = None) -> Picture | None:
    if not bars:
        return None
    places, ends = np.arange(len(bars), dtype=np.float64), np.zeros(len(bars))
    layers: list[Bars | Text] = []
    for part, (words, style, hatch) in PARTS.items():
        starts, ends = ends, ends + np.array([part_shares(budget)[part] for _, budget, _ in bars])
        colours = [style.colour if worth else pale(style.colour) for _, _, worth in bars]
        layers.append(Bars(places=places, start=starts, end=ends, colours=colours, name=words, hatch=hatch))
    whole = [f"{budget.rms('whole'):.1e} α" for _, budget, _ in bars]
    layers += [Text(x=1.02, y=place + 0.3, text=text) for place, text in zip(places, whole, strict=True)]
    shares = ticks_at((0.0, 0.25, 0.5, 0.75, 1.0))
    panel = Panel(
        x=Axis(label="share of the parts", unit="-", low=0.0, high=1.25, ticks=shares),
        y=list_axis([label for label, _, _ in bars]),
        layers=layers,
        height=0.9 + 0.27 * len(bars),
    )
    return Picture(name=name, caption=caption("budget", name=case), panels=[panel])


def parts_picture(view: CaseView, name: str, *, above: float = 0.0) -> Picture | None:
    """Parts against time for differences with an RMS of at least `above` [alpha]."""
    y = Axis(label="|part| / α", unit="-", log=True)
    panels = []
    for (run, model), budget in view.budgets.items():
        if budget.rms("whole") < above:
            continue
        lines = []
        resting = ("numerics", "unexplained") if budget.not_split else ()
        for part, (words, style, _) in ({"whole": _WHOLE} | PARTS).items():
            if part in resting:
                continue
            values = np.abs(getattr(budget, part))
            if values.any():
                upper = np.maximum(envelope(budget.time, values), _SMALLEST)
                width = 0.9 if part == "whole" else 1.6
                lines.append(Line(x=budget.time, y=upper, name=words, style=style, width=width))
        layers: list[Layer] = [*lines, Rule(at=budget.covered, axis="x", text="counted up to here")]
        panels.append(Panel(x=TIME, y=y, layers=layers, title=f"{run} − {model}"))
    if not panels:
        return None
    said = caption("budget_parts", name=view.case.name)
    return Picture(name=name, caption=said, panels=panels, link_x=True)
