"""The fifteen cases: bodies, starts, motions, and criteria.

The bounds mean the same everywhere: a body 1 % too large fails in every free motion; "good" is a tenth of
"pass", and "exact" what only a converged solution of the same equations reaches. Under shaking the bound is
that of an agreement, 1 % of alpha at every moment, in the window in which perturbed copies keep it, too.
"""

from __future__ import annotations

import math
from collections.abc import Iterable
from dataclasses import dataclass, field
from random import Random
from typing import Any, Literal

import numpy as np
from shaken_problems import noise

from rockwobble.models import Cylinder, GroundMotion, InitialState, Tendon, el_centro_1940
from rockwobble.reduced.exact import steady_wobble_rate

G = 9.81
Support = Literal["recess", "flat", "either"]
SUPPORTS: tuple[Support, ...] = ("recess", "flat")
Criterion = dict[str, Any]


@dataclass(frozen=True, slots=True)
class BenchmarkRun:
    """One motion of a case.

    Parameters
    ----------
    name : str
    cylinder : Cylinder
    support : {"recess", "flat", "either"}
        "either": the motion is the same on both.
    duration : float
        [s]
    initial : InitialState, optional
    motion : GroundMotion, optional
    friction : float
        Coefficient of the pair.
    tendon : Tendon, optional
    turned : float
        What is added to the azimuth of the reference that the runs of a case share [rad].
    time_unit : float
        Unit of the times of that reference [s].
    levels : dict
        Tilt over alpha, and shift over the base radius, at which a time is taken.
    closes : bool
        Whether it rocks in the plane of x and z, where each closing of the base is an impact.
    """

    name: str
    cylinder: Cylinder
    support: Support
    duration: float
    initial: InitialState | None = None
    motion: GroundMotion | None = None
    friction: float = 1.0
    tendon: Tendon | None = None
    turned: float = 0.0
    time_unit: float = 1.0
    levels: dict[str, float] = field(default_factory=dict)
    closes: bool = False

    @property
    def slides(self) -> bool:
        """Whether the body only slides."""
        return "slide_level" in self.levels

    @property
    def model(self) -> Literal["recess", "flat"]:
        """Support of the reference model."""
        return "recess" if self.support == "recess" else "flat"


@dataclass(frozen=True, slots=True)
class Definition:
    """One case: runs, sample step of its reference [s], and criteria."""

    name: str
    title: str
    runs: tuple[BenchmarkRun, ...]
    step: float
    criteria: tuple[Criterion, ...]
    needed: tuple[str, ...]
    needs: Literal["all", "any"] = "all"
    end: float | None = None  # of the reference [s], where that is before the end of the run


def quantity(name: str, unit: str, size: float, exact: float, **more: Any) -> Criterion:
    """Criterion of a scalar."""
    bounds = {"pass": size, "good": 0.1 * size, "exact": exact}
    return {"name": name, "kind": "quantity", "unit": unit, **bounds, **more}


def trace(name: str, end: float, exact: float, *, start: float = 0.0, **more: Any) -> Criterion:
    """Criterion of a trace between two times [s]."""
    unit = "b" if name == "path" else "alpha"
    bounds = {"pass": 0.003, "good": 0.0003, "exact": exact}
    return {"name": name, "kind": "trace", "unit": unit, "window": [start, end], **bounds, **more}


def lean_and_tilt(end: float, exact: float, **more: Any) -> tuple[Criterion, ...]:
    """Criteria of tilt vector and tilt; a file with the tilt only is judged on one."""
    return trace("tilt", end, exact, **more), trace("lean", end, exact, **more)


SQUAT = Cylinder.from_dimensions(base_radius=1.0, height=4.0)  # that of tests/reference/finite_release.csv
PIER = Cylinder(semidiagonal=6.0, tan_alpha=0.2)
AZIMUTH = 0.3  # of the releases [rad]: along no axis, so that mistaken axes show


def release(cylinder: Cylinder, spin: float) -> InitialState:
    """Release from rest in tilt at alpha/2."""
    return InitialState(0.5 * cylinder.alpha, 0.0, AZIMUTH, spin)


def returns(
    name: str, title: str, runs: Iterable[BenchmarkRun], end: float, exact: float, **more: Any
) -> Definition:
    """Angle of turn and period after a release, up to the next maximum."""
    asked = quantity("turn_1", "rad", 0.01, 1e-6), quantity("period_1", "relative", 0.002, 1e-6)
    needed = ("turn_1", "period_1", "tilt")
    return Definition(name, title, tuple(runs), 0.002, (*asked, *lean_and_tilt(end, exact)), needed, **more)


