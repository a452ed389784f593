"""Judge the trajectory of a rocking cylinder against a case of this benchmark; needs Python 3.10 and numpy.

    python check.py CASE TRAJECTORY.csv [--label "my code 1.2"] [--out result.json]

CASE is a folder under cases/; README.md says what a trajectory file may hold. Exit code 0: passed (as pass,
good or exact); 1: failed; 2: rejected, because the file cannot be judged. The lean is sin(tilt) times
(cos(azimuth), sin(azimuth)), as a complex number: near upright it is smooth where tilt and azimuth are not.
"""

from __future__ import annotations

import argparse
import csv
import hashlib
import json
import math
import sys
from collections.abc import Callable, Iterator
from dataclasses import asdict, dataclass, replace
from functools import partial
from pathlib import Path
from typing import Any

import numpy as np

LEVELS = ("exact", "good", "pass")
UNITS = {"": 1.0, "-": 1.0, "s": 1.0, "ms": 1e-3, "rad": 1.0, "deg": math.pi / 180.0, "m": 1.0, "mm": 1e-3}
ANGLES, QUATERNION, POSITION = ("tilt", "azimuth"), ("qw", "qx", "qy", "qz"), ("x", "y", "z")
KNOWN = ("time", *ANGLES, *QUATERNION, *POSITION)
FEWEST, FITTED = 30, 7  # samples in a window; samples of the polynomial through a maximum of the tilt
FALLEN, ENOUGH = 1.5, 4.0  # [rad]: what fell ends early; a mistake named reduces the error so many times
Columns = dict[str, np.ndarray]


class RejectedError(Exception):
    """A file that cannot be judged, and why."""


@dataclass(frozen=True)
class Motion:
    """One run: time [s], tilt [rad] and lean, each (n,), mass centre (n, 3) [m]; NaN where not told."""

    time: np.ndarray
    tilt: np.ndarray
    lean: np.ndarray
    path: np.ndarray


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


Motions = dict[str, Motion]
Change = tuple[str, Callable[[Any], Any]]  # the words for a mistake, and what takes it back


def read_csv(path: Path) -> dict[str, Columns]:
    """Return the columns of each run, in SI units and radians as far as the header tells the units."""
    try:
        lines = [line for line in path.read_text("utf-8-sig").splitlines() if line.strip(" ,;\t")]
    except (OSError, UnicodeDecodeError) as error:
        raise RejectedError(f"{path.name} cannot be read: {error}") from None
    if len(lines := [line for line in lines if not line.startswith("#")]) < 2:
        raise RejectedError(f"{path.name} has no samples")
    titles, *rows = csv.reader(lines, delimiter=max(",;\t", key=lines[0].count))
    values: Columns = {}
    for i, title in enumerate(titles):
        name, _, unit = title.lower().replace("(", "[").partition("[")
        name, unit = name.strip(), unit.strip(" )]")
        if name in KNOWN and unit not in UNITS:
            raise RejectedError(f"the unit of {name} must be one of {', '.join(list(UNITS)[1:])}, got {unit}")
        try:
            cells, factor = [row[i].strip() for row in rows], UNITS.get(unit, 1.0)
            values[name] = np.array(cells if name == "run" else [float(c or "nan") * factor for c in cells])
        except (ValueError, IndexError):
            if name in KNOWN:
                raise RejectedError(f"a cell of {name} is missing or is not a number") from None
    of_run = values.pop("run", np.array([""] * len(rows)))
    runs = dict.fromkeys(of_run.tolist())
    return {run: {name: column[of_run == run] for name, column in values.items()} for run in runs}


def motion_of(columns: Columns, run: dict[str, Any]) -> Motion:
    """Return the motion that the columns tell."""
    time = columns.get("time", np.array([]))
    if not len(time) or not np.all(np.diff(time) > 0.0):
        raise RejectedError("there must be a column time, of numbers that rise")
    lean, path = np.full(len(time), np.nan + 0j), np.full((len(time), 3), np.nan)
    if set(POSITION) <= set(columns):
        path = np.column_stack([columns[one] for one in POSITION])
    if set(QUATERNION) <= set(columns):
        w, x, y, z = (columns[one] for one in QUATERNION)
        size = w * w + x * x + y * y + z * z
        lean = 2.0 * ((x * z + w * y) + 1j * (y * z - w * x)) / size
        tilt = np.arctan2(np.abs(lean), (w * w - x * x - y * y + z * z) / size)
    elif "tilt" in columns:
        tilt = columns["tilt"]
        if "azimuth" in columns:
            lean = np.sin(tilt) * np.exp(1j * np.where(tilt == 0.0, 0.0, columns["azimuth"]))
    else:  # the height of the mass centre is R cos(alpha - tilt)
        share = path[:, 2] / math.hypot(run["base_radius"], run["mass_centre_height"])
        tilt = run["alpha"] - np.arccos(np.clip(share, -1.0, 1.0))
        if run["support"] == "recess":
            lean = np.sin(tilt) * np.exp(1j * np.arctan2(path[:, 1], path[:, 0]))
    if np.any(np.isnan(tilt)) or np.any(np.isnan(lean)) != np.all(np.isnan(lean)):
        raise RejectedError("there must be tilt; or qw, qx, qy, qz; or x, y, z; with a value in each row")
    return Motion(time, np.abs(tilt), lean, path)


