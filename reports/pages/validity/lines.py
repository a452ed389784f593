"""The pictures of what the engine did: verification, slip, rings, contact, agreement times, distributions."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from ...figures.heat import Array
from ...figures.picture import Axis, Picture
from .picture import Series, line_picture

if TYPE_CHECKING:
    import pandas as pd

_SMALLEST = 1e-9  # what a logarithmic axis shows of nothing


_WIDEST = 1.2  # [alpha] beyond, single cylinders come back from a tilt that should have been their fall


def verification_picture(table: pd.DataFrame) -> Picture:
    """Return how well the engine tells the models apart."""
    models = table.pivot_table("turn", ["tan_alpha", "release", "spin"], "model", dropna=False)
    apart = (models["recess"] - models["flat"]).abs()
    series = []
    for support, rows in table.groupby("support", sort=False):
        keys = rows.set_index(["tan_alpha", "release", "spin"]).index
        x = np.degrees(apart.reindex(keys).to_numpy(dtype=np.float64))
        y = np.degrees(np.abs((rows["engine_turn"] - rows["turn"]).to_numpy(dtype=np.float64)))
        model = rows["model"].iloc[0]
        series.append(Series(name=f"{support} against {model}", x=x, y=np.maximum(y, _SMALLEST), marks=True))
    return line_picture(
        name="verification",
        title="The engine tells the models apart",
        caption="Each mark is a release: how far the engine's angle of turn is off that of its own model, "
        "over how "
        "far the two models are apart. Below the line the engine decides between them.",
        x=Axis(label="|recess − rolling|", unit="deg", log=True),
        y=Axis(label="|engine − its model|", unit="deg", log=True),
        series=series,
        diagonal="no telling apart",
    )


def slip_picture(table: pd.DataFrame) -> Picture:
    """Return slip over friction."""
    series = [
        Series(
            name=f"tan α = {tan_alpha:g} (needs {rows['needed'].iloc[0]:.3f})",
            x=_of(rows, "share"),
            y=np.maximum(_of(rows, "slip"), _SMALLEST),
        )
        for tan_alpha, rows in table.sort_values("share").groupby("tan_alpha")
    ]
    return line_picture(
        name="slip",
        title="Slip of the engine where friction is short",
        caption="Distance over which the contact slips in one period of free response, over the friction "
        "as a share "
        "of what the recess model says is needed.",
        x=Axis(label="friction / friction needed", unit="-"),
        y=Axis(label="slip / b", unit="-", log=True),
        series=series,
    )


def ring_pictures(table: pd.DataFrame) -> list[Picture]:
    """Return peak tilt and displacement over slenderness, a line for each recess."""
    # walls of other inclinations are in the table, and would be too many lines here
    shaken = table[(table["motion"] != "free response") & (table["inclination"] == 0.0)]
    peak = (shaken["peak"] / shaken["recess_peak"] - 1.0).abs()
    shaken = shaken.assign(off=100.0 * peak, displaced=shaken["rolled_out"])
    return [
        line_picture(
            name="ring-peak",
            title="Peak tilt in a real recess",
            caption="How far the peak tilt in a ring of walls that lean by α is off that of the ideal "
            "recess, under El "
            "Centro at 1.5 "
            "g tan α, largest of the runs.",
            x=Axis(label="tan α", unit="-"),
            y=Axis(label="difference", unit="%", log=True),
            series=_rings(shaken, "off"),
        ),
        line_picture(
            name="ring-place",
            title="Leaving its place",
            caption="How far from its place the cylinder would come down, at most, in the same runs.",
            x=Axis(label="tan α", unit="-"),
            y=Axis(label="rolled out / b", unit="-", log=True),
            series=_rings(shaken, "displaced"),
        ),
    ]


def _rings(table: pd.DataFrame, name: str) -> list[Series]:
    series = []
    for _, rows in table.groupby("clearance"):
        worst = rows.groupby("tan_alpha")[name].max()
        clearance = float(rows["clearance"].iloc[0])
        label = {0.0: "ideal recess", np.inf: "open ground"}.get(clearance, f"clearance {clearance:g} b")
        series.append(
            Series(
                name=label,
                x=worst.index.to_numpy(dtype=np.float64),
                y=np.maximum(worst.to_numpy(dtype=np.float64), 1e-6),
            )
        )
    return series


def contact_pictures(table: pd.DataFrame) -> list[Picture]:
    """Return peak tilt and energy lost over the time constant of contact."""
    off = 100.0 * (table["peak"] / table["recess_peak"] - 1.0).abs()
    table = table.assign(off=off, lost=100.0 * table["loss"].abs(), ms=1e3 * table["time_constant"])
    critical, bouncing = table[table["damping"] == 1.0], table[table["damping"] != 1.0]
    groups = [
        (f"tan α = {tan_alpha:g}", rows.sort_values("ms"), False)
        for tan_alpha, rows in critical.groupby("tan_alpha")
    ]
    groups += [(f"damping {damping:g}, all", rows, True) for damping, rows in bouncing.groupby("damping")]
    return [
        line_picture(
            name=f"contact-{name}",
            title=title,
            caption=f"{caption} R = 6 m.",
            x=Axis(label="time to take up a blow", unit="ms", log=True),
            y=Axis(label=label, unit="%", log=True),
            series=[
                Series(name=words, x=_of(rows, "ms"), y=np.maximum(_of(rows, column), 1e-6), marks=marks)
                for words, rows, marks in groups
            ],
        )
        for name, title, caption, label, column in (
            (
                "peak",
                "Peak tilt with contact that gives",
                "How far the peak tilt under El Centro at 2 g tan α is off that of the recess model. Lines: "
                "critical damping.",
                "difference",
                "off",
            ),
            (
                "loss",
                "Energy that contact takes",
                "Energy lost in a pass of free response, over the energy of the release. Lines: critical "
                "damping.",
                "lost per pass",
                "lost",
            ),
        )
    ]


def horizon_picture(table: pd.DataFrame) -> Picture:
    """Return agreement measured over agreement predicted."""
    series = [
        Series(
            name=f"{support} against {reference}",
            x=_of(rows, "predicted_agreement_time"),
            y=_of(rows, "agreement_time"),
            marks=True,
        )
        for (support, reference), rows in table.groupby(["support", "reference"])
    ]
    return line_picture(
        name="horizon",
        title="How long traces agree",
        caption="Time from uplift until the tilts differ by more than 1 % of α, over the time that the "
        "reduced models "
        "predict. Runs that agree to their end are at the end.",
        x=Axis(label="predicted", unit="s"),
        y=Axis(label="measured", unit="s"),
        series=series,
        diagonal="as predicted",
    )


def distribution_pictures(table: pd.DataFrame) -> list[Picture]:
    """Return the distributions of peak tilt, one picture for each level."""
    pictures = []
    for level, members in table.groupby("level"):
        series = []
        for method, rows in members.groupby("method", sort=False):
            known = rows[rows["peak"].notna()]
            standing = np.sort(_of(known[known["outcome"] != "overturned"], "peak"))
            series.append(
                Series(
                    name=str(method),
                    x=np.concatenate([[0.0], standing]),
                    y=np.arange(len(standing) + 1) / max(len(known), 1),
                    steps=True,
                )
            )
        farthest = max(float(line.x.max()) for line in series)
        end = _WIDEST if farthest > _WIDEST else None
        pictures.append(
            line_picture(
                name=f"distribution-{level:g}",
                title=f"Peak tilt of {members['motion'].nunique()} records at {level:g} g tan α",
                caption="Share of the records whose peak tilt is at most that of the axis; what a curve "
                "lacks to 1 "
                "overturns.",
                x=Axis(label="peak tilt / α", unit="-", low=0.0, high=end),
                y=Axis(label="share of the records", unit="-"),
                series=series,
            )
        )
    return pictures


def _of(table: pd.DataFrame, name: str) -> Array:
    return table[name].to_numpy(dtype=np.float64)
