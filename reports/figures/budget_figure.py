"""The error budgets of all cases in one picture for a document."""

from __future__ import annotations

import io
from typing import TYPE_CHECKING

from rockwobble.compare import LARGEST_SHARE, WORTH_EXPLAINING

from .charts.budget import PARTS, part_shares

if TYPE_CHECKING:
    from rockwobble.compare import Comparison

# a taller picture cannot be read any more; the table has them all
_MOST = 60
_HATCHES = {"model_form": "//", "numerics": "", "unexplained": "xx"}


def budget_figure(comparison: Comparison) -> bytes:
    """Return stacked bars, one for each row of the summary with a budget, as SVG; findings on top.

    The order is: rows above the bound, the worst first; then those worth explaining; then the rest, which
    is drawn pale.
    """
    import matplotlib as mpl
    from matplotlib.figure import Figure

    summary = comparison.summary[comparison.summary["whole_rms"].notna()]
    worth = summary["whole_rms"] > WORTH_EXPLAINING
    finding = worth & (summary["unexplained_share"] > LARGEST_SHARE)
    ordered = (
        summary.assign(worth=worth, finding=finding)
        .sort_values(["finding", "worth", "unexplained_share"], ascending=False)
        .head(_MOST)
    )
    with mpl.rc_context({"svg.hashsalt": "rockwobble", "font.size": 9, "hatch.linewidth": 0.5}):
        figure = Figure(figsize=(9.0, 1.3 + 0.26 * len(ordered)), layout="constrained")
        axes = figure.subplots()
        for place, (_, row) in enumerate(ordered.iterrows()):
            shares = part_shares(comparison.budgets[row["case"], row["run"], row["reference"]])
            left = 0.0
            for part, (name, style, _) in PARTS.items():
                axes.barh(
                    place,
                    shares[part],
                    left=left,
                    height=0.78,
                    color=style.colour if row["worth"] else _pale(style.colour),
                    hatch=_HATCHES[part],
                    edgecolor="white",
                    label=name if place == 0 else None,
                )
                left += shares[part]
            axes.text(1.01, place, f"{row['whole_rms']:.1e} α", va="center")
        axes.set_yticks(
            range(len(ordered)),
            [
                f"{'▲ ' if row['finding'] else ''}{row['case']}, {row['run']} − {row['reference']}"
                for _, row in ordered.iterrows()
            ],
        )
        axes.set_ylim(len(ordered) - 0.4, -0.6)
        axes.set_xlim(0.0, 1.14)
        axes.set_xticks([0.0, 0.25, 0.5, 0.75, 1.0])
        axes.set_xlabel(
            "RMS of each part over the sum of the three; on the right the RMS of the whole difference"
        )
        axes.spines[["top", "right"]].set_visible(False)
        # outside of the axes, which long names leave too narrow for it
        figure.legend(*axes.get_legend_handles_labels(), loc="outside upper right", ncols=3, frameon=False)
        buffer = io.BytesIO()
        figure.savefig(buffer, format="svg", metadata={"Date": None, "Creator": "rockwobble"})
    return buffer.getvalue()


def _pale(colour: str) -> tuple[float, ...]:
    """Mix a colour with white: transparency and hatches together are drawn differently everywhere."""
    from matplotlib.colors import to_rgb

    return tuple(0.45 * part + 0.55 for part in to_rgb(colour))
