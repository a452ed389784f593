"""Who can slide: 40 random cylinders from rest on flat ground, friction below b/h, in every engine.

Such a cylinder slides and does nothing else, which is known exactly. Right is a displacement within 5 % of
its peak at any time, no uplift and a twist below 0.01 rad, without a diagnostic.
"""

from __future__ import annotations

import time
from collections.abc import Iterator, Sequence
from itertools import islice
from typing import Any

import numpy as np

from rockwobble import multibody, reduced
from rockwobble.models import Case, Cylinder, GroundMotion, Trace, el_centro_1940
from rockwobble.models.mode import REST, ROCKS, SLIDES
from rockwobble.models.synthetic import synthetic_motions
from rockwobble.multibody import simulation
from rockwobble.multibody.engines.registry import engine_named, own_engines
from rockwobble.multibody.modes import TOLERANCE, TURN
from rockwobble.reports.cli.options import settings

from .console import options_of

DRAWS, SEED, LENGTH, G = 40, 62, 6.0, 9.81  # [-], [-], [s], [m/s^2]


def draws() -> Iterator[Case]:
    """Random frictions of 0.1 to 0.97 b/h, bodies, records, intensities; a quarter with vertical motion."""
    random = np.random.default_rng(SEED)
    for number in range(DRAWS):
        tan_alpha = float(np.exp(random.uniform(np.log(0.15), 0.0)))
        body = Cylinder(semidiagonal=float(np.exp(random.uniform(0.0, np.log(10.0)))), tan_alpha=tan_alpha)
        friction = tan_alpha * random.uniform(0.1, 0.97)
        if number % 2:
            samples = synthetic_motions(1, peak=1.0, seed=number, duration=12.0)[0].acceleration
            step = 0.01
        else:
            record = el_centro_1940()
            samples, step = np.array(record.acceleration[:, :2]), record.time_step
            turn = random.uniform(0.0, 2.0 * np.pi)
            samples = samples @ [[np.cos(turn), np.sin(turn)], [-np.sin(turn), np.cos(turn)]]
        samples = samples[: round(LENGTH / step) + 1]
        samples = samples * friction * G * random.uniform(1.3, 5.0) / np.hypot(*samples.T).max()
        if number % 4 == 3:  # another motion for the vertical, of at most a third of gravity
            up = synthetic_motions(1, peak=G / 3.0, seed=1000 + number, duration=12.0)[0].acceleration[:, 0]
            samples = np.column_stack([samples, up[: len(samples)]])
        yield Case(body, GroundMotion(samples, step), friction=friction, duration=LENGTH, gravity=G)


def judged(case: Case, run: Trace) -> tuple[float, str]:
    """Largest displacement difference over its peak, and the errors in words."""
    exact = reduced.simulate(case, support="flat", sample_step=0.01)
    count = min(len(run.time), len(exact.time))
    apart = np.hypot(*(run.displacement[:count] - exact.displacement[:count]).T)
    away, twist = float(apart.max()) / exact.peak_displacement, float(np.abs(run.twist).max())
    wrong = [] if away <= TOLERANCE else [f"{100 * away:.1f} %"]
    wrong += (
        [] if run.mode in (REST, SLIDES) else [f"{run.mode}, {run.peak_tilt / case.cylinder.alpha:.1e} alpha"]
    )
    wrong += [] if twist <= TURN else [f"twist {twist:.3f}"]
    return away, ", ".join(wrong)


def main(arguments: Sequence[str]) -> int:
    """Print each wrong draw, and the totals."""
    parser = options_of("who_can_slide", __doc__ or "")
    parser.add_argument("engines", nargs="*", help="default: all that can start from rest")
    parser.add_argument("--set", action="append", default=[], metavar="NAME=VALUE", help="a setting")
    parser.add_argument("--draws", type=int, default=DRAWS, help="the first of 40")
    parser.add_argument("--as-it-rocks", action="store_true", help="with the settings for a base that rocks")
    parser.add_argument("--all", action="store_true", help="print what is right, too")
    given = parser.parse_args(arguments)
    if given.as_it_rocks:
        vars(simulation)["expected_mode"] = lambda case, support: ROCKS
    chosen: dict[str, Any] = dict(settings(given.set))
    for engine in given.engines or own_engines():
        if not engine_named(engine).uplifts:
            print(f"{engine}: cannot start from rest")
            continue
        errors, right, silent, spent, steps = [], 0, 0, 0.0, 0.0
        for number, case in enumerate(islice(draws(), given.draws)):
            started = time.process_time()
            run = multibody.simulate(case, engine=engine, support="flat", **chosen)
            spent += time.process_time() - started
            steps += LENGTH / run.time_step
            away, wrong = judged(case, run)
            codes = ", ".join(fact.code for fact in run.facts)
            errors.append(away)
            right += not wrong and not codes
            silent += bool(wrong) and not codes
            if wrong or codes or given.all:
                b_over_h, size = case.cylinder.tan_alpha, case.cylinder.semidiagonal
                print(
                    f"{engine} {number:2d}: tan alpha {b_over_h:.2f}, R {size:.1f} m, friction"
                    f" {case.friction / b_over_h:.2f} b/h: {100 * away:.2f} %; wrong: {wrong or '-'};"
                    f" diagnostics: {codes or '-'}",
                    flush=True,
                )
        print(
            f"{engine}: right without a diagnostic {right} of {len(errors)}, wrong without one {silent};"
            f" errors {100 * np.median(errors):.2f} % median, {100 * max(errors):.2f} % largest;"
            f" {1e6 * spent / steps:.0f} us a step",
            flush=True,
        )
    return 0
