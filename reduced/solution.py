"""Solution of a reduced model: positions, forces, energy and passes, and whether its assumptions held."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from functools import cache
from typing import TYPE_CHECKING, NamedTuple

import numpy as np
from numpy.typing import NDArray

from rockwobble.models import CLOSED_TILT, Assumptions, Diagnostic
from rockwobble.models.shown import CompactRepr
from rockwobble.models.trace_file import Array, friction_of

from . import forces, kernels
from .integration.result import MAXIMUM, MINIMUM
from .problem import Problem, ground_at, in_plane

if TYPE_CHECKING:
    import pandas as pd

# number of columns of a state that are among the six columns, by number of variables
_WIDTHS = {size: min(kernels.SIZES[name.split()[-1]], 6) for name, size in kernels.SIZES.items()}
# Parts of a step at which the demands are looked at: between two of them they are close to a parabola. A run
# of a million steps, which is chatter, has fewer.
_PARTS, _LEAST_PARTS, _MOST_TIMES = 8, 2, 400_000
_ROUNDS = 5  # rounds of refinement by eight, so that the error of a parabola falls to 8^-8 of its first value


class Demands(NamedTuple):
    """Demands of a solution at n times, also where the base is closed, which no limit concerns."""

    normal: Array  # (n,) least normal force in weights
    load: Array  # (n,) largest normal force in weights
    friction: Array  # (n,) horizontal over normal force; inf where the normal force is not positive
    moment: Array  # (n,) the restraining one, over the weight [m]
    open_base: NDArray[np.bool_]  # (n,) moving, at a tilt of CLOSED_TILT alpha or more


@cache
def _pass_columns() -> pd.Index:
    import pandas as pd

    return pd.Index(["time", "minimum_tilt", "angle_of_turn", "resolved"])


@dataclass(frozen=True, eq=False, kw_only=True, repr=False)
class Solution(CompactRepr):
    """States of a reduced model at n samples, and the problem that they solve.

    Attributes
    ----------
    problem : Problem
    time : ndarray, shape (n,)
        [s]
    states : ndarray, shape (n, 6)
        theta [rad], theta' [rad/s], phi [rad], L or Lambda [m^2/s], phi + psi [rad], S [m^2/s].
    roll_out : ndarray, shape (n, 2)
        Centre of the circle that the rim rolls on, relative to O [m].
    energy_lost : ndarray, shape (n,), optional
        By rolling resistance, impacts with it included, per unit mass [m^2/s^2]; None without it.
    uplift_time : float
        [s]
    extrema, rest_intervals : ndarray
        As of `Trace`.
    """

    problem: Problem
    time: Array
    states: Array
    roll_out: Array
    energy_lost: Array | None
    uplift_time: float
    extrema: Array
    rest_intervals: Array

    def quantities(self) -> Mapping[str, Array]:
        """Return rolling rate, energy, contact force and restraining moment at the samples."""
        quantities, top = self._derive(self.time, self.states)
        return {
            "rolling_rate": quantities[:, forces.ROLLING_RATE],
            "energy": quantities[:, forces.ENERGY],
            "contact_force": quantities[:, forces.FORCE_X : forces.FORCE_Z + 1],
            "restraining_moment": quantities[:, forces.MOMENT],
            "energy_lost": self._lost_at_impacts() if self.energy_lost is None else self.energy_lost,
        } | ({} if top is None else {"top_contact_force": top})

    def _lost_at_impacts(self) -> Array:
        """Return the energy that impacts took before each sample (n,), per unit mass [m^2/s^2]."""
        problem = self.problem
        landings = self.extrema[self.extrema[:, 1] == 0.0, 0]
        if problem.rebound == 1.0 or not len(landings):
            return np.zeros(len(self.time))
        result, _ = problem.solve(landings)  # states just before the rebound
        rate = result.samples[: result.reached, 1]
        lost = 0.5 * problem.body.A * (1.0 - problem.rebound**2) * rate * rate
        before = np.searchsorted(landings[: len(lost)], self.time)
        return np.concatenate([[0.0], np.cumsum(lost)])[before]

    def contact_point(self, moving: NDArray[np.bool_]) -> Array:
        """Return the contact point (n, 2) relative to O [m]; NaN at rest."""
        phi = np.where(moving, self.states[:, 2], math.nan)
        b = self.problem.case.cylinder.base_radius
        return self.roll_out + b * np.column_stack([np.cos(phi), np.sin(phi)])

    def centre_of_mass(self) -> Array:
        """Return the mass centre (n, 3) relative to O [m]: equations (8) and (10)."""
        b, h = self.problem.body.b, self.problem.body.h
        theta, phi = self.states[:, 0], self.states[:, 2]
        s, c = np.sin(theta), np.cos(theta)
        radius = s * (h + b * np.tan(0.5 * theta))
        horizontal = self.roll_out + radius[:, None] * np.column_stack([np.cos(phi), np.sin(phi)])
        return np.column_stack([horizontal, b * s + h * c])

    def passes(self) -> pd.DataFrame:
        """Return the passes: a tilt minimum between two maxima of one motion, one row each.

        Turning points closer than the tolerance of the solution, as in steady wobble, are not told apart and
        make no pass, and neither does a rest.
        """
        import pandas as pd

        time, tilt, angle, kind = self.extrema.T
        motion = np.searchsorted(self.rest_intervals[:, 0], time)  # number of rests before
        at = (
            (kind[1:-1] == MINIMUM)
            & (kind[:-2] == MAXIMUM)
            & (kind[2:] == MAXIMUM)
            & (motion[:-2] == motion[2:])
            & (np.minimum(tilt[:-2], tilt[2:]) > tilt[1:-1] * (1.0 + 100.0 * self.problem.rtol))
        )
        columns = (
            time[1:-1][at],
            tilt[1:-1][at],
            (angle[2:] - angle[:-2])[at],
            np.ones(np.count_nonzero(at), dtype=bool),
        )
        # stored as one array and named later: naming takes longer than many a run
        table = pd.DataFrame(dict(enumerate(columns)))
        table.columns = _pass_columns()
        return table

    def assumptions(self, until: float) -> Assumptions:
        """Whether contact and friction held until a time [s], also between the steps.

        From a tilt of `CLOSED_TILT` alpha on.
        """
        result, _ = self.problem.solve(np.empty(0), record_steps=True)
        end = [min(result.end, until)]
        steps = np.concatenate([[0.0], result.steps[:, 0], self.rest_intervals[:, 0], end])
        landings = self.extrema[self.extrema[:, 1] == 0.0, 0]
        jumps = np.concatenate([[self.uplift_time], self.rest_intervals[:, 1], landings])
        jumps = jumps[np.isfinite(jumps) & (jumps > 0.0) & (jumps < until)]
        return review(self._demands_at, np.unique(steps[steps <= until]), jumps, self.problem.case.friction)

    def _demands_at(self, times: Array) -> Demands:
        result, azimuth = self.problem.solve(times)
        reached = result.reached
        derived, top = self._derive(times[:reached], six_columns(result.samples[:reached], azimuth))
        force = derived[:, forces.FORCE_X : forces.FORCE_Z + 1]
        least, largest, friction = force[:, 2], force[:, 2], friction_of(force)
        if top is not None:  # the larger demand of both ends counts
            least, largest = np.minimum(least, top[:, 2]), np.maximum(largest, top[:, 2])
            friction = np.maximum(friction, friction_of(top))
        opens = result.samples[:reached, 0] >= CLOSED_TILT * self.problem.body.alpha
        open_base = result.moving[:reached] & opens
        return Demands(least, largest, friction, derived[:, forces.MOMENT], open_base)

    def _derive(self, times: Array, states: Array) -> tuple[Array, Array | None]:
        """Return the derived quantities (n, 6), and in a frame the force on the slab (n, 3)."""
        problem = self.problem
        ground = ground_at(problem.case, times)
        if problem.plane is not None:
            ground = in_plane(ground, problem.plane)
        derived = forces.derived_quantities(
            problem.body, np.ascontiguousarray(states), ground, problem.free_twist
        )
        if problem.case.cylinder.slab_mass_ratio == 0.0:
            return derived, None
        base = derived[:, forces.FORCE_X : forces.FORCE_Z + 1]
        gamma = problem.case.cylinder.slab_mass_ratio
        return derived, forces.top_force(problem.body, base, ground, states, gamma)


def six_columns(states: Array, azimuth: float) -> Array:
    """Return theta, theta', phi, Lambda, tau, S (n, 6) of the variables of any model.

    Planar motion has neither spin nor twist, and only the flat-ground model has the latter.
    """
    full = np.zeros((len(states), 6))
    width = _WIDTHS[states.shape[1]]
    full[:, :width] = states[:, :width]
    full[:, 2] += azimuth
    return full


def review(
    demands_at: Callable[[Array], Demands], steps: Array, jumps: Array, friction: float
) -> Assumptions:
    """Compare the demands of a solution with contact and a coefficient of friction.

    Parameters
    ----------
    demands_at : callable
        Demands of the continuous solution at increasing times (n,) [s].
    steps : ndarray, shape (k,)
        Times between which the demands are smooth, from beginning to end [s]: the steps of the solution.
    jumps : ndarray, shape (j,)
        Times at which they jump: uplifts and landings [s]. At such a time the solution is that before it.
    friction : float
        Coefficient of the pair [-].
    """
    edges = np.unique(np.concatenate([steps, jumps, np.nextafter(jumps, math.inf)]))
    parts = max(_LEAST_PARTS, min(_PARTS, _MOST_TIMES // len(edges)))
    times = np.unique(_subdivision(edges, parts))
    samples = demands_at(times)
    if not samples.open_base.any():
        return Assumptions(friction=friction)

    def slips(demands: Demands) -> NDArray[np.bool_]:
        # loss of contact takes precedence over friction
        return demands.open_base & (demands.normal > 0.0) & (demands.friction > friction)

    def largest(quantity: Callable[[Demands], Array]) -> tuple[float, float]:
        return _largest(quantity, demands_at, times, samples)

    pull, pulled = largest(lambda demands: -demands.normal)
    need, needed = largest(lambda demands: demands.friction)
    normal, _ = largest(lambda demands: demands.load)
    moment, _ = largest(lambda demands: np.abs(demands.moment))
    if (pull >= 0.0 and not _contact_loss(samples).any()) or (need > friction and not slips(samples).any()):
        # a breach shorter than a part of a step
        times = np.union1d(times, [pulled, needed])
        samples = demands_at(times)
    breaches = []
    if _contact_loss(samples).any():
        breaches.append(_breach("tension", _contact_loss, demands_at, times, samples, -pull, 0.0))
    if slips(samples).any():
        breaches.append(_breach("friction_needed", slips, demands_at, times, samples, need, friction))
    return Assumptions(
        breaches=tuple(breaches),
        least_normal_force=-pull,
        largest_normal_force=normal,
        largest_friction_needed=need,
        largest_restraining_moment=moment,
        friction=friction,
    )


def _contact_loss(demands: Demands) -> NDArray[np.bool_]:
    return demands.open_base & (demands.normal <= 0.0)


def _breach(
    code: str,
    broken_at: Callable[[Demands], NDArray[np.bool_]],
    demands_at: Callable[[Array], Demands],
    times: Array,
    demands: Demands,
    size: float,
    bound: float,
) -> Diagnostic:
    broken = broken_at(demands)
    # time at which a breach begins or ends, refined: a step of a fall takes tenths of a second
    for _ in range(_ROUNDS - 1):
        changes = np.flatnonzero(broken[1:] != broken[:-1])
        times = np.unique(np.concatenate([times, *(_subdivision(times[i : i + 2], _PARTS) for i in changes)]))
        broken = broken_at(demands_at(times))
    return Diagnostic(
        code=code,
        time=float(times[broken.argmax()]),
        duration=float(np.diff(times)[broken[:-1] & broken[1:]].sum()),
        size=size,
        bound=bound,
    )


def _largest(
    quantity: Callable[[Demands], Array],
    demands_at: Callable[[Array], Demands],
    times: Array,
    demands: Demands,
) -> tuple[float, float]:
    """Largest value of an open base, refined about the largest at `times`, and its time."""
    best, when = -math.inf, math.nan
    for _ in range(_ROUNDS):
        values = np.where(demands.open_base, quantity(demands), -math.inf)
        at = int(values.argmax())
        if not values[at] <= best:
            best, when = float(values[at]), float(times[at])
        if math.isinf(best):
            break
        about = times[max(at - 1, 0) : at + 2]
        times = np.unique(_subdivision(about, _PARTS))
        demands = demands_at(times)
    return best, when


def _subdivision(edges: Array, parts: int) -> Array:
    """Return times (parts (k - 1) + 1,) that divide each interval between `edges` (k,)."""
    share = np.arange(parts) / parts
    inner = edges[:-1, None] + np.diff(edges)[:, None] * share
    return np.append(inner.ravel(), edges[-1])