def through(x: np.ndarray, X: np.ndarray, Y: np.ndarray) -> np.ndarray:
    """Return the cubic through the four nearest of evenly spaced samples; NaN outside them."""
    at = (x - X[0]) * (len(X) - 1) / (X[-1] - X[0])
    first = np.clip(np.floor(at).astype(int) - 1, 0, len(X) - 4)
    a, b, c, d = (at - first - k for k in range(4))
    weights = enumerate((-b * c * d / 6.0, a * c * d / 2.0, -a * b * d / 2.0, a * b * c / 6.0))
    total = sum(weight * Y[first + k] for k, weight in weights)
    return np.where((at > -1e-6) & (at < len(X) - 1 + 1e-6), total, np.nan)


def maxima(motion: Motion) -> Iterator[tuple[float, float, float]]:
    """Yield time, tilt and azimuth of each maximum of the tilt inside the run."""
    tilt, half, degree = motion.tilt, FITTED // 2, FITTED - 1
    peaks = np.flatnonzero((tilt[1:-1] > tilt[:-2]) & (tilt[1:-1] >= tilt[2:])) + 1
    for i in peaks[(peaks >= half) & (peaks < len(tilt) - half)]:
        near = slice(i - half, i + half + 1)
        unit = motion.time[i + half] - motion.time[i - half]
        time = (motion.time[near] - motion.time[i]) / unit
        fit = np.polyfit(time, tilt[near], degree)
        roots = np.roots(np.polyder(fit))
        best = float(min(roots[np.abs(roots.imag) < 1e-9].real, key=abs, default=0.0))
        turned = np.nan_to_num(np.angle(motion.lean[near] * np.conj(motion.lean[i])))
        azimuth = np.angle(motion.lean[i]) + np.polyval(np.polyfit(time, turned, degree), best)
        yield float(motion.time[i] + best * unit), float(np.polyval(fit, best)), float(azimuth)


def exceeds(time: np.ndarray, value: np.ndarray, level: float, power: float) -> float:
    """Return when a value first exceeds a level; its root of that power is linear between samples."""
    i = int(np.argmax(value > level))
    if i == 0:
        return float(time[0]) if value[0] > level else math.nan if np.isnan(value[0]) else math.inf
    low, high = np.maximum(value[i - 1 : i + 1], 0.0) ** (1.0 / power)
    return float(time[i - 1] + (time[i] - time[i - 1]) * (level ** (1.0 / power) - low) / (high - low))


def measured(quantity: str, motion: Motion, run: dict[str, Any], wanted: float) -> float:
    """Return a quantity of reference.json; NaN where it is not told, inf where it does not happen."""
    name, _, digits = quantity.rpartition("_")
    if digits.isdigit() and name in ("turn", "period", "maximum"):  # of the first so many tilt maxima
        found = [one for _, one in zip(range(int(digits)), maxima(motion), strict=False)]
        if len(found) < int(digits):
            return math.inf
        time, tilt, azimuth = found[-1]
        if name == "turn":  # samples do not tell revolutions apart: of all, the nearest to the reference
            off = azimuth - run["start"]["azimuth"] - int(digits) * wanted
            return wanted + math.remainder(off, 2.0 * math.pi) / int(digits)
        return float(time / int(digits) if name == "period" else tilt / run["alpha"])
    if name == "revolutions":
        turned = np.abs(np.unwrap(np.angle(motion.lean)) - run["start"]["azimuth"])
        return exceeds(motion.time, turned, 2.0 * math.pi * int(digits), 1.0)
    if quantity == "slide_time":
        moved = np.hypot(*(motion.path - motion.path[0]).T[:2])
        return exceeds(motion.time, moved, run["slide_level"] * run["base_radius"], 3.0)
    if quantity == "peak_tilt":
        peak = max([float(motion.tilt.max()), *(tilt for _, tilt, _ in maxima(motion))])
        return float(min(peak, 0.5 * math.pi) / run["alpha"])  # no more than the side on the ground
    at = exceeds(motion.time, motion.tilt, run["lean_level"] * run["alpha"], 3.0)
    azimuth = float(np.angle(motion.lean[int(np.argmax(motion.time >= at))]))
    return at if quantity == "lean_time" else wanted + math.remainder(azimuth - wanted, 2.0 * math.pi)