def turns(name: str, support: Support, words: str) -> Definition:
    """Return releases with three spins."""
    runs = (
        BenchmarkRun(f"spin-{spin:g}", SQUAT, support, 5.0, initial=release(SQUAT, spin))
        for spin in (0.03, 0.1, 1.0)
    )
    return returns(name, f"Angle of turn and period {words}", runs, 3.0, 1e-5)


def disc() -> Definition:
    """Thick disc that rolls fast, dominated by axial inertia and gyroscopic term."""
    body = Cylinder.from_dimensions(base_radius=1.0, height=0.6)
    start = InitialState(0.3 * body.alpha, 0.0, AZIMUTH, 3.0)
    runs = (BenchmarkRun(support, body, support, 4.0, initial=start, friction=2.0) for support in SUPPORTS)
    return returns("rolling-disc", "A thick disc that rolls fast", runs, 3.0, 1e-5, needs="any")


def steady() -> Definition:
    """Steady wobble."""
    rate = float(steady_wobble_rate(SQUAT, 0.3 * SQUAT.alpha, gravity=G))
    start = InitialState(0.3 * SQUAT.alpha, 0.0, AZIMUTH, rate)
    length = round(100.5 * 2.0 * math.pi / rate, 2)
    runs = (BenchmarkRun("wobble", SQUAT, "either", length, initial=start),)
    criteria = (quantity("revolutions_100", "relative", 0.002, 1e-6), *lean_and_tilt(0.98 * length, 1e-4))
    needed = ("revolutions_100", "tilt")
    return Definition("steady-wobble", "Steady wobble over 100 turns", runs, 0.02, criteria, needed)


def uplift() -> Definition:
    """Uplift on a ramp of the ground acceleration, in 24 directions."""
    body = Cylinder(semidiagonal=2.0, tan_alpha=0.3)
    rate = G * body.tan_alpha  # [m/s^3]: uplift after one second
    runs = []
    for degrees in range(0, 360, 15):
        angle = math.radians(degrees)
        push = 1.8 * rate * np.array([math.cos(angle), math.sin(angle)])
        motion = GroundMotion(np.vstack([np.zeros(2), push]), 1.8)
        more: dict[str, Any] = {"motion": motion, "turned": angle, "levels": {"lean_level": 0.01}}
        runs.append(BenchmarkRun(f"{degrees:03d}-deg", body, "either", 1.8, **more))
    criteria = (
        quantity("lean_time", "s", 0.01, 1e-5),
        quantity("lean_azimuth", "rad", 0.02, 1e-5),
        *lean_and_tilt(1.75, 1e-5, start=1.0),
    )
    needed, title = ("lean_time", "lean_azimuth", "tilt"), "Uplift threshold in 24 directions"
    return Definition("uplift-directions", title, tuple(runs), 0.002, criteria, needed)


def near_upright() -> Definition:
    """Passes with decreasing minimum tilt."""
    runs = (
        BenchmarkRun(f"spin-{spin:g}", PIER, "recess", 6.0, initial=release(PIER, spin))
        for spin in (0.1, 0.01, 0.001)
    )
    return returns("near-upright-pass", "Passes near the upright position at three spins", runs, 5.5, 1e-4)


def slip() -> Definition:
    """Onset of slip under a ramp of ground acceleration, with and without a vertical ramp."""
    body = Cylinder(semidiagonal=1.0, tan_alpha=0.4)
    ramp, vertical = 2.0, 1.0  # [m/s^3]

    def run(name: str, friction: float, az: float, length: float, **levels: float) -> BenchmarkRun:
        motion = GroundMotion(length * np.array([[0.0, 0.0, 0.0], [ramp, 0.0, az]]), length)
        return BenchmarkRun(name, body, "flat", length, motion=motion, friction=friction, levels=dict(levels))

    runs = (
        run("slides", 0.3, 0.0, 2.5, slide_level=1e-3),
        run("slides-under-vertical", 0.3, vertical, 2.8, slide_level=1e-3),
        run("rocks", 0.5, 0.0, 2.6, lean_level=0.01),
    )
    sliding = [one.name for one in runs[:2]]
    criteria = (
        quantity("slide_time", "s", 0.01, 1e-4, runs=sliding),
        trace("path", 2.45, 1e-5, runs=sliding),
        quantity("lean_time", "s", 0.01, 1e-5, runs=["rocks"]),
        trace("tilt", 2.45, 1e-5),
    )
    needed, title = ("slide_time", "lean_time", "tilt"), "Onset of slip, and of rocking in its place"
    return Definition("onset-of-slip", title, runs, 0.002, criteria, needed)


