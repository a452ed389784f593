"""Judge the trajectory of a rocking cylinder against a case of this benchmark; needs Python 3.10 and numpy.

    python check.py CASE TRAJECTORY.csv [--label "my code 1.2"] [--out result.json]

CASE is a folder under cases/; README.md says what a trajectory file may hold. Exit code 0: satisfied, or
caution where not every criterion could be judged; 1: not satisfied; 2: not tested, the file cannot be judged.
"""

from __future__ import annotations

import argparse
import hashlib
import json
import math
import sys
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import asdict, dataclass, replace
from functools import partial
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

# modules that read, compare and explain trajectories: beside this file in an archive, else in the checkout
sys.path.append(str(Path(__file__).resolve().parent / "../../../compare"))
from external.mistakes import (
    Change,
    Explanation,
    Mistake,
    correct,
    explanations,
    in_time_scale,
    readings,
)
from external.motion import Motion, Reference, exceeds, motion_at, pose_of
from external.table import Array, Table, Values, name_list, read_tables

LEVELS = ("exact", "good", "pass")
FEWEST_IN_WINDOW = 30
FITTED_SAMPLES = 7  # of the polynomial through a maximum of the tilt
FALLEN = 1.5  # [rad] tilt of overturned runs, which end early
ENOUGH = 4.0  # least factor by which a named mistake reduces the error
EXPLAINED_RUNS = 3  # of the worst runs, for whose mistakes all are tried
# differences that are explained: tilt [alpha] and azimuth [rad]
EXPLAINED_TILT, EXPLAINED_AZIMUTH = 3e-3, 1e-2
LEAST_LEAN = 0.05  # share of the largest tilt above which an azimuth is compared
Run = dict[str, Any]  # of case.json
Motions = dict[str, Motion]


@dataclass(frozen=True)
class Outcome:
    """One criterion: its largest error over the runs, and what exact, good and pass allow."""

    name: str
    unit: str
    error: float
    run: str  # empty where the file does not tell the error
    bounds: tuple[float, ...]

    @property
    def level(self) -> str:
        """The best level whose bound holds."""
        best = (one for one, bound in zip(LEVELS, self.bounds, strict=True) if self.error <= bound)
        return next(best, "fail") if self.run else "not given"


@dataclass(frozen=True)
class Judgement:
    """What is said of a file."""

    outcomes: tuple[Outcome, ...]
    mistakes: tuple[Mistake, ...]
    columns_not_read: tuple[str, ...]

    @property
    def judged(self) -> int:
        """Number of criteria that were judged."""
        return sum(bool(one.run) for one in self.outcomes)

    @property
    def verdict(self) -> str:
        """The lowest level of what was judged; without criteria the file is rejected."""
        levels = ("rejected", *LEVELS, "fail")
        return max((one.level for one in self.outcomes if one.run), key=levels.index, default="rejected")

    @property
    def grade(self) -> str:
        """The verdict as a grade."""
        passed = "satisfied" if self.judged == len(self.outcomes) else "caution"
        return {"fail": "not satisfied", "rejected": "not tested"}.get(self.verdict, passed)


def read_motion(run: Run, values: Values) -> Motion | None:
    """Motion that columns tell; None where a value is missing or the time does not rise."""
    size = {name: run[name] for name in ("base_radius", "mass_centre_height")}
    pose = pose_of(values, **size, recess=run["support"] == "recess")
    if not (np.all(np.diff(values["time"]) > 0.0) and np.isfinite(pose.axis).all()):
        return None
    return Motion(time=values["time"], tilt=pose.tilt, lean=pose.lean, path=pose.position)


