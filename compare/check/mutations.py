"""The checks, checked: one fault at a time in a copy of the reduced models, or in the engines' settings.

    python -m rockwobble.compare.check.mutations            # every fault against every layer
    python -m rockwobble.compare.check.mutations --first    # each against its own layer, to the first failure

A fault that no layer finds, or whose first failure names another part than the one that is wrong, makes
the exit code 1.
"""

from __future__ import annotations

import argparse
import sys
import time
from collections.abc import Callable, Sequence
from contextlib import ExitStack
from dataclasses import dataclass
from typing import Any

import numpy as np

import rockwobble.reduced
from rockwobble.models import Run, read_suite

from .bench import Bench
from .finding import LAYERS, Finding
from .layers import run_checks
from .mutant import Fault, mutated
from .term_faults import FILE, term_faults


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
    """Return all faults."""
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
    places = [
        ("b", "    A = I1 + h * h", "    b *= 1.01\n    A = I1 + h * h"),
        ("h", "    A = I1 + h * h", "    h *= 1.01\n    A = I1 + h * h"),
        ("I1", "    A = I1 + h * h", "    I1 *= 1.01\n    A = I1 + h * h"),
        ("I2", "    A = I1 + h * h", "    I2 *= 1.01\n    A = I1 + h * h"),
        ("A", "        A=A,", "        A=1.01 * A,"),
        ("J", "        J=I1 +", "        J=1.01 * I1 + 1.01 *"),
        ("C", "        C=I2 +", "        C=1.01 * I2 + 1.01 *"),
        ("E", "        E=h", "        E=1.01 * h"),
        ("g", "        g=gravity", "        g=1.01 * gravity"),
        ("p^2", "        p2=p2,", "        p2=1.01 * p2,"),
        ("sin(alpha)", "        sin_alpha=b", "        sin_alpha=1.01 * b"),
        ("cos(alpha)", "        cos_alpha=h", "        cos_alpha=1.01 * h"),
    ]
    found = [
        Mutation(
            name=f"1 % off everywhere: {name}",
            faults=(Fault(file="body.py", before=before, after=after),),
            layer="equations",
            named=("(18)", "(19)"),
        )
        for name, before, after in places
    ]
    size = Fault(
        file="problem.py",
        before="        cylinder=cylinder,\n        motion=motion,",
        after="        cylinder=Cylinder(semidiagonal=1.01 * cylinder.semidiagonal, "
        "tan_alpha=cylinder.tan_alpha),\n        motion=motion,",
    )
    # through the whole cylinder every term keeps its place: only scales of time and length tell
    return [
        *found,
        Mutation(name="R 1 % off", faults=(size,), layer="exact", named=("size R", "start after the uplift")),
    ]


def _structure() -> list[Mutation]:
    # the pieces keep their times, but from the 21st on they are those of the next
    skipped = (
        Fault(
            file="driver.py",
            before="    end = index + 1\n",
            after="    skipped = 1 if 20 < index < len(record) - 2 else 0\n"
            "    index += skipped\n    end = index + 1\n",
        ),
        Fault(file="driver.py", before="slope, end * time_step", after="slope, (end - skipped) * time_step"),
    )
    exchanged = Fault(
        file="problem.py",
        before="    record[:, : motion.acceleration.shape[1]] = motion.acceleration\n",
        after="    record[:, : motion.acceleration.shape[1]] = motion.acceleration\n"
        "    record = record[:, [1, 0, 2]]\n",
    )
    late = Fault(
        file="driver.py",
        before="                    lift = elapsed + wait\n",
        after="                    wait = 0.0 if wait == 0.0 else -1.0\n"
        "                    lift = elapsed + wait\n",
    )
    rolling = (
        Fault(file="kernels.py", before='"recess": march_recess', after='"recess": march_rolling'),
        Fault(file="kernels.py", before='"recess": 4', after='"recess": 8'),
    )
    leak = Fault(
        file=FILE,
        before="momentum_1 = -h * D0 * t0\n",
        after="momentum_1 = -h * D0 * t0 - 1e-6 * h * L\n",
    )
    return [
        Mutation(
            name="a sample of the record skipped", faults=skipped, layer="conserved", named=("forcing",)
        ),
        Mutation(name="components exchanged", faults=(exchanged,), layer="exact", named=("components",)),
        Mutation(name="uplift at the next sample", faults=(late,), layer="exact", named=("uplift",)),
        Mutation(name="no-twist constraint dropped", faults=rolling, layer="residual", named=("no twist",)),
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

    return [
        Mutation(
            name="default contact margin, pybullet",
            adjust=setting("pybullet", collision_margin=0.04),
            layer="agreement",
            named=("contact of pybullet",),
        ),
        Mutation(
            name="elastic contact, mujoco",
            adjust=setting("mujoco", contact_damping_ratio=0.01),
            layer="agreement",
            named=("contact of mujoco",),
        ),
        Mutation(
            name="step ten times too large, mujoco",
            adjust=coarse("mujoco"),
            layer="agreement",
            named=("time step of mujoco",),
        ),
        Mutation(
            name="step ten times too large, pybullet",
            adjust=coarse("pybullet"),
            layer="agreement",
            named=("time step of pybullet",),
        ),
    ]


def failures(
    mutation: Mutation, layers: Sequence[str], *, first: bool, kept: dict[str, Any] | None = None
) -> list[Finding]:
    """Return what failed in the layers under a fault; with `first`, no more than one finding.

    `kept` holds the engine runs that other faults have needed before.
    """
    with ExitStack() as stack:
        reduced = stack.enter_context(mutated(*mutation.faults)) if mutation.faults else rockwobble.reduced
        bench = Bench(reduced=reduced, suite=read_suite("quick"), workers=1 if first else None)
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


def names_it(mutation: Mutation, finding: Finding) -> bool:
    """Return whether a failure names the part that the fault is in."""
    return any(word in finding.part for word in mutation.named)


def main(arguments: Sequence[str] | None = None) -> int:
    """Print the table, and return the exit code."""
    parser = argparse.ArgumentParser(prog="python -m rockwobble.compare.check.mutations", description=__doc__)
    parser.formatter_class = argparse.RawDescriptionHelpFormatter
    parser.add_argument("--first", action="store_true", help="own layer only, to the first failure")
    parser.add_argument("--only", default="", help="faults whose name holds this text")
    options = parser.parse_args(arguments)
    missed = 0
    kept: dict[str, Any] = {}
    begun = time.monotonic()
    chosen = [mutation for mutation in mutations() if options.only in mutation.name]
    for mutation in chosen:
        started = time.monotonic()
        layers = [mutation.layer] if options.first else LAYERS
        found = failures(mutation, layers, first=options.first, kept=kept)
        own = [finding for finding in found if finding.layer == mutation.layer]
        right = bool(own) and names_it(mutation, own[0])
        missed += not right
        hit = list(dict.fromkeys(finding.layer for finding in found))
        verdict = "found" if right else ("found, but another part is named" if own else "MISSED")
        print(f"{verdict:8} {mutation.name} ({time.monotonic() - started:.1f} s)")
        if own:
            print(f"         {own[0].layer}: {own[0].part}; {own[0].note}")
        if not options.first:
            print(f"         in {len(found)} checks of {', '.join(hit) or 'no layer'}")
        sys.stdout.flush()
    print(
        f"{len(chosen) - missed} of {len(chosen)} faults found and named, in {time.monotonic() - begun:.0f} s"
    )
    return 1 if missed else 0


if __name__ == "__main__":
    sys.exit(main())
