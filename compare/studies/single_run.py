"""Single run: the trace of one reduced model or engine, and until when one trace is reproducible."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass
from typing import TYPE_CHECKING, Self

from rockwobble.models import Case, Run, Trace
from rockwobble.models.plain_json import fields_of
from rockwobble.models.trace_file import COLUMNS, PASS_COLUMNS, packed

from ..comparison.prediction import nudged, reproducible_until
from ..runs.choice import own_model
from ..runs.execution import Job, job_fingerprint, simulate_all
from ..runs.progress import ProgressCallback
from ..storage.manifest import Number, Stored
from ..storage.results import Results

if TYPE_CHECKING:
    from matplotlib.figure import Figure

_FILE = "run.parquet"


@dataclass(frozen=True, kw_only=True, eq=False, repr=False)
class SingleRun(Results, kind="run"):
    """One run.

    Attributes
    ----------
    tables : mapping of str to DataFrame
        run: the samples of the trace.
    facts : mapping
        run: its label; case and result: what the samples do not hold; single_trace: until when one trace is
        reproducible [s], and the command that answers what many copies do; columns of the files.
    trace : Trace
    """

    trace: Trace

    def headline(self) -> Mapping[str, Number]:
        """Return outcome, peak tilt, uplift and number of passes."""
        trace = self.trace
        return {
            "outcome": trace.outcome,
            "peak tilt [alpha]": trace.peak_tilt / trace.case.cylinder.alpha,
            "uplift [s]": trace.uplift_time,
            "passes": len(trace.passes),
        }

    def sheets(self) -> Mapping[str, bytes]:
        """Return the trace as `Trace.load` reads it, its samples and its passes as CSV."""
        trace = self.trace
        return {
            _FILE: packed(self.tables["run"], trace.to_plain(), trace.case),
            "run.csv": self.tables["run"].to_csv(index=False).encode(),
            "passes.csv": trace.passes.to_csv(index=False).encode(),
        }

    @classmethod
    def of_stored(cls, stored: Stored) -> Self:
        """Return the results whose files are whole."""
        trace = Trace.load(stored.folder / _FILE)
        return cls(tables=stored.tables(), facts=stored.manifest.about, manifest=stored.manifest, trace=trace)

    def plot(self, part: str | None = None) -> Figure:
        """Return a matplotlib figure of the trace."""
        return self.trace.plot(part)


def single_run(
    case: Case, run: Run, *, answer: str = "", progress: ProgressCallback | None = None
) -> SingleRun:
    """Return a run, and until when it is reproducible, by copies of its reduced model.

    Parameters
    ----------
    case : Case
    run : Run
    answer : str, optional
        Command that says what many copies do.
    progress : callable, optional
        Called with a `Progress` at the start and at the end of each run.
    """
    job = Job(case=case, run=run)
    model = run if run.engine is None else own_model(run)
    cases = [*([case] if model != run else []), *nudged(case)]
    copies = [Job(case=each, run=model, label=f"copy of the {model}") for each in cases]
    # in a process of its own, so that Ctrl-C also stops an engine in the middle of a long call
    trace, *others = simulate_all([job, *copies], workers=2, progress=progress)
    own, first, second = others if model != run else (trace, *others)
    known = all(len(each.time) for each in (own, first, second))
    return single_run_of(trace, reproducible_until(own, (first, second)) if known else math.inf, answer)


def single_run_of(trace: Trace, until: float = math.inf, answer: str = "") -> SingleRun:
    """Return the results of a trace that is reproducible until a time of the run [s]."""
    job = Job(case=trace.case, run=trace.run)
    case, motion = fields_of(trace.case), trace.case.motion
    left_out = ("rest_intervals", "extrema", "passes")
    facts = {
        "inputs": job_fingerprint(job),
        "run": job.label,
        "case": case | {"motion": motion and {"name": motion.name, "time_step": motion.time_step}},
        "result": {name: value for name, value in trace.to_plain().items() if name not in left_out},
        "single_trace": {"until": until, "answer": answer},
        "columns": {"run.csv": COLUMNS, "passes.csv": PASS_COLUMNS},
    }
    return SingleRun(tables={"run": trace.to_frame()}, facts=facts, trace=trace)
