"""Model of the `explore` page, run in a browser and compared with the reduced models."""

from __future__ import annotations

import json
import math
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from browser import dumped, needs_chromium
from numpy.typing import NDArray

from rockwobble.compare.metrics.pair import beyond_yield
from rockwobble.models import (
    CLOSED_TILT,
    Case,
    Cylinder,
    GroundMotion,
    InitialState,
    Tendon,
    Trace,
    WobblingFrame,
    el_centro_1940,
)
from rockwobble.models.members import perturbed_in_gravity
from rockwobble.models.synthetic import synthetic_motions
from rockwobble.reduced import simulate

SCRIPTS = Path(__file__).parents[2] / "reports" / "pages" / "templates" / "explore"
COUNT, SEED = 40, 11
STEP = 0.05  # of the samples [s]
AGREES = 1e-6  # of alpha: what the page may be off while nothing but its own error counts
AGREES_AT_CORNERS = 2e-5  # the same in a plane with rolling resistance, whose couple turns over with the tilt
AGREES_IN_PLACE = 1e-4  # of the radius: the rolling angle turns by pi within a pass, at an error of its time
AGREES_IN_FORCE = 1e-3  # of the weight: the centrifugal force of a pass has its peak there
PERTURBED = 1e-9  # of gravity: a copy so far off predicts when chance comes in; the page errs by less
SLIDES_ALIKE = 3e-4  # of the peak displacement: stops within steps of 0.2 ms
DECIDED = 1e-6  # of gravity: where copies so far off end alike, how it ends is no matter of chance
ROWS = ("tilt", "angle", "x", "y", "outward", "across", "normal")


@dataclass(frozen=True)
class Problem:
    """Case with its support: recess, flat, or planar in an azimuth [rad]."""

    case: Case
    support: str
    azimuth: float = 0.0

    def solved(self, case: Case, rtol: float = 1e-11) -> Trace:
        options: dict[str, Any] = {"support": self.support}
        if self.support == "planar":
            options = {"plane": self.azimuth}
        return simulate(case, rtol=rtol, sample_step=STEP, **options)

    def stated(self) -> dict[str, object]:
        """The problem as input of the page."""
        case, body = self.case, self.case.cylinder
        initial, tendon, motion = case.initial, case.tendon, case.motion
        values: dict[str, object] = {
            "diameter": 2.0 * body.base_radius,
            "height": 2.0 * body.half_height,
            "gamma": body.slab_mass_ratio,
            "delta": case.rolling_resistance,
            "yielding": (tendon.yield_force or 0.0) if tendon else 0.0,
            "prestress": tendon.prestress if tendon else 0.0,
            "stiffness": tendon.stiffness if tendon else 0.0,
            "support": self.support,
            "friction": case.friction,
            "azimuth": self.azimuth,
            "duration": case.length,
            "release": None,
            "motion": None,
        }
        if initial is not None:
            rate = initial.rolling_rate
            values["release"] = {"tilt": initial.tilt, "azimuth": initial.rolling_angle, "rate": rate}
        if motion is not None:
            columns = np.asarray(motion.acceleration, dtype=np.float64).T.tolist()
            values["motion"] = dict(zip("xyz", columns, strict=False)) | {
                "dt": motion.time_step,
                "scale": [1.0, 1.0, 1.0],
            }
        return values


