"""The layers rest, properties and studies hold, and find models that are wrong in what they watch."""

from __future__ import annotations

import dataclasses
from collections.abc import Callable
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

from rockwobble import reduced
from rockwobble.compare.check import Bench
from rockwobble.compare.check.finding import Finding
from rockwobble.compare.check.measures import batch
from rockwobble.compare.check.models import after_record, demands, landing, properties, rest, turning_points
from rockwobble.models import Case, GroundMotion, Trace, read_suite

SUITE = read_suite("quick")
PARTS = (rest, landing, after_record, properties, turning_points, demands, batch)
Options = dict[str, Any]
Change = Callable[[GroundMotion | None, Options], GroundMotion | None]


def as_given(motion: GroundMotion | None, options: Options) -> GroundMotion | None:
    return motion


def bench_with(change: Change = as_given, answer: Callable[[Trace], Trace] = lambda found: found) -> Bench:
    """A bench whose model is asked another question, or gives another answer."""

    def simulate(case: Case, **options: Any) -> Trace:
        other = dataclasses.replace(case, motion=change(case.motion, options), duration=case.length)
        return answer(reduced.simulate(other, **options))

    def peak_tilts(sizes: Any, tan_alpha: float, motion: Any, scales: Any, **options: Any) -> Any:
        return reduced.peak_tilts(sizes, tan_alpha, change(motion, options), scales, **options)

    return Bench(reduced=SimpleNamespace(simulate=simulate, peak_tilts=peak_tilts), suite=SUITE)


def failed(part: Any, bench: Bench) -> list[Finding]:
    return [finding for finding in part.check(bench) if finding.failed]


@pytest.mark.parametrize("part", PARTS, ids=lambda part: part.__name__.rsplit(".", 1)[-1])
def test_the_model_holds(part: Any) -> None:
    findings = list(part.check(bench_with()))
    assert findings
    assert len({finding.name for finding in findings}) == len(findings)
    assert not [f"{f.name}: {f.value}, {f.note}" for f in findings if f.failed]


def vertical_reversed(motion: GroundMotion | None, options: Options) -> GroundMotion | None:
    if motion is None or not motion.has_vertical:
        return motion
    return GroundMotion(motion.acceleration * [1.0, 1.0, -1.0], motion.time_step)


def held_after_the_end(motion: GroundMotion | None, options: Options) -> GroundMotion | None:
    if motion is None:
        return None
    last = np.tile(motion.acceleration[-1:], (round(20.0 / motion.time_step) + 1, 1))
    return GroundMotion(np.vstack([motion.acceleration, last]), motion.time_step)


def ends_a_sample_early(motion: GroundMotion | None, options: Options) -> GroundMotion | None:
    if motion is None or len(motion.acceleration) < 3:
        return motion
    return GroundMotion(motion.acceleration[:-1], motion.time_step)


def half_a_sample_late(motion: GroundMotion | None, options: Options) -> GroundMotion | None:
    if motion is None:
        return None
    a = motion.acceleration
    return GroundMotion(np.vstack([a[:1], 0.5 * (a[1:] + a[:-1])]), motion.time_step)


def lossier(motion: GroundMotion | None, options: Options) -> GroundMotion | None:
    if isinstance(options.get("restitution"), float):
        options["restitution"] **= 2
    return motion


def rests_early(motion: GroundMotion | None, options: Options) -> GroundMotion | None:
    options["rest_tilt"] = 1.3 * options.get("rest_tilt", 0.0)
    return motion


@pytest.mark.parametrize(
    ("part", "change", "word"),
    [
        (rest, vertical_reversed, "vertical"),
        (rest, rests_early, "rest threshold"),
        (landing, lossier, "landing"),
        (after_record, held_after_the_end, "end of the record"),
        (after_record, vertical_reversed, "end of the record"),
        (properties, half_a_sample_late, "samples of the record"),
        (properties, vertical_reversed, "vertical acceleration"),
        (properties, ends_a_sample_early, "end of the record"),
    ],
)
def test_a_wrong_question_is_found(part: Any, change: Change, word: str) -> None:
    parts = [finding.part for finding in failed(part, bench_with(change))]
    assert any(word in each for each in parts), parts


def forgets_the_peak(found: Trace) -> Trace:
    every_fifth = found.tilt[:: max(1, len(found.tilt) // 40)]
    return dataclasses.replace(found, peak_tilt=float(every_fifth.max()))


def turns_late(found: Trace) -> Trace:
    rows = found.extrema.copy()
    rows[:, 0] += 1e-6
    return dataclasses.replace(found, extrema=rows)


def slower(found: Trace) -> Trace:
    return dataclasses.replace(found, tilt_rate=1.0001 * found.tilt_rate)


@pytest.mark.parametrize(
    ("part", "answer", "word"),
    [
        (turning_points, forgets_the_peak, "peak tilt"),
        (turning_points, turns_late, "turning points"),
        (properties, slower, "rates of the response"),
        (landing, slower, "landing"),
        (batch, forgets_the_peak, "batch kernel"),
    ],
)
def test_a_wrong_answer_is_found(part: Any, answer: Callable[[Trace], Trace], word: str) -> None:
    parts = [finding.part for finding in failed(part, bench_with(answer=answer))]
    assert any(word in each for each in parts), parts


def test_an_early_end_of_a_fall_that_is_not_certain_is_found() -> None:
    def hasty(sizes: Any, tan_alpha: float, *given: Any, **options: Any) -> Any:
        peaks = reduced.peak_tilts(sizes, tan_alpha, *given, **options)
        return np.where(peaks > np.arctan(tan_alpha), 0.5 * np.pi, peaks)

    bench = Bench(reduced=SimpleNamespace(simulate=reduced.simulate, peak_tilts=hasty), suite=SUITE)
    assert [finding.part for finding in failed(after_record, bench) if "certain" in finding.part]


def test_a_gravity_that_does_not_reach_a_grid_is_found() -> None:
    def peak_tilts(*arguments: Any, gravity: float, **options: Any) -> Any:
        return reduced.peak_tilts(*arguments, **options)

    models = SimpleNamespace(simulate=reduced.simulate, peak_tilts=peak_tilts)
    assert len(failed(batch, Bench(reduced=models, suite=SUITE))) == 6  # each model, each kind of scale


@pytest.mark.parametrize(
    ("place", "fault", "name"),
    [
        ("reduced.solution.friction_of", lambda force: np.hypot(*force[:, :2].T), "time and duration"),
        ("models.traces.trace.friction_of", lambda force: np.hypot(*force[:, :2].T), "friction needed"),
        (
            "reduced.assumptions._lost",
            lambda found: found.moving & (found.normal <= 0.003),
            "time and duration",
        ),
        ("reduced.assumptions._pull", lambda found: found.normal, "extremes"),
        ("reduced.assumptions._need", lambda found: found.friction * found.normal, "extremes"),
    ],
)
def test_demands_that_are_wrong_are_found(
    place: str, fault: Callable[[Any], Any], name: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(f"rockwobble.{place}", fault)
    assert any(finding.name.startswith(name) for finding in failed(demands, bench_with()))


def test_a_duration_counted_twice_is_found(monkeypatch: pytest.MonkeyPatch) -> None:
    from rockwobble.reduced import assumptions

    right = assumptions._breach

    def doubled(*arguments: Any) -> Any:
        fact = right(*arguments)
        return dataclasses.replace(fact, duration=2.0 * fact.duration)

    monkeypatch.setattr(assumptions, "_breach", doubled)
    assert failed(demands, bench_with())
