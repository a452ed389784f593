"""Faults chosen by hand: one at a time in a copy of the reduced models, or in the engines' settings.

    python tests/mutation listed            # every fault against every layer
    python tests/mutation listed --first    # each against its own layer, to the first failure

A fault that no layer finds, or whose first failure names another part than the one that is wrong, makes
the exit code 1; and so does, where every layer is asked, a failure in a copy without a fault.
"""

from __future__ import annotations

import sys
import time
from collections.abc import Callable, Sequence
from contextlib import ExitStack
from dataclasses import dataclass
from typing import Any

import numpy as np

import rockwobble.reduced
from rockwobble.compare.check import LAYERS, Bench, Finding, run_checks
from rockwobble.compare.check.bench import engines_here
from rockwobble.compare.runs.choice import runs_here
from rockwobble.models import Run, Suite, read_suite

from .mutant import Fault, mutated
from .places import after_assignment, appended, before_assignment, scaled_argument, wrapped
from .term_faults import FILE, term_faults

# asked of a copy without a fault: the others, solutions to 1e-13 and suites, are too long in the interpreter
_INTERPRETED = [layer for layer in LAYERS if layer not in ("order", "agreement", "baseline")]


@dataclass(frozen=True, slots=True, kw_only=True)
class Mutation:
    """One fault, and what must find it.

    Parameters
    ----------
    name : str
    faults : tuple of Fault
        In the sources of the reduced models; empty for a fault in an engine.
    adjust : callable, optional
        Changes the settings of an engine run.
    layer : str
        Which must find it.
    named : tuple of str
        Words one of which must be in the part that the first failure names.
    """

    name: str
    faults: tuple[Fault, ...] = ()
    adjust: Callable[[Run], Run] | None = None
    layer: str
    named: tuple[str, ...]


def mutations() -> tuple[Mutation, ...]:
    """Return all faults; those of engines are faults of the standard engines."""
    return (
        *_terms(1.01, "1 % off"),
        *_terms(-1.0, "sign"),
        *_constants(),
        *_structure(),
        *_engines(),
    )


def _terms(factor: float, word: str) -> list[Mutation]:
    """Every term of (18) and (19), wherever it stands: at the start of a step and in its series."""
    return [
        Mutation(name=f"{word}: {each.name}", faults=(each.fault,), layer="equations", named=each.equations)
        for each in term_faults(factor)
    ]


def _constants() -> list[Mutation]:
    """Constants of the body 1 % off, wherever they are used; R off through the cylinder itself."""
    # those of which others are made are changed before A, the first that is made of them
    made_of = {"b": "b", "h": "h", "I1": "I1", "I2": "I2"}
    changes = {
        name: before_assignment("body_of", "A", f"{symbol} *= 1.01") for name, symbol in made_of.items()
    }
    fields = ("A", "J", "C", "E", "g", "p2", "sin_alpha", "cos_alpha")
    changes |= {name: scaled_argument("body_of", "Body", name, 1.01) for name in fields}
    found = [
        Mutation(
            name=f"1 % off everywhere: {name}",
            faults=(Fault(file="body.py", change=change),),
            layer="equations",
            named=("(18)", "(19)"),
        )
        for name, change in changes.items()
    ]
    # through the whole cylinder every term keeps its place: only scales of time and length tell
    size = _around(
        "problem.py",
        "make_problem(case, **options)",
        "size = 1.01 * case.cylinder.semidiagonal\n"
        "other = Cylinder(semidiagonal=size, tan_alpha=case.cylinder.tan_alpha)\n"
        "return without_fault(dataclasses.replace(case, cylinder=other), **options)",
    )
    return [
        *found,
        Mutation(name="R 1 % off", faults=(size,), layer="exact", named=("size R", "start after the uplift")),
    ]


def _around(file: str, head: str, body: str) -> Fault:
    """Return the fault of a function that calls the one of its name as `without_fault`."""
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
    exchanged = _around("columns.py", "three_columns(motion)", "return without_fault(motion)[:, [1, 0, 2]]")
    late = _around(
        "integration/uplift.py",
        "uplift_in(*arguments)",
        "return 0.0 if without_fault(*arguments) == 0.0 else -1.0",
    )
    rolling = Fault(
        file="kernels.py", change=appended('INTEGRATORS["recess"], SIZES["recess"] = integrate_flat, 8')
    )
    leak = Fault(file=FILE, change=after_assignment("expand", "momentum_1", "momentum_1 -= 1e-6 * h * L"))
    return [
        Mutation(
            name="a sample of the record skipped", faults=(skipped,), layer="conserved", named=("forcing",)
        ),
        Mutation(name="components exchanged", faults=(exchanged,), layer="exact", named=("components",)),
        Mutation(name="uplift at the next sample", faults=(late,), layer="exact", named=("uplift",)),
        Mutation(
            name="no-twist constraint dropped", faults=(rolling,), layer="residual", named=("no twist",)
        ),
        Mutation(name="L decays", faults=(leak,), layer="conserved", named=("L",)),
    ]


