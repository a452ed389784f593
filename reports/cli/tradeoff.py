"""`rockwobble tradeoff`: error against computing time of reduced models, other solvers and engines."""

from __future__ import annotations

from pathlib import Path

import rockwobble.compare.storage as rs
from rockwobble.compare.studies.plans import TradeoffPlan

from ..console.progress import shown_progress
from ..console.results import show_and_save
from ..console.terminal import interruptible, user_input
from .inputs import options
from .inputs.plan_options import takes_options


@takes_options
def tradeoff(plan: TradeoffPlan, out: options.Out = Path("rockwobble-tradeoff")) -> None:
    """Measure what accuracy costs: the reduced models, scipy's solvers and the engines on three problems.

    The angle of turn in free response, two times El Centro until ten seconds
    after uplift, and the distribution of peak tilt over synthetic motions;
    then the cost of each part of an engine's scene. All runs are timed in
    turn, one after another in one process.

    Writes tradeoff.html (open it in a browser), tradeoff.md with its pictures
    as SVG, and the tables points, problems and scenes as Parquet. `rockwobble
    report` draws the pages again.
    """
    with interruptible():
        with user_input():
            rs.require_writable(out)
        from rockwobble.compare.studies.tradeoff.study import measure_tradeoff

        with shown_progress("rounds") as progress:
            found = measure_tradeoff(plan, progress=progress)
        show_and_save(found, out)