def maxima(motion: Motion) -> Iterator[tuple[float, float, float]]:
    """Yield time [s], tilt and azimuth [rad] of each maximum of the tilt inside the run, by a polynomial fit.

    The azimuth is NaN where none is known.
    """
    tilt, half, degree = motion.tilt, FITTED_SAMPLES // 2, FITTED_SAMPLES - 1
    peaks = np.flatnonzero((tilt[1:-1] > tilt[:-2]) & (tilt[1:-1] >= tilt[2:])) + 1
    for i in peaks[(peaks >= half) & (peaks < len(tilt) - half)]:
        near = slice(i - half, i + half + 1)
        unit = motion.time[i + half] - motion.time[i - half]
        time = (motion.time[near] - motion.time[i]) / unit
        fit = np.polyfit(time, tilt[near], degree)
        roots = np.roots(np.polyder(fit))
        best = float(min(roots[np.abs(roots.imag) < 1e-9].real, key=abs, default=0.0))
        azimuth = math.nan
        if motion.lean is not None:
            turned = np.angle(motion.lean[near] * np.conj(motion.lean[i]))
            azimuth = float(np.angle(motion.lean[i]) + np.polyval(np.polyfit(time, turned, degree), best))
        yield float(motion.time[i] + best * unit), float(np.polyval(fit, best)), azimuth


def through(x: Array, X: Array, Y: NDArray[Any]) -> NDArray[Any]:
    """Cubic through the four nearest of evenly spaced samples; NaN outside them."""
    at = (x - X[0]) * (len(X) - 1) / (X[-1] - X[0])
    first = np.clip(np.floor(at).astype(int) - 1, 0, len(X) - 4)
    a, b, c, d = (at - first - k for k in range(4))
    weights = enumerate((-b * c * d / 6.0, a * c * d / 2.0, -a * b * d / 2.0, a * b * c / 6.0))
    total: NDArray[Any] = sum(weight * Y[first + k] for k, weight in weights)
    return np.where((at > -1e-6) & (at < len(X) - 1 + 1e-6), total, np.nan)


def measured(quantity: str, motion: Motion, run: Run, wanted: float) -> float:
    """Quantity of reference.json; NaN where it is not known, inf where it does not happen."""
    name, _, digits = quantity.rpartition("_")
    if name == "kept":  # energy ratio across an impact, from two maxima
        tops = [measured(f"maximum_{int(digits) + k}", motion, run, wanted) for k in (0, 1)]
        if math.inf in tops:
            return math.inf
        before, after = (math.cos(run["alpha"] * (1.0 - top)) - math.cos(run["alpha"]) for top in tops)
        return after / before
    if digits.isdigit() and name in ("turn", "period", "maximum"):  # over the first so many tilt maxima
        level = run.get("lean_level", 0.0) * run["alpha"]
        counted = (one for one in maxima(motion) if one[1] > level)
        first = [one for _, one in zip(range(int(digits)), counted, strict=False)]
        if len(first) < int(digits):
            return math.inf
        time, tilt, azimuth = first[-1]
        if name == "turn":  # revolutions are unknown from samples: nearest number to the reference
            off = azimuth - run["start"]["azimuth"] - int(digits) * wanted
            return wanted + (math.nan if math.isnan(off) else math.remainder(off, 2.0 * math.pi)) / int(
                digits
            )
        return float(time / int(digits) if name == "period" else tilt / run["alpha"])
    if quantity == "peak_tilt":
        peak = max([float(motion.tilt.max()), *(tilt for _, tilt, _ in maxima(motion))])
        return float(min(peak, 0.5 * math.pi) / run["alpha"])  # at most pi/2, the side on the ground
    if name == "slide":
        if motion.path is None:
            return math.nan
        moved = np.hypot(*(motion.path - motion.path[0]).T[:2]) / run["base_radius"]
        at_end = quantity == "slide_end"
        return float(moved[-1]) if at_end else exceeds(motion.time, moved, run["slide_level"], 3.0)
    at = exceeds(motion.time, motion.tilt, run.get("lean_level", 0.0) * run["alpha"], 3.0)
    if quantity == "lean_time":
        return at
    if motion.lean is None:
        return math.nan
    if name == "revolutions":
        turned = np.abs(np.unwrap(np.angle(motion.lean)) - run["start"]["azimuth"])
        return exceeds(motion.time, turned, 2.0 * math.pi * int(digits), 1.0)
    azimuth = float(np.angle(motion.lean[int(np.argmax(motion.time >= at))]))
    return wanted + math.remainder(azimuth - wanted, 2.0 * math.pi)