def _engines() -> list[Mutation]:
    def setting(engine: str, **settings: float) -> Callable[[Run], Run]:
        def adjust(run: Run) -> Run:
            if run.engine != engine:
                return run
            return Run(run.engine, run.support, run.time_step, **{**run.settings, **settings})

        return adjust

    def coarse(engine: str) -> Callable[[Run], Run]:
        return lambda run: Run(engine, run.support, 1e-3, **run.settings) if run.engine == engine else run

    found = [
        Mutation(
            name="elastic contact, mujoco",
            adjust=setting("mujoco", contact_damping_ratio=0.01),
            layer="agreement",
            named=("contact of mujoco",),
        )
    ]
    if "pybullet" in engines_here():
        margin = setting("pybullet", collision_margin=0.04)
        named = ("contact of pybullet",)
        found.append(
            Mutation(name="default contact margin, pybullet", adjust=margin, layer="agreement", named=named)
        )
    return found + [
        Mutation(
            name=f"step ten times too large, {engine}",
            adjust=coarse(engine),
            layer="agreement",
            named=(f"time step of {engine}",),
        )
        for engine in engines_here()
    ]


def failures(
    mutation: Mutation, layers: Sequence[str], *, first: bool, kept: dict[str, Any] | None = None
) -> list[Finding]:
    """Return what failed in the layers under a fault; with `first`, no more than one finding.

    `kept` holds the engine runs that other faults have needed before.
    """
    with ExitStack() as stack:
        reduced = stack.enter_context(mutated(*mutation.faults)) if mutation.faults else rockwobble.reduced
        quick = read_suite("quick")
        suite = Suite(quick.cases, runs_here(quick.runs)[0], quick.bounds)
        bench = Bench(reduced=reduced, suite=suite, workers=1 if first else None)
        bench.kept = {} if kept is None else kept
        if mutation.adjust is not None:
            bench.adjust = mutation.adjust
        found = []
        stack.enter_context(np.errstate(all="ignore"))  # the interpreter warns of what a kernel takes
        for finding in run_checks(bench, layers):
            if finding.failed:
                found.append(finding)
                if first:
                    break
        return found


def false_alarm(layers: Sequence[str]) -> Finding | None:
    """Return what fails first in a copy without a fault: then a failure in one with a fault shows nothing."""
    with mutated() as copy:
        bench = Bench(reduced=copy, suite=read_suite("quick"), workers=1)
        return next((finding for finding in run_checks(bench, layers) if finding.failed), None)


def names_it(mutation: Mutation, finding: Finding) -> bool:
    """Return whether a failure names the part that the fault is in."""
    return any(word in finding.part for word in mutation.named)


def run(*, only: str = "", first: bool = False) -> int:
    """Try the faults whose name holds the text `only`, print the table, and return the exit code.

    With `first`, each is held against its own layer alone, to the first failure.
    """
    kept: dict[str, Any] = {}
    begun = time.monotonic()
    alarm = None if first else false_alarm(_INTERPRETED)
    if alarm is not None:
        print(f"without a fault: {alarm.layer}: {alarm.name}: {alarm.part}; {alarm.note}")
    missed = 0
    chosen = [mutation for mutation in mutations() if only in mutation.name]
    for mutation in chosen:
        started = time.monotonic()
        layers = [mutation.layer] if first else LAYERS
        found = failures(mutation, layers, first=first, kept=kept)
        own = [finding for finding in found if finding.layer == mutation.layer]
        right = bool(own) and names_it(mutation, own[0])
        missed += not right
        hit = list(dict.fromkeys(finding.layer for finding in found))
        verdict = "found" if right else ("found, but another part is named" if own else "MISSED")
        print(f"{verdict:8} {mutation.name} ({time.monotonic() - started:.1f} s)")
        if own:
            print(f"         {own[0].layer}: {own[0].part}; {own[0].note}")
        if not first:
            print(f"         in {len(found)} checks of {', '.join(hit) or 'no layer'}")
        sys.stdout.flush()
    print(
        f"{len(chosen) - missed} of {len(chosen)} faults found and named, in {time.monotonic() - begun:.0f} s"
    )
    return 1 if missed or alarm is not None else 0
