"""Agreement matrix: each motion of a case against every other on the same support."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from itertools import permutations
from typing import TYPE_CHECKING, Any

from rockwobble.models import Case, Trace

from ..metrics.agreement import agreement_time
from ..metrics.pair import make_pair
from ..metrics.tilt import tilt_rms, tilt_rms_relative

if TYPE_CHECKING:
    import pandas as pd

# name: (unit, meaning); the order is that of the table
MATRIX_COLUMNS: Mapping[str, tuple[str, str]] = {
    "case": ("", "name of the case"),
    "support": ("", "of both"),
    "run": ("", "label of an engine's run, or of the reduced model of the support"),
    "other": ("", "label of what it is held against"),
    "tilt_rms": ("alpha", "root mean square of the tilt difference"),
    "tilt_rms_relative": ("", "the same over the root mean square of the other's tilt"),
    "peak_tilt_difference": ("alpha", "run minus other"),
    "agreement_time": ("s", "from uplift or release to the first tilt difference above 1 % of alpha"),
    "diverged": ("", "whether there was such a difference"),
    "other_uplift_time": ("s", "uplift or release of the other; 0 where it stays at rest"),
}


def agreement_matrix(
    cases: Mapping[str, Case], traces: Mapping[tuple[str, str], Trace], *, until: float | None = None
) -> pd.DataFrame:
    """Return the differences of each motion of a case from every other on the same support.

    Only where two engines or more have run: what one engine differs from its model by is in the summary.

    Parameters
    ----------
    cases : mapping
        Case of each name.
    traces : mapping
        Trace for each name of a case and label; what left no samples is left out.
    until : float, optional
        End of the window of the RMS columns, in the time of the run [s]. Default: the whole run.
    """
    import pandas as pd

    rows = [row for name, case in cases.items() for row in _rows(name, case, traces, until)]
    return pd.DataFrame(rows, columns=list(MATRIX_COLUMNS)).astype({"diverged": bool})


def _rows(
    name: str, case: Case, traces: Mapping[tuple[str, str], Trace], until: float | None
) -> Iterator[dict[str, Any]]:
    own = {label: trace for (of, label), trace in traces.items() if of == name and len(trace.time)}
    for support in dict.fromkeys(trace.run.support for trace in own.values()):
        members = {label: trace for label, trace in own.items() if trace.run.support == support}
        if len({trace.run.engine for trace in members.values()} - {None}) < 2:
            continue
        for run, other in permutations(members, 2):
            yield {
                "case": name,
                "support": support,
                "run": run,
                "other": other,
                **_difference(case, members[run], members[other], until),
            }


def _difference(case: Case, trial: Trace, reference: Trace, until: float | None) -> dict[str, Any]:
    cylinder = case.cylinder
    whole = make_pair(cylinder, reference, trial, until=case.length)
    window = whole if until is None else make_pair(cylinder, reference, trial, until=until)
    found = agreement_time(whole, broken="failed" in (trial.outcome, reference.outcome))
    return {
        "tilt_rms": tilt_rms(window),
        "tilt_rms_relative": tilt_rms_relative(window),
        "peak_tilt_difference": (trial.peak_tilt - reference.peak_tilt) / cylinder.alpha,
        "agreement_time": found.length,
        "diverged": found.diverged,
        "other_uplift_time": whole.start,
    }
