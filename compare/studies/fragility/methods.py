"""Methods of a fragility, and the runs of one, cut into tasks that can be kept and repeated singly."""

from __future__ import annotations

import math
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import pandas as pd

from rockwobble.models import Case, Cylinder, GroundMotion, Run, Trace
from rockwobble.models.number_checks import require_one_of

from ...metrics.tilt import outcome_of, overturned
from ...runs.execution import engine_time, makers_of, simulate_run
from ...runs.labels import run_labels
from ...storage.fingerprint import fingerprint

# The worse plane is no run of its own: of both planes, for each motion, the one that tilts more.
WORSE_PLANE = "worse-plane"
_PLANES = {"planar-x": 0.0, "planar-y": 0.5 * math.pi}
MODELS: Mapping[str, str] = {
    "recess": "recess model",
    "flat": "flat-ground model",
    "planar-x": "planar x",
    "planar-y": "planar y",
    WORSE_PLANE: "worse plane",
}


@dataclass(frozen=True, slots=True, kw_only=True)
class Method:
    """One method.

    Attributes
    ----------
    label : str
        Different for each method.
    run : Run or None
        None for what is made of others.
    of : tuple of str
        Labels of the methods of which it is the worse, motion by motion.
    """

    label: str
    run: Run | None
    of: tuple[str, ...] = ()

    @property
    def support(self) -> str:
        """What holds the cylinder: "recess", "flat", "ring" or "planar"."""
        if self.run is None or self.run.settings.get("plane") is not None:
            return "planar"
        return self.run.support


def methods_of(given: Iterable[str | Run], *, restitution: float | str = 1.0) -> tuple[Method, ...]:
    """Return the methods, in their order; both planes besides where the worse of them is asked for.

    Parameters
    ----------
    given : iterable of str or Run
        Names in `MODELS`, and runs of engines or of reduced models with settings.
    restitution : float or "momentum", optional
        Of the planar models, see `reduced.simulate`.

    Raises
    ------
    ValueError
        If a name is unknown, two methods are alike, there is none, or no planar one for a restitution.
    """
    chosen: list[str | Run] = []
    for method in given:
        if isinstance(method, str):
            require_one_of("a reduced model", method, MODELS)
        chosen += [plane for plane in _PLANES if method == WORSE_PLANE and plane not in chosen]
        if method not in chosen or not isinstance(method, str):
            chosen.append(method)
    if not chosen:
        raise ValueError("a fragility needs at least one method, got none")
    labels = iter(run_labels([method for method in chosen if isinstance(method, Run)]))
    found = [_method(method, restitution, labels) for method in chosen]
    if restitution != 1.0 and not any(method in _PLANES for method in chosen):
        raise ValueError(f"restitution is of planar models, got {restitution!r} without one")
    names = [method.label for method in found]
    for name in names:
        if names.count(name) > 1:
            raise ValueError(f"the methods must differ, got {name!r} twice")
    return tuple(found)


def _method(given: str | Run, restitution: float | str, labels: Iterable[str]) -> Method:
    if isinstance(given, Run):
        return Method(label=next(iter(labels)), run=given)
    if given == WORSE_PLANE:
        return Method(label=MODELS[given], run=None, of=tuple(MODELS[plane] for plane in _PLANES))
    if given in _PLANES:
        loss: dict[str, Any] = {} if restitution == 1.0 else {"restitution": restitution}
        return Method(label=MODELS[given], run=Run(None, "recess", plane=_PLANES[given], **loss))
    return Method(label=MODELS[given], run=Run(None, given))


def own_model(method: Method, methods: Sequence[Method]) -> str:
    """Return the label of the reduced model of the support of an engine, if there is one among the methods.

    No reduced model knows the walls of a ring.
    """
    if method.run is None or method.run.engine is None:
        return ""
    return next(
        (
            other.label
            for other in methods
            if other.run is not None and other.run.engine is None and other.support == method.support
        ),
        "",
    )


