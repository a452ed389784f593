"""Choice of the runs of a comparison: defaults, references, settings, and distinct labels."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import NamedTuple

from rockwobble.models import Case, InitialState, Run
from rockwobble.models.case import REDUCED_MODELS, TimeStep
from rockwobble.models.mode import plane_of
from rockwobble.models.support import MODELLED, RECESS, SUPPORTS
from rockwobble.multibody import BrokenEngineError, EngineNotInstalledError, available_engines
from rockwobble.multibody.engines.registry import (
    engine_fault,
    engine_named,
    engine_packages,
    find_engine,
    stand_in,
    standard_engines,
)
from rockwobble.multibody.scene import default_step
from rockwobble.multibody.simulation import STEP_SETTINGS, resolved_settings

_LEAN = 1e-3  # tilt over alpha that fits into any ring


def with_settings(case: Case, runs: Sequence[Run], settings: Mapping[str, object]) -> tuple[Run, ...]:
    """Runs with more settings, each where the run has a setting of that name.

    Parameters
    ----------
    case : Case
    runs : sequence of Run
    settings : mapping

    Returns
    -------
    tuple of Run

    Raises
    ------
    ValueError
        If no run has a setting of that name, with those that there are.

    Examples
    --------
    >>> import rockwobble as rw
    >>> pier = rw.Cylinder(semidiagonal=6.0, tan_alpha=0.2)
    >>> release = rw.InitialState(0.5 * pier.alpha, rolling_rate=0.5)
    >>> case = rw.Case(pier, initial=release, duration=4.0)
    >>> with_settings(case, [Run("mujoco", "recess"), Run(None, "recess")], {"iterations": 50})
    (Run('mujoco', 'recess', iterations=50), Run(None, 'recess'))
    """
    known = [_setting_names(case, run) for run in runs]
    for name in settings:
        if not any(name in names for names in known):
            allowed = dict.fromkeys(each for names in known for each in names)
            raise ValueError(f"no run has a setting {name!r}; there are {', '.join(allowed)}")
    return tuple(
        Run(
            run.engine,
            run.support,
            run.time_step,
            **{**run.settings, **{name: value for name, value in settings.items() if name in names}},
        )
        for run, names in zip(runs, known, strict=True)
    )


def at_step(run: Run, step: TimeStep) -> Run:
    """Run at another time step, without the settings of its search for one.

    Parameters
    ----------
    run : Run
    step : float or str or None
        In seconds, or a way to a step, whose settings stay.

    Returns
    -------
    Run

    Examples
    --------
    >>> at_step(Run("mujoco", "recess", "extrapolated", finest_step=1e-4, iterations=50), 2e-4)
    Run('mujoco', 'recess', time_step=0.0002, iterations=50)
    """
    kept = {name: value for name, value in run.settings.items() if STEP_SETTINGS.get(name, step) == step}
    return Run(run.engine, run.support, step, **kept)


def _setting_names(case: Case, run: Run) -> tuple[str, ...]:
    # try a release that every engine and ring can start, as the settings may depend on the case
    start = Case(
        case.cylinder, initial=InitialState(_LEAN * case.cylinder.alpha), duration=1.0, name=case.name
    )
    if run.is_model:
        return ("plane", "restitution", "rtol", "rest_tilt")
    return (*resolved_settings(start, run.engine_name, run.support, {}), *step_settings(run))


def step_settings(run: Run) -> tuple[str, ...]:
    """Settings of the search for the time step of a run."""
    return tuple(name for name, way in STEP_SETTINGS.items() if way == run.time_step)


class Compared(NamedTuple):
    """One run of a case, with its references.

    Attributes
    ----------
    case : Case
    label : str
    run : Run
    own : Run
        The reduced model that an exact engine would follow.
    references : mapping of str to Run
        By label.
    """

    case: Case
    label: str
    run: Run
    own: Run
    references: Mapping[str, Run]


def compared_runs(cases: Sequence[Case], runs: Sequence[Run], reference: Run | None) -> list[Compared]:
    """Each run of each case, compared with `reference` or with the references of its support."""
    labels, named = labels_beside_references(runs, reference)
    return [
        Compared(case, label, run, own_model_of(case, run), references_of(case, run, label, reference, named))
        for case in cases
        for label, run in zip(labels, runs, strict=True)
    ]


def labels_beside_references(runs: Sequence[Run], reference: Run | None) -> tuple[tuple[str, ...], str]:
    """Labels of each run and of the reference, all different and none equal to that of another model.

    A reduced model at its defaults keeps its name.
    """
    run_labels(runs)  # all different
    others: list[Run] = []
    for each in (*REDUCED_MODELS, *(() if reference is None else (reference,))):
        if each not in (*runs, *others):
            others.append(each)
    labels = run_labels((*runs, *others))
    named = "" if reference is None else labels[[*runs, *others].index(reference)]
    return labels[: len(runs)], named


def run_labels(runs: Sequence[Run]) -> tuple[str, ...]:
    """Label for each run: engine and support, and as many settings as distinguish the runs."""
    labels = [str(run) for run in runs]
    steps = [
        f"{run.time_step:g} s" if isinstance(run.time_step, float) else run.time_step or "" for run in runs
    ]
    settings = [" ".join(f"{key}={value}" for key, value in run.settings.items()) for run in runs]
    for details in (steps, settings):
        labels = [
            f"{label} {detail}".rstrip() if labels.count(label) > 1 else label
            for label, detail in zip(labels, details, strict=True)
        ]
    for label in labels:
        if labels.count(label) > 1:
            raise ValueError(f"the runs of a comparison must differ, got {label!r} twice")
    return tuple(labels)


def missing_engines() -> tuple[str, ...]:
    """Standard engines that do not run in this installation.

    Returns
    -------
    tuple of str
    """
    return tuple(name for name in standard_engines() if engine_fault(name))


def left_out(name: str) -> str:
    """Line on a standard engine that does not run here."""
    return f"{name} {engine_fault(name)}; it is left out"


def runs_here(runs: Sequence[Run], named: Sequence[str] = ()) -> tuple[list[Run], list[str]]:
    """Runs of a suite that this installation can make, and a line on each missing engine.

    Where an engine has no wheel, another takes its place as in a default run. One that every installation is
    meant to have is left out where it is missing or does not load; others, and those that are named, stay,
    and are refused.

    Parameters
    ----------
    runs : sequence of Run
    named : sequence of str
        Engines that the user asked for by name.

    Returns
    -------
    tuple
        The runs, a list of Run, and the lines, a list of str.
    """
    possible, said = list[Run](), dict[str, str]()
    for run in runs:
        name, other = run.engine, None
        if name is not None and name not in named and engine_fault(name):
            other = stand_in(name)
            if other is not None and not engine_fault(other) and run.support in find_engine(other).supports:
                run = Run(other, run.support, run.time_step)
                said.setdefault(name, f"{name} has no wheel here, {other} takes its place")
            elif other is not None or name in standard_engines():
                said.setdefault(name, left_out(name))
                continue
        if run not in possible:
            possible.append(run)
    return possible, list(said.values())


def reserved_engines() -> dict[str, str]:
    """Installed engines that a default run leaves out, with the reason.

    A default run takes the engines that serve any case: those with each support and with uplift. The
    others run where they are named, as do those of ours that are an extra.

    Returns
    -------
    dict
        Reason by name of the engine.
    """
    reasons = {name: _reservation(name) for name in available_engines()}
    return {name: reason for name, reason in reasons.items() if reason}


def _reservation(name: str) -> str:
    try:
        engine = engine_named(name)
    except BrokenEngineError as error:
        # a broken engine of another package is skipped
        return str(error)
    lacks = [f"no {support} support" for support in MODELLED if support not in engine.supports]
    lacks += [] if engine.uplifts else ["no uplift"]
    if lacks:
        return f"{name} has {' and '.join(lacks)}"
    if name in engine_packages() and name not in standard_engines():
        return f"{name} is an extra"
    fault = engine_fault(name)
    return f"{name} {fault}" if fault else ""


def require_runnable(case: Case, run: Run) -> None:
    """Check engine, support, time step and settings of a run before any other run starts.

    Parameters
    ----------
    case : Case
    run : Run

    Raises
    ------
    ValueError
        If the engine is unknown, not installed or does not load, does not have the support or cannot start
        the case, the time step is too large for contact, or a setting is unknown or out of range.
    """
    if run.is_model:
        # loads the compiler, which an import alone does not need
        from rockwobble.reduced.problem import Problem

        Problem(case, **run.settings, support=run.support)
        return
    step = None if isinstance(run.time_step, str) else run.time_step
    settings = {name: value for name, value in run.settings.items() if name not in step_settings(run)}
    resolved_settings(case, run.engine_name, run.support, settings, step)


def default_runs(
    engines: Sequence[str] | None = None,
    supports: Sequence[str] | None = None,
    *,
    cases: Sequence[Case] = (),
) -> tuple[Run, ...]:
    """Every engine that serves any case with each support, those in a recess first.

    Engines that are named run whatever they can do: with the supports that they have where none is named.
    Where only supports are named, each gets the engines that have it, or all if none has, which will say so.

    Parameters
    ----------
    engines : sequence of str, optional
    supports : sequence of str, optional
        "recess", "flat" and "ring".
    cases : sequence of Case, optional
        What is to be run: of cases with an anchor, such as a tendon, flat ground is left out where no
        support is named.

    Returns
    -------
    tuple of Run

    Examples
    --------
    >>> default_runs(["mujoco"])
    (Run('mujoco', 'recess'), Run('mujoco', 'flat'))
    """
    if engines is not None and supports is not None:
        return tuple(Run(engine, support) for support in supports for engine in engines)
    unnamed = engines is None
    if engines is None:
        reserved = reserved_engines()
        engines = [name for name in available_engines() if name not in reserved]
    runs = []
    tied = any(case.anchor for case in cases)
    usual = [each for each in MODELLED if each.guided or not tied]
    for support in MODELLED if supports is None else supports:
        able = [engine for engine in engines if support in find_engine(engine).supports]
        if supports is None and support not in usual:
            # a named engine with no other support is refused, not left out
            others = [] if unnamed else able
            able = [engine for engine in others if not set(usual) & set(find_engine(engine).supports)]
        if unnamed and supports is not None and not able:
            for name in missing_engines():
                if support in engine_named(name).supports:
                    find_engine(name)  # refuses it with the missing package
        runs += [Run(engine, support) for engine in able or (engines if supports is not None else ())]
    return tuple(runs)


def all_runs(cases: Sequence[Case], supports: Sequence[str] | None = None) -> tuple[Run, ...]:
    """Every installed engine that can start all cases, with each of its supports.

    Raises
    ------
    ValueError
        If there is none.
    """
    engines = [name for name in available_engines() if not _unable(name, cases)]
    asked = default_runs(engines, supports or MODELLED)
    runs = [run for run in asked if run.support in find_engine(run.engine_name).supports]
    if not runs:
        raise ValueError(
            f"no installed engine has the support {' or '.join(supports or MODELLED)} for this case"
        )
    return tuple(runs)


def unable_engines(cases: Sequence[Case]) -> tuple[str, ...]:
    """Reasons why installed engines cannot run these cases, one sentence for each."""
    return tuple(filter(None, (_unable(name, cases) for name in available_engines())))


def _unable(name: str, cases: Sequence[Case]) -> str:
    try:
        engine = find_engine(name)
    except (BrokenEngineError, EngineNotInstalledError) as error:
        return f"{error}; it is left out"
    if engine.uplifts or all(case.is_release for case in cases):
        return ""
    return f"{name} cannot uplift a cylinder that stands and is left out"


def omissions(supports: Sequence[str]) -> tuple[str, ...]:
    """Reasons why a default run with these supports leaves out installed engines, one sentence for each."""
    reserved = reserved_engines()
    names = [name for name in available_engines() if name not in reserved]
    lacks = [
        (name, support) for support in supports for name in names if support not in find_engine(name).supports
    ]
    return tuple(f"{name} has no {support} support and is left out there" for name, support in lacks)


def references_of(
    case: Case, run: Run, label: str, reference: Run | None = None, named: str = ""
) -> dict[str, Run]:
    """References of a run, by label: `reference`, or those of its support.

    The reference is called `named`, by default as it calls itself.

    A run is compared with the models of `models_of`; one between walls also with itself at half its
    step, or, where that is sought, at half the default step.
    """
    chosen = {str(model): model for model in models_of(case, run)}
    if reference is not None:
        chosen = {named or str(reference): reference}
    elif run.support.walls:
        # the step of a run with an automatic step is unknown beforehand
        half = "half the default step" if isinstance(run.time_step, str) else "half the step"
        default = default_step(case.cylinder.semidiagonal, case.gravity)
        step = run.time_step if isinstance(run.time_step, float) else default
        chosen[f"{label}, {half}"] = at_step(run, 0.5 * step)
    return {name: other for name, other in chosen.items() if other != run}


def models_of(case: Case, run: Run) -> tuple[Run, ...]:
    """Reduced models with which a run of a case is compared; the last is the nearest to it.

    Those that its support names. From rest in one plane an engine's base closes with an impact: the planar
    model takes it by the moment of momentum. What friction lets slide on flat ground is compared with the
    model of that support alone.
    """
    if not run.is_model and run.support in SUPPORTS:
        plane = plane_of(case)
        if run.support.lets_slide and not case.is_release and case.friction < case.friction_of_uplift:
            return run.compared_with[-1:]
        if plane is not None and case.uplifts and not case.is_release:
            return (Run(None, RECESS, plane=plane, restitution="momentum"),)
    return run.compared_with


def own_model_of(case: Case, run: Run) -> Run:
    """Reduced model that an exact engine would follow in this run."""
    nearest = models_of(case, run)[-1]
    return nearest if nearest.is_planar and not run.is_model else run.own_model
