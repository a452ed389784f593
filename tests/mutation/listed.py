"""Handwritten faults: one at a time in a copy of the reduced models, or in the settings of an engine.

    python tests/mutation listed            # every fault
    python tests/mutation listed --only "1 % off"

Each must be found by `rockwobble check`, by a number or a motion that fails: any other exception may be one
of the planted code itself, as of a signature that is no longer so, and finds nothing. One that is missed
makes the exit code 1, and so does a failure in a copy without a fault. What only a test finds is scored by
`python tests/mutation generated --tests`.
"""

from __future__ import annotations

import time
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any

import numpy as np

from rockwobble.compare.check import GROUPS, Result, Subject, engine, reduced_model, run_checks
from rockwobble.compare.check.groups import ENDS
from rockwobble.multibody import available_engines

from .mutant import Fault, mutated
from .places import appended, at_assignment, scaled_argument, wrapped
from .term_faults import FILE, term_faults

# asked of a copy, which the interpreter runs: the others have solutions to 1e-13 and long records
INTERPRETED = tuple(group for group in GROUPS if group not in ("order", "baseline"))


@dataclass(frozen=True, slots=True, kw_only=True)
class Mutation:
    """One fault, with the check groups that should detect it first."""

    name: str
    group: str  # of the checks that find it; the others are asked where it does not
    faults: tuple[Fault, ...] = ()  # in the sources of the reduced models
    engine: str = ""  # whose settings are wrong
    settings: Mapping[str, Any] = field(default_factory=dict)  # its time step and settings


def mutations() -> tuple[Mutation, ...]:
    """All faults; engine faults are for the standard engines."""
    return (
        *_terms(1.01, "1 % off"),
        *_terms(-1.0, "sign"),
        *_constants(),
        *_structure(),
        *_tendons(),
        *_engines(),
    )


def _terms(factor: float, word: str) -> list[Mutation]:
    """Every term of (18) and (19), at the start of a step and in its series."""
    return [
        Mutation(name=f"{word}: {each.name}", faults=(each.fault,), group="equations")
        for each in term_faults(factor)
    ]


def _constants() -> list[Mutation]:
    """Body constants 1 % off, wherever they are used; R off through the cylinder itself."""
    # those of which others are made are changed before A, the first that is made of them
    made_of = {"b": "b", "h": "h", "I1": "I1", "I2": "I2"}
    changes = {name: at_assignment("body_of", "A", f"{symbol} *= 1.01") for name, symbol in made_of.items()}
    fields = ("A", "J", "C", "E", "g", "p2", "sin_alpha", "cos_alpha")
    changes |= {name: scaled_argument("body_of", "Body", name, 1.01) for name in fields}
    constants = [
        Mutation(
            name=f"1 % off everywhere: {name}",
            faults=(Fault(file="body.py", change=change),),
            group="equations",
        )
        for name, change in changes.items()
    ]
    # through the whole cylinder every term keeps its place: only scales of time and length tell
    size = _around(
        "simulation.py",
        "simulate(case, **options)",
        "import dataclasses\n"
        "from rockwobble.models import Cylinder\n"
        "size = 1.01 * case.cylinder.semidiagonal\n"
        "other = Cylinder(semidiagonal=size, tan_alpha=case.cylinder.tan_alpha)\n"
        "return without_fault(dataclasses.replace(case, cylinder=other), **options)",
    )
    return [
        *constants,
        Mutation(name="R 1 % off", faults=(size,), group="exact"),
    ]


def _around(file: str, head: str, body: str) -> Fault:
    """Fault that wraps a function; the original is called `without_fault`."""
    text = f"def {head}:\n" + "".join(f"    {line}\n" for line in body.splitlines())
    return Fault(file=file, change=wrapped(head.split("(")[0], text))


def _structure() -> list[Mutation]:
    # the pieces keep their times, but from the 21st on they are those of the next
    skipped = _around(
        "integration/record.py",
        "piece_of_record(record, time_step, index, begin, last)",
        "piece = without_fault(record, time_step, index, begin, last)\n"
        "skipped = 1 if 20 < index < len(record) - 2 else 0\n"
        "other = without_fault(record, time_step, index + skipped, begin, last)\n"
        "return Piece(begin, piece.finish, piece.length, other.a, other.slope)",
    )
    exchanged = _around("problem.py", "three_columns(motion)", "return without_fault(motion)[:, [1, 0, 2]]")
    late = _around(
        "integration/uplift.py",
        "uplift_in(*arguments)",
        "return 0.0 if without_fault(*arguments) == 0.0 else -1.0",
    )
    rolling = Fault(
        file="kernels.py", change=appended('INTEGRATORS["recess"], SIZES["recess"] = integrate_flat, 8')
    )
    leak = Fault(
        file=FILE, change=at_assignment("expand", "momentum_1", "momentum_1 -= 1e-6 * h * L", after=True)
    )
    return [
        Mutation(name="a sample of the record skipped", faults=(skipped,), group="conserved"),
        Mutation(name="components exchanged", faults=(exchanged,), group="rest"),
        Mutation(name="uplift at the next sample", faults=(late,), group="rest"),
        Mutation(name="no-twist constraint dropped", faults=(rolling,), group="trace"),
        Mutation(name="L decays", faults=(leak,), group="conserved"),
    ]


