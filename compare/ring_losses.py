"""What a real recess costs: energy, place and agreement against clearance, inclination and facets of a ring.

`python -m rockwobble.compare.ring_losses` prints the table. Each ring is held against the recess model,
which is the ideal of it, and against the rolling model, which is open ground. The guided and the free
engine stand above the rings: what they differ by from their models is the error of the engine.
"""

from __future__ import annotations

import math
from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from rockwobble.models import Case, Cylinder, InitialState, Run, el_centro_1940
from rockwobble.multibody.ring_geometry import clearance_needed
from rockwobble.multibody.ring_settings import take_ring

from .execution import Crash, Job, simulate_all
from .tilt import tilt_rms_relative
from .traces import FloatArray, make_pair

CLEARANCES = (0.0, 1e-4, 1e-3, 3e-3, 1e-2, 5e-2)  # [b]
INCLINATIONS = (0.1, 0.2, 0.3, 0.5, 0.8, 1.1)  # [rad]
FACETS = (8, 16, 32, 64, 128, 256)
FRICTIONS = (0.0, 0.2, 0.5, 1.0)
# azimuths by which each case is turned [deg]: the same problem, but for the walls and for chance
TURNS = (0.0, 2.0, 5.0, 9.0)
# tan(alpha): peak of the record over the acceleration that uplifts. Large motion, and the ground keeps hold
_INTENSITIES = ((0.2, 2.0), (1.0, 1.3))
_FRICTION = 3.0  # of the ground: a squat cylinder that uplifts needs more than 1
_LENGTH = 8.0  # [s] of a free response
_RECORD = 15.0  # [s] of the record: the strong part


@dataclass(frozen=True, slots=True, kw_only=True)
class RingRow:
    """One run: which ring, and what it did.

    Attributes
    ----------
    case : str
    support : str
    settings : dict
        Of the ring; empty for the defaults.
    outcome : str
    first_contact, contact_time : float
        First contact with a wall and time in contact [s].
    passes : int
    loss : float
        Energy lost over the largest reached.
    rolled_out, at_end : float
        Distance from O of the place on which the cylinder would stand if it came to rest upright, largest
        and last [b].
    residual : float
        Displacement of the base centre at the end [b].
    twist : float
        At the end [rad].
    peak, recess_peak : float
        Peak tilt of the run and of the recess model [alpha].
    against_recess, against_rolling : float
        RMS of the tilt difference over that of the model's tilt.
    """

    case: str
    support: str
    settings: dict[str, Any]
    outcome: str
    first_contact: float
    contact_time: float
    passes: int
    loss: float
    rolled_out: float
    at_end: float
    residual: float
    twist: float
    peak: float
    recess_peak: float
    against_recess: float
    against_rolling: float


def ring_cases(
    turn: float = 0.0,
    *,
    intensities: Sequence[tuple[float, float]] = _INTENSITIES,
    length: float = _LENGTH,
) -> tuple[Case, ...]:
    """Return the cases of the table, turned by an azimuth [rad]: free response and El Centro.

    For each slenderness and intensity, with `length` that of the free response [s].
    """
    cases = []
    record = el_centro_1940()
    for tan_alpha, intensity in intensities:
        cylinder = Cylinder(semidiagonal=6.0, tan_alpha=tan_alpha)
        release = InitialState(tilt=0.5 * cylinder.alpha, rolling_angle=turn, rolling_rate=0.5)
        scaled = record.scaled(intensity * tan_alpha * 9.81 / record.peak).rotated(turn)
        name = f"tan alpha {tan_alpha:g}"
        cases += [
            Case(f"free response, {name}", cylinder, None, release, length, friction=_FRICTION),
            Case(f"El Centro, {name}", cylinder, scaled, None, _RECORD, friction=_FRICTION),
        ]
    return tuple(cases)


def ring_runs() -> tuple[Run, ...]:
    """Return the runs of each case: guided, free, and rings that differ from the default in one setting."""
    varied: dict[str, Sequence[Any]] = {
        "ring_clearance": CLEARANCES,
        "ring_inclination": INCLINATIONS,
        "ring_facets": FACETS,
        "ring_friction": FRICTIONS,
    }
    rings = [Run("mujoco", "ring", **{name: value}) for name, values in varied.items() for value in values]
    return (Run("mujoco", "guided"), Run("mujoco", "free"), *rings)


def measure(cases: Sequence[Case], runs: Sequence[Run], *, workers: int | None = None) -> list[RingRow]:
    """Run each case with each run, and return one row for each; what a case refuses is left out."""
    rows = []
    for case in cases:
        possible = [run for run in runs if _possible(case, run)]
        methods: list[Run | str] = ["recess", "rolling", *possible]
        jobs = [Job(case=case, method=method, label=str(n)) for n, method in enumerate(methods)]
        recess, rolling, *trials = simulate_all(jobs, workers=workers)
        rows += [
            _row(case, run, trial, recess, rolling)
            for run, trial in zip(possible, trials, strict=True)
            if not isinstance(trial, Crash)
        ]
    return rows


def _possible(case: Case, run: Run) -> bool:
    """Whether the release is outside of the walls."""
    _, ring = take_ring(run.settings, run.support, case.cylinder.tan_alpha)
    if ring is None or case.initial is None:
        return True
    needed = clearance_needed(case.cylinder, case.initial.tilt, ring.ring_inclination)
    return needed <= ring.ring_clearance


