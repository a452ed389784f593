"""One run of an engine, from a case by way of its scene to a trace."""

from __future__ import annotations

import contextlib
import math
import time as clock
from collections.abc import Iterator, Mapping
from dataclasses import replace
from functools import partial
from typing import Any

import numpy as np

from rockwobble.models import Case, Diagnostic, InitialState, Run, Trace
from rockwobble.models.bounds import OVERTURNED_TILT
from rockwobble.models.case import TimeStep
from rockwobble.models.mode import SLIDES, expected_mode
from rockwobble.models.number_checks import require_positive, require_sample_step
from rockwobble.models.support import RECESS, support_named
from rockwobble.models.trace import NO_PEAK
from rockwobble.models.trace_file import EagerSource, pass_table

from .auto_step import AUTO, STEP_TOLERANCE, Progress, find_step
from .engines.registry import DEFAULT_ENGINE, EngineNotInstalledError, engine_fault, engine_for
from .excitation import StepMeans
from .extrapolated_step import EXTRAPOLATED, FINEST, extrapolate, require_finest
from .guard import check_time_step
from .modes import compare_impacts, mode_facts
from .passes import STEPS_OF_A_PASS, TurningPoint, filter_noise_swings, negligible_uplifts, passes_between
from .protocol import Engine, Settings, Stepper
from .reaction import EARLY
from .recorder import COLUMNS, Recorder
from .restraint import scaled_restraint
from .scene import (
    REFERENCE_GRAVITY,
    Array,
    Scale,
    Scene,
    default_step,
    froude_scale,
    scaled_body,
    starting_state,
)
from .stepping import run_steps

STEP_SETTINGS = {"step_tolerance": AUTO, "finest_step": EXTRAPOLATED}  # settings of the choice of a step
_SWING = 1e-9  # [rad] least difference of two turning points above rounding


def simulate(
    case: Case,
    *,
    engine: str = DEFAULT_ENGINE,
    support: str = RECESS,
    time_step: TimeStep = None,
    sample_step: float = 0.01,
    progress: Progress | None = None,
    **settings: object,
) -> Trace:
    """Run a rigid cylinder on rigid ground in a physics engine.

    Parameters
    ----------
    case : Case
        Cylinder, ground motion, initial state, length, gravity, and the Coulomb coefficient of the pair
        cylinder and ground.
    engine : str
        One of `engine_names()`; `available_engines()` are installed. Exudyn is an ideal rim: flat
        ground, from a release only. Rapier computes in single precision.
    support : {"recess", "flat", "ring"}
        The ideal recess, which holds the twist at zero; flat ground; or a recess of inclined walls with
        clearance, which MuJoCo has.
    time_step : float, "auto" or "extrapolated", optional
        [s]; default 1e-4 s at a semidiagonal of 6 m and a gravity of 9.81 m/s^2, and so in proportion to
        sqrt(semidiagonal/gravity): accuracy does not depend on size. "auto" halves the step, from four
        times the default, until the tilt has settled within `step_tolerance`, another keyword, of alpha
        (default 1e-3), and says what error is left: see `auto_step`. "extrapolated" runs at three
        steps, down to `finest_step` [s], another keyword (default: 1.75 times the default step, so
        that it costs as much as one run at that), and gives what
        they tend to, as far as they agree: see `extrapolated_step`.
    sample_step : float
        Sample step of the result [s]; at most 10 million samples.
    progress : callable, optional
        Called now and then with the fraction done.
    **settings
        Of the engine, as those of MuJoCo in `MujocoSettings`; of a recess with clearance: see `RingSettings`.

    Returns
    -------
    Trace
        A numerical failure is an outcome with its diagnostics, not an exception. A run that ends while the
        cylinder moves is followed over still ground to the next maximum of the tilt, which counts for the
        peak; one that overturns ends there, later than asked for.
        The contact force is a mean over 65 steps (a Hann window about the sample), from the change of the
        engine's velocity: in a single step contact may be lost or carry twice the load.

    Raises
    ------
    ValueError
        If an argument or a setting is out of range, the engine or the support is unknown, the engine is
        not installed, or the time step is too large for contact.

    Examples
    --------
    >>> from rockwobble.models import Case, Cylinder, InitialState
    >>> pier = Cylinder(semidiagonal=6.0, tan_alpha=0.2)
    >>> release = InitialState(tilt=pier.alpha / 2, rolling_rate=0.5)
    >>> run = simulate(Case(pier, initial=release, duration=1.0))
    >>> run.outcome, len(run.time)
    ('stands', 101)
    """
    run = Run(engine, support, time_step, **settings)
    unit_time = froude_scale(case.cylinder.semidiagonal, case.gravity).time

    def attempt(step: float, tell: Progress | None) -> Trace:
        return _simulate(case, run, step, sample_step, tell, settings)

    if time_step == AUTO:
        given = settings.pop("step_tolerance", STEP_TOLERANCE)
        tolerance = require_positive("step_tolerance", given, "of alpha")
        return find_step(attempt, unit_time, case.cylinder.alpha, tolerance, progress)
    if time_step == EXTRAPOLATED:
        finest = require_positive("finest_step", settings.pop("finest_step", FINEST * unit_time), "s")
        require_finest(finest, unit_time)
        return extrapolate(attempt, finest, case.cylinder.alpha, progress)
    for name, way in STEP_SETTINGS.items():
        if name in settings:
            raise ValueError(f'{name} goes with time_step="{way}", got time_step={time_step!r}')
    if time_step is None:
        time_step = default_step(case.cylinder.semidiagonal, case.gravity)
    return attempt(float(time_step), progress)


