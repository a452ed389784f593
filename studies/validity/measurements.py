"""The measurements: free response, peaks over records, agreement times, contact, recesses with clearance."""

from __future__ import annotations

import itertools
import math
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from dataclasses import asdict, replace
from functools import partial

import numpy as np

from rockwobble import multibody, reduced
from rockwobble.compare.comparison.driver import comparison_row
from rockwobble.compare.metrics.pair import FloatArray, make_pair, tilt_rms
from rockwobble.compare.runs.execution import simulate_run
from rockwobble.models import Case, InitialState, Run, Trace
from rockwobble.models.case import RECESS_MODEL, REDUCED_MODELS
from rockwobble.models.support import FLAT, MODELLED, RECESS, RING, SUPPORTS, Support, support_named
from rockwobble.multibody import DEFAULT_ENGINE
from rockwobble.multibody.engines.registry import find_engine
from rockwobble.multibody.ring import clearance_needed, take_ring
from rockwobble.multibody.scene import REFERENCE_TIME_STEP
from rockwobble.reduced.body import body_of

from .plan import (
    AMPLE,
    EL_CENTRO,
    FREE,
    HALVED,
    LARGEST_PEAK,
    PERTURBED,
    POINT,
    REFERENCE_SIZE,
    RELEASE,
    Extent,
    Structure,
    motion_named,
    record_names,
    release_case,
    shaken_case,
)

Row = dict[str, float | str | bool]
Point = Mapping[str, float | str]  # coordinates, the first columns of every row of a task
Inputs = Mapping[str, object]  # other arguments: numbers, tuples of them and a `Structure`
Task = tuple[str, Point, Inputs]  # the part first

_FREE_RTOL = 1e-10
_CYCLES = 10.0  # over which the flat-ground model may gather tilt
_MAXIMUM = 1.0  # code of a maximum in the fourth column of `Trace.extrema`


def needs_of(trace: Trace) -> dict[str, float]:
    """Demands of the recess model on ground and recess in a run.

    friction, least_normal [weights], moment, the restraining moment over weight and base radius; NaN where it
    does not move or overturns. In a frame of base or top, whichever asks for more, over the weight that it
    carries. With a tendon tension, its largest over the weight of a column.
    """
    needs, case = trace.assumptions, trace.case
    known = needs is not None and trace.outcome == "stands" and trace.peak_tilt > 0.0
    row = dict.fromkeys(("friction", "least_normal", "moment"), math.nan)
    if needs is not None and known:
        row = {
            "friction": needs.largest_friction_needed,
            "least_normal": needs.least_normal_force,
            "moment": needs.largest_restraining_moment / case.cylinder.base_radius,
        }
    return row if case.tendon is None else row | {"tension": trace.peak_tendon_force if known else math.nan}


def loss_of(trace: Trace) -> float:
    """Energy lost in contact over the largest energy reached; NaN without motion."""
    largest = float(trace.energy.max())
    return -float(trace.energy_error[-1]) / largest if largest > 0.0 else math.nan


def next_maximum(trace: Trace) -> tuple[float, float]:
    """Time and rolling angle from the release to the next tilt maximum; NaN if there is none."""
    maxima = trace.extrema[trace.extrema[:, 3] == _MAXIMUM]
    if len(maxima) < 2:
        return math.nan, math.nan
    return float(maxima[1, 0] - maxima[0, 0]), float(maxima[1, 2] - maxima[0, 2])