def _row(case: Case, run: Run, trial: Any, recess: Any, rolling: Any) -> RingRow:
    out = _rolled_out(trial, case.cylinder.base_radius)
    largest = float(trial.energy.max())
    return RingRow(
        case=case.name,
        support=run.support,
        settings=dict(run.settings),
        outcome=trial.outcome,
        first_contact=trial.first_wall_contact,
        contact_time=float(trial.wall_contact[-1]),
        passes=len(trial.passes),
        loss=-float(trial.energy_error[-1]) / largest if largest > 0.0 else math.nan,
        rolled_out=float(out.max(initial=0.0)),
        at_end=float(out[-1]) if len(out) else 0.0,
        residual=trial.residual_displacement / case.cylinder.base_radius,
        twist=trial.residual_twist,
        peak=trial.peak_tilt / case.cylinder.alpha,
        recess_peak=recess.peak_tilt / case.cylinder.alpha,
        against_recess=tilt_rms_relative(make_pair(case.cylinder, recess, trial)),
        against_rolling=tilt_rms_relative(make_pair(case.cylinder, rolling, trial)),
    )


def _rolled_out(trial: Any, radius: float) -> FloatArray:
    """Distance from O of the place to which a cylinder would come down, while it is tilted [b].

    The contact point less a radius in the direction of the lean: in the recess model that is O.
    """
    lean = np.column_stack([np.cos(trial.rolling_angle), np.sin(trial.rolling_angle)])
    place = trial.contact_point - radius * lean
    distance: FloatArray = np.hypot(place[:, 0], place[:, 1]) / radius
    return distance[np.isfinite(distance)]


def table(rows: Sequence[RingRow]) -> str:
    """Return the rows as text, one block for each case: medians over the rows of a case and a ring."""
    head = [
        f"{'run':17} {'first':>6} {'contact':>8} {'passes':>6} {'lost':>8} {'from':>8} {'to':>8} "
        f"{'a pass':>8} {'rolled':>8} {'at end':>8} {'twist':>6} {'recess':>7} {'rolling':>7}",
        f"{'':17} {'s':>6} {'s':>8} {'':>6} {'%':>8} {'%':>8} {'%':>8} {'%':>8} "
        f"{'b':>8} {'b':>8} {'rad':>6} {'RMS':>7} {'RMS':>7}",
    ]
    lines = []
    for case in dict.fromkeys(row.case for row in rows):
        lines += ["", case, *head]
        blocks: dict[str, list[RingRow]] = {}
        for row in rows:
            if row.case == case:
                blocks.setdefault(_name(row), []).append(row)
        lines += [_line(name, block) for name, block in blocks.items()]
    return "\n".join(lines)


def _name(row: RingRow) -> str:
    changed = (f"{name.removeprefix('ring_')} {value:g}" for name, value in row.settings.items())
    return " ".join(changed) or row.support


def _line(name: str, rows: Sequence[RingRow]) -> str:
    def median(field: str) -> float:
        return _median(abs(getattr(row, field)) for row in rows)

    lost = [100.0 * row.loss for row in rows]
    each = _median(100.0 * row.loss / row.passes for row in rows if row.passes)
    broken = sum(row.outcome in ("failed", "overturned") for row in rows)
    return (
        f"{name:17} {median('first_contact'):6.2f} {median('contact_time'):8.4f} {median('passes'):6.0f} "
        f"{_median(lost):8.3f} {min(lost):8.3f} {max(lost):8.3f} {each:8.3f} "
        f"{median('rolled_out'):8.4f} {median('at_end'):8.4f} {median('twist'):6.3f} "
        f"{median('against_recess'):7.0e} {median('against_rolling'):7.0e}"
        + (f"  {broken} of {len(rows)} failed or overturned" if broken else "")
    )


def _median(values: Iterable[float]) -> float:
    """Median of what is finite: a run without a touch has no time of it."""
    finite = [value for value in values if math.isfinite(value)]
    return float(np.median(finite)) if finite else math.nan


def main() -> None:
    """Print the table."""
    import argparse
    import sys

    parser = argparse.ArgumentParser(
        prog="python -m rockwobble.compare.ring_losses",
        description="What a real recess costs, against clearance, inclination, facets and friction. "
        "Example: --turns 1 --tan-alpha 1",
    )
    parser.add_argument(
        "--turns",
        type=int,
        choices=range(1, len(TURNS) + 1),
        default=2,
        help="azimuths by which each case is turned, up to five minutes on two cores each (%(default)s)",
    )
    parser.add_argument(
        "--tan-alpha",
        type=float,
        action="append",
        choices=[tan_alpha for tan_alpha, _ in _INTENSITIES],
        help="slenderness, may be repeated (default: all)",
    )
    given = parser.parse_args()
    chosen = [each for each in _INTENSITIES if each[0] in (given.tan_alpha or [each[0]])]
    turns = TURNS[: given.turns]
    rows: list[RingRow] = []
    for turn in turns:
        print(f"turned by {turn:g} deg", file=sys.stderr)
        rows += measure(ring_cases(math.radians(turn), intensities=chosen), ring_runs())
    azimuths = ", ".join(f"{turn:g}" for turn in turns)
    print(
        "MuJoCo, R = 6 m, friction of the ground 3. A ring has its default settings but for the one named.\n"
        f"Medians of runs turned by {azimuths} deg about the vertical. lost: of the largest energy reached.\n"
        "rolled: how far from its place the cylinder would come down, largest and at the end.\n"
        "recess, rolling: RMS of the tilt difference over that of the model's tilt."
    )
    print(table(rows))


if __name__ == "__main__":
    main()
