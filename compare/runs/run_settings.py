"""Settings of runs: which there are, and runs with others."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

from rockwobble.models import Case, InitialState, Run
from rockwobble.models.case import TimeStep
from rockwobble.multibody.simulation import STEP_SETTINGS, resolved_settings

_LEAN = 1e-3  # of alpha: a tilt that fits into any ring


def with_settings(case: Case, runs: Sequence[Run], settings: Mapping[str, object]) -> tuple[Run, ...]:
    """Return the runs with more settings, each where the run has one of that name.

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
    """Return the run at another time step, without the settings of the way to its own.

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
    # from a release that every engine and every ring can start: what is to be set may be what the case needs
    start = Case(
        case.cylinder, initial=InitialState(_LEAN * case.cylinder.alpha), duration=1.0, name=case.name
    )
    if run.engine is None:
        return ("plane", "restitution", "rtol", "rest_tilt")
    return (*resolved_settings(start, run.engine, run.support, {}), *step_settings(run))


def step_settings(run: Run) -> tuple[str, ...]:
    """Return the settings of the way to a time step that the run takes."""
    return tuple(name for name, way in STEP_SETTINGS.items() if way == run.time_step)