class Case:
    """A folder of the benchmark, and what it asks for; distributions by Kolmogorov and Smirnov."""

    def __init__(self, folder: Path) -> None:
        self.digest = hashlib.sha256((folder / "reference.json").read_bytes()).hexdigest()
        texts = [(folder / f"{name}.json").read_text("utf-8") for name in ("case", "accept", "reference")]
        given, self.accept, reference = (json.loads(text) for text in texts)
        self.gravity = given["gravity"]
        self.runs: dict[str, Run] = {run["name"]: run for run in given["runs"]}
        self.wanted = {(one["name"], one["run"]): one["value"] for one in reference["quantities"]}
        titles = (folder / "reference.csv").read_text("utf-8").partition("\n")[0].split(",")
        table = np.loadtxt(folder / "reference.csv", delimiter=",", skiprows=1).T
        self.table = dict(zip(titles, table, strict=True))
        self.known = {name: self.reference(name) for name in self.runs if "alpha" in self.runs[name]}

    def reference(self, name: str) -> Motion | None:
        """Motion of reference.csv of a run; None where it has none."""
        run = self.runs[name]
        own = {
            key: self.table.get(f"{key}:{name}", self.table.get(key)) for key in ("tilt", "azimuth", "x", "y")
        }
        if own["tilt"] is None or own["azimuth"] is None:
            return None
        azimuth = np.where(own["tilt"] > 0.0, own["azimuth"], 0.0) + run.get("turned", 0.0)
        path = None
        if own["x"] is not None and own["y"] is not None:
            path = np.column_stack([own["x"], own["y"], np.full_like(own["x"], run["mass_centre_height"])])
        return motion_at(self.table["time"] * run.get("time_unit", 1.0), own["tilt"], azimuth, path)

    def judge(self, motions: Motions) -> tuple[Outcome, ...]:
        """Outcome of every criterion; one whose value is unknown for some run is not judged."""
        outcomes = []
        for one in self.accept["criteria"]:
            runs = [name for name in one.get("runs", self.runs) if name in motions]
            if one["kind"] == "trace":
                errors = {name: self.difference(one, name, motions[name]) for name in runs}
            else:
                wanted = {name: self.wanted[one["name"], name] for name in runs}
                got = {n: measured(one["name"], motions[n], self.runs[n], wanted[n]) for n in runs}
                relative = one["unit"] == "relative"
                errors = {n: abs(got[n] - wanted[n]) / (abs(wanted[n]) if relative else 1.0) for n in runs}
                if one["kind"] == "distribution" and runs:
                    both = [*wanted.values(), *got.values()]
                    below = [np.searchsorted(np.sort([*v.values()]), both, "right") for v in (wanted, got)]
                    errors = {"all": float(np.max(np.abs(below[0] - below[1]))) / len(runs)}
            known = bool(errors) and not any(math.isnan(error) for error in errors.values())
            worst = max(errors, key=lambda name: errors[name]) if known else ""
            error, bounds = errors.get(worst, 0.0), tuple(one[level] for level in LEVELS)
            outcomes.append(Outcome(one["name"], one["unit"], error, worst, bounds))
        return tuple(outcomes)

    def score(self, motions: Motions) -> float:
        """Largest error over its bound for a pass."""
        return max((one.error / one.bounds[-1] for one in self.judge(motions) if one.run), default=math.inf)

    def difference(self, one: dict[str, Any], name: str, motion: Motion) -> float:
        """Root mean square difference from the reference in the window of a criterion."""
        run, known = self.runs[name], self.known[name]
        assert known is not None  # a case that compares traces has them
        assert known.lean is not None
        low, high = (edge * run.get("time_unit", 1.0) for edge in one["window"])
        inside = (motion.time >= low - 1e-9) & (motion.time <= high + 1e-9)
        time = motion.time[inside]
        if one["name"] == "path":
            if motion.path is None or known.path is None:
                return math.nan
            place, wanted = ((path[:, 0] + 1j * path[:, 1]) for path in (motion.path[inside], known.path))
            apart = np.abs(place - through(time, known.time, wanted)) / run["base_radius"]
        elif one["name"] == "tilt":
            sine = np.minimum(np.abs(through(time, known.time, known.lean)), 1.0)
            apart = np.abs(motion.tilt[inside] - np.arcsin(sine)) / run["alpha"]
        elif motion.lean is None:
            return math.nan
        else:
            apart = np.abs(motion.lean[inside] - through(time, known.time, known.lean)) / math.sin(
                run["alpha"]
            )
        finite = np.isfinite(apart)
        if np.count_nonzero(finite) < FEWEST_IN_WINDOW or time[finite][-1] - time[finite][0] < 0.9 * (
            high - low
        ):
            return math.inf
        if one.get("measure") == "largest":
            return float(apart[finite].max())
        length = (np.concatenate([step := np.diff(time), [0.0]]) + np.concatenate([[0.0], step]))[finite]
        return math.sqrt(float(np.sum(length * apart[finite] ** 2) / np.sum(length)))

    def explanations(self, name: str, values: Values) -> Iterator[Explanation]:
        """Yield what explains the difference of one run from its reference."""
        run, known = self.runs[name], self.known[name]
        if known is None:
            return
        facts = Reference(
            motion=known,
            alpha=run["alpha"],
            base_radius=run["base_radius"],
            time_scale=math.sqrt(math.hypot(run["base_radius"], run["mass_centre_height"]) / self.gravity),
            start=float(known.time[int(np.argmax(known.tilt > 0.0))]),
            is_free=run["motion"]["kind"] == "still",
            tilt_bound=EXPLAINED_TILT,
            azimuth_bound=EXPLAINED_AZIMUTH,
            least_lean=LEAST_LEAN,
        )
        yield from explanations(values, partial(read_motion, run), facts)

    def candidates(self, tables: Mapping[str, Table], names: Sequence[str]) -> Iterator[tuple[Change, ...]]:
        """Yield what explains the difference of some runs, then what may explain that of all."""
        mistakes = [one for name in names for one in self.explanations(name, tables[name].values)]
        alone = [one.mistakes[0] for one in mistakes if len(one.mistakes) == 1]
        rates = [mistake.value for mistake in alone if mistake.code == "time_scale"]
        if rates:  # an unscaled spin changes each run a little
            yield (in_time_scale(sum(rates) / len(rates)),)
        yield from (one.changes for one in mistakes)
        # from peaks alone only a wrong unit can be told
        yield from ((change,) for change in readings(tables[names[0]].values))

    def mistakes(self, tables: Mapping[str, Table], motions: Motions) -> tuple[Mistake, ...]:
        """Fewest mistakes without which the case is passed, or as much better."""
        enough = min(1.0, self.score(motions) / ENOUGH)
        worst = sorted(motions, key=lambda name: -self.score({name: motions[name]}))[:EXPLAINED_RUNS]
        for changes in self.candidates(tables, worst):
            runs = {
                name: correct(table.values, partial(read_motion, self.runs[name]), changes)
                for name, table in tables.items()
            }
            moving = {name: motion for name, motion in runs.items() if motion is not None}
            if changes and len(moving) == len(runs) and self.score(moving) <= enough:
                return tuple(change.mistake for change in changes)
        return ()