def scales() -> Definition:
    """Return one motion at five sizes."""
    runs = []
    for size in (0.01, 0.1, 1.0, 10.0, 100.0):
        body, unit = Cylinder(semidiagonal=size, tan_alpha=0.35), math.sqrt(size / G)
        start = InitialState(0.5 * body.alpha, 0.0, AZIMUTH, 0.4 / unit)
        runs.append(BenchmarkRun(f"r-{size:g}", body, "flat", 12.0 * unit, initial=start, time_unit=unit))
    criteria = (quantity("period_1", "relative", 0.002, 1e-6), *lean_and_tilt(11.0, 1e-5))
    title = "One motion at five sizes, 1 cm to 100 m"
    return Definition("scale-invariance", title, tuple(runs), 0.005, criteria, ("tilt",))


def el_centro() -> Definition:
    """Pier under twice El Centro, up to the divergence of perturbed copies."""
    record = el_centro_1940().scaled(2.0)
    # the ends are those of the agreement with a copy whose record is 0.1 % stronger
    ends = {"recess": 26.0, "flat": 22.0}
    motion = GroundMotion(np.round(np.array(record.acceleration)[:2801], 6), record.time_step)  # as published
    runs = tuple(
        BenchmarkRun(name, PIER, name, 28.0, motion=motion, levels={"lean_level": 0.01}) for name in SUPPORTS
    )
    agreement = {"pass": 0.01, "good": 0.001, "measure": "largest"}
    criteria = [
        {**one, **agreement, "runs": [name]} for name in SUPPORTS for one in lean_and_tilt(ends[name], 1e-4)
    ]
    asked = (quantity("lean_time", "s", 0.02, 5e-4), *criteria)
    title = "El Centro 1940 until agreement must end"
    return Definition("el-centro", title, runs, 0.01, asked, ("tilt",), "any")


def records() -> Definition:
    """Ensemble of 22 synthetic ground motions, compared by the distribution of peaks only."""
    runs = []
    for index in range(22):
        samples = noise(Random(1940 + index), 0.02, 20.0, 2)
        samples *= 2.2 * G * PIER.tan_alpha / np.hypot(*samples.T).max()
        samples[[0, -1]] = 0.0
        kept = GroundMotion(np.round(samples, 4), 0.02)  # rounded as published
        runs.append(BenchmarkRun(f"record-{index + 1:02d}", PIER, "recess", kept.duration, motion=kept))
    share = {"pass": 9.01 / 22.0, "good": 5.01 / 22.0, "exact": 1.01 / 22.0}
    criteria = ({"name": "peak_tilt", "kind": "distribution", "unit": "share", **share},)
    title = "Peak tilts under 22 records, as a distribution"
    return Definition("records-distribution", title, tuple(runs), 0.02, criteria, ("peak_tilt",))


def energy() -> Definition:
    """Energy conservation over 100 passes."""
    start = release(SQUAT, 0.5)
    runs = tuple(BenchmarkRun(support, SQUAT, support, 152.0, initial=start) for support in SUPPORTS)
    criteria = (
        quantity("maximum_100", "alpha", 0.003, 1e-6),
        quantity("period_100", "relative", 0.002, 1e-7),
        *lean_and_tilt(14.0, 1e-5),
    )
    title = "Energy over 100 passes"
    return Definition("energy-100-passes", title, runs, 0.005, criteria, ("maximum_100",), "any", 15.0)