def measure_free_response(
    tan_alpha: float, releases: Sequence[float], spins: Sequence[float], structure: Structure
) -> Iterator[Row]:
    """One row for each release and spin.

    The columns: tan_alpha, release, spin; period [s] and turn [rad] from tilt maximum to next maximum, exact
    (recess) and integrated (flat_period, flat_turn; NaN where it overturns first), flat_peak, the
    largest tilt of the flat-ground model in ten periods over the release, all three NaN with a tendon;
    `needs_of` the recess model in one period.
    """
    for release, spin in itertools.product(releases, spins):
        case = release_case(tan_alpha, release, spin, structure=structure)
        assert case.initial is not None
        exact = reduced.free_response(case.cylinder, case.initial, tendon=case.tendon)
        period = turn = peak = math.nan
        if not case.anchor:  # the flat-ground model has no anchor
            longer = replace(case, duration=_CYCLES * exact.period)
            flat = reduced.simulate(longer, support=FLAT, rtol=_FREE_RTOL)
            (period, turn), peak = next_maximum(flat), flat.peak_tilt
        yield {
            "release": release,
            "spin": spin,
            "period": exact.period,
            "flat_period": period,
            "turn": exact.angle_of_turn,
            "flat_turn": turn,
            "flat_peak": peak / case.initial.tilt,
            **needs_of(reduced.simulate(case, rtol=_FREE_RTOL)),
        }


_VERIFIED_PERIODS = 2.2  # periods up to just after the second maximum
_FRICTION = 10.0  # ample, as friction is another limit


def measure_verification(
    tan_alpha: float, release: float, spin: float, structure: Structure
) -> Iterator[Row]:
    """A row for each support that has a model: the first pass by model and engine, and the tilts.

    The columns: tan_alpha, release, spin, support; turn, engine_turn [rad], half_period, engine_half_period
    [s] to the first tilt minimum; tilt_rms over alpha; resolved, whether the contact of the engine resolves
    the pass; outcome.
    """
    case = release_case(tan_alpha, release, spin, _VERIFIED_PERIODS, structure=structure)
    case = replace(case, friction=_FRICTION)
    none = {"time": math.nan, "angle_of_turn": math.nan, "resolved": False}
    for support in _models(structure):
        model = simulate_run(case, Run(None, support, rtol=_FREE_RTOL))
        run = simulate_run(case, Run(DEFAULT_ENGINE, support))
        first, own_first = (next(iter(each.passes.to_dict("records")), none) for each in (run, model))
        yield {
            "support": support,
            "turn": next_maximum(model)[1],
            "engine_turn": first["angle_of_turn"],
            "half_period": own_first["time"],
            "engine_half_period": first["time"],
            "tilt_rms": tilt_rms(make_pair(case.cylinder, model, run)),
            "resolved": first["resolved"],
            "outcome": run.outcome,
        }


_SLIP_PERIODS = 1.1  # one pass, as later passes need equal friction


def measure_slip(
    tan_alpha: float, release: float, spin: float, shares: Sequence[float], structure: Structure
) -> Iterator[Row]:
    """A row for each friction, as a share of what the recess model needs.

    The columns: tan_alpha, release, spin, needed, share, friction, slip of the engine in a recess in one
    period [b], tilt_rms against the recess model over alpha, outcome. No row where the model loses contact:
    no friction is enough.
    """
    period = release_case(tan_alpha, release, spin, structure=structure)
    needed = needs_of(reduced.simulate(period, rtol=_FREE_RTOL))["friction"]
    case = release_case(tan_alpha, release, spin, _SLIP_PERIODS, structure=structure)
    recess = reduced.simulate(case, rtol=_FREE_RTOL)
    for share in shares if math.isfinite(needed) else ():
        run = multibody.simulate(replace(case, friction=share * needed))
        yield {
            "needed": needed,
            "share": share,
            "friction": share * needed,
            "slip": float(run.slip[-1]) / case.cylinder.base_radius,
            "tilt_rms": tilt_rms(make_pair(case.cylinder, recess, run)),
            "outcome": run.outcome,
        }


# relative change of the record in the perturbed copy: no record is known better, and no model can be
# more accurate than its effect
COPY = 0.01
_RTOL = 1e-7