class Case:
    """A folder of the benchmark, and what it asks for; distributions by Kolmogorov and Smirnov."""

    def __init__(self, folder: Path) -> None:
        self.digest = hashlib.sha256((folder / "reference.json").read_bytes()).hexdigest()
        texts = [(folder / f"{name}.json").read_text("utf-8") for name in ("case", "accept", "reference")]
        given, self.accept, reference = (json.loads(text) for text in texts)
        self.runs = {run["name"]: run for run in given["runs"]}
        self.wanted = {(one["name"], one["run"]): one["value"] for one in reference["quantities"]}
        self.table = read_csv(folder / "reference.csv")[""]
        self.known, nothing = {}, np.array([])  # path and lean, computed once: clocks asks a thousand times
        for name, run in self.runs.items():
            own = {key: self.table.get(f"{key}:{name}", self.table.get(key, nothing)) for key in KNOWN}
            azimuth = np.where(own["tilt"] > 0.0, own["azimuth"], 0.0) + run.get("turned", 0.0)
            self.known[name] = own["x"] + 1j * own["y"], np.sin(own["tilt"]) * np.exp(1j * azimuth)

    def judge(self, motions: Motions) -> list[Outcome]:
        """Return the outcome of every criterion; what is told of some runs only is not told."""
        outcomes = []
        for one in self.accept["criteria"]:
            runs = [name for name in one.get("runs", self.runs) if name in motions]
            if one["kind"] == "trace":
                found = {name: self.difference(one, name, motions[name]) for name in runs}
            else:
                wanted = {name: self.wanted[one["name"], name] for name in runs}
                got = {n: measured(one["name"], motions[n], self.runs[n], wanted[n]) for n in runs}
                relative = one["unit"] == "relative"
                found = {n: abs(got[n] - wanted[n]) / (abs(wanted[n]) if relative else 1.0) for n in runs}
                if one["kind"] == "distribution" and runs:
                    both = [*wanted.values(), *got.values()]
                    below = [np.searchsorted(np.sort([*v.values()]), both, "right") for v in (wanted, got)]
                    found = {"all": float(np.max(np.abs(below[0] - below[1]))) / len(runs)}
            told = bool(found) and not any(math.isnan(error) for error in found.values())
            worst = max(found, key=lambda name: found[name]) if told else ""
            error, bounds = found.get(worst, 0.0), tuple(one[level] for level in LEVELS)
            outcomes.append(Outcome(one["name"], one["unit"], error, worst, bounds))
        return outcomes

    def score(self, motions: Motions) -> float:
        """Return the largest error over its bound for a pass."""
        return max((one.error / one.bounds[-1] for one in self.judge(motions) if one.run), default=math.inf)

    def difference(self, one: dict[str, Any], name: str, motion: Motion) -> float:
        """Return the root mean square difference from the reference in the window of a criterion."""
        run, unit = self.runs[name], self.runs[name].get("time_unit", 1.0)
        low, high = one["window"][0] * unit, one["window"][1] * unit
        inside = (motion.time >= low - 1e-9) & (motion.time <= high + 1e-9)
        time, clock, (path, lean) = motion.time[inside], self.table["time"] * unit, self.known[name]
        if one["name"] == "path":
            place = motion.path[inside, 0] + 1j * motion.path[inside, 1]
            apart = np.abs(place - through(time, clock, path)) / run["base_radius"]
        elif one["name"] == "tilt":
            sine = np.minimum(np.abs(through(time, clock, lean)), 1.0)
            apart = np.abs(motion.tilt[inside] - np.arcsin(sine)) / run["alpha"]
        else:
            apart = np.abs(motion.lean[inside] - through(time, clock, lean)) / math.sin(run["alpha"])
        if np.all(np.isnan(apart)) and len(apart):
            return math.nan
        known = np.isfinite(apart)
        if np.count_nonzero(known) < FEWEST or time[known][-1] - time[known][0] < 0.9 * (high - low):
            return math.inf
        if one.get("measure") == "largest":
            return float(apart[known].max())
        length = (np.concatenate([step := np.diff(time), [0.0]]) + np.concatenate([[0.0], step]))[known]
        return math.sqrt(float(np.sum(length * apart[known] ** 2) / np.sum(length)))


