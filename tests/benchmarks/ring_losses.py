"""Print what a real recess costs against clearance, inclination, facets and friction of its ring of walls.

The engine in an ideal recess and on flat ground stands above the rings: what it differs by from its models
is its error.
"""

from __future__ import annotations

import math
from collections.abc import Iterable, Mapping, Sequence
from typing import Any

import numpy as np

from rockwobble.compare.runs.execution import Job, simulate_all
from rockwobble.compare.studies.validity.motions import EL_CENTRO, REFERENCE_SIZE, shaken_case
from rockwobble.compare.studies.validity.rings import against_models, has_room, losses, release_of
from rockwobble.models import Case, Run

from .console import options_of

Row = Mapping[str, Any]
# tan(alpha): peak of the record over the acceleration that uplifts. Large motion, and the ground keeps hold
INTENSITIES = ((0.2, 2.0), (1.0, 1.3))
_RELEASED, _SHAKEN = 8.0, 15.0  # lengths [s]: of the record the strong part

CLEARANCES = (0.0, 1e-4, 1e-3, 3e-3, 1e-2, 5e-2)  # [b]
INCLINATIONS = (0.1, 0.2, 0.3, 0.5, 0.8, 1.1)  # [rad]
FACETS = (8, 16, 32, 64, 128, 256)
FRICTIONS = (0.0, 0.2, 0.5, 1.0)
# azimuths by which each case is turned [deg]: the same problem, but for the walls and for chance
TURNS = (0.0, 2.0, 5.0, 9.0)


def ring_runs() -> tuple[Run, ...]:
    """Return the runs of each case: recess, flat ground, rings that differ from the default in one thing."""
    varied: dict[str, Sequence[Any]] = {
        "ring_clearance": CLEARANCES,
        "ring_inclination": INCLINATIONS,
        "ring_facets": FACETS,
        "ring_friction": FRICTIONS,
    }
    rings = [Run("mujoco", "ring", **{name: value}) for name, values in varied.items() for value in values]
    return (Run("mujoco", "recess"), Run("mujoco", "flat"), *rings)


def ring_cases(turn: float, intensities: Sequence[tuple[float, float]] = INTENSITIES) -> list[Case]:
    """Return a release and the record for each slenderness, turned by an angle [rad]."""
    return [
        case
        for tan_alpha, intensity in intensities
        for case in (
            release_of(tan_alpha, turn, _RELEASED),
            shaken_case(EL_CENTRO, tan_alpha, REFERENCE_SIZE, intensity, duration=_SHAKEN, turn=turn),
        )
    ]


def measure(cases: Sequence[Case], runs: Sequence[Run], *, workers: int | None = None) -> list[Row]:
    """Return a row for each case and run whose walls leave room for the release.

    case, support, settings, what `rings.losses` and `rings.against_models` say.
    """
    jobs = [Job(case=case, run=run) for case in cases for run in runs if has_room(case, run)]
    return [
        {
            "case": f"{job.case.name}, tan alpha {job.case.cylinder.tan_alpha:g}",
            "support": job.run.support,
            "settings": job.run.settings,
            **losses(trace),
            **against_models(trace),
        }
        for job, trace in zip(jobs, simulate_all(jobs, workers=workers), strict=True)
    ]


def table(rows: Sequence[Row]) -> str:
    """Return the rows as text, one block for each case: medians over the rows of a case and a ring."""
    head = [
        f"{'run':17} {'first':>6} {'contact':>8} {'passes':>6} {'lost':>8} {'from':>8} {'to':>8} "
        f"{'a pass':>8} {'rolled':>8} {'at end':>8} {'twist':>6} {'recess':>7} {'flat':>7}",
        f"{'':17} {'s':>6} {'s':>8} {'':>6} {'%':>8} {'%':>8} {'%':>8} {'%':>8} "
        f"{'b':>8} {'b':>8} {'rad':>6} {'RMS':>7} {'RMS':>7}",
    ]
    lines = []
    for case in dict.fromkeys(row["case"] for row in rows):
        lines += ["", case, *head]
        blocks: dict[str, list[Row]] = {}
        for row in rows:
            if row["case"] == case:
                blocks.setdefault(_name(row), []).append(row)
        lines += [_line(name, block) for name, block in blocks.items()]
    return "\n".join(lines)


def _name(row: Row) -> str:
    changed = (f"{name.removeprefix('ring_')} {value:g}" for name, value in row["settings"].items())
    return " ".join(changed) or str(row["support"])


def _line(name: str, rows: Sequence[Row]) -> str:
    def median(field: str) -> float:
        return _median(abs(row[field]) for row in rows)

    lost = [100.0 * row["loss"] for row in rows]
    each = _median(100.0 * row["loss"] / row["passes"] for row in rows if row["passes"])
    broken = sum(row["outcome"] in ("failed", "overturned") for row in rows)
    return (
        f"{name:17} {median('first_contact'):6.2f} {median('contact_time'):8.4f} {median('passes'):6.0f} "
        f"{_median(lost):8.3f} {min(lost):8.3f} {max(lost):8.3f} {each:8.3f} "
        f"{median('rolled_out'):8.4f} {median('at_end'):8.4f} {median('twist'):6.3f} "
        f"{median('recess'):7.0e} {median('flat'):7.0e}"
        + (f"  {broken} of {len(rows)} failed or overturned" if broken else "")
    )


def _median(values: Iterable[float]) -> float:
    """Median of what is finite: a run without a touch has no time of it."""
    finite = [value for value in values if math.isfinite(value)]
    return float(np.median(finite)) if finite else math.nan


def main(arguments: Sequence[str] | None = None) -> int:
    """Print the table."""
    import sys

    parser = options_of(
        "ring_losses",
        "What a real recess costs, against clearance, inclination, facets and friction. "
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
        choices=[tan_alpha for tan_alpha, _ in INTENSITIES],
        help="slenderness, may be repeated (default: all)",
    )
    given = parser.parse_args(arguments)
    chosen = [each for each in INTENSITIES if each[0] in (given.tan_alpha or [each[0]])]
    turns = TURNS[: given.turns]
    rows: list[Row] = []
    for turn in turns:
        print(f"turned by {turn:g} deg", file=sys.stderr)
        rows += measure(ring_cases(math.radians(turn), intensities=chosen), ring_runs())
    azimuths = ", ".join(f"{turn:g}" for turn in turns)
    print(
        "MuJoCo, R = 6 m, friction of the ground 3. A ring has its default settings but for the one named.\n"
        f"Medians of runs turned by {azimuths} deg about the vertical. lost: of the largest energy reached.\n"
        "rolled: how far from its place the cylinder would come down, largest and at the end.\n"
        "recess, flat: RMS of the tilt difference over that of the model's tilt."
    )
    print(table(rows))
    return 0