def measure_peaks(
    motion: str, tan_alpha: float, semidiagonal: float, intensities: Sequence[float], structure: Structure
) -> Iterator[Row]:
    """One row for each plausible intensity, see `LARGEST_PEAK`.

    The columns: motion, tan_alpha, semidiagonal [m], intensity; peak tilt over alpha, pi/2 over alpha if
    overturned, of the recess model, of its perturbed copy under a record stronger by 1 %, of the flat-ground
    model (NaN with a tendon), and of the recess model with the vertical component (NaN where the record has
    none); `needs_of` the recess model.
    """
    shaken = partial(shaken_case, motion, tan_alpha, semidiagonal, structure=structure)
    simulate = partial(reduced.simulate, rtol=_RTOL)
    for intensity in intensities:
        if intensity * tan_alpha > LARGEST_PEAK:
            continue
        case = shaken(intensity)
        traces = {RECESS: simulate(case), "copy": simulate(shaken(intensity * (1.0 + COPY)))}
        if not case.anchor:
            traces[FLAT] = simulate(case, support=FLAT)
        if motion_named(motion).has_vertical:
            traces["vertical"] = simulate(shaken(intensity, vertical=True))
        yield {
            "intensity": intensity,
            **dict.fromkeys((FLAT, "vertical"), math.nan),
            **{name: trace.peak_tilt / case.cylinder.alpha for name, trace in traces.items()},
            **needs_of(traces[RECESS]),
        }


def measure_records(
    motion: str,
    tan_alpha: float,
    semidiagonal: float,
    intensity: float,
    time_step: float,
    structure: Structure,
) -> Iterator[Row]:
    """One row for each method.

    The columns: motion, tan_alpha, semidiagonal [m], intensity, method, peak over alpha, outcome;
    contact_time with walls [s] and loss, see `loss_of`. The methods: the reduced models (one with a tendon),
    the perturbed copy of the recess model under a record stronger by 1 %, the engine in a recess, on flat
    ground and, without a slab, in a ring, and this at half its step.
    """
    shaken = partial(shaken_case, motion, tan_alpha, semidiagonal, structure=structure)
    case, stronger = shaken(intensity), shaken(intensity * (1.0 + COPY))
    runs: dict[str, tuple[Case, Run]] = {
        **{str(model): (case, model) for model in REDUCED_MODELS if model.support in _models(structure)},
        PERTURBED: (stronger, RECESS_MODEL),
        **{each: (case, Run(DEFAULT_ENGINE, each, time_step)) for each in _supports(structure)},
    }
    if RING in runs:
        runs[HALVED] = case, Run(DEFAULT_ENGINE, RING, 0.5 * time_step)
    for method, (problem, run) in runs.items():
        trace = simulate_run(problem, run)
        yield {
            "method": method,
            "peak": trace.peak_tilt / case.cylinder.alpha,
            "outcome": trace.outcome,
            "contact_time": float(trace.wall_contact[-1]),
            "loss": loss_of(trace),
        }


def _models(structure: Structure) -> list[Support]:
    """Supports with a reduced model of the structure."""
    return [each for each in MODELLED if structure.tendon is None or each.guided]


def _supports(structure: Structure) -> list[Support]:
    """Supports of the engine; a slab excludes walls."""
    known = [each for each in SUPPORTS.values() if each in find_engine(DEFAULT_ENGINE).supports]
    return [each for each in known if not (structure.slab_mass_ratio and each.walls)]


_COLUMNS = (
    *("support", "reference_support", "outcome", "reference_outcome", "peak_tilt", "reference_peak_tilt"),
    *("tilt_rms", "tilt_rms_relative", "agreement_time", "predicted_agreement_time", "diverged"),
    *("agreed_passes", "residual_displacement", "residual_twist"),
)


def measure_record_agreement(
    tan_alpha: float, semidiagonal: float, intensity: float, duration: float, structure: Structure
) -> Iterator[Row]:
    """Summary of a run of the engine against the recess and, on flat ground, the flat model.

    The columns are tan_alpha, semidiagonal, intensity, duration and those of `SUMMARY_COLUMNS`.
    """
    case = shaken_case(EL_CENTRO, tan_alpha, semidiagonal, intensity, duration=duration, structure=structure)
    models = {Run(None, support): simulate_run(case, Run(None, support)) for support in _models(structure)}
    for support in _models(structure):
        run = Run(DEFAULT_ENGINE, support)
        trace = simulate_run(case, run)
        for model in run.compared_with:
            row = comparison_row(
                case,
                str(model),
                models[model],
                str(run),
                trace,
                own=models[run.own_model],
                simulate=simulate_run,
            )
            yield {name: row[name] for name in _COLUMNS}