def tendon() -> Definition:
    """Return releases with tendons, one from beyond alpha, and the uplift that a prestress raises."""
    # slope of the couple at uplift over m g b: stiffness less h/b, which is 2
    tendons = {
        "prestressed": (0.5, Tendon(prestress=0.5)),
        "falling": (0.5, Tendon(prestress=0.5, stiffness=1.0)),
        "growing": (1.2, Tendon(prestress=0.25, stiffness=4.0)),
    }
    length, runs = 4.0, []
    for name, (share, held) in tendons.items():
        start = InitialState(share * SQUAT.alpha, 0.0, AZIMUTH, 0.3)
        runs.append(BenchmarkRun(name, SQUAT, "recess", length, initial=start, tendon=held))
    # it lifts off at four fifths of the length, where without a tendon it would at a little more than half
    push = 1.5 * G * SQUAT.tan_alpha / 0.8 * np.array([math.cos(AZIMUTH), math.sin(AZIMUTH)])
    motion, held = GroundMotion(np.vstack([np.zeros(2), push]), length), Tendon(prestress=0.5)
    more: dict[str, Any] = {"motion": motion, "tendon": held, "levels": {"lean_level": 0.01}}
    runs.append(BenchmarkRun("uplift", SQUAT, "recess", length, **more))
    released, lifted = list(tendons), ["uplift"]
    criteria = (
        quantity("turn_1", "rad", 0.01, 1e-6, runs=released),
        quantity("period_1", "relative", 0.002, 1e-6, runs=released),
        *lean_and_tilt(2.5, 1e-5, runs=released),
        quantity("lean_time", "s", 0.01, 1e-5, runs=lifted),
        *lean_and_tilt(3.9, 1e-5, start=3.2, runs=lifted),
    )
    needed, title = ("turn_1", "period_1", "tilt"), "A column with a tendon: turn, period and uplift"
    return Definition("tendon", title, tuple(runs), 0.002, criteria, needed)


def impact() -> Definition:
    """One sine in one direction: each impact conserves the moment of momentum."""
    time = 0.005 * np.arange(161)
    push = np.column_stack([0.65 * G * np.sin(2.0 * math.pi * time / 0.8), np.zeros(161)])
    motion = GroundMotion(np.round(push, 6), 0.005)  # rounded as published
    more: dict[str, Any] = {"friction": 5.0, "levels": {"lean_level": 0.01}, "closes": True}
    runs = tuple(BenchmarkRun(support, SQUAT, support, 2.0, motion=motion, **more) for support in SUPPORTS)
    criteria = (
        *(quantity(f"maximum_{k}", "alpha", 0.001, 1e-6) for k in (2, 3, 4)),
        *(quantity(f"kept_{k}", "relative", 0.01, 1e-5) for k in (2, 3)),
        *lean_and_tilt(1.9, 1e-5),
    )
    title = "Impacts of a base that closes in one plane"
    return Definition("impact", title, runs, 0.002, criteria, ("maximum_2", "kept_2"), "any")


def slide(name: str, title: str, motion: GroundMotion, length: float, *asked: Criterion) -> Definition:
    """Slide from rest under a motion of the ground, at 0.6 and at 0.9 of b/h."""
    more: dict[str, Any] = {"motion": motion, "levels": {"slide_level": 1e-3}}
    runs = tuple(
        BenchmarkRun(f"friction-{friction:g}", SQUAT, "flat", length, friction=friction, **more)
        for friction in (0.3, 0.45)
    )
    end, moved = length - 0.01, quantity("slide_end", "relative", 0.01, 1e-5)
    criteria = (*asked, moved, trace("path", end, 1e-5), trace("tilt", end, 1e-5))
    return Definition(name, title, runs, 0.002, criteria, ("slide_end", "path", "tilt"))


def slide_on_a_line() -> Definition:
    """Slide under a rectangular pulse of 0.6 g, with a closed-form solution."""
    push = 0.6 * G * np.array([math.cos(AZIMUTH), math.sin(AZIMUTH)])
    motion = GroundMotion(np.vstack([push, push]), 0.5)
    begin = quantity("slide_time", "s", 0.003, 1e-5)
    return slide("slide-line", "A slide along one line", motion, 1.6, begin)


def slide_on_a_curve() -> Definition:
    """Slide on ground that moves in a circle once a second with 0.6 g, and stops after three seconds."""
    turn = AZIMUTH + 2.0 * math.pi * 0.01 * np.arange(301)
    motion = GroundMotion(np.round(0.6 * G * np.column_stack([np.cos(turn), np.sin(turn)]), 6), 0.01)
    return slide("slide-curve", "A slide along a curve", motion, 3.6)


def definitions() -> tuple[Definition, ...]:
    """Fifteen cases, in the order of the page."""
    return (
        turns("turn-flat", "flat", "on flat ground"),
        turns("turn-recess", "recess", "in a recess"),
        disc(),
        steady(),
        uplift(),
        near_upright(),
        slip(),
        scales(),
        el_centro(),
        records(),
        energy(),
        tendon(),
        impact(),
        slide_on_a_line(),
        slide_on_a_curve(),
    )
