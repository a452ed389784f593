"""Subjects of the checks: a reduced model, an engine, another model, or files of trajectories."""

from __future__ import annotations

import importlib
import sys
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from pathlib import Path
from types import ModuleType

import numpy as np

from rockwobble import reduced
from rockwobble.models import Case, Run, Trace
from rockwobble.models.case import TimeStep
from rockwobble.models.number_checks import require_in_range
from rockwobble.models.shown import CompactRepr
from rockwobble.models.support import MODELLED, RECESS
from rockwobble.multibody.engines.registry import engine_facts, find_engine
from rockwobble.reduced.restoring import TERMS

from ..external.trajectory import measurement
from ..runs.execution import SAMPLE_STEP, simulate_run
from ..storage.provenance import fingerprint
from .measurement import RELEASE, Bound, trace_of

Simulate = Callable[..., Trace]

FIELDS = frozenset(
    {"tilt", "tilt_rate", "rolling_angle", "rolling_rate", "twist", "contact_point", "centre_of_mass"}
    | {"energy", "contact_force", "extrema", "passes", "peak_tilt", "outcome", "uplift_time"}
)
_ENGINE_FIELDS = ("slip", "contact_offset", "energy_error", "residual_displacement")
# relative: error of the reduced models at rtol 1e-11, magnified by passes; 1e-12 to 3e-11 was measured
MODEL_TOLERANCE, _MODEL_RTOL = 1e-10, 1e-11
# relative to alpha: contact at the default step; a tenth to a half of it was measured with all engines
ENGINE_TOLERANCE = 1e-5
# rounding errors within the tolerance: thousands of steps add them up in part
_ROUNDINGS = 1e4
# tolerance for the same motion, rotated or mirrored: solvers stop at a tolerance, and passes magnify the
# error
ENGINE_REPEATABILITY = 1e-5
# features of a subject: an independent model as its reference, trajectories of files alone, starts from a
# standing cylinder, wobbling frames
REFERENCE, FILES, UPLIFT, SLAB = "reference", "files", "uplift", "slab"
TOLERANCE = 1e-3  # default for an external model or trajectory


@dataclass(frozen=True, slots=True, kw_only=True, repr=False)
class Subject(CompactRepr):
    """One source of motions, in the form that every check takes.

    Parameters
    ----------
    label : str
    source : callable
        Returns the `Trace` of a case and a support, with `sample_step` and what `options` names.
    supports : tuple of str
        "recess", "flat", "ring" and, of the reduced models, "planar".
    knows : frozenset of str
        Fields of a trace that it fills.
    features : frozenset of str
        Further options of `source`, terms of a case (`Case.terms`), and `UPLIFT`, `SLAB`, `REFERENCE`;
        "stepper" says that it is an engine of the protocol, `FILES` that it answers its cases alone.
    tolerance : float
        Relative accuracy that it claims: of alpha, of a time or of an energy.
    repeatability : float
        Difference of the same motion stated in another way, over alpha.
    reference : callable, optional
        The independent model that it is compared with, called as `reduced.simulate`.
    run : Run, optional
        Engine, time step and settings, of an engine.
    cases : tuple of Case, optional
        The only cases that it answers. Default: any.
    """

    label: str
    source: Simulate
    supports: tuple[str, ...]
    knows: frozenset[str]
    features: frozenset[str]
    tolerance: float
    repeatability: float
    reference: Simulate | None = None
    run: Run | None = None
    cases: tuple[Case, ...] | None = None

    def simulate(
        self, case: Case, support: str, *, sample_step: float = SAMPLE_STEP, **options: object
    ) -> Trace:
        """Motion of a case; options that the source does not take are left out."""
        known = {name: value for name, value in options.items() if name in self.features}
        return self.source(case, support, sample_step=sample_step, **known)

    def tolerance_bound(self, times: float, reason: str, unit: str = "") -> Bound:
        """A multiple of the tolerance as a bound."""
        return Bound(times * self.tolerance, f"{times:g} times its tolerance: {reason}", unit)


def reduced_model(module: ModuleType = reduced, *, rtol: float = _MODEL_RTOL) -> Subject:
    """Subject of the reduced models.

    Parameters
    ----------
    module : module, optional
        Their package; a copy of it, such as one with a fault.
    rtol : float, optional
        Relative tolerance of a step.

    Returns
    -------
    Subject
    """

    def source(
        case: Case, support: str, *, sample_step: float, rtol: float = rtol, **options: object
    ) -> Trace:
        way = {"plane": 0.0} if support == "planar" else {"support": support}
        trace: Trace = module.simulate(case, sample_step=sample_step, rtol=rtol, **way, **options)
        return trace

    return Subject(
        label="reduced model",
        source=_with_memory(source),
        supports=(*MODELLED, "planar"),
        knows=FIELDS,
        features=TERMS | {"rtol", "rest_tilt", "restitution", "plane", UPLIFT, SLAB},
        tolerance=MODEL_TOLERANCE,
        repeatability=MODEL_TOLERANCE,
    )