def _simulate(
    case: Case,
    run: Run,
    step: float,
    sample_step: float,
    progress: Progress | None,
    settings: Settings,
) -> Trace:
    """Run with one time step [s]."""
    engine_fault(run.engine_name)  # loaded here, so that the time of a run is that of a warm engine
    started = clock.perf_counter()
    scale = froude_scale(case.cylinder.semidiagonal, case.gravity)
    backend, scene, resolved = _statement(case, run.engine_name, run.support, settings, step)
    samples = _sample_times(case.length, require_sample_step(sample_step, case.length)) / scale.time
    release = InitialState(0.0) if case.initial is None else case.initial
    recorder = Recorder(
        scene,
        samples,
        release.rolling_angle,
        release.tilt_rate == 0.0,
        backend.facts.rounding,
        joined=not backend.uplifts,
    )
    means = StepMeans(case.motion, scale, scene.time_step)
    try:
        recorder = run_steps(backend, scene, resolved, recorder, means, sample_step / scale.time, progress)
    except ImportError as error:
        reason = " ".join(str(error).split())
        raise EngineNotInstalledError(
            f"engine {run.engine!r} is installed and does not load: {reason}"
        ) from error
    trace = _trace(
        recorder,
        scene,
        scale,
        case=case,
        run=run,
        version=backend.version(),
        time_step=step,
        settings=dict(resolved),
        wall_time=clock.perf_counter() - started,
    )
    facts = tuple(mode_facts(trace))
    return replace(trace, facts=trace.facts + facts) if facts else compare_impacts(trace)


def _trace(recorder: Recorder, scene: Scene, scale: Scale, **method: Any) -> Trace:
    rows = _rows_to_end(recorder)
    kept = (rows[:, 0] != recorder.asked) | (not recorder.off_grid)
    forces, rows = recorder.forces.at(rows[:, 0])[kept], rows[kept]
    outcome = recorder.ended or ("undecided" if recorder.undecided else "stands")
    table = dict(zip(("time", *COLUMNS), rows.T, strict=True))
    uplift_time, uplift_direction = recorder.uplift or (math.nan, math.nan)
    contact = np.column_stack([table["contact_x"], table["contact_y"]])
    resting = ~(table["time"] >= uplift_time) | ~(table["tilt"] > recorder.floor)
    for field in (table["rolling_angle"], contact):
        field[resting] = np.nan
    resolution = max(
        recorder.penetration / (1.5 * scene.body.base_radius),
        STEPS_OF_A_PASS * recorder.fastest * scene.time_step,
    )
    passes = _passes(recorder, scale)
    sampled = {
        "rolling_rate": np.where(resting, 0.0, table["rolling_rate"] / scale.time),
        "contact_force": forces,
        "energy": table["energy"] * scale.energy,
        "energy_error": table["energy_error"] * scale.energy,
        "slip": table["slip"] * scale.length,
        "wall_contact": table["wall_contact"] * scale.time,
        "wall_impulse": table["wall_impulse"] * scale.length / scale.time,
    }
    if scene.restraint.is_active and not scene.support.guided:
        # the base moves off its anchor, so the tilt alone does not give the elongation
        sampled["elongation"] = table["elongation"] * scale.length
    if scene.rolling_resistance > 0.0:
        sampled["energy_lost"] = table["energy_lost"] * scale.energy
    return Trace(
        time=table["time"] * scale.time,
        tilt=table["tilt"],
        tilt_rate=table["tilt_rate"] / scale.time,
        rolling_angle=table["rolling_angle"],
        twist=table["twist"],
        contact_point=contact * scale.length,
        centre_of_mass=np.column_stack([table["x"], table["y"], table["z"]]) * scale.length,
        peak_tilt=_peak(recorder, outcome, rows),
        outcome=outcome,
        rests=outcome == "stands" and recorder.resting,
        followed_until=recorder.followed_until * scale.time,
        uplift_time=uplift_time * scale.time,
        uplift_direction=uplift_direction,
        source=EagerSource(sampled),
        # as a table when it is asked for: the process of an engine need not load pandas
        passes=partial(pass_table, passes, passes["minimum_tilt"] > resolution),
        facts=(
            *diagnostics(recorder, passes, resolution, scale.time),
            *_facts_of_terms(method["case"], recorder, scale),
        ),
        rest_intervals=np.array(recorder.rests.after_motion(), dtype=float).reshape(-1, 2) * scale.time,
        extrema=_extrema(recorder, scene, scale),
        contact_resolution=resolution,
        **method,
    )