def judged(case: Case, path: Path) -> Judgement:
    """Return what is said of a file.

    Raises
    ------
    ValueError
        If the file cannot be judged.
    """
    tables = read_tables(path, "rad")
    if set(tables) == {""} and len(case.runs) == 1:
        tables = {next(iter(case.runs)): tables[""]}
    if set(tables) - set(case.runs) or (case.accept["runs"] == "all" and len(tables) < len(case.runs)):
        raise ValueError(f"the column run must name {', '.join(case.runs)}; got {name_list(list(tables))}")
    motions = {}
    for name, table in tables.items():
        steps = np.diff(table.values["time"], prepend=-math.inf)
        table.require(steps > 0.0, "time must rise")
        for column in table.values:
            table.complete(column, where=table.values["tilt"] != 0.0 if column == "azimuth" else None)
        motion = read_motion(case.runs[name], table.values)
        assert motion is not None
        motions[name] = motion
    ignored = next(iter(tables.values())).ignored
    outcomes = case.judge(motions)
    if missing := set(case.accept["needed"]) - {one.name for one in outcomes if one.run}:
        unknown = f"; columns not read: {name_list(ignored)}" if ignored else ""
        raise ValueError(
            f"the file does not give {', '.join(sorted(missing))}, which this case needs{unknown}"
        )
    judgement = Judgement(outcomes, (), ignored)
    mistakes = case.mistakes(tables, motions) if judgement.verdict != "exact" else ()
    # missing maximum of a complete file: a wrong answer
    whole = all(motion.time[-1] > 0.99 * case.runs[name]["duration"] for name, motion in motions.items())
    asked = [one for one in outcomes if one.unit in ("alpha", "b") and one.error == math.inf]
    short = [one.name for one in asked if not (whole and one.name.startswith("maximum"))]
    if short and not mistakes and all(motion.tilt.max() < FALLEN for motion in motions.values()):
        raise ValueError(f"the samples do not cover the window of {', '.join(short)}")
    return replace(judgement, mistakes=mistakes)


