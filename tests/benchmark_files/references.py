"""References of the cases: each number by two independent formulations, with their difference.

The first is the reduced model, in angles and momenta, by its own integrator; the second is `second`, and
where there is one a closed form or a quadrature is the third. A bound is ten times what they differ by.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray
from scipy.interpolate import BarycentricInterpolator, CubicHermiteSpline
from scipy.optimize import brentq

from rockwobble import reduced
from rockwobble.models import Case
from rockwobble.reduced.exact import free_response, steady_wobble_rate

from .definitions import BenchmarkRun, Definition, G
from .impact import maximum_after
from .second import REST, Sampled, sampled
from .slide import closed, integrated, modelled

Array = NDArray[np.float64]
RTOL = 1e-13
FIRST = "reduced model, rtol 1e-13"
SECOND = "Newton-Euler in vectors, rtol 1e-13"
SLIDING = "closed form of the sliding body"
MODEL = "sliding model, Taylor series"
INTEGRATED = "integration of the sliding body, Dormand-Prince 8"
_REACH = 5  # samples on each side of a root


class Reference(NamedTuple):
    """Contents of reference.json and reference.csv."""

    quantities: list[dict[str, Any]]
    columns: dict[str, Array]
    bounds: dict[str, float]  # of the columns, in their own units


def first(run: BenchmarkRun, spacing: float, end: float) -> Sampled:
    """Return samples of the reduced model."""
    case = Case(run.cylinder, run.motion, initial=run.initial, duration=end, gravity=G, tendon=run.tendon)
    plane: dict[str, Any] = {"plane": 0.0, "restitution": "momentum"} if run.closes else {}
    trace = reduced.simulate(case, support=run.model, rtol=RTOL, rest_tilt=REST, sample_step=spacing, **plane)
    count = round(end / spacing) + 1
    return Sampled(
        *(column[:count] for column in (trace.time, trace.tilt, trace.tilt_rate, trace.rolling_angle))
    )


def reference(definition: Definition) -> Reference:
    """Compute the reference of a case."""
    if definition.name == "records-distribution":
        return _peaks(definition)
    traces = {run.name: _both(definition, run) for run in definition.runs if not run.slides}
    paths = {run.name: _paths(definition, run) for run in definition.runs if run.slides}
    quantities = []
    for criterion in definition.criteria:
        for run in definition.runs:
            name = criterion["name"]
            if criterion["kind"] != "quantity" or run.name not in criterion.get("runs", [*traces, *paths]):
                continue
            if run.slides:
                quantities.append(_quantity(name, run.name, _of_slide(name, run, *paths[run.name])))
                continue
            known = {
                by: measured(name, run, trace)
                for by, trace in zip((FIRST, SECOND), traces[run.name], strict=True)
            }
            if run.closes:
                known |= _after_impact(name, run, traces[run.name][1])
            quantities.append(_quantity(name, run.name, {**_closed(name, run), **known}))
    columns, bounds = _columns(definition, traces, paths)
    return Reference(quantities, columns, bounds)


def _paths(definition: Definition, run: BenchmarkRun) -> tuple[Array, Array, Array]:
    """Times, and the path by the reduced model and by integration."""
    times = definition.step * np.arange(round(run.duration / definition.step) + 1)
    return times, modelled(run, times), integrated(run, times)


def _of_slide(name: str, run: BenchmarkRun, times: Array, model: Array, other: Array) -> dict[str, float]:
    """Quantity of a slide by each known method."""
    exact, known = closed(name, run), {}
    if exact is not None:
        known[SLIDING] = exact
    for by, path in ((MODEL, model), (INTEGRATED, other)):
        moved = np.hypot(*path.T) / run.cylinder.base_radius
        excess = moved - run.levels["slide_level"]
        known[by] = float(moved[-1])
        if name == "slide_time":
            known[by] = _root(times, excess, int(np.flatnonzero(excess > 0.0)[0]) - 1)
    return known


def _both(definition: Definition, run: BenchmarkRun) -> tuple[Sampled, Sampled]:
    spacing = definition.step * run.time_unit
    end = spacing * round(min(run.duration, definition.end or math.inf) / spacing)
    # far quantities need the complete run
    whole = spacing * round(run.duration / spacing)
    end = whole if any(c["name"].endswith("_100") for c in definition.criteria) else end
    return first(run, spacing, end), sampled(run, spacing, end)


def measured(name: str, run: BenchmarkRun, trace: Sampled) -> float:
    """Quantity from roots of polynomials through the samples."""
    kind, _, digits = name.rpartition("_")
    time, alpha = trace.time, run.cylinder.alpha
    if kind == "kept":
        return energy_kept(*(measured(f"maximum_{int(digits) + k}", run, trace) for k in (0, 1)), alpha)
    if kind in ("turn", "period", "maximum"):
        falls = np.flatnonzero((trace.tilt_rate[:-1] > 0.0) & (trace.tilt_rate[1:] <= 0.0))
        falls = falls[falls > 0]  # a release is a maximum up to rounding
        at = _root(time, trace.tilt_rate, int(falls[int(digits) - 1]))
        if kind == "period":
            return at / int(digits)
        if kind == "maximum":
            return _value(time, trace.tilt, at) / alpha
        assert run.initial is not None
        return (_value(time, trace.azimuth, at) - run.initial.rolling_angle) / int(digits)
    if kind == "revolutions":
        excess = trace.azimuth - trace.azimuth[0] - 2.0 * math.pi * int(digits)
        return _root(time, excess, int(np.flatnonzero(excess > 0.0)[0]) - 1)
    excess = trace.tilt - run.levels["lean_level"] * alpha
    at = _root(time, excess, int(np.flatnonzero(excess > 0.0)[0]) - 1)
    if name == "lean_time":
        return at
    azimuth = _value(time, trace.azimuth, at) % (2.0 * math.pi)
    # an azimuth of 0 may round to just below a full turn
    return azimuth - 2.0 * math.pi if 2.0 * math.pi - azimuth < 1e-9 else azimuth


def energy_kept(before: float, after: float, alpha: float) -> float:
    """Energy ratio across an impact, from the adjacent tilt maxima [alpha]."""
    first, second = (math.cos(alpha - alpha * tilt) - math.cos(alpha) for tilt in (before, after))
    return second / first


def _around(time: Array, values: Array, i: int) -> Callable[[float], float]:
    near = slice(max(0, i - _REACH + 1), i + _REACH + 1)
    polynomial = BarycentricInterpolator(time[near] - time[i], values[near])
    return lambda at: float(polynomial(at - time[i]))


def _root(time: Array, values: Array, i: int) -> float:
    return float(brentq(_around(time, values, i), time[i], time[i + 1], xtol=1e-15, rtol=1e-15))


def _value(time: Array, values: Array, at: float) -> float:
    return _around(time, values, int(np.searchsorted(time, at)) - 1)(at)


def _closed(name: str, run: BenchmarkRun) -> dict[str, float]:
    """Closed-form values, without integration."""
    kind = name.rpartition("_")[0]
    if kind == "revolutions":
        assert run.initial is not None
        rate = float(steady_wobble_rate(run.cylinder, run.initial.tilt, gravity=G))
        return {"closed form": 200.0 * math.pi / rate}
    if run.support == "recess" and run.initial is not None:
        exact = free_response(run.cylinder, run.initial, gravity=G, tendon=run.tendon)
        known = {"turn": exact.angle_of_turn, "period": exact.period}
        known["maximum"] = exact.maximum_tilt / run.cylinder.alpha
        return {"quadrature": known[kind]}
    return {}


def _after_impact(name: str, run: BenchmarkRun, trace: Sampled) -> dict[str, float]:
    """Closed form on still ground: energy and moment of momentum, from the largest tilt after the pulse."""
    kind, _, digits = name.rpartition("_")
    alpha = run.cylinder.alpha
    top = alpha * measured("maximum_2", run, trace)
    if kind == "kept":
        return {"closed form": energy_kept(top / alpha, maximum_after(top, run, 1) / alpha, alpha)}
    if name == "maximum_2":
        return {}
    return {"closed form": maximum_after(top, run, int(digits) - 2) / alpha}


def _quantity(name: str, run: str, by: dict[str, float]) -> dict[str, Any]:
    """Entry of reference.json; the first known method gives the value."""
    values = list(by.values())
    apart = max(values) - min(values)
    unit = {"turn": "rad", "maximum": "alpha", "kept": "share"}.get(name.rpartition("_")[0], "s")
    unit = {"lean_azimuth": "rad", "peak_tilt": "alpha", "slide_end": "b"}.get(name, unit)
    bound = _rounded_up(10.0 * max(apart, 1e-14 * abs(values[0])))
    return {"name": name, "run": run, "value": values[0], "unit": unit, "bound": bound, "certified": by}


def _rounded_up(bound: float) -> float:
    digit = 10.0 ** math.floor(math.log10(bound))
    return float(f"{math.ceil(bound / digit) * digit:.0e}")


def _columns(
    definition: Definition,
    traces: dict[str, tuple[Sampled, Sampled]],
    paths: dict[str, tuple[Array, Array, Array]],
) -> tuple[dict[str, Array], dict[str, float]]:
    """Table of reference.csv, with the accuracy of its columns."""
    named = definition.runs
    shared = any(run.turned for run in named) or any(run.time_unit != 1.0 for run in named)
    count = round(definition.end / definition.step) + 1 if definition.end else None
    count = count or min(
        len(times) for times in [*(one.time for one, _ in traces.values()), *(p[0] for p in paths.values())]
    )
    columns: dict[str, Array] = {"time": definition.step * np.arange(count)}
    bounds = dict.fromkeys([*(("tilt", "azimuth") if traces else ()), *(("x", "y") if paths else ())], 0.0)
    for run in named:
        if run.slides:
            continue
        one, two = ((t.tilt[:count], np.nan_to_num(t.azimuth[:count])) for t in traces[run.name])
        bounds["tilt"] = max(bounds["tilt"], float(np.abs(one[0] - two[0]).max()))
        leans = one[0] > 1e-3 * run.cylinder.alpha
        apart = np.abs(np.angle(np.exp(1j * (one[1] - two[1])[leans])))
        bounds["azimuth"] = max(bounds["azimuth"], float(apart.max()))
        label = "" if shared or len(named) == 1 else f":{run.name}"
        if shared and "tilt" in columns:  # every run certifies the common value
            bounds["tilt"] = max(bounds["tilt"], float(np.abs(one[0] - columns["tilt"]).max()))
            continue
        columns[f"tilt{label}"] = one[0]
        columns[f"azimuth{label}"] = np.where(one[0] > 0.0, one[1] - run.turned, 0.0)
    if paths:
        columns |= {"tilt": np.zeros(count), "azimuth": np.zeros(count)}
    for name, (_, model, other) in paths.items():
        for axis, one, two in zip("xy", model[:count].T, other[:count].T, strict=True):
            columns[f"{axis}:{name}"] = one
            bounds[axis] = max(bounds[axis], float(np.abs(one - two).max()))
    return columns, {name: _rounded_up(10.0 * max(bound, 1e-15)) for name, bound in bounds.items()}


def _peak(run: BenchmarkRun) -> float:
    """Peak tilt by the second formulation [rad], still ground after the record included."""
    samples = sampled(run, 0.005, run.duration + 10.0, rtol=1e-12)
    tilt = CubicHermiteSpline(samples.time, samples.tilt, samples.tilt_rate)
    turns = tilt.derivative().roots(extrapolate=False)
    return min(0.5 * math.pi, float(tilt(turns[np.isfinite(turns)]).max(initial=samples.tilt.max())))


def _peaks(definition: Definition) -> Reference:
    """Peak tilts under the records; a sensitive record has a wide bound."""
    quantities, rows = [], []
    for index, run in enumerate(definition.runs):
        assert run.motion is not None
        case = Case(run.cylinder, run.motion, duration=run.duration, gravity=G)
        trace = reduced.simulate(case, support=run.model, rtol=1e-12, rest_tilt=REST)
        alpha = run.cylinder.alpha
        by = {
            FIRST.replace("13", "12"): trace.peak_tilt / alpha,
            SECOND.replace("13", "12"): _peak(run) / alpha,
        }
        one = _quantity("peak_tilt", run.name, by)
        quantities.append(one)
        highest = float(trace.time[int(np.argmax(trace.tilt))])
        rows.append((highest, float(index + 1), one["value"], one["bound"]))
    table = np.array(rows)
    return Reference(
        quantities, dict(zip(("time", "record", "peak_tilt", "bound"), table.T, strict=True)), {}
    )