def units(columns: Columns) -> Iterator[Change]:
    """Yield the mistakes in units and in the order of components."""

    def scaled(factor: float, *names: str) -> Callable[[Columns], Columns]:
        return lambda given: {key: value * factor if key in names else value for key, value in given.items()}

    def quaternion(letters: str, sign: int) -> Callable[[Columns], Columns]:
        signs = [1 if letter == "w" else sign for letter in letters]
        taken = [(q, f"q{letter}", s) for q, letter, s in zip(QUATERNION, letters, signs, strict=True)]
        return lambda given: {**given, **{q: s * given[own] for q, own, s in taken}}

    if "tilt" in columns:
        yield "angles are in degrees, not radians", scaled(math.pi / 180.0, *ANGLES)
        yield "the azimuth is in degrees, not radians", scaled(math.pi / 180.0, "azimuth")
    if set(POSITION) <= set(columns):
        yield "lengths are in mm, not m", scaled(1e-3, *POSITION)
        yield "z points down", scaled(-1.0, "z")
    if set(QUATERNION) <= set(columns):
        yield "the quaternion has its scalar last, not first", quaternion("zwxy", 1)
        yield "the quaternion is inverse: from world to body", quaternion("wxyz", -1)
    yield "times are in ms, not s", scaled(1e-3, "time")


AXES = {
    "x and y are reversed: turned by 180 degrees": (-1, False),
    "the axes are turned by 90 degrees": (1j, False),
    "the axes are turned by -90 degrees": (-1j, False),
    "y is reversed: left-handed axes, or an azimuth that runs clockwise": (1, True),
    "x is reversed: left-handed axes": (-1, True),
    "x and y are swapped: left-handed axes": (1j, True),
    "x and y are swapped and reversed: left-handed axes": (-1j, True),
}


def axes(motion: Motion) -> Iterator[Change]:
    """Yield the mistakes in the axes: horizontal vectors mirrored in x, then turned, and z reversed."""
    down = bool(np.median(motion.tilt) > 0.5 * math.pi)

    def mapped(given: Motion, turn: complex, mirrored: bool) -> Motion:
        flat = given.path[:, 0] + 1j * given.path[:, 1]
        flat, lean = (turn * (z.conj() if mirrored else z) for z in (flat, given.lean))
        path = np.column_stack([flat.real, flat.imag, given.path[:, 2]])
        return Motion(given.time, math.pi - given.tilt if down else given.tilt, lean, path)

    told = AXES if np.isfinite([motion.lean, *motion.path.T]).any() else {}  # the tilt alone has no axes
    for text, (turn, mirrored) in [*([("", (1, False))] if down else []), *told.items()]:
        words = " and ".join(filter(None, ("z points down" if down else "", text)))
        yield words, partial(mapped, turn=turn, mirrored=mirrored)


def clocks(case: Case, motions: Motions) -> Iterator[Change]:
    """Yield an offset and a wrong rate of the clock, as the tilts tell them."""
    tilts = [one for one in case.accept["criteria"] if one["kind"] == "trace" and one["name"] == "tilt"]
    asked = [({**one, "measure": ""}, n) for one in tilts for n in one.get("runs", case.runs) if n in motions]

    def clocked(given: Motion, shift: float = 0.0, rate: float = 1.0) -> Motion:
        return replace(given, time=rate * given.time + shift)

    def fitted(name: str, centre: float, width: float) -> float:
        for _ in range(6):
            least, tried = math.inf, (centre + width * np.linspace(-1.0, 1.0, 61)).tolist()
            centre, width = tried[0], 0.1 * width
            for value in tried:
                worst = 0.0
                for one, run in asked:
                    if worst < least:  # else this value is no better, whatever the other runs say
                        worst = max(worst, case.difference(one, run, clocked(motions[run], **{name: value})))
                least, centre = min((least, centre), (worst, value))
        return centre

    if asked:
        shift = fitted("shift", 0.0, 0.3 * max(motion.time[-1] for motion in motions.values()))
        yield f"times are off by {-shift:.4g} s", partial(clocked, shift=shift)
        rate = fitted("rate", 1.0, 0.1)
        yield f"it moves as a body of {100 * (rate**-2 - 1):+.2g} % in size (R)", partial(clocked, rate=rate)