# Computing time of a reduced run for each second of its motion, forces included or not, on one core [s]: a
# rough mean of the models.
_KERNEL_TIME, _SOLUTION_TIME = 3e-5, 1e-3
# facts of a run that mean that the ground would have to pull, or did not touch the cylinder
_LOST = ("tension", "lift_off")
_RTOL = 1e-7


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Shaking:
    """A ground motion and the factors on it."""

    motion: GroundMotion
    scales: tuple[float, ...]


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Task:
    """One cylinder by one method under some motions, each with some factors.

    Attributes
    ----------
    cylinder : Cylinder
    name, label : str
        Of the cylinder and of the method.
    run : Run
    shakings : tuple of Shaking
    gravity, friction : float
    contact : bool
        Whether it is asked if a reduced model keeps its contact: that takes its forces.
    """

    cylinder: Cylinder
    name: str
    label: str
    run: Run
    shakings: tuple[Shaking, ...]
    gravity: float
    friction: float
    contact: bool

    @property
    def title(self) -> str:
        """Description of the task, for whoever waits."""
        more = f" and {len(self.shakings) - 1} more" if len(self.shakings) > 1 else ""
        first = self.shakings[0]
        scale = f" × {first.scales[0]:.3g}" if len(first.scales) == 1 else ""
        return f"{self.name}, {self.label}, {first.motion.name}{scale}{more}"

    @property
    def cost(self) -> float:
        """Rough computing time [s]."""
        if self.run.engine is not None:
            return sum(
                engine_time(Case(self.cylinder, each.motion, gravity=self.gravity), self.run)
                * len(each.scales)
                for each in self.shakings
            )
        length = sum(shaking.motion.duration * len(shaking.scales) for shaking in self.shakings)
        return length * (_KERNEL_TIME if self._of_peaks else _SOLUTION_TIME)

    def key(self) -> str:
        """Return the hash of all that the results depend on; names are no part of it."""
        own = {"contact": self.contact, "rtol": _RTOL} if self.run.engine is None else {}
        return fingerprint(
            {
                "cylinder": self.cylinder,
                "shakings": [(s.motion.acceleration, s.motion.time_step, s.scales) for s in self.shakings],
                "run": self.run,
                "gravity": self.gravity,
                "friction": self.friction,
                "made with": makers_of(self.run),
                **own,
            }
        )

    @property
    def _of_peaks(self) -> bool:
        """Whether the batch kernel does, which knows homogeneous cylinders, a slab, and peaks alone."""
        own = self.cylinder
        homogeneous = (own.height, own.transverse_inertia, own.axial_inertia) == (None, None, None)
        return self.run.engine is None and homogeneous and not self.contact

    def rows(self) -> list[dict[str, Any]]:
        """Return a row for each motion and factor, in their order."""
        if self._of_peaks:
            return [row for shaking in self.shakings for row in self._peaks(shaking)]
        return [self._row(s.motion, scale) for s in self.shakings for scale in s.scales]

    def _peaks(self, shaking: Shaking) -> list[dict[str, Any]]:
        from rockwobble import reduced

        peaks = reduced.peak_tilts(
            [self.cylinder.semidiagonal],
            self.cylinder.tan_alpha,
            shaking.motion,
            shaking.scales,
            workers=1,  # the processes share the cores already
            gravity=self.gravity,
            slab_mass_ratio=self.cylinder.slab_mass_ratio,
            support=self.run.support,
            **{"rtol": _RTOL, **self.run.settings},
        )[0]
        return [
            {
                "peak_tilt": float(peak) / self.cylinder.alpha,
                "outcome": "failed" if math.isnan(peak) else "overturned" if overturned(peak) else "stands",
                "contact_lost": math.nan,
            }
            for peak in peaks
        ]

    def _row(self, motion: GroundMotion, scale: float) -> dict[str, Any]:
        case = Case(self.cylinder, motion.scaled(scale), gravity=self.gravity, friction=self.friction)
        run = self.run
        if run.engine is None:
            run = Run(None, run.support, **{"rtol": _RTOL, **run.settings})
        trace = simulate_run(case, run)
        return {
            "peak_tilt": trace.peak_tilt / self.cylinder.alpha,
            "outcome": outcome_of(trace),
            "contact_lost": self._lost(trace),
        }

    def _lost(self, trace: Trace) -> float:
        """1 where contact was lost, 0 where it was not; NaN where nobody asked or the run failed."""
        if trace.outcome == "failed" or not (self.contact or self.run.engine):
            return math.nan
        return float(any(fact.code in _LOST for fact in trace.diagnostics))


def run_task(task: Task) -> pd.DataFrame:
    """Return the table of a task: peak_tilt [alpha], outcome, contact_lost."""
    return pd.DataFrame(task.rows())