_RELEASE, _SPIN, _PASSES = 0.5, 0.1, 4
# over the acceleration at uplift; [s]
STRONG, _LENGTH = 2.0, 10.0


def measure_contact(
    tan_alpha: float, time_constant: float, damping: float, structure: Structure
) -> Iterator[Row]:
    """One row: loss in free response in a recess, and peak tilt under El Centro.

    The columns: tan_alpha, time_constant [s] in which contact removes a normal velocity, damping ratio,
    softness, the time constant times the frequency parameter p; loss of energy per pass over the energy of
    the release, passes, peak and recess_peak under El Centro over alpha, free_outcome, outcome.
    """
    run = Run(DEFAULT_ENGINE, RECESS, contact_time_constant=time_constant, contact_damping_ratio=damping)
    free = simulate_run(release_case(tan_alpha, _RELEASE, _SPIN, _PASSES, structure=structure), run)
    strong = STRONG * structure.uplift
    case = shaken_case(EL_CENTRO, tan_alpha, REFERENCE_SIZE, strong, duration=_LENGTH, structure=structure)
    shaken = simulate_run(case, run)
    lost = -float(free.energy_error[-1]) / float(free.energy[0])
    yield {
        "softness": time_constant * body_of(case.cylinder, case.gravity).p,
        "loss": lost / max(len(free.passes), 1),
        "passes": len(free.passes),
        "peak": shaken.peak_tilt / case.cylinder.alpha,
        "recess_peak": reduced.simulate(case).peak_tilt / case.cylinder.alpha,
        "free_outcome": free.outcome,
        "outcome": shaken.outcome,
    }


# over the acceleration at uplift: strong rocking without a fall
INTENSITY = 1.5


def measure_rings(
    motion: str,
    tan_alpha: float,
    turn: float,
    support: str,
    clearance: float,
    inclination: float,
    friction: float,
    length: float,
    structure: Structure,
) -> Iterator[Row]:
    """One row for free response or El Centro; none if the walls are too narrow for the release.

    The columns: motion, tan_alpha, turn [rad], support, clearance [b], inclination [rad] (0 for alpha) and
    friction of the walls, those of `losses`; recess_peak, and halved_peak, that of the same ring at half the
    step [alpha].
    """
    walls: dict[str, float] = {}
    if support_named(support).walls:
        walls = {"ring_clearance": clearance, "ring_friction": friction}
        walls |= {"ring_inclination": inclination} if inclination > 0.0 else {}
    if motion == FREE:
        cylinder = structure.column(REFERENCE_SIZE, tan_alpha)
        initial = InitialState(tilt=0.5 * cylinder.alpha, rolling_angle=turn, rolling_rate=0.5)
        case = Case(cylinder, initial=initial, duration=length, friction=AMPLE, tendon=structure.tendon)
    else:
        strong = INTENSITY * structure.uplift
        case = shaken_case(
            motion, tan_alpha, REFERENCE_SIZE, strong, duration=length, turn=turn, structure=structure
        )
    run, finer = (Run(DEFAULT_ENGINE, support, part * REFERENCE_TIME_STEP, **walls) for part in (1.0, 0.5))
    if has_room(case, run):
        alpha = case.cylinder.alpha
        yield {
            **losses(simulate_run(case, run)),
            "recess_peak": reduced.simulate(case).peak_tilt / alpha,
            "halved_peak": simulate_run(case, finer).peak_tilt / alpha if walls else math.nan,
        }


def has_room(case: Case, run: Run) -> bool:
    """Whether the release is clear of the walls."""
    _, ring = take_ring(run.settings, run.support, case.cylinder.tan_alpha)
    if ring is None or case.initial is None:
        return True
    return clearance_needed(case.cylinder, case.initial.tilt, ring.ring_inclination) <= ring.ring_clearance


