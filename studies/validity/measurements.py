"""The measurements: free response, peaks over records, agreement times, contact, recesses with clearance."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable, Sequence
from dataclasses import asdict, replace
from functools import partial

import numpy as np

from rockwobble import multibody, reduced
from rockwobble.compare.comparison.driver import comparison_row
from rockwobble.compare.metrics.pair import FloatArray, make_pair, tilt_rms
from rockwobble.compare.runs.execution import simulate_run
from rockwobble.models import Case, Cylinder, InitialState, Run, Trace
from rockwobble.models.case import RECESS_MODEL, REDUCED_MODELS
from rockwobble.models.support import FLAT, RECESS, RING, SUPPORTS, Support, support_named
from rockwobble.multibody import DEFAULT_ENGINE
from rockwobble.multibody.engines.registry import find_engine
from rockwobble.multibody.ring import clearance_needed, take_ring
from rockwobble.multibody.scene import REFERENCE_TIME_STEP
from rockwobble.reduced.body import body_of

from .plan import (
    ALONE,
    AMPLE,
    EL_CENTRO,
    LARGEST_PEAK,
    POINT,
    REFERENCE_SIZE,
    RELEASE,
    Extent,
    Inputs,
    Part,
    Row,
    Structure,
    grid,
    inputs_at,
    loss_of,
    modelled,
    motion_named,
    needs_of,
    record_names,
    release_case,
    shaken_case,
)

_FREE_RTOL = 1e-10
_CYCLES = 10.0  # over which the flat-ground model may gather tilt
_MAXIMUM = 1.0  # code of a maximum in the fourth column of `Trace.extrema`


def measure_free_response(
    tan_alpha: float, releases: Sequence[float], spins: Sequence[float], structure: Structure = ALONE
) -> list[Row]:
    """Return one row for each release and spin.

    The columns: tan_alpha, release, spin; period [s] and turn [rad] from tilt maximum to next maximum, exact
    (recess) and integrated (flat_period, flat_turn; NaN where it overturns first), flat_peak, the
    largest tilt of the flat-ground model in ten periods over the release, all three NaN with a tendon;
    `needs_of` the recess model in one period.
    """
    return [_release_row(tan_alpha, release, spin, structure) for release in releases for spin in spins]


def _release_row(tan_alpha: float, release: float, spin: float, structure: Structure) -> Row:
    case = release_case(tan_alpha, release, spin, structure=structure)
    assert case.initial is not None
    exact = reduced.free_response(case.cylinder, case.initial, tendon=case.tendon)
    period = turn = peak = math.nan
    if not case.anchor:  # the flat-ground model has no anchor
        flat = reduced.simulate(replace(case, duration=_CYCLES * exact.period), support=FLAT, rtol=_FREE_RTOL)
        (period, turn), peak = next_maximum(flat), flat.peak_tilt
    return {
        "release": release,
        "spin": spin,
        "period": exact.period,
        "flat_period": period,
        "turn": exact.angle_of_turn,
        "flat_turn": turn,
        "flat_peak": peak / case.initial.tilt,
        **needs_of(reduced.simulate(case, rtol=_FREE_RTOL)),
    }


def next_maximum(trace: Trace) -> tuple[float, float]:
    """Return time and rolling angle from the release, a tilt maximum, to the next; NaN if there is none."""
    maxima = trace.extrema[trace.extrema[:, 3] == _MAXIMUM]
    if len(maxima) < 2:
        return math.nan, math.nan
    return float(maxima[1, 0] - maxima[0, 0]), float(maxima[1, 2] - maxima[0, 2])


FREE_RESPONSE = Part(
    name="free_response",
    tasks=lambda extent: grid(tan_alpha=extent.tan_alphas, releases=[extent.releases], spins=[extent.spins]),
    measure=measure_free_response,
    keys=("tan_alpha",),
    cost=lambda releases, spins, **_: 0.02 * len(releases) * len(spins),
    engine="",
)


_VERIFIED_PERIODS = 2.2  # the second maximum, and a little more, so that it is seen to be one
_FRICTION = 10.0  # whatever the motion needs: friction is another limit


def measure_verification(
    tan_alpha: float, release: float, spin: float, structure: Structure = ALONE
) -> list[Row]:
    """Return a row for each support that has a model: the first pass by model and engine, and the tilts.

    The columns: tan_alpha, release, spin, support; turn, engine_turn [rad], half_period, engine_half_period
    [s] to the first tilt minimum; tilt_rms over alpha; resolved, whether the contact of the engine resolves
    the pass; outcome.
    """
    case = release_case(tan_alpha, release, spin, _VERIFIED_PERIODS, structure=structure)
    case = replace(case, friction=_FRICTION)
    rows: list[Row] = []
    for support in modelled(structure):
        trial = Run(DEFAULT_ENGINE, support)
        own = simulate_run(case, Run(None, trial.own_model.support, rtol=_FREE_RTOL))
        run = simulate_run(case, trial)
        none = {"time": math.nan, "angle_of_turn": math.nan, "resolved": False}
        first, own_first = (next(iter(each.passes.to_dict("records")), none) for each in (run, own))
        rows.append(
            {
                "support": support,
                "turn": next_maximum(own)[1],
                "engine_turn": first["angle_of_turn"],
                "half_period": own_first["time"],
                "engine_half_period": first["time"],
                "tilt_rms": tilt_rms(make_pair(case.cylinder, own, run)),
                "resolved": first["resolved"],
                "outcome": run.outcome,
            }
        )
    return rows


VERIFICATION = Part(
    name="verification",
    tasks=lambda extent: inputs_at(RELEASE, extent.engine_points),
    measure=measure_verification,
    keys=RELEASE,
    cost=lambda **_: 1.5,
)


_SLIP_PERIODS = 1.1  # one pass: the friction of the next is the same


def measure_slip(
    tan_alpha: float, release: float, spin: float, shares: Sequence[float], structure: Structure = ALONE
) -> list[Row]:
    """Return a row for each friction, as a share of what the recess model needs.

    The columns: tan_alpha, release, spin, needed, share, friction, slip of the engine in a recess in one
    period [b], tilt_rms against the recess model over alpha, outcome. No row where the model loses contact:
    no friction is enough.
    """
    period = release_case(tan_alpha, release, spin, structure=structure)
    needed = needs_of(reduced.simulate(period, rtol=_FREE_RTOL))["friction"]
    if not math.isfinite(needed):
        return []
    case = release_case(tan_alpha, release, spin, _SLIP_PERIODS, structure=structure)
    recess = reduced.simulate(case, rtol=_FREE_RTOL)
    rows: list[Row] = []
    for share in shares:
        run = multibody.simulate(replace(case, friction=share * needed))
        rows.append(
            {
                "needed": needed,
                "share": share,
                "friction": share * needed,
                "slip": float(run.slip[-1]) / case.cylinder.base_radius,
                "tilt_rms": tilt_rms(make_pair(case.cylinder, recess, run)),
                "outcome": run.outcome,
            }
        )
    return rows


SLIP = Part(
    name="slip",
    tasks=lambda extent: inputs_at(RELEASE, extent.slip_points, shares=extent.slip_shares),
    measure=measure_slip,
    keys=RELEASE,
    cost=lambda shares, **_: 0.5 * len(shares),
)


# the record of the perturbed copy is stronger by this: no record is known better, and no model can be asked
# for more than what it changes
COPY = 0.01
_RTOL = 1e-7


def _peaks_tasks(extent: Extent) -> Iterable[Inputs]:
    # El Centro besides, which has a vertical component
    for motion in [*record_names(extent.members), EL_CENTRO]:
        for tan_alpha in extent.shaken_tan_alphas:
            intensities = tuple(each for each in extent.intensities if each * tan_alpha <= LARGEST_PEAK)
            yield from grid(
                motion=[motion],
                tan_alpha=[tan_alpha],
                semidiagonal=extent.sizes,
                intensities=[intensities],
            )


def measure_peaks(
    motion: str,
    tan_alpha: float,
    semidiagonal: float,
    intensities: Sequence[float],
    structure: Structure = ALONE,
) -> list[Row]:
    """Return one row for each intensity.

    The columns: motion, tan_alpha, semidiagonal [m], intensity; peak tilt over alpha, pi/2 over alpha if
    overturned, of the recess model, of its perturbed copy under a record stronger by 1 %, of the flat-ground
    model (NaN with a tendon), and of the recess model with the vertical component (NaN where the record has
    none); `needs_of` the recess model.
    """
    shaken = partial(shaken_case, motion, tan_alpha, semidiagonal, structure=structure)
    vertical = motion_named(motion).has_vertical
    return [_row(shaken, intensity, vertical) for intensity in intensities]


def _row(shaken: Callable[..., Case], intensity: float, vertical: bool) -> Row:
    case, stronger = shaken(intensity), shaken(intensity * (1.0 + COPY))
    recess = reduced.simulate(case, rtol=_RTOL)
    found = {
        RECESS: recess,
        "copy": reduced.simulate(stronger, rtol=_RTOL),
    }
    if not case.anchor:
        found[FLAT] = reduced.simulate(case, support=FLAT, rtol=_RTOL)
    if vertical:
        found["vertical"] = reduced.simulate(shaken(intensity, vertical=True), rtol=_RTOL)
    return {
        "intensity": intensity,
        **dict.fromkeys((FLAT, "vertical"), math.nan),
        **{name: trace.peak_tilt / case.cylinder.alpha for name, trace in found.items()},
        **needs_of(recess),
    }


PEAKS = Part(
    name="peaks",
    tasks=_peaks_tasks,
    measure=measure_peaks,
    keys=("motion", "tan_alpha", "semidiagonal"),
    cost=lambda intensities, **_: 0.03 * len(intensities),
    engine="",
)


def _supports() -> list[Support]:
    """The supports that the engine of these measurements has."""
    known = find_engine(DEFAULT_ENGINE).supports
    return [support for support in SUPPORTS.values() if support in known]


PERTURBED = "perturbed copy"
HALVED = f"{RING}, half the step"


def measure_records(
    motion: str,
    tan_alpha: float,
    semidiagonal: float,
    intensity: float,
    time_step: float,
    structure: Structure = ALONE,
) -> list[Row]:
    """Return a row for each method.

    The columns: motion, tan_alpha, semidiagonal [m], intensity, method, peak over alpha, outcome;
    contact_time with walls [s] and loss, see `loss_of`. The methods: the reduced models (one with a tendon),
    the perturbed copy of the recess model under a record stronger by 1 %, the engine in a recess, on flat
    ground and, without a slab, in a ring, and this at half its step.
    """
    shaken = partial(shaken_case, motion, tan_alpha, semidiagonal, structure=structure)
    case, stronger = shaken(intensity), shaken(intensity * (1.0 + COPY))
    walls = structure.slab_mass_ratio == 0.0
    runs: dict[str, tuple[Case, Run]] = {
        **{str(model): (case, model) for model in REDUCED_MODELS if model.support in modelled(structure)},
        PERTURBED: (stronger, RECESS_MODEL),
        **{
            support: (case, Run(DEFAULT_ENGINE, support, time_step))
            for support in _supports()
            if walls or not support.walls
        },
    }
    if walls:
        runs[HALVED] = case, Run(DEFAULT_ENGINE, RING, 0.5 * time_step)
    rows: list[Row] = []
    for method, (problem, run) in runs.items():
        trace = simulate_run(problem, run)
        rows.append(
            {
                "method": method,
                "peak": trace.peak_tilt / case.cylinder.alpha,
                "outcome": trace.outcome,
                "contact_time": float(trace.wall_contact[-1]),
                "loss": loss_of(trace),
            }
        )
    return rows


RECORDS = Part(
    name="records",
    tasks=lambda extent: [
        {"motion": motion, **point}
        for point in inputs_at(POINT, extent.record_points, time_step=extent.record_step)
        for motion in record_names(extent.members)
    ],
    measure=measure_records,
    keys=("motion", *POINT),
    cost=lambda time_step, **_: 16.0 * 2e-4 / time_step,
)


_COLUMNS = (
    *("support", "reference_support", "outcome", "reference_outcome", "peak_tilt", "reference_peak_tilt"),
    *("tilt_rms", "tilt_rms_relative", "agreement_time", "predicted_agreement_time", "diverged"),
    *("agreed_passes", "residual_displacement", "residual_twist"),
)


def measure_record_agreement(
    tan_alpha: float,
    semidiagonal: float,
    intensity: float,
    support: str,
    duration: float,
    structure: Structure = ALONE,
) -> list[Row]:
    """Return the summary of a run of the engine against the recess and, on flat ground, the flat model.

    The columns are tan_alpha, semidiagonal, intensity, duration and those of `SUMMARY_COLUMNS`.
    """
    case = shaken_case(EL_CENTRO, tan_alpha, semidiagonal, intensity, duration=duration, structure=structure)
    run = Run(DEFAULT_ENGINE, support)
    models = {model: simulate_run(case, model) for model in (*run.compared_with, run.own_model)}
    trace = simulate_run(case, run)
    rows = [
        comparison_row(
            case,
            str(model),
            models[model],
            str(run),
            trace,
            own=models[run.own_model],
            simulate=simulate_run,
        )
        for model in run.compared_with
    ]
    return [{name: row[name] for name in _COLUMNS} for row in rows]


FOLLOWING = Part(
    name="following",
    tasks=lambda extent: [
        {**point, "support": support}
        for point in inputs_at(POINT, extent.trace_points, duration=extent.trace_length)
        for support in modelled(extent.structure)
    ],
    measure=measure_record_agreement,
    keys=(*POINT, "duration"),
    cost=lambda duration, **_: 0.04 * duration,
)


_RELEASE, _SPIN, _PASSES = 0.5, 0.1, 4
# over the acceleration at uplift; [s]
STRONG, _LENGTH = 2.0, 10.0


def measure_contact(
    tan_alpha: float, time_constant: float, damping: float, structure: Structure = ALONE
) -> list[Row]:
    """Return a row: what free response in a recess loses, and the peak tilt under El Centro.

    The columns: tan_alpha, time_constant [s] in which contact removes a normal velocity, damping ratio,
    softness, the time constant times the frequency parameter p; loss of energy per pass over the energy of
    the release, passes, peak and recess_peak under El Centro over alpha, free_outcome, outcome.
    """
    run = Run(DEFAULT_ENGINE, RECESS, contact_time_constant=time_constant, contact_damping_ratio=damping)
    release = release_case(tan_alpha, _RELEASE, _SPIN, _PASSES, structure=structure)
    free = simulate_run(release, run)
    case = shaken_case(
        EL_CENTRO,
        tan_alpha,
        REFERENCE_SIZE,
        STRONG * structure.uplift,
        duration=_LENGTH,
        structure=structure,
    )
    shaken = simulate_run(case, run)
    lost = -float(free.energy_error[-1]) / float(free.energy[0])
    return [
        {
            "softness": time_constant * body_of(case.cylinder, case.gravity).p,
            "loss": lost / max(len(free.passes), 1),
            "passes": len(free.passes),
            "peak": shaken.peak_tilt / case.cylinder.alpha,
            "recess_peak": reduced.simulate(case).peak_tilt / case.cylinder.alpha,
            "free_outcome": free.outcome,
            "outcome": shaken.outcome,
        }
    ]


CONTACT = Part(
    name="contact",
    tasks=lambda extent: grid(
        tan_alpha=extent.contact_tan_alphas, time_constant=extent.time_constants, damping=extent.dampings
    ),
    measure=measure_contact,
    keys=("tan_alpha", "time_constant", "damping"),
    cost=lambda **_: 1.0,
)


# over the acceleration at uplift: strong rocking without a fall
INTENSITY = 1.5
FREE, SHAKEN = "free response", EL_CENTRO
_WALLS = ("clearance", "inclination", "friction")


def _rings_tasks(extent: Extent) -> Iterable[Inputs]:
    none = dict.fromkeys(_WALLS, math.nan)
    supports: list[Inputs] = [
        {"support": support, **walls}
        for support in _supports()
        for walls in (map(asdict, extent.rings) if support.walls else [none])
    ]
    for problem in grid(
        tan_alpha=extent.ring_tan_alphas, turn=extent.ring_turns, length=[extent.ring_length]
    ):
        for support in supports:
            for motion in (FREE, SHAKEN):
                yield {"motion": motion, **problem, **support}


def measure_rings(
    motion: str,
    tan_alpha: float,
    turn: float,
    length: float,
    support: str,
    clearance: float,
    inclination: float,
    friction: float,
    structure: Structure = ALONE,
) -> list[Row]:
    """Return a row for free response or El Centro; none where the walls leave no room for the release.

    The columns: motion, tan_alpha, turn [rad], support, clearance [b], inclination [rad] (0 for alpha) and
    friction of the walls, those of `losses`; recess_peak, and halved_peak, that of the same ring at half the
    step [alpha].
    """
    walls: dict[str, float] = {}
    if support_named(support).walls:
        walls = {"ring_clearance": clearance, "ring_friction": friction}
        walls |= {"ring_inclination": inclination} if inclination > 0.0 else {}
    if motion == FREE:
        case = replace(release_of(tan_alpha, turn, length), tendon=structure.tendon)
    else:
        strong = INTENSITY * structure.uplift
        case = shaken_case(
            motion, tan_alpha, REFERENCE_SIZE, strong, duration=length, turn=turn, structure=structure
        )
    run, finer = (Run(DEFAULT_ENGINE, support, part * REFERENCE_TIME_STEP, **walls) for part in (1.0, 0.5))
    if not has_room(case, run):
        return []
    alpha = case.cylinder.alpha
    return [
        {
            **losses(simulate_run(case, run)),
            "recess_peak": reduced.simulate(case).peak_tilt / alpha,
            "halved_peak": simulate_run(case, finer).peak_tilt / alpha if walls else math.nan,
        }
    ]


def release_of(tan_alpha: float, turn: float, length: float) -> Case:
    """Return a release at alpha/2 in an azimuth [rad], of a duration [s]."""
    cylinder = Cylinder(semidiagonal=REFERENCE_SIZE, tan_alpha=tan_alpha)
    initial = InitialState(tilt=0.5 * cylinder.alpha, rolling_angle=turn, rolling_rate=0.5)
    return Case(cylinder, initial=initial, duration=length, friction=AMPLE, name=FREE)


def has_room(case: Case, run: Run) -> bool:
    """Return whether the release is outside of the walls."""
    _, ring = take_ring(run.settings, run.support, case.cylinder.tan_alpha)
    if ring is None or case.initial is None:
        return True
    return clearance_needed(case.cylinder, case.initial.tilt, ring.ring_inclination) <= ring.ring_clearance


def losses(trace: Trace) -> Row:
    """Return the losses of a run in a recess of any kind.

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
    """Distance from O of the place to which a cylinder would come down, while it is tilted [b].

    The contact point less a radius in the direction of the lean: in the recess model that is O.
    """
    radius = trace.case.cylinder.base_radius
    lean = np.column_stack([np.cos(trace.rolling_angle), np.sin(trace.rolling_angle)])
    place = trace.contact_point - radius * lean
    distance: FloatArray = np.hypot(place[:, 0], place[:, 1]) / radius
    return distance[np.isfinite(distance)]


RINGS = Part(
    name="rings",
    tasks=_rings_tasks,
    measure=measure_rings,
    keys=("motion", "tan_alpha", "turn", "support", *_WALLS),
    cost=lambda support, length, **_: (0.4 if support_named(support).walls else 0.125) * length,
    walls=True,
)
