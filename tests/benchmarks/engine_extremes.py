"""Whether a run at an extreme of its engine says so where it goes wrong.

`python tests/benchmarks engine_extremes` prints the table. Each trial takes one thing to its extreme
(step, contact, friction, slenderness, spin, excitation, guide) and is held against the reduced model of
its support, solved to 1e-10. The verdict is

* agrees: the tilt is within `AGREES` of alpha as far as the model holds;
* failed: the guard ended the run;
* said: it does not agree, and a diagnostic that begins no later than the error says what limits it;
* refused: a ValueError with one line, before anything ran;
* wrong: it does not agree and none says why. There must be none.

The model holds as long as the friction given and the contact suffice by its own account; beyond that a
trial only has to say that it slips or flies.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from typing import TYPE_CHECKING, Any

import numpy as np

from rockwobble import multibody, reduced
from rockwobble.compare.metrics.pair import make_pair
from rockwobble.models import Case, Cylinder, InitialState, Run, Trace

from .console import options_of, show
from .engine_trials import Trial, trials

if TYPE_CHECKING:
    import pandas as pd

AGREES = 0.01  # of alpha: what ends an agreement everywhere else


def run(trial: Trial) -> dict[str, Any]:
    """Run one trial; return its row.

    Returns
    -------
    dict
        extreme, value, tan_alpha, engine, support, verdict, error (the largest tilt difference in alpha as
        far as the model holds; NaN if it failed) and diagnostics (codes, or why it was refused).
    """
    cylinder = Cylinder(semidiagonal=6.0, tan_alpha=trial.tan_alpha)
    release = InitialState(trial.tilt * cylinder.alpha, rolling_rate=trial.rate) if trial.tilt else None
    row: dict[str, Any] = {
        "extreme": trial.extreme,
        "value": trial.value,
        "tan_alpha": trial.tan_alpha,
        "engine": trial.engine,
        "support": trial.support,
        "error": math.nan,
    }
    settings = {"friction": 1.0, **trial.arguments}
    case = Case(
        cylinder,
        trial.motion,
        initial=release,
        duration=trial.length,
        friction=settings.pop("friction"),
    )
    try:
        result = multibody.simulate(case, engine=trial.engine, support=trial.support, **settings)
    except ValueError as refusal:
        return row | {"verdict": "refused", "diagnostics": str(refusal)}
    row["diagnostics"] = ", ".join(dict.fromkeys(fact.code for fact in result.facts))
    if result.outcome == "failed":
        return row | {"verdict": "failed"}
    own = Run(trial.engine, trial.support).own_model
    error, begins, whole = _difference(case, reduced.simulate(case, support=own.support, rtol=1e-10), result)
    said = any(not fact.time > begins for fact in result.facts)  # one of the whole run has no time
    agrees = error <= AGREES and (whole or bool(result.facts))
    return row | {"verdict": "agrees" if agrees else "said" if said else "wrong", "error": error}


def _difference(case: Case, model: Trace, result: Trace) -> tuple[float, float, bool]:
    """Largest tilt difference as long as the model holds [alpha], when it is too large, and if that is all.

    A fall after the run multiplies every difference and is left out.
    """
    pair = make_pair(case.cylinder, model, result, until=case.length)
    held = model.assumptions_until(case.length)
    until = min((breach.time for breach in held.breaches), default=math.inf) if held else math.inf
    within = np.abs(pair.tilt_difference)[pair.time <= until]
    beyond = pair.time[: len(within)][within > AGREES]
    whole = math.isinf(until) and model.outcome != "failed"
    return float(within.max(initial=0.0)), float(beyond[0]) if len(beyond) else pair.end, whole


def measure(
    chosen: Sequence[Trial] | None = None,
    *,
    workers: int | None = None,
    say: Callable[[str], None] | None = None,
) -> pd.DataFrame:
    """Run the trials; return their rows in the same order, see `run`.

    Parameters
    ----------
    chosen : sequence of Trial, optional
        Default: all.
    workers : int, optional
        Processes; default one for each core.
    say : callable, optional
        Called with a line of progress.
    """
    import pandas as pd

    from rockwobble.compare.runs.progress import Lost, Progress
    from rockwobble.compare.runs.scheduler import run_tasks

    def tell(event: Progress) -> None:
        if say is not None and event.state == "finished":
            say(f"{event.done}/{event.total} {event.label}")

    chosen = trials() if chosen is None else chosen
    found = run_tasks(
        run,
        chosen,
        workers=workers,
        label=lambda trial: f"{trial.engine} {trial.extreme} {trial.value}",
        progress=tell,
    )
    rows = [row for row in found if not isinstance(row, Lost)]
    if len(rows) < len(found):
        raise RuntimeError(next(row.why for row in found if isinstance(row, Lost)))
    return pd.DataFrame(rows)


def main(arguments: Sequence[str] | None = None) -> int:
    """Print the table; return 1 if a run is silently wrong."""
    import sys

    options = options_of(
        "engine_extremes", "The engines at their own extremes: does a run that goes wrong say so?"
    )
    options.parse_args(arguments)
    table = measure(say=lambda line: print(line, file=sys.stderr, flush=True))
    formats = {"extreme": "", "value": "", "tan_alpha": "g", "engine": "", "support": ""}
    counts = ", ".join(f"{count} {verdict}" for verdict, count in table["verdict"].value_counts().items())
    show(
        table,
        "Engines at their extremes",
        formats | {"verdict": "", "error": ".1e", "diagnostics": ""},
        counts,
    )
    return 1 if (table["verdict"] == "wrong").any() else 0
