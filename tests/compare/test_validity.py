"""The limits of the reduced model: measured on a tiny grid, kept, and changed by a changed constant."""

from __future__ import annotations

import dataclasses
import json
import math

import numpy as np
import pandas as pd
import pytest

from rockwobble.compare.studies.validity import PARTS, QUICK, limits_of, measure_all
from rockwobble.compare.studies.validity.limits.limit import first_failing, percent, up_to
from rockwobble.compare.studies.validity.limits.peaks import peak_difference
from rockwobble.compare.studies.validity.parts import part_named
from rockwobble.reduced import body, problem
from rockwobble.reduced.exact import _checks
from rockwobble.reports.pages.validity.headline import headline

TINY = dataclasses.replace(
    QUICK,
    name="tiny",
    tan_alphas=(0.2, 0.7),
    releases=(0.5,),
    spins=(0.1, 0.5),
    sizes=(4.0, 12.0),
    intensities=(1.5, 3.0),
    shaken_tan_alphas=(0.2, 0.7),
    engine_points=((0.4, 0.5, 0.25),),
    slip_points=((0.2, 0.5, 0.25),),
    slip_shares=(0.9, 1.05),
    trace_points=((0.2, 6.0, 2.0),),
    trace_length=3.0,
    ring_tan_alphas=(0.7,),
    ring_clearances=(1e-3,),
    ring_length=4.0,
    contacts=((2e-3, 1.0),),
    members=2,
    member_step=5e-4,
)
ENGINE_FREE = ("free_response", "shaking")
# of the transverse inertia: far above every error of an engine, and no other body
HEAVIER = 1.1


def _with_heavier_models(patch):
    """Let the reduced models, and nothing else, have another transverse inertia."""

    def heavier(cylinder, gravity):
        true = body.body_of(cylinder, gravity)
        I1 = HEAVIER * true.I1
        A, J = true.A - true.I1 + I1, true.J - true.I1 + I1
        p2 = true.p2 * true.A / A
        return true._replace(I1=I1, A=A, J=J, p2=p2, p=p2**0.5)

    patch.setattr(problem, "body_of", heavier)
    patch.setattr(_checks, "body_of", heavier)


@pytest.fixture(scope="module")
def kept(tmp_path_factory):
    return tmp_path_factory.mktemp("measured")


@pytest.fixture(scope="module")
def tables(kept):
    return measure_all(TINY, kept, workers=1)


@pytest.fixture(scope="module")
def heavier_tables(tmp_path_factory):
    with pytest.MonkeyPatch.context() as patch:
        _with_heavier_models(patch)
        return measure_all(TINY, tmp_path_factory.mktemp("heavier"), workers=1)


def test_every_part_measures_and_every_limit_is_drawn(tables):
    assert set(tables) == {part.name for part in PARTS}
    assert all(len(table) for table in tables.values())
    limits = limits_of(tables)
    assert len({limit.subject for limit in limits}) == len(limits) == 10
    for limit in limits:
        for words in (limit.use, limit.error, limit.avoid):
            assert words.endswith(".")
            assert "nan" not in words.split()


def test_engine_confirms_both_models_and_the_report_says_so(tables):
    numbers = {limit.subject: limit.numbers for limit in limits_of(tables)}
    form = numbers["Free response: rolling out"]
    assert form["confirmed"] == form["points"] == 2.0
    assert headline(limits_of(tables)).startswith("In an ideal recess the reduced model is right")


def test_another_constant_in_the_reduced_model_changes_the_conclusions(tables, heavier_tables):
    right, wrong = limits_of(tables), limits_of(heavier_tables)
    form = next(limit for limit in wrong if limit.subject == "Free response: rolling out")
    assert form.numbers["contradicted"] == form.numbers["points"] == 2.0
    assert form.use.startswith("Not established: the engine contradicts")
    assert headline(wrong).startswith("The reduced model is not established even in an ideal recess")
    changed = [ours.subject for ours, theirs in zip(right, wrong, strict=True) if ours != theirs]
    # what each limit rests on is the reduced model, in part at least
    assert set(changed) == {limit.subject for limit in right}