def _facts_of_terms(case: Case, recorder: Recorder, scale: Scale) -> Iterator[Diagnostic]:
    """Diagnostics of a tendon beyond its yield force, also after the end, and of columns left out."""
    tendon = case.tendon
    if tendon is not None and tendon.yield_force is not None and not math.isnan(recorder.yield_time):
        elongation = recorder.elongation * scale.length
        size = tendon.prestress + tendon.stiffness * elongation / case.cylinder.base_radius
        time = recorder.yield_time * scale.time
        yield Diagnostic(code="tendon_yield", time=time, size=size, bound=tendon.yield_force)
    columns = case.cylinder.columns if case.cylinder.slab_mass_ratio else 1
    if columns > 1:  # one column stands for all
        yield Diagnostic(code="one_column", size=columns)


def _extrema(recorder: Recorder, scene: Scene, scale: Scale) -> Array:
    """Turning points (k, 4): time [s], tilt, rolling angle [rad], 1 for a maximum and -1 for a minimum."""
    points = filter_noise_swings([point for point in recorder.points if point.time <= recorder.end], _SWING)
    if scene.start.standing and points and not points[0].is_maximum:
        del points[0]  # the uplift is no turning point of a standing cylinder
    rows = [
        (point.time * scale.time, point.tilt, point.rolling_angle, 1.0 if point.is_maximum else -1.0)
        for point in points
    ]
    return np.array(rows, dtype=float).reshape(-1, 4)


def _rows_to_end(recorder: Recorder) -> Array:
    """Samples of the run; one that ended early gets its end as the last sample."""
    rows = recorder.table
    if not recorder.ended:
        return rows
    last = recorder.last_row.copy()
    if recorder.ended == "overturned":
        last[0], last[1] = recorder.end_time, OVERTURNED_TILT
    rows = rows[rows[:, 0] < last[0]]
    return np.vstack([rows, last])


def _peak(recorder: Recorder, outcome: str, rows: Array) -> float:
    if outcome in NO_PEAK:
        return math.nan
    if outcome == "overturned":
        return OVERTURNED_TILT
    maxima = [point.tilt for point in recorder.points if point.is_maximum and point.time <= recorder.end]
    # a tilt that still grows at the end is largest in its last sample
    return max([recorder.peak, float(rows[-1, 1]), *maxima])


def _passes(recorder: Recorder, scale: Scale) -> dict[str, Array]:
    start = recorder.uplift[0] if recorder.uplift is not None else math.inf
    points = [point for point in recorder.points if start <= point.time <= recorder.end]
    passes = passes_between(points, _SWING, recorder.rests.rests())
    return passes | {"time": passes["time"] * scale.time}


def _sample_times(end: float, sample_step: float) -> Array:
    """Multiples of the sample step, and the exact end."""
    times: Array = sample_step * np.arange(math.floor(end / sample_step + 1e-9) + 1, dtype=float)
    return times if math.isclose(times[-1], end, rel_tol=1e-9) else np.append(times, end)


def resolved_settings(
    case: Case, engine: str, support: str, settings: Settings, time_step: float | None = None
) -> Mapping[str, object]:
    """Return every setting with which `simulate` would run a case, without running it.

    Raises
    ------
    ValueError
        If the engine is unknown, cannot run the case, the time step is out of range, or a setting is
        unknown or out of range.
    """
    return _statement(case, engine, support, settings, time_step)[-1]