def engine(name: str, time_step: TimeStep | None = None, **settings: object) -> Subject:
    """Subject of an engine with its settings.

    Parameters
    ----------
    name : str
    time_step : float, "auto" or "extrapolated", optional
        [s]
    **settings
        Of the engine.

    Returns
    -------
    Subject

    Raises
    ------
    ValueError
        If there is no such engine, or it is not installed.
    """
    found, facts = find_engine(name), engine_facts(name)
    tolerance = max(ENGINE_TOLERANCE, _ROUNDINGS * facts.rounding)
    abilities = [name for name, has in ((UPLIFT, found.uplifts), (SLAB, facts.carries_slab)) if has]

    def source(case: Case, support: str, *, sample_step: float) -> Trace:
        return simulate_run(case, Run(name, support, time_step, **settings), sample_step=sample_step)

    return Subject(
        label=name,
        source=_with_memory(source),
        supports=found.supports,
        knows=FIELDS.union(_ENGINE_FIELDS),
        features=facts.terms.union({"stepper", REFERENCE}, abilities),
        tolerance=tolerance,
        repeatability=ENGINE_REPEATABILITY,
        reference=reduced.simulate,
        run=Run(name, found.supports[0], time_step, **settings),
    )


def external_model(
    model: Callable[[Case, str], object], *, support: str = RECESS, tolerance: float = TOLERANCE
) -> Subject:
    """Subject of an external model.

    Parameters
    ----------
    model : callable
        Takes a `Case` and a support, and returns a mapping, a table or an object with `time` [s] (n,) and
        `tilt` [rad] (n,), and, if it knows them, `azimuth` or `rolling_angle`, the direction of the lean
        [rad] (n,), and `energy` [m^2/s^2] (n,): relative to the ground, per unit mass, zero standing.
    support : {"recess", "flat"}, optional
        What it models.
    tolerance : float, optional
        How exact it claims to be, relative.

    Returns
    -------
    Subject

    Raises
    ------
    ValueError
        If support or tolerance is out of range.
    """
    _require(support, tolerance)

    def source(case: Case, support: str, *, sample_step: float) -> Trace:
        return trace_of(model(case, support), case, support)

    remembered = _with_memory(source)
    try:
        first = remembered(RELEASE, support, sample_step=SAMPLE_STEP)
        known = {name for name in ("rolling_angle", "energy") if np.isfinite(getattr(first, name)).any()}
    except Exception:  # exceptions are reported by each check
        known = {"rolling_angle", "energy"}
    return Subject(
        label=f"{getattr(model, '__module__', '')}:{getattr(model, '__name__', 'model')}",
        source=remembered,
        supports=(support,),
        knows=frozenset({"tilt", *known}),
        features=frozenset({UPLIFT, REFERENCE}),
        tolerance=tolerance,
        repeatability=tolerance,
        reference=reduced.simulate,
    )


def trajectories(traces: Sequence[Trace], *, support: str = RECESS, tolerance: float = TOLERANCE) -> Subject:
    """Subject of the motions in files.

    Parameters
    ----------
    traces : sequence of Trace
        Traces, from `rockwobble.compare.read_trajectory`, each of the case that it answers.
    support : {"recess", "flat"}, optional
        What they are of.
    tolerance : float, optional
        How exact they claim to be, relative.

    Returns
    -------
    Subject

    Raises
    ------
    ValueError
        If support or tolerance is out of range, or a file tells no tilt.
    """
    _require(support, tolerance)
    answers = {}
    for trace in traces:
        poses = measurement(trace).poses
        if "tilt" not in poses.given:
            raise ValueError(f"{trace.run.engine} must have tilt, or qw, qx, qy and qz")
        # compare at the samples of its file: interpolation between them is less exact
        azimuth = poses.rolling_angle if "azimuth" in poses.given else None
        columns = {"time": poses.time, "tilt": poses.tilt, "azimuth": azimuth}
        answers[fingerprint(trace.case)] = trace_of(columns, trace.case, support)
    has_azimuths = all(np.isfinite(trace.rolling_angle).any() for trace in answers.values())
    return Subject(
        label=", ".join(str(trace.run.engine) for trace in traces),
        source=lambda case, support, *, sample_step: answers[fingerprint(case)],
        supports=(support,),
        knows=frozenset({"tilt", "rolling_angle"} if has_azimuths else {"tilt"}),
        features=frozenset({UPLIFT, REFERENCE, FILES}),
        tolerance=tolerance,
        repeatability=tolerance,
        reference=reduced.simulate,
        cases=tuple(trace.case for trace in traces),
    )


def load_model(name: str) -> Callable[[Case, str], object]:
    """Callable named "module:function"; modules of the working folder are found.

    Raises
    ------
    ValueError
        If there is none.
    """
    module, _, function = name.partition(":")
    if not (module and function):
        raise ValueError(f"a model must be given as module:function, got {name!r}")
    if str(Path.cwd()) not in sys.path:
        sys.path.insert(0, str(Path.cwd()))
    try:
        loaded = getattr(importlib.import_module(module), function)
    except (ImportError, AttributeError) as error:
        raise ValueError(f"the model {name} cannot be imported: {error}") from error
    if not callable(loaded):
        raise ValueError(f"the model {name} must be callable, got {type(loaded).__name__}")  # noqa: TRY004 bad input
    model: Callable[[Case, str], object] = loaded
    return model


def _require(support: str, tolerance: float) -> None:
    if support not in MODELLED:
        raise ValueError(f"support must be {' or '.join(map(repr, MODELLED))}, got {support!r}")
    require_in_range("tolerance", tolerance, above=0.0, below=1.0)


def _with_memory(source: Simulate) -> Simulate:
    """Source that runs each case once and stores it, since many checks use one motion."""
    kept: dict[str, Trace] = {}

    def simulate(case: Case, support: str, **options: object) -> Trace:
        key = fingerprint([case, support, options])
        if key not in kept:
            kept[key] = source(case, support, **options)
        return kept[key]

    return simulate
