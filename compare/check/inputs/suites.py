"""Layer studies, second part: a suite file, and what its ranges and keys must come to."""

from __future__ import annotations

import itertools
import math
import tempfile
from collections.abc import Iterator
from pathlib import Path

import numpy as np

from rockwobble.models import Case, Suite, read_suite

from ..bench import Bench, largest
from ..finding import Bound, Finding, none_wrong, worst_of

TEXT = """
[[runs]]
engine = ["mujoco", "pybullet"]
support = ["recess", "flat"]
time_step = [1e-4, 2e-4]
settings = { iterations = 50 }

[[cases]]
name = "grid"
cylinder.semidiagonal = { from = 1, to = 100, count = 3, spacing = "log" }
cylinder.tan_alpha = { from = 0.1, to = 0.3, step = 0.1 }
release = { tilt_over_alpha = { from = 0.2, to = 0.8, count = 3 }, rolling_rate = 0.5 }
duration = [4, 6]

[[cases]]
name = "fields"
cylinder.base_radius = 1.5
cylinder.height = 8
cylinder.mass_centre_height = 5
cylinder.transverse_inertia = 7
cylinder.axial_inertia = 2
release = { tilt_deg = 3, tilt_rate = -0.1, rolling_angle_deg = 30, rolling_rate = 0.2 }
duration = 7
gravity = 3.7
friction = 0.4

[[cases]]
name = "record"
cylinder = { semidiagonal = 6, tan_alpha = 0.2 }
motion = { x = "x.csv", y = "y.csv", units = "g", scale = 1.5, rotation_deg = 90, time_shift = 0.4 }

[[cases]]
name = "earlier"
cylinder = { semidiagonal = 6, tan_alpha = 0.2 }
motion = { x = "x.csv", y = "y.csv", units = "g", time_shift = -0.2 }

[[cases]]
name = "strength"
cylinder = { semidiagonal = 6, tan_alpha = 0.25 }
motion = { x = "x.csv", y = "y.csv", units = "g", times_uplift = [1.5, 2] }
gravity = 5

[[cases]]
name = "pulse"
cylinder = { semidiagonal = 6, tan_alpha = 0.25 }
motion = { pulse = "half-sine", times_uplift = 1.2, period = 2, azimuth_deg = 90, time_shift = 0.5 }
duration = 3
"""
X, Y, STEP = np.array([0.0, 0.125, -0.25, 0.5]), np.array([0.25, -0.5, 0.125, 0.0]), 0.2
PULSE_STEP = 0.005  # [s] of a pulse with a period of 2 s
# relative: ranges are rounded to 12 digits, angles turned into radians
ROUNDING = Bound(1e-12, "the same numbers worked out by hand, to rounding")


def check(bench: Bench) -> Iterator[Finding]:
    """Yield the findings of this part."""
    del bench
    with tempfile.TemporaryDirectory() as place:
        folder = Path(place)
        for name, values in (("x.csv", X), ("y.csv", Y)):
            lines = [f"{STEP * index:.1f},{value!r}" for index, value in enumerate(values.tolist())]
            (folder / name).write_text("time,acceleration\n" + "\n".join(lines) + "\n", encoding="utf-8")
        path = folder / "check.suite.toml"
        path.write_text(TEXT, encoding="utf-8")
        suite = read_suite(path)
    yield _expansion(suite)
    named = {case.name: case for case in suite.cases}
    part = "suite file: keys of a case, or their units"
    yield worst_of("fields of a case, from a suite file", _field_errors(named["fields"]), ROUNDING, part)
    part = "suite file: scale, rotation, shift or strength of a motion"
    yield worst_of("ground motions of a suite file", _motion_errors(named), ROUNDING, part)