def _tendons() -> list[Mutation]:
    """Constants and terms of a tendon; the balance tilt only shortens runs and has its own test."""
    changes = {
        f"{factor} {field}": scaled_argument("_tied_body", "TiedBody", field, number)
        for factor, number in (("1 % off:", 1.01), ("sign:", -1.0))
        for field in ("prestress", "stiffness")
    }
    changes |= {
        "1 % off: gaps of the force": scaled_argument("_tied_body", "TiedBody", "gaps", 1.01),
        "a gap missing": at_assignment("_tied_body", "stiffness", "gaps = 1"),
    }
    bodies = {
        "half angle: couple": (
            "_couple(body, arm, s, u)",
            "return without_fault(body, arm, s, 2.0 * u * u - 1.0)",
        ),
        "half angle: series": (
            "_coefficient_tied(body, weight, s, v, u0, order, c, place)",
            "return without_fault(body, weight, s, 2.0 * v, u0, order, c, place)",
        ),
        "half angle: energy": (
            "_energy(body, c)",
            "return without_fault(body, 2 * c * c - 1)",
        ),
        "half angle: pull": ("_pull(body, c)", "return without_fault(body, 2.0 * c * c - 1.0)"),
        "uplift: no prestress": ("standing_force(body, az)", "return body.g + az"),
        "uplift: prestress 1 % off": (
            "standing_force(body, az)",
            "return 1.01 * without_fault(body, az) - 0.01 * (body.g + az)",
        ),
    }
    faults = {name: Fault(file="restoring.py", change=change) for name, change in changes.items()}
    faults |= {name: _around("restoring.py", *parts) for name, parts in bodies.items()}
    faults["force at the top"] = _around(
        "forces.py",
        "top_force(body, base, ground, states, gamma)",
        "return without_fault(body, base, ground, states, 1.01 * gamma)",
    )
    # at rest the pull is along the axis: only the force in motion tells
    groups = dict.fromkeys(faults, "tendon") | {"half angle: pull": "equations"}
    return [
        Mutation(name=f"tendon, {name}", faults=(fault,), group=groups[name])
        for name, fault in faults.items()
    ]


def _engines() -> list[Mutation]:
    settings = [
        Mutation(
            name="elastic contact, mujoco",
            group="order",
            engine="mujoco",
            settings={"contact_damping_ratio": 0.01},
        )
    ]
    here = [name for name in ("mujoco", "pybullet") if name in available_engines()]
    if "pybullet" in here:
        margin = {"collision_margin": 0.04}
        settings.append(
            Mutation(
                name="default contact margin, pybullet", group="exact", engine="pybullet", settings=margin
            )
        )
    return settings + [
        Mutation(
            name=f"step ten times too large, {name}", group="exact", engine=name, settings={"time_step": 1e-3}
        )
        for name in here
    ]


def first_failure(mutation: Mutation) -> Result | None:
    """First check that detects a fault, starting with its own groups; None if none does."""
    groups = [mutation.group, *(group for group in INTERPRETED if group != mutation.group)]
    if mutation.engine:
        subject = engine(mutation.engine, **mutation.settings)
        return _failed(subject, groups, broken=False)
    with mutated(*mutation.faults) as copy:
        return _failed(reduced_model(copy), groups, broken=False)


def false_alarm() -> Result | None:
    """First failure in a copy without a fault, which would void all detections."""
    with mutated() as copy:
        return _failed(reduced_model(copy), INTERPRETED, broken=True)


def _failed(subject: Subject, groups: Sequence[str], *, broken: bool) -> Result | None:
    """First failure; `broken`: code that does not run counts too."""
    with np.errstate(all="ignore"):  # the interpreter warns of what a kernel takes
        results = (result for group in groups for result in run_checks(subject, [group]))
        failed = (result for result in results if result.failed)
        return next((each for each in failed if broken or not _does_not_run(each)), None)


def _does_not_run(result: Result) -> bool:
    # of a motion that fails a check raises a RuntimeError itself
    return result.reason == ENDS.reason and not result.note.startswith("RuntimeError: ")


def run(*, only: str = "") -> int:
    """Try the faults with names containing `only`, print a table, and return the exit code."""
    begun, missed = time.monotonic(), 0
    alarm = false_alarm()
    if alarm is not None:
        print(f"without a fault: {alarm.group}: {alarm.name} {alarm.note}")
    chosen = [mutation for mutation in mutations() if only in mutation.name]
    for mutation in chosen:
        failure = first_failure(mutation)
        missed += failure is None
        where = "MISSED" if failure is None else f"{failure.group}: {failure.name}"
        print(f"{mutation.name}: {where}", flush=True)
    print(f"{len(chosen) - missed} of {len(chosen)} faults found, in {time.monotonic() - begun:.0f} s")
    return 1 if missed or alarm is not None else 0