def losses(trace: Trace) -> Row:
    """Energy losses of a run in a recess with or without clearance.

    outcome; first_contact with a wall (inf where there is none) and contact_time [s]; passes; loss of energy,
    see `loss_of`; rolled_out and at_end, distance from O of the place on which the cylinder would come down,
    largest and last [b]; twist at the end [rad]; peak [alpha].
    """
    out = _rolled_out(trace)
    return {
        "outcome": trace.outcome,
        "first_contact": trace.first("wall_contact"),
        "contact_time": float(trace.wall_contact[-1]),
        "passes": len(trace.passes),
        "loss": loss_of(trace),
        "rolled_out": float(out.max(initial=0.0)),
        "at_end": float(out[-1]) if len(out) else 0.0,
        "twist": trace.residual_twist,
        "peak": trace.peak_tilt / trace.case.cylinder.alpha,
    }


def _rolled_out(trace: Trace) -> FloatArray:
    """Distance from O of the landing place of a cylinder, while it is tilted [b].

    The contact point less a radius in the direction of the lean: in the recess model that is O.
    """
    radius = trace.case.cylinder.base_radius
    lean = np.column_stack([np.cos(trace.rolling_angle), np.sin(trace.rolling_angle)])
    place = trace.contact_point - radius * lean
    distance: FloatArray = np.hypot(place[:, 0], place[:, 1]) / radius
    return distance[np.isfinite(distance)]


# name of the table of each part, and its measurement
PARTS: Mapping[str, Callable[..., Iterator[Row]]] = {
    "free_response": measure_free_response,
    "verification": measure_verification,
    "peaks": measure_peaks,
    "slip": measure_slip,
    "rings": measure_rings,
    "contact": measure_contact,
    "following": measure_record_agreement,
    "records": measure_records,
}


def tasks_of(extent: Extent) -> list[Task]:
    """Tasks of all parts; with a slab only of parts without walls."""
    records, structure = record_names(extent.members), extent.structure
    none = dict.fromkeys(("clearance", "inclination", "friction"), math.nan)
    walls = [
        {"support": support, **each}
        for support in _supports(structure)
        for each in (map(asdict, extent.rings) if support.walls else [none])
    ]
    turned = _grid(motion=(FREE, EL_CENTRO), tan_alpha=extent.ring_tan_alphas, turn=extent.ring_turns)
    rings: list[Point] = [{**point, **each} for point in turned for each in walls]
    followed = [(*point, extent.trace_length) for point in extent.trace_points]
    points: dict[str, list[Point]] = {
        "free_response": _grid(tan_alpha=extent.tan_alphas),
        "verification": _points(RELEASE, extent.engine_points),
        # El Centro besides, which has a vertical component
        "peaks": _grid(
            motion=[*records, EL_CENTRO], tan_alpha=extent.shaken_tan_alphas, semidiagonal=extent.sizes
        ),
        "slip": _points(RELEASE, extent.slip_points),
        "rings": [] if structure.slab_mass_ratio else rings,
        "contact": _grid(
            tan_alpha=extent.contact_tan_alphas, time_constant=extent.time_constants, damping=extent.dampings
        ),
        "following": _points((*POINT, "duration"), followed),
        "records": [
            {"motion": motion, **point}
            for point in _points(POINT, extent.record_points)
            for motion in records
        ],
    }
    inputs: dict[str, dict[str, object]] = {
        "free_response": {"releases": extent.releases, "spins": extent.spins},
        "peaks": {"intensities": extent.intensities},
        "slip": {"shares": extent.slip_shares},
        "rings": {"length": extent.ring_length},
        "records": {"time_step": extent.record_step},
    }
    return [
        (name, point, {**inputs.get(name, {}), "structure": structure})
        for name, every in points.items()
        for point in every
    ]


def _points(names: Sequence[str], points: Iterable[tuple[float | str, ...]]) -> list[Point]:
    return [dict(zip(names, point, strict=True)) for point in points]


def _grid(**axes: Iterable[float | str]) -> list[Point]:
    """Points of the Cartesian product of values, the last name varying fastest."""
    return _points(tuple(axes), itertools.product(*axes.values()))
