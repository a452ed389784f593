"""Layer traces, second part: runs whose time step is found, and runs extrapolated to no step at all.

They are held against the reduced model field by field, and their own estimates against the error they have.
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping

from rockwobble.models import Run, Trace

from ...runs.choice import own_model
from ...runs.execution import simulate_run
from ..bench import Array, Bench, engines_here, largest, why
from ..finding import Bound, Finding, at_most
from .traces import RELEASE, SAMPLE, SHAKEN


def _left(most: float, unit: str) -> Bound:
    return Bound(most, "what extrapolation leaves of the steps; less than a half was measured", unit)


FIELDS: Mapping[str, Bound] = {
    "tilt": _left(2e-7, "rad"),
    "tilt_rate": _left(3e-6, "rad/s"),
    "rolling_angle": _left(1e-6, "rad"),
    "rolling_rate": _left(1e-5, "rad/s"),
    "twist": _left(1e-7, "rad"),
    "contact_point": _left(3e-6, "m"),
    "centre_of_mass": _left(2e-6, "m"),
    "energy": _left(3e-5, "m^2/s^2"),
}
TURNING, PEAK = _left(2e-6, "s, rad"), _left(5e-8, "rad")
ESTIMATE = Bound(1.0, "the error is at most twice the estimate: log2 of their ratio")
SERIES = 7.0  # of a pure series of second order the estimate is that much too large
ENDS = Bound(0.0, "the run must reach its end")


def check(bench: Bench) -> Iterator[Finding]:
    """Yield the findings of this part; the part before says which engines are not installed."""
    for engine in engines_here(bench.engines):
        yield from _shaken(bench, bench.adjust(Run(engine, "flat", "extrapolated")))
        yield from _shaken(bench, bench.adjust(Run(engine, "flat", "auto")))
        yield from _released(bench, bench.adjust(Run(engine, "recess", "extrapolated")))


def _shaken(bench: Bench, run: Run) -> Iterator[Finding]:
    trace = simulate_run(SHAKEN, run, sample_step=SAMPLE)
    model = bench.solve(SHAKEN, own_model(run).support, rtol=1e-11, sample_step=SAMPLE)
    if trace.outcome == "failed" or len(trace.time) != len(model.time):
        yield _failed(run, trace)
        return
    part = f"step of {run.engine}: {run.time_step} (multibody/time_step)"
    if run.time_step == "extrapolated":
        for name, bound in FIELDS.items():
            yield at_most(
                f"{name}, {_name(run)}", largest(getattr(trace, name) - getattr(model, name)), bound, part
            )
    error = largest(trace.tilt - model.tilt) / SHAKEN.cylinder.alpha
    said = [fact.size for fact in trace.diagnostics if fact.code in ("settled", "extrapolated")]
    off = max(math.log2(error / said[0]), math.log2(said[0] / (SERIES * error))) if said else math.nan
    yield at_most(f"estimate of its own error, {_name(run)}", off, ESTIMATE, part, f"it is {error:.2g} alpha")


def _released(bench: Bench, run: Run) -> Iterator[Finding]:
    trace, model = simulate_run(RELEASE, run), bench.solve(RELEASE, rtol=1e-11)
    if trace.outcome == "failed":
        yield _failed(run, trace)
        return
    part = f"turning points of an extrapolated trace of {run.engine} (multibody/time_step)"
    yield at_most(f"peak, {_name(run)}", abs(trace.peak_tilt - model.peak_tilt), PEAK, part)
    yield at_most(f"passes, {_name(run)}", _apart(*(_passes(each) for each in (trace, model))), TURNING, part)
    yield at_most(f"maxima, {_name(run)}", _apart(*(_maxima(each) for each in (trace, model))), TURNING, part)


def _passes(trace: Trace) -> Array:
    return trace.passes[["time", "minimum_tilt", "angle_of_turn"]].to_numpy(dtype=float)


def _maxima(trace: Trace) -> Array:
    return trace.extrema[trace.extrema[:, 3] > 0.0, :3]


def _apart(own: Array, other: Array) -> float:
    return largest(own - other) if own.shape == other.shape else math.nan


def _name(run: Run) -> str:
    return f"{run}, {run.time_step}"


def _failed(run: Run, trace: Trace) -> Finding:
    part = f"contact of {run.engine}: the run failed"
    return at_most(f"{_name(run)} reaches its end", math.nan, ENDS, part, why(trace))
