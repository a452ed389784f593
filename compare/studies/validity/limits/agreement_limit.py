"""How long traces may be compared."""

from __future__ import annotations

import numpy as np

from ....comparison.prediction import IN_TIME
from .limit import Limit, Tables, column, largest, percent, quantile, short


def horizon(tables: Tables) -> Limit:
    """Draw the limit from engine runs held against the reduced models."""
    table = tables["following"]
    guided = table[(table["support"] == "recess") & (table["reference"] == "recess")]
    opened = table[(table["support"] == "flat") & (table["reference"] == "recess")]
    own = table[(table["support"] == "flat") & (table["reference"] == "flat")]
    agreed, predicted = column(table, "agreement_time"), column(table, "predicted_agreement_time")
    early = table["diverged"].to_numpy(dtype=bool) & (agreed * IN_TIME < predicted)
    numbers = {
        "recess": quantile(column(guided, "agreement_time"), 0.5),
        "guided_whole": float((~guided["diverged"].to_numpy(dtype=bool)).sum()),
        "guided_runs": float(len(guided)),
        "open": quantile(column(opened, "agreement_time"), 0.5),
        "open_passes": quantile(column(opened, "agreed_passes"), 0.5),
        "own": quantile(column(own, "agreement_time"), 0.5),
        "early": float(early.sum()),
        "comparisons": float(len(table)),
        "duration": float(np.max(column(table, "duration"))),
        "open_peak": largest(
            np.abs(column(opened, "peak_tilt") / column(opened, "reference_peak_tilt") - 1.0)
        ),
    }
    return Limit(
        subject="Single traces",
        use="As a trace in an ideal recess: the engine follows it within 1 % of α for "
        f"{short(numbers['recess'])} s "
        f"(median), to the end of {numbers['guided_whole']:.0f} of {numbers['guided_runs']:.0f} runs of "
        f"{numbers['duration']:g} s.",
        error=f"On open ground the trace is good for {short(numbers['open'])} s (median; "
        f"{short(numbers['open_passes'])} "
        f"passes), while the flat-ground model follows the engine for {short(numbers['own'])} s. "
        f"{numbers['early']:.0f} of {numbers['comparisons']:.0f} comparisons diverged in less than half of "
        "the time "
        "predicted.",
        avoid=f"As a trace on open ground beyond that: the peak of the run is off by up to "
        f"{percent(numbers['open_peak'])}. Past the horizon compare distributions.",
        numbers=numbers,
    )