def mistakes(case: Case, columns: dict[str, Columns], motions: Motions) -> tuple[str, ...]:
    """Return the fewest mistakes that explain why a case is not passed, or not as well as it might be."""
    nothing: list[Change] = [("", lambda given: given)]
    candidates: list[tuple[tuple[str, ...], Motions]] = []
    fits: dict[bytes, list[Change]] = {}  # by times and tilts, which tell the clock: most changes keep them
    first, before = next(iter(motions)), case.score(motions)
    for unit, convert in [*nothing, *units(columns[first])]:
        runs = {name: motion_of(convert(given), case.runs[name]) for name, given in columns.items()}
        for frame, turn in [*nothing, *axes(runs[first])]:
            turned = {name: turn(motion) for name, motion in runs.items()}
            told = b"".join(m.time.tobytes() + m.tilt.tobytes() for m in turned.values())
            for clock, correct in fits.setdefault(told, fits.get(told) or [*nothing, *clocks(case, turned)]):
                said = tuple(filter(None, (unit, frame, clock)))
                candidates.append((said, {name: correct(motion) for name, motion in turned.items()}))
    for count in (1, 2, 3):
        alike = [(case.score(other), said) for said, other in candidates if len(said) == count]
        best, said = min(alike, default=(math.inf, ()))
        if best <= min(1.0, before / ENOUGH):
            return said
    return ()


def judged(case: Case, path: Path) -> tuple[str, list[Outcome], tuple[str, ...]]:
    """Return the verdict on a file, the outcomes, and likely mistakes."""
    columns = read_csv(path)
    if set(columns) == {""} and len(case.runs) == 1:
        columns = {next(iter(case.runs)): columns[""]}
    if set(columns) - set(case.runs) or (case.accept["runs"] == "all" and len(columns) < len(case.runs)):
        raise RejectedError(f"the column run must name {', '.join(case.runs)}; got {', '.join(columns)}")
    motions = {name: motion_of(columns[name], case.runs[name]) for name in columns}
    found = case.judge(motions)
    if missing := set(case.accept["needed"]) - {one.name for one in found if one.run}:
        raise RejectedError(f"the file does not tell {', '.join(sorted(missing))}, which this case needs")
    verdict = max((one.level for one in found if one.run), key=(*LEVELS, "fail").index)
    said = mistakes(case, columns, motions) if verdict != "exact" else ()
    short = [one.name for one in found if one.unit in ("alpha", "b") and one.error == math.inf]
    if short and not said and all(motion.tilt.max() < FALLEN for motion in motions.values()):
        raise RejectedError(f"the samples do not cover the window of {', '.join(short)}")
    return verdict, found, said


def main() -> int:
    """Judge one file; return the exit code."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    cases = {one.parent.name: one.parent for one in Path(__file__).resolve().parent.glob("cases/*/case.json")}
    parser.add_argument("case", choices=sorted(cases))
    parser.add_argument("trajectory", type=Path)
    parser.add_argument("--label", default="", help="who made it: name, version and settings of the code")
    parser.add_argument("--out", type=Path, default=Path("result.json"))
    given = parser.parse_args()
    case = Case(cases[given.case])
    try:
        verdict, found, said, reason = *judged(case, given.trajectory), ""
    except RejectedError as error:
        verdict, found, said, reason = "rejected", [], (), str(error)
    print(f"{given.case}: {verdict}{': ' * bool(reason)}{reason}")
    for one in found:
        limits = "exact {:.2g}, good {:.2g}, pass {:.2g}".format(*one.bounds)
        value = f" {one.error:.3g} {one.unit} (run {one.run}; {limits})" if one.run else ""
        print(f"  {one.name}: {one.level}{value}")
    for text in said:
        print(f"  likely mistake: {text}")
    errors = [{"level": one.level, "error": one.error if one.error < math.inf else None} for one in found]
    criteria = [asdict(one) | error for one, error in zip(found, errors, strict=True)]
    result = {"schema": "result/1", "case": given.case, "label": given.label, "verdict": verdict}
    result |= {"reason": reason, "criteria": criteria, "likely_mistakes": said, "check": "1"}
    given.out.write_text(json.dumps(result | {"reference_sha256": case.digest}, indent=1) + "\n", "utf-8")
    return {"fail": 1, "rejected": 2}.get(verdict, 0)


if __name__ == "__main__":
    sys.exit(main())
