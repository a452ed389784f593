"""The files in which faults are sought, in groups, and a sample of their faults.

A pattern that matches no file is an error: who moves or renames a file moves its pattern.
"""

from __future__ import annotations

import ast
import math
import random
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

from .names import signatures_of
from .sites import GeneratedFault, faults_of

PACKAGES = ("models", "reduced", "multibody", "compare")


@dataclass(frozen=True, slots=True, kw_only=True)
class Group:
    """Files of one sort.

    Parameters
    ----------
    name : str
    patterns : tuple of str
        Of their paths in the checkout.
    layers : tuple of str
        Groups of checks that are likely to find a fault, the likeliest first; the others follow. One that
        the check does not have is passed over.
    """

    name: str
    patterns: tuple[str, ...]
    layers: tuple[str, ...]


GROUPS = (
    Group(
        name="records",
        patterns=(
            "models/records/at2_file.py",
            "models/records/column_file.py",
            "models/records/el_centro.py",
            "models/ground_motion.py",
            "models/records/p695.py",
            "models/pulses.py",
            "models/records/files.py",
            "models/records/units.py",
            "models/records/component.py",
        ),
        layers=("conserved", "exact", "invariance"),
    ),
    Group(
        name="bodies, cases and suites",
        patterns=(
            "models/case.py",
            "models/cylinder.py",
            "models/initial_state.py",
            "models/suites/build.py",
            "models/suites/motion.py",
        ),
        layers=("exact", "equations"),
    ),
    Group(
        name="reduced, compiled",
        patterns=(
            "reduced/body.py",
            "reduced/integration/driver.py",
            "reduced/integration/endings.py",
            "reduced/integration/events.py",
            "reduced/integration/log.py",
            "reduced/integration/progress.py",
            "reduced/integration/record.py",
            "reduced/integration/recurrences.py",
            "reduced/integration/result.py",
            "reduced/integration/sampling.py",
            "reduced/integration/stepping.py",
            "reduced/integration/systems.py",
            "reduced/integration/taylor.py",
            "reduced/trigonometry.py",
            "reduced/integration/tsit5.py",
            "reduced/integration/uplift.py",
        ),
        layers=("exact", "equations", "rest", "conserved", "invariance"),
    ),
    Group(
        name="reduced, around it",
        patterns=(
            "reduced/assumptions.py",
            "reduced/batch.py",
            "reduced/columns.py",
            "reduced/equations.py",
            "reduced/forces.py",
            "reduced/kernels.py",
            "reduced/problem.py",
            "reduced/solution.py",
            "reduced/simulation.py",
        ),
        layers=("exact", "rest", "equations", "trace"),
    ),
    Group(
        name="exact solutions",
        patterns=("reduced/exact/*.py",),
        layers=("exact",),
    ),
    Group(
        name="engines",
        patterns=(
            "multibody/body.py",
            "multibody/scene/excitation.py",
            "multibody/scene/friction.py",
            "multibody/scene/froude.py",
            "multibody/engines/*_engine.py",
            "multibody/engines/mujoco_ring.py",
            "multibody/engines/mujoco_scene.py",
            "multibody/scene/ring_geometry.py",
            "multibody/scene_of_case.py",
            "multibody/start.py",
        ),
        layers=("agreement", "exact", "baseline"),
    ),
    Group(
        name="traces of engines",
        patterns=(
            "multibody/time_step/*.py",
            "multibody/recording/forces.py",
            "multibody/scene/guard.py",
            "multibody/kinematics.py",
            "multibody/recording/passes.py",
            "multibody/recording/recorder.py",
            "multibody/simulation.py",
            "multibody/recording/diagnostics.py",
            "multibody/recording/uplift.py",
            "multibody/recording/wall_watch.py",
        ),
        layers=("agreement", "exact", "baseline"),
    ),
    Group(
        name="metrics",
        patterns=(
            "compare/metrics/contact.py",
            "compare/metrics/distributions.py",
            "compare/metrics/energy.py",
            "compare/metrics/agreement.py",
            "compare/comparison/prediction.py",
            "compare/comparison/summary.py",
            "compare/metrics/tilt.py",
            "compare/traces/pair.py",
            "compare/metrics/turning.py",
        ),
        layers=("conserved", "agreement"),
    ),
    Group(
        name="studies",
        patterns=(
            "compare/studies/spectrum/search.py",
            "compare/studies/spectrum/series.py",
            "compare/studies/spectrum/study.py",
            "compare/studies/sweep/grid.py",
        ),
        layers=(),
    ),
)


def files_of(group: Group, root: Path) -> list[Path]:
    """Return the files of a group in the checkout `root`.

    Raises
    ------
    ValueError
        If a pattern matches none.
    """
    found: dict[Path, None] = {}
    for pattern in group.patterns:
        matched = sorted(path for path in root.glob(pattern) if path.name != "__init__.py")
        if not matched:
            raise ValueError(f"the files of the group {group.name!r} must be there, got none for {pattern}")
        found |= dict.fromkeys(matched)
    return list(found)


def all_faults(root: Path) -> dict[str, list[GeneratedFault]]:
    """Return the faults of every file that is named in `GROUPS`, by the path of the file."""
    sources = [path for package in PACKAGES for path in sorted((root / package).rglob("*.py"))]
    signatures = signatures_of(ast.parse(path.read_text(encoding="utf-8")) for path in sources)
    return {
        file: list(faults_of(file, path.read_text(encoding="utf-8"), signatures))
        for group in GROUPS
        for path in files_of(group, root)
        for file in [path.relative_to(root).as_posix()]
    }


def group_of(file: str) -> Group:
    """Return the group of a file.

    Raises
    ------
    ValueError
        If it belongs to none.
    """
    for group in GROUPS:
        if any(Path(file).match(pattern) for pattern in group.patterns):
            return group
    raise ValueError(f"a fault must be in a file of the groups, got {file}")


def sample(faults: dict[str, list[GeneratedFault]], count: int, seed: int) -> list[GeneratedFault]:
    """Return `count` faults, or all there are, drawn from every file and from every kind.

    A file gets a share that goes with the root of the number of its faults, so that long ones do not
    crowd out short ones; in a file the kinds take turns. The order is made so that any part of the
    sample from its beginning on is spread over the files, too.
    """
    shares = {file: math.sqrt(len(each)) for file, each in faults.items() if each}
    drawn: list[tuple[float, GeneratedFault]] = []
    for file, share in shares.items():
        random_of_file = random.Random(f"{seed} {file}")
        offset = random_of_file.random()
        turns = _in_turns(faults[file], random_of_file)
        # the times at which a file takes its turn: evenly apart, the closer the larger its share
        drawn += [((place + offset) / share, fault) for place, fault in enumerate(turns)]
    drawn.sort(key=lambda each: (each[0], each[1].name))
    return [fault for _, fault in drawn[:count]]


def _in_turns(faults: Sequence[GeneratedFault], chosen_by: random.Random) -> list[GeneratedFault]:
    of_kind: dict[str, list[GeneratedFault]] = {}
    for fault in faults:
        of_kind.setdefault(fault.kind, []).append(fault)
    for each in of_kind.values():
        chosen_by.shuffle(each)
    kinds = list(of_kind)
    chosen_by.shuffle(kinds)
    found = []
    while any(of_kind.values()):
        found += [of_kind[kind].pop() for kind in kinds if of_kind[kind]]
    return found
