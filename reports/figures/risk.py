"""Hazard, probability of overturning and their product, the contributions to the annual frequency."""

from __future__ import annotations

from rockwobble.studies import Fragility

from .palette import DARK, GREY, ORDER, Style, mark_styles
from .picture import Axis, Line, Panel, Picture, Rule, caption, table_line

_MOST = 4  # methods of a panel: more lines cannot be told apart
_COLOURS = (DARK, *ORDER)
_RETURN_PERIODS = (475, 2475)  # return periods of codes [year]
_LEAST = 0.01  # share of the largest contribution below which none is drawn


def risk_pictures(results: Fragility) -> list[Picture]:
    """Picture for each cylinder; none without a hazard."""
    if "risk" not in results.tables:
        return []
    return [
        _picture(results, str(name), place) for place, name in enumerate(results.facts["cylinders"], start=1)
    ]


def _picture(results: Fragility, cylinder: str, place: int) -> Picture:
    hazard = results.facts["hazard"]
    table = results.contributions[results.contributions["cylinder"] == cylinder]
    scaled = ["contribution", "contribution_fit"]
    table = table.astype(dict.fromkeys(scaled, float))
    table[scaled] *= 1e4
    labels = list(dict.fromkeys(table["method"]))[:_MOST]
    first = table[table["method"] == labels[0]]
    x = first["intensity"].to_numpy(float)
    shares: list[Line | Rule] = []
    products: list[Line | Rule] = []
    for index, (label, style) in enumerate(mark_styles(labels).items()):
        own, colour = table[table["method"] == label], _COLOURS[index % len(_COLOURS)]
        line = Style(colour=colour, dash=style.dash)
        pale = Style(colour=colour, dash="dot")
        shares.append(table_line(own, "intensity", "probability", label, line, width=1.8))
        products.append(table_line(own, "intensity", "contribution", label, line, width=1.8))
        if index == 0:
            name = f"{label}, lognormal curve"
            shares.append(table_line(own, "intensity", "probability_fit", name, pale))
            products.append(table_line(own, "intensity", "contribution_fit", name, pale))
    words, _, unit = str(hazard["title"]).rpartition(" [")
    drawn = table[table["method"].isin(labels)].groupby("intensity")["contribution"].max()
    shown = drawn.index[drawn >= _LEAST * drawn.max()]
    low = max(float(shown.min()) / 3.0, float(x[0]))
    axis = Axis(label=words.partition(",")[0], unit=unit.rstrip("]"), log=True, low=low, high=float(x[-1]))
    curve = table_line(first, "intensity", "annual_frequency", "hazard", Style(colour=GREY), width=1.8)
    panels = [
        Panel(
            x=axis,
            y=Axis(label="exceedance", unit="1/year", log=True),
            layers=[curve, *(Rule(at=1.0 / n, axis="y", text=f"{n} years") for n in _RETURN_PERIODS)],
            title="Hazard",
            height=2.6,
        ),
        Panel(
            x=axis,
            y=Axis(label="probability of overturning", unit="-", low=-0.02, high=1.02),
            layers=shares,
            title="Fragility",
            height=2.6,
        ),
        Panel(
            x=axis,
            y=Axis(label="contribution", unit="1e-4/a per ln unit", low=0.0),
            layers=products,
            title="Contribution",
            height=2.6,
        ),
    ]
    return Picture(
        name=f"risk-{place}",
        caption=caption(
            "risk", name=cylinder, count=len(labels) if len(set(table["method"])) > _MOST else None
        ),
        panels=panels,
        columns=3,
        legend="panels",
    )