@contextlib.contextmanager
def open_scene(case: Case, engine: str, support: str, settings: Settings) -> Iterator[Stepper]:
    """Open the scene of a case as `simulate` does at its default step, for a caller that steps it alone.

    Parameters
    ----------
    case : Case
    engine, support : str
    settings : mapping
        Of the engine.

    Returns
    -------
    context manager of Stepper
        With whatever members its engine adds.

    Raises
    ------
    ValueError
        As `simulate` does.
    """
    backend, scene, resolved = _statement(case, engine, support, settings)
    with backend.open(scene, resolved) as stepper:
        yield stepper


def _statement(
    case: Case, engine: str, support: str, settings: Settings, time_step: float | None = None
) -> tuple[Engine, Scene, Mapping[str, object]]:
    """Return the engine, the scene of a case at the reference size, and every setting."""
    backend = engine_for(case, engine, support)
    size = case.cylinder.semidiagonal, case.gravity
    scale = froude_scale(*size)
    step = default_step(*size) if time_step is None else time_step
    check_time_step(step, scale.time)
    body, motion = scaled_body(case.cylinder, scale.length), case.motion
    scene = Scene(
        body=body,
        start=starting_state(body, case.initial, scale.time),
        support=support_named(support),
        friction=case.friction,
        time_step=step / scale.time,
        gravity=REFERENCE_GRAVITY,
        components="" if motion is None else "xyz" if motion.has_vertical else "xy",
        unit_time=scale.time,
        rolling_resistance=case.rolling_resistance / scale.length,
        restraint=scaled_restraint(case, body.base_radius, REFERENCE_GRAVITY, backend.facts.rounding),
        mode=expected_mode(case, support),
    )
    return backend, scene, backend.settings(settings, scene)


def diagnostics(
    recorder: Recorder, passes: Mapping[str, Array], resolution: float, unit_time: float
) -> Iterator[Diagnostic]:
    """Yield the diagnostics of a run, its failure first.

    `passes` and `resolution` [rad] are those of the trace, in the time of the user; `unit_time` is one second
    of the scene there [s]. How the side comes down in a fall that is followed beyond the end asked for
    limits nothing: what happens there is not said.
    """
    end = recorder.asked
    if recorder.ended == "failed":
        yield Diagnostic(
            code=recorder.failure, time=recorder.end_time * unit_time, detail="; ".join(recorder.warnings)
        )
    # an event that never happened has the time NaN, which is never before the end; a slide must slip, and
    # friction takes its energy
    slides = recorder.mode == SLIDES
    for code, time in (
        ("slip", math.nan if slides else recorder.slip_time),
        ("tension", recorder.pull_time),
        ("friction_needed", recorder.grip_time),
        ("lift_off", recorder.flight_time),
        ("wall_contact", recorder.walls.first),
    ):
        if time <= end:
            yield Diagnostic(code=code, time=time * unit_time)
    since, share, bound = recorder.energy.remark(end)
    if not math.isnan(since) and not slides:
        yield Diagnostic(code="energy", time=since * unit_time, size=share, bound=bound)
        rolled = recorder.last_value("energy_lost") / recorder.energy.largest
        if rolled > 0.0:
            yield Diagnostic(code="rolling_loss", size=rolled)
    if recorder.undecided:
        yield Diagnostic(code="undecided", time=end * unit_time)
    if recorder.unsolved:
        yield Diagnostic(code="solver", size=recorder.unsolved, bound=recorder.looks)
    if slides:  # a slide never uplifts; where contact trembles, its mode says so
        return
    if recorder.uplift is not None and recorder.missing_load > EARLY:
        yield Diagnostic(
            code="early_uplift", time=recorder.uplift[0] * unit_time, size=recorder.missing_load, bound=EARLY
        )
    close = passes["time"][passes["minimum_tilt"] <= resolution]
    if recorder.uplift is not None and not recorder.energy.moves:
        # a base that closed again before it had moved: a pass through upright with no motion after it
        yield Diagnostic(
            code="unresolved_pass", time=recorder.uplift[0] * unit_time, size=1, bound=resolution
        )
        return
    # a tilt that only grows has no turning point before the last step
    last = TurningPoint(float(recorder.last_row[0]), recorder.last_value("tilt"), 0.0, is_maximum=True)
    faint = negligible_uplifts([*recorder.points, last], resolution, recorder.rests.rests())
    if unresolved := sorted([*close.tolist(), *(unit_time * opened for opened in faint)]):
        yield Diagnostic(code="unresolved_pass", time=unresolved[0], size=len(unresolved), bound=resolution)