def main() -> int:
    """Judge one file; return the exit code."""
    parser = argparse.ArgumentParser(description=(__doc__ or "").partition("\n")[0])
    cases = {one.parent.name: one.parent for one in Path(__file__).resolve().parent.glob("cases/*/case.json")}
    parser.add_argument("case", choices=sorted(cases))
    parser.add_argument("trajectory", type=Path)
    parser.add_argument("--label", default="", help="who made it: name, version and settings of the code")
    parser.add_argument("--out", type=Path, default=Path("result.json"))
    given = parser.parse_args()
    case, reason = Case(cases[given.case]), ""
    try:
        found = judged(case, given.trajectory)
    except ValueError as error:
        found, reason = Judgement((), (), ()), str(error)
    asked = len(case.accept["criteria"])
    print(f"{given.case}: {found.verdict} ({found.grade}), judged {found.judged} of {asked} criteria")
    notes = [reason, f"columns not read: {name_list(found.columns_not_read)}" * bool(found.columns_not_read)]
    for one in found.outcomes:
        limits = "exact {:.2g}, good {:.2g}, pass {:.2g}".format(*one.bounds)
        value = f" {one.error:.3g} {one.unit} (run {one.run}; {limits})" if one.run else ""
        notes.append(f"{one.name}: {one.level}{value}")
    notes += [f"likely mistake: {mistake.words}" for mistake in found.mistakes]
    print(*(f"  {note}" for note in notes if note), sep="\n")
    criteria = [
        asdict(one) | {"level": one.level, "error": one.error if one.error < math.inf else None}
        for one in found.outcomes
    ]
    result = {
        "schema": "result/1",
        "case": given.case,
        "label": given.label,
        "verdict": found.verdict,
        "grade": found.grade,
        "judged": [found.judged, asked],
        "reason": reason,
        "criteria": criteria,
        "columns_not_read": found.columns_not_read,
        "likely_mistakes": [mistake.words for mistake in found.mistakes],
        "mistakes": [
            asdict(one) | {"value": None if math.isnan(one.value) else one.value} for one in found.mistakes
        ],
        "check": "2",
        "reference_sha256": case.digest,
    }
    given.out.write_text(json.dumps(result, indent=1) + "\n", "utf-8")
    return {"not satisfied": 1, "not tested": 2}.get(found.grade, 0)


if __name__ == "__main__":
    sys.exit(main())