@pytest.mark.parametrize(
    ("factor", "scatter", "words"),
    [
        (1.001, 0.0, "they agree within 5 % in the median (95 %: a ratio from 1.001 to 1.001)"),
        (1.1, 0.0, "they do not agree within 5 % in the median (95 %: a ratio from 1.100 to 1.100)"),
        (1.0, 0.3, "it is undecided whether they agree within 5 % in the median"),
    ],
)
def test_over_records_agreement_is_said_where_the_interval_shows_it(tables, factor, scatter, words):
    random, count = np.random.default_rng(1), 22
    peaks = random.lognormal(-1.2, 0.8, count)
    scattered = factor * peaks * np.exp(scatter * random.standard_normal(count))
    members = pd.DataFrame(
        [
            {"motion": f"record {i}", "level": 2.0, "method": method, "peak": peak, "outcome": "completed"}
            for method, values in (("recess", peaks), ("engine, recess", scattered), ("engine, flat", peaks))
            for i, peak in enumerate(values)
        ]
    )
    limits = limits_of({**tables, "statistics": members})
    use = next(limit.use for limit in limits if limit.subject == "Distributions of peak tilt")
    assert f"in an ideal recess {words}" in use
    assert "on open ground they agree within 5 % in the median (95 %: a ratio from 1.000 to 1.000)" in use
    said = headline(limits)
    assert said.startswith("The reduced model is not established") is (factor == 1.1)
    assert ("over 22 records it is undecided whether peaks agree within 5 %" in said) is (scatter > 0.0)


def test_engine_does_not_know_of_the_constant(tables, heavier_tables):
    ours, theirs = (found["statistics"] for found in (tables, heavier_tables))
    engine = ours["method"].str.startswith("engine")
    np.testing.assert_array_equal(ours[engine]["peak"], theirs[engine]["peak"])
    assert (ours[~engine]["peak"].to_numpy() != theirs[~engine]["peak"].to_numpy()).all()


def test_second_run_repeats_nothing_and_finds_the_same(tables, kept, monkeypatch):
    def measured_again(*_):
        raise AssertionError("measured again")

    monkeypatch.setattr("rockwobble.compare.studies.validity.campaign.measure_task", measured_again)
    told = []
    again = measure_all(TINY, kept, workers=1, progress=told.append)
    assert told[-1].found == told[-1].total == told[-1].done
    for name, table in tables.items():
        assert table.to_csv() == again[name].to_csv()


def test_an_ended_run_goes_on_where_it_was(tmp_path, monkeypatch):
    parts = [part_named(name) for name in ENGINE_FREE]
    whole = measure_all(TINY, tmp_path / "whole", parts=parts, workers=1)
    seen = []

    def stop(event):
        seen.append(event.done)
        if event.done == 3:
            raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt):
        measure_all(TINY, tmp_path / "ended", parts=parts, workers=1, progress=stop)
    told = []
    found = measure_all(TINY, tmp_path / "ended", parts=parts, workers=1, progress=told.append)
    assert told[0].found == 3
    assert all(found[name].to_csv() == whole[name].to_csv() for name in whole)


def test_a_torn_file_is_not_taken_for_a_result(tmp_path):
    parts = [part_named("free_response")]
    measure_all(TINY, tmp_path, parts=parts, workers=1)
    for path in (tmp_path / "measured").glob("*.json"):
        assert set(json.loads(path.read_text())) == {"part", "inputs", "rows"}


def test_up_to_needs_every_row_of_a_point():
    points = np.array([0.1, 0.1, 0.2, 0.2, 0.3])
    holds = np.array([True, True, True, False, True])
    assert up_to(points, holds) == 0.1
    assert first_failing(points, holds) == 0.2
    assert math.isnan(up_to(points, ~holds | (points > 0.1)) - up_to(points, np.zeros(5, bool)))
    assert math.isnan(first_failing(points, np.ones(5, bool)))


def test_percent_is_short_and_says_when_it_does_not_know():
    assert [percent(share) for share in (0.0, 1e-9, 0.00123, 0.1234, 1.5)] == [
        "0 %",
        "less than 0.001 %",
        "0.12 %",
        "12 %",
        "150 %",
    ]
    assert percent(math.nan) == "an unknown share"


def test_peak_difference_counts_falls_apart():
    found = peak_difference(
        np.array([0.0, 0.1, 0.2, 8.0, 8.0, math.nan]),
        np.array([0.1, 0.11, 8.0, 8.0, 0.3, 0.1]),
        np.full(6, 8.0),
    )
    assert (found.standing, found.falls) == (1, 3)
    assert found.half == pytest.approx(0.1)
    assert found.verdicts == pytest.approx(2.0 / 3.0)
