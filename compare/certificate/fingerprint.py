"""Fingerprint of a method: twelve short motions, how exactly they repeat, and how long they can agree.

Two installations of one method differ by rounding, and two versions of an engine by a little more. What that
becomes in time is told by copies of a case whose start or record is off by the accuracy of the method: a
difference counts where it is larger than ten times theirs. Where the copies differ by 1 % of alpha themselves
the agreement ends, and the tilts of many copies are kept instead, for their largest from then on. Those
copies are ten times further off: so much may two versions differ.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass
from random import Random
from types import ModuleType
from typing import Any

import numpy as np
from numpy.typing import NDArray

from rockwobble import multibody, reduced
from rockwobble.models import AGREEMENT, Case, Run, Trace
from rockwobble.models.case import TimeStep
from rockwobble.models.members import perturbed

from .short_cases import G, ShortCase, short_cases
from .verdict import SAME, Entry, Sample, compare_entries

Array = NDArray[np.float64]
_SAMPLES = 40  # of each motion
_BEYOND = 10.0  # what counts is so many times larger than the difference of the copies
_MEMBERS = 16
SIGNALS = ("tilt", "lean_x", "lean_y", "twist", "energy", "force_x", "force_y", "force_z", "moment")


@dataclass(frozen=True, slots=True, kw_only=True)
class Method:
    """The method that is certified.

    Parameters
    ----------
    run : Run
        Engine, or None for the reduced models, time step and settings; each case has its own support.
    accuracy : float
        Relative difference of a copy: what the method itself leaves open.
    repeats : float
        To how much of its size a number is repeated.
    simulate : callable
        Of a short case, and of that with another case in its place.
    """

    run: Run
    accuracy: float
    repeats: float
    simulate: Callable[[ShortCase, Case], Trace]


def reduced_method(module: ModuleType = reduced) -> Method:
    """Return the reduced models at their default tolerance; of a copy of the package, for its tests."""

    def simulate(short: ShortCase, case: Case) -> Trace:
        step = case.length / _SAMPLES
        found: Trace = module.simulate(case, support=short.support, sample_step=step, **short.options)
        return found

    return Method(run=Run(None, "recess"), accuracy=1e-10, repeats=1e-9, simulate=simulate)


def engine_method(engine: str, time_step: TimeStep | None = None, **settings: Any) -> Method:
    """Return an engine, at its defaults where nothing else is asked for."""

    def simulate(short: ShortCase, case: Case) -> Trace:
        step = case.length / _SAMPLES
        return multibody.simulate(
            case, engine=engine, support=short.support, time_step=time_step, sample_step=step, **settings
        )

    run = Run(engine, "recess", time_step, **settings)
    return Method(run=run, accuracy=1e-5, repeats=1e-4, simulate=simulate)


def fingerprint(method: Method) -> Iterator[Entry]:
    """Yield the twelve entries, each when it is computed."""
    for short in short_cases():
        trace = method.simulate(short, short.case)
        found, values = entry(short, trace), _signals(trace)
        copies = [_signals(method.simulate(short, copy)) for copy in _copies(short.case, method.accuracy)]
        spread = _BEYOND * np.array([_apart(copy, values) for copy in copies]).max(axis=0)
        lost = np.flatnonzero(spread[:, SIGNALS.index("tilt")] > AGREEMENT)
        allowed = method.repeats * np.maximum(1.0, np.abs(np.nan_to_num(values))) + spread
        if len(lost):  # from there on copies are no measure
            allowed[lost[0] :] = allowed[max(lost[0] - 1, 0)]
        whole: Entry = {
            **found,
            "agreement_time": found["time"][lost[0]] if len(lost) else None,
            "repeats": method.repeats,
            "allowed": {name: _rounded(allowed[:, k]) for k, name in enumerate(SIGNALS)},
        }
        if len(lost):
            whole["copies"] = copied_tilts(short, method)
        yield whole


def repeated(method: Method, old: Sequence[Entry]) -> Iterator[Sample]:
    """Yield the parts of the entries needed to hold them against older ones: the copies are theirs."""
    for short, one in zip(short_cases(), old, strict=True):
        found = entry(short, method.simulate(short, short.case))
        if one["agreement_time"] is not None and compare_entries(one, found).word != SAME:
            found["copies"] = copied_tilts(short, method)
        yield found


def entry(short: ShortCase, trace: Trace) -> Sample:
    """Return the samples and the events of one case."""
    values = _signals(trace)
    return {
        "name": short.name,
        "claim": short.claim,
        "term": short.term,
        "support": short.support,
        "outcome": trace.outcome,
        "uplift_time": _known(trace.uplift_time),
        "uplift_direction": _known(trace.uplift_direction),
        # as the signals, of the run alone
        "peak_tilt": _known(trace.peak_within_run / short.case.cylinder.alpha),
        "time": _rounded(trace.time),
        "signals": {name: _listed(values[:, k]) for k, name in enumerate(SIGNALS)},
    }


def copied_tilts(short: ShortCase, method: Method) -> list[list[float | None]]:
    """Return the tilts of many copies, over alpha."""
    members = _members(short.case, _BEYOND * method.accuracy)
    return [_listed(method.simulate(short, member).tilt / member.cylinder.alpha) for member in members]


def _signals(trace: Trace) -> Array:
    """Return the signals (n, 9): over alpha, sin(alpha), g R, weights and b."""
    body = trace.case.cylinder
    lean = np.sin(trace.tilt) * np.exp(1j * np.nan_to_num(trace.rolling_angle)) / math.sin(body.alpha)
    return np.column_stack(
        [
            trace.tilt / body.alpha,
            lean.real,
            lean.imag,
            trace.twist,
            trace.energy / (G * body.semidiagonal),
            trace.contact_force,
            trace.restraining_moment / body.base_radius,
        ]
    )


def _apart(copy: Array, values: Array) -> Array:
    """Return the difference (n, 9), of a copy that ended earlier as far as it goes."""
    apart = np.zeros_like(values)
    count = min(len(copy), len(values))
    apart[:count] = np.nan_to_num(np.abs(copy[:count] - values[:count]))
    running = np.maximum.accumulate(apart, axis=0)  # a difference that is zero by chance says nothing
    return np.asarray(running, dtype=np.float64)


def _copies(case: Case, share: float) -> list[Case]:
    return [perturbed(case, 1.0 + share, 1.0 + share), perturbed(case, 1.0 - share, 1.0 + 0.5 * share)]


def _members(case: Case, share: float) -> list[Case]:
    random = Random(1940)
    factors = [(1.0 + share * random.gauss(0, 1), 1.0 + share * random.gauss(0, 1)) for _ in range(_MEMBERS)]
    return [perturbed(case, *pair) for pair in factors]


def _known(value: float) -> float | None:
    return float(value) if math.isfinite(value) else None


def _listed(values: Array) -> list[float | None]:
    return [value if math.isfinite(value) else None for value in _rounded(values)]


def _rounded(values: Array) -> list[float]:
    return [float(f"{value:.12g}") for value in values]
