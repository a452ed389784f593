"""The runs of a fragility, cut into tasks that can be kept and repeated singly."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Any

import pandas as pd

from rockwobble.models import Case, Cylinder, GroundMotion, Run, Trace

from ...metrics.tilt import outcome_of, overturned
from ...runs.execution import engine_time, makers_of, simulate_run
from ...storage.fingerprint import fingerprint

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
        """Whether the batch kernel does, which knows homogeneous cylinders and peaks alone."""
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
