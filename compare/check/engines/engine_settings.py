"""Layer agreement, first part: errors by the time step and by the contact of each engine.

One release is run at the step of the suite and at half of it. Their difference is what the step does;
what is left of the difference from the reduced model when both are extrapolated to no step at all is
what contact does, however small the step.
"""

from __future__ import annotations

import math
from collections.abc import Iterator

from rockwobble.models import Run

from ...metrics.tilt import rms
from ...runs.execution import Job
from ...runs.run_settings import at_step
from ..bench import Bench, engines_here, not_here, why
from ..finding import Bound, Finding, at_most
from ..problems import released

CASE = released(0.5, 0.5, 2.0, name="release, tan alpha = 0.2")
STEP = 1e-4  # [s] the default at this size
# first order in the step, with every engine
BY_STEP = Bound(3e-8, "9e-9 was measured at 1e-4 s, and it goes with the step", "alpha")
# 3e-8 with steps ten times as large
BY_CONTACT = Bound(1e-7, "extrapolated from steps of 1e-4 and 5e-5 s; 4e-10 was measured", "alpha")


def check(bench: Bench) -> Iterator[Finding]:
    """Yield the findings of this part, for the suite that ships only."""
    if not bench.shipped:
        return
    exact = bench.solve(CASE, rtol=1e-11)
    alpha = CASE.cylinder.alpha
    yield from not_here("contact and time step", bench.engines)
    for engine in engines_here(bench.engines):
        run = bench.adjust(Run(engine, "recess", STEP))
        step = run.time_step if isinstance(run.time_step, float) else STEP
        finer = at_step(run, 0.5 * step)
        coarse, fine = bench.traces(
            [Job(case=CASE, run=run), Job(case=CASE, run=finer, label=f"{engine} recess, half the step")]
        )
        broken = [trace for trace in (coarse, fine) if trace.outcome == "failed"]
        by_contact = math.nan if broken else rms(2.0 * fine.tilt - coarse.tilt - exact.tilt) / alpha
        by_step = math.nan if broken else rms(fine.tilt - coarse.tilt) / alpha
        settings = [f"time step {step:g} s", *(f"{key} = {value}" for key, value in run.settings.items())]
        note = why(broken[0]) if broken else ", ".join(settings)
        part = f"contact of {engine}: margin, stiffness, damping, friction, guide"
        name = f"contact of {engine}: what no smaller step removes"
        yield at_most(name, by_contact, BY_CONTACT, part, note)
        part = f"contact of {engine}: the run failed" if broken else f"time step of {engine}"
        yield at_most(f"time step of {engine}: against half of it", by_step, BY_STEP, part, note)