def problems() -> list[Problem]:
    """Releases and records on all supports, with and without slab, loss and tendon."""
    random = np.random.default_rng(SEED)
    records = [el_centro_1940(), *synthetic_motions(3, peak=4.0, seed=SEED)]
    cases = []
    for place in range(COUNT):
        support = ("recess", "flat", "planar", "recess")[place % 4]
        tan_alpha = float(random.uniform(0.1, 0.5))
        body: Cylinder = Cylinder(semidiagonal=float(random.uniform(1.0, 12.0)), tan_alpha=tan_alpha)
        if place % 5 == 1:
            body = WobblingFrame(body, float(random.uniform(0.3, 3.0)))
        azimuth = float(random.uniform(-math.pi, math.pi))
        loss = place % 3 == 1
        tendon = None
        if place % 3 != 0 and place % 12 != 4 and place % 24 != 10 and support != "flat":
            stiffness = float(random.uniform(0, 8 if place % 2 else 200))
            tendon = Tendon(prestress=float(random.uniform(0, 1)), stiffness=stiffness)
        initial, motion = None, None
        if (place // 4) % 3 == 0:
            rate = 0.0 if support == "planar" else float(random.uniform(0.05, 0.8))
            tilt = float(random.uniform(0.2, 0.9)) * body.alpha
            initial = InitialState(tilt=tilt, rolling_angle=azimuth, rolling_rate=rate)
        else:
            motion = records[place % len(records)]
            uplift = 9.81 * tan_alpha * (tendon.uplift_factor(body) if tendon else 1.0)
            motion = motion.scaled(float(random.uniform(1.2, 4.0)) * uplift / motion.peak)
            if place % 7 == 3:
                x, y = np.asarray(motion.acceleration).T[:2]
                motion = GroundMotion(np.column_stack([x, y, 0.4 * x[::-1]]), motion.time_step, motion.name)
        case = Case(
            body,
            motion,
            initial=initial,
            duration=12.0 if motion is None else min(motion.duration, 20.0),
            rolling_resistance=float(random.uniform(0.001, 0.02)) * body.base_radius if loss else 0.0,
            tendon=tendon,
        )
        cases.append(Problem(case, support, azimuth))
    return cases


RUNS = """
const NUMBERS = ["outcome", "relativePeak", "displacement"], ROWS = ["time", "tilt", "angle", "x", "y", "outward", "across", "normal"];
const found = PROBLEMS.map((each) => {
  const run = simulateMotion(each, each.motion, { sampleStep: STEP });
  return Object.fromEntries([...NUMBERS.map((name) => [name, String(run[name])]), ...ROWS.map((name) => [name, Array.from(run[name])])]);
});
document.body.textContent = JSON.stringify(found);
"""  # noqa: E501


def on_the_page(
    solved: list[Problem], folder: Path, *, broken: tuple[str, str] | None = None
) -> list[dict[str, Any]]:
    """Results of the page's scripts for some problems; `broken`: script text and its replacement."""
    scripts = "\n".join((SCRIPTS / name).read_text() for name in ("model.js", "motion.js", "slide.js"))
    if broken is not None:
        assert scripts.count(broken[0]) == 1
        scripts = scripts.replace(*broken)
    runs = RUNS.replace("PROBLEMS", json.dumps([each.stated() for each in solved])).replace("STEP", str(STEP))
    page = folder / "model.html"
    page.write_text(f'<!doctype html><meta charset="utf-8"><body><script>{scripts}{runs}</script></body>')
    text = dumped(page)
    return json.loads(text[text.index("[{") : text.rindex("}]") + 2])


def rate_to_lie_down(body: Cylinder, tendon: Tendon, excess: float) -> float:
    """Rolling rate at half of alpha with the energy of a quarter turn plus a relative excess."""
    b, h, g = body.base_radius, body.half_height, 9.81
    axial, transverse = b * b / 2, (3 * b * b + 4 * h * h) / 12

    def inertia(tilt: float) -> float:
        t = math.tan(tilt / 2)
        return math.sin(tilt) ** 2 * (transverse + h * h + 2 * h * b * t + (axial + b * b) * t * t)

    def potential(tilt: float) -> float:
        opening = 2 * math.sin(tilt / 2)
        held = tendon.prestress * b * opening + tendon.stiffness * b * opening**2 / 2
        return g * (b * math.sin(tilt) + h * (math.cos(tilt) - 1) + held)

    start, end = 0.5 * body.alpha, math.pi / 2
    barrier = potential(end) - potential(start)
    spin = inertia(start)
    return math.sqrt(2 * barrier * (1 + excess) / (spin - spin**2 / inertia(end)))


@pytest.fixture(scope="module")
def solved() -> list[tuple[Problem, Trace, Trace]]:
    """Problems, each with its motion and that of a perturbed copy."""
    return [
        (each, each.solved(each.case), each.solved(perturbed_in_gravity(each.case, PERTURBED)))
        for each in problems()
    ]


def apart(one: NDArray[np.float64], other: NDArray[np.float64]) -> NDArray[np.float64]:
    count = min(len(one), len(other))
    return np.abs(one[:count] - other[:count])


def agreement(trace: Trace, copy: Trace) -> int:
    """Number of samples for which a perturbed copy is within the tolerance of the page."""
    leaves = apart(trace.tilt, copy.tilt) > AGREES * trace.case.cylinder.alpha
    return int(leaves.argmax()) if leaves.any() else len(leaves)


def complaints_of(solved: list[tuple[Problem, Trace, Trace]], runs: list[dict[str, Any]]) -> list[str]:
    """Differences between page and package."""
    wrong = []
    for place, ((problem, trace, copy), run) in enumerate(zip(solved, runs, strict=True)):
        body, until = problem.case.cylinder, agreement(trace, copy)
        rows = {name: np.array(run[name], dtype=np.float64)[:until] for name in ROWS}
        opened = trace.tilt[:until] > CLOSED_TILT * body.alpha
        radius = body.base_radius
        point = np.column_stack([rows["x"], rows["y"]])
        point += radius * np.column_stack([np.cos(rows["angle"]), np.sin(rows["angle"])])
        force, weight = trace.contact_force[:until], problem.case.gravity
        corners = problem.support == "planar" and problem.case.rolling_resistance
        off = {
            "tilt": (apart(rows["tilt"], trace.tilt) / body.alpha, AGREES_AT_CORNERS if corners else AGREES),
            "contact": (np.abs(point - trace.contact_point[:until])[opened] / radius, AGREES_IN_PLACE),
            "normal force": (apart(rows["normal"] / weight, force[:, 2])[opened], AGREES_IN_FORCE),
            "horizontal force": (
                apart(np.hypot(rows["outward"], rows["across"]) / weight, np.hypot(*force[:, :2].T))[opened],
                AGREES_IN_FORCE,
            ),
        }
        label = f"{place} {problem.support}"
        for name, (size, allowed) in off.items():
            if not size.max(initial=0.0) <= allowed:
                wrong.append(f"{label}: {name} off by {size.max():.2g} until {trace.time[until - 1]:.2f} s")
        ends = {problem.solved(perturbed_in_gravity(problem.case, by)).outcome for by in (DECIDED, -DECIDED)}
        if ends == {trace.outcome} and run["outcome"] != trace.outcome:
            wrong.append(f"{label}: {run['outcome']}, not {trace.outcome}")
        peak = trace.peak_tilt / body.alpha
        if (
            until == len(trace.tilt)
            and run["outcome"] == "stands"
            and float(run["relativePeak"]) != pytest.approx(peak, rel=2e-5 if corners else 1e-6)
        ):
            wrong.append(f"{label}: peak {run['relativePeak']}, not {peak}")
    return wrong


@pytest.mark.slow
@needs_chromium
def test_page_motion_matches_the_reduced_models(solved, tmp_path: Path):
    assert len({trace.outcome for _, trace, _ in solved}) == 2
    runs = on_the_page([each for each, _, _ in solved], tmp_path)
    assert complaints_of(solved, runs) == []


@pytest.mark.slow
@needs_chromium
def test_undecided_and_overturned_runs_have_no_peak(tmp_path: Path):
    slender = Cylinder(semidiagonal=6.0, tan_alpha=0.2)
    # turns back just beyond a quarter turn, within a step: so much energy is left there
    tendon = Tendon(prestress=0.5, stiffness=8.0)
    beyond = [
        Problem(
            Case(
                slender,
                initial=InitialState(0.5 * slender.alpha, rolling_rate=rate),
                duration=12.0,
                tendon=tendon,
            ),
            "recess",
        )
        for rate in (rate_to_lie_down(slender, tendon, excess) for excess in (-1e-6, 1e-6))
    ]
    # held on its rim but for a creep, which needs more steps than the page has
    squat = Cylinder(semidiagonal=2.95, tan_alpha=1.46)
    start, resistance = InitialState(squat.alpha - 0.01), 0.1 * squat.base_radius
    creeps = Problem(Case(squat, initial=start, duration=12.0, rolling_resistance=resistance), "recess")
    runs = on_the_page([creeps, *beyond], tmp_path)
    ends = [(run["outcome"], run["relativePeak"]) for run in runs]
    assert ends[0] == ("undecided", "NaN")
    assert ends[1][0] == "stands"
    assert ends[2] == ("overturned", "Infinity")


@pytest.mark.slow
@needs_chromium
@pytest.mark.parametrize(
    "broken",
    [
        # terms of recess, tendon, couple and uplift, 1e-4 off; of the place on flat ground, 1e-3
        ("s * H1 / 2) / o.A", "s * H1 / 2.0002) / o.A"),
        ("(o.b * o.I1 - o.h * o.I2 * t) / H * at", "(o.b * o.I1 - 1.001 * o.h * o.I2 * t) / H * at"),
        ("q = gaps * prestress * g / w", "q = 1.0001 * gaps * prestress * g / w"),
        ("share = load / (o.A * Math", "share = 1.0001 * load / (o.A * Math"),
        ("(o.ca * c + o.sa * s) * ar", "(o.ca * c + 1.0001 * o.sa * s) * ar"),
        ("mu = (1 + 4 * gamma) / w", "mu = (1 + 4.0004 * gamma) / w"),
    ],
)
def test_a_wrong_term_in_explore_is_detected(broken, solved, tmp_path: Path):
    runs = on_the_page([each for each, _, _ in solved], tmp_path, broken=broken)
    assert complaints_of(solved, runs) != []


@needs_chromium
def test_page_matches_the_sliding_model_at_friction_below_b_over_h(tmp_path: Path):
    cask = Cylinder(semidiagonal=3.0, tan_alpha=0.5)
    records = [el_centro_1940(vertical=True), *synthetic_motions(2, peak=4.0, seed=SEED)]
    cases = [
        Case(cask, each.scaled(1.5), duration=12.0, friction=mu) for each in records for mu in (0.1, 0.2)
    ]
    problems = [Problem(case, "flat") for case in cases]
    traces = [simulate(case, support="flat", sample_step=STEP) for case in cases]

    def off(broken: tuple[str, str] | None = None) -> float:
        """Largest difference of position and peak, over the peak."""
        runs = on_the_page(problems, tmp_path, broken=broken)
        worst = 0.0
        for run, trace in zip(runs, traces, strict=True):
            place = np.column_stack([run["x"], run["y"]])
            apart_by = apart(place, trace.displacement).max() / trace.peak_displacement
            worst = max(worst, apart_by, abs(float(run["displacement"]) / trace.peak_displacement - 1.0))
        return worst

    assert off() < SLIDES_ALIKE
    assert off(("1 - friction * (g + az) * h", "1 - 1.01 * friction * (g + az) * h")) > SLIDES_ALIKE
    (near,) = on_the_page(
        [Problem(Case(cask, records[0].scaled(2.5), duration=4.0, friction=0.52), "flat")], tmp_path
    )
    assert (near["outcome"], near["relativePeak"]) == ("mixed", "NaN")


@needs_chromium
@pytest.mark.slow
@pytest.mark.parametrize("yielding", [0.0, 2.0, 3.0])
def test_run_beyond_tendon_yield_has_no_result(yielding: float, tmp_path: Path):
    pier = Cylinder(semidiagonal=6.0, tan_alpha=0.2)
    tendon = Tendon(prestress=1.0, stiffness=4.0, yield_force=yielding or None)
    case = Case(pier, el_centro_1940().scaled(3.0), duration=12.0, tendon=tendon)
    (run,) = on_the_page([Problem(case, "recess")], tmp_path)
    trace = simulate(case)
    assert bool(beyond_yield(trace.peak_tilt, case)) == (run["outcome"] == "yielded")
    assert (run["relativePeak"] == "NaN") == (run["outcome"] == "yielded")