def _expansion(suite: Suite) -> Finding:
    """Every combination of four ranges, the last key fastest, and every run once."""
    axes = [(1.0, 10.0, 100.0), (0.1, 0.2, 0.3), (0.2, 0.5, 0.8), (4.0, 6.0)]
    wrong = []
    combinations = list(itertools.product(*axes))
    found = [case for case in suite.cases if case.name.startswith("grid")]
    if len(found) != len(combinations):
        wrong.append(f"{len(found)} cases instead of {len(combinations)}")
    for case, (size, tan_alpha, share, duration) in zip(found, combinations, strict=False):
        name = f"grid: semidiagonal {size:g}, tan_alpha {tan_alpha:g}, tilt_over_alpha {share:g}"
        assert case.initial is not None
        tilted = abs(case.initial.tilt / math.atan(tan_alpha) - share) < ROUNDING.most
        stated = (case.name, case.cylinder.semidiagonal, case.cylinder.tan_alpha, case.length)
        released = case.initial.tilt_rate, case.initial.rolling_angle, case.initial.rolling_rate
        as_stated = stated == (f"{name}, duration {duration:g}", size, tan_alpha, duration)
        if not (tilted and as_stated and released == (0.0, 0.0, 0.5)):
            wrong.append(case.name)
    runs = [(run.engine, run.support, run.time_step, dict(run.settings)) for run in suite.runs]
    expected = itertools.product(
        ("mujoco", "pybullet"), ("recess", "flat"), (1e-4, 2e-4), ({"iterations": 50},)
    )
    if runs != list(expected):
        wrong.append("the runs")
    return none_wrong(
        f"wrong cases and runs of a suite file with four ranges, {len(combinations)} cases",
        wrong,
        "every combination, in the order of the file, the last key fastest",
        "suite file: ranges, names or order of the cases",
    )


def _field_errors(case: Case) -> dict[str, float]:
    cylinder, initial = case.cylinder, case.initial
    assert initial is not None
    found = {
        "base radius": cylinder.base_radius / 1.5,
        "height of the mass centre": cylinder.mass_centre_height / 5.0,
        "height": 2.0 * cylinder.half_height / 8.0,
        "semidiagonal": cylinder.semidiagonal / math.hypot(1.5, 5.0),
        "transverse inertia": (cylinder.transverse_inertia or math.nan) / 7.0,
        "axial inertia": (cylinder.axial_inertia or math.nan) / 2.0,
        "duration": case.length / 7.0,
        "gravity": case.gravity / 3.7,
        "friction": case.friction / 0.4,
        "tilt": initial.tilt / (math.pi / 60.0),
        "tilt rate": initial.tilt_rate / -0.1,
        "rolling angle": initial.rolling_angle / (math.pi / 6.0),
        "rolling rate": initial.rolling_rate / 0.2,
    }
    return {name: value - 1.0 for name, value in found.items()}


def _motion_errors(named: dict[str, Case]) -> dict[str, float]:
    both = 9.81 * np.column_stack([X, Y])
    uplifts = 5.0 * 0.25 / float(np.hypot(*both.T).max()) * both
    # turned by 90 degrees x becomes y and y becomes -x; two time steps of still ground come first
    shifted = np.vstack([np.zeros((2, 2)), 1.5 * np.column_stack([-both[:, 1], both[:, 0]])])
    at = PULSE_STEP * np.arange(round(1.5 / PULSE_STEP) + 1)
    along = np.where(at >= 0.5, 1.2 * 9.81 * 0.25 * np.sin(math.pi * (at - 0.5)), 0.0)
    expected = {
        "record": (shifted, STEP),
        "earlier": (both[1:], STEP),
        "strength: times_uplift 1.5": (1.5 * uplifts, STEP),
        "strength: times_uplift 2": (2.0 * uplifts, STEP),
        "pulse": (np.column_stack([0.0 * along, along]), PULSE_STEP),
    }
    found = {}
    for name, (values, step) in expected.items():
        motion = named[name].motion
        assert motion is not None
        same = motion.acceleration.shape == values.shape and motion.time_step == step
        found[name] = largest(motion.acceleration - values) / 9.81 if same else math.nan
    return found
