"""Properties of any trace: quantities by their definitions, the words of a summary."""

from __future__ import annotations

import math
from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd
import pyarrow.parquet as pq
import pytest

from rockwobble.models import Case, Cylinder, Diagnostic, Run, Tendon, Trace, WobblingFrame, plain_json
from rockwobble.models.diagnostic import Assumptions
from rockwobble.models.trace import EagerSource, lost_trace

SEEDS = range(4)  # a column or a frame, with or without a tendon


def any_trace(seed: int, **given: Any) -> Trace:
    """Trace of random numbers, of a column or a frame, with or without a tendon."""
    chance = np.random.default_rng(seed)
    count = int(chance.integers(5, 30))
    body: Cylinder | WobblingFrame = Cylinder(semidiagonal=chance.uniform(0.5, 20.0), tan_alpha=0.2)
    body = WobblingFrame(body, chance.uniform(0.0, 3.0)) if seed % 2 else body
    tendon = Tendon(prestress=0.3, stiffness=chance.uniform(0.1, 5.0)) if seed % 4 > 1 else None
    time = chance.uniform(0.01, 0.1) * np.arange(count)
    tilt = (
        np.where(chance.uniform(size=count) < 0.3, 1e-3, 1.0) * chance.uniform(0.0, 1.6, count) * body.alpha
    )
    angle = np.where(chance.uniform(size=count) < 0.3, math.nan, chance.uniform(-9.0, 9.0, count))
    late = {
        "contact_force": chance.normal(0.3, 1.0, (count, 3)) * 10.0 ** chance.uniform(-9.0, 3.0, (count, 1)),
        "top_contact_force": chance.normal(0.3, 1.0, (count, 3)),
    }
    late["contact_force"][1] = [0.1, 0.0, 0.0]
    late["contact_force"][2] = math.nan
    values = {
        "case": Case(body, duration=float(time[-1]), tendon=tendon),
        "run": Run("mujoco", "recess", 1e-4),
        "version": "1",
        "time": time,
        "tilt": tilt,
        "tilt_rate": chance.normal(size=count),
        "rolling_angle": angle,
        "twist": chance.normal(size=count),
        "contact_point": chance.normal(size=(count, 2)),
        "centre_of_mass": chance.normal(size=(count, 3)),
        "peak_tilt": float(tilt.max()),
        "outcome": "stands",
        "uplift_time": 0.125,
        "uplift_direction": 0.5,
        "source": EagerSource(late),
    }
    return Trace(**{**values, **given})


@pytest.mark.parametrize("seed", SEEDS)
def test_friction_demand_is_horizontal_over_normal_force_for_any_size(seed: int) -> None:
    trace = any_trace(seed)
    for force, friction in (
        (trace.contact_force, trace.friction_needed),
        (trace.top_contact_force, trace.top_friction_needed),
    ):
        for (x, y, normal), demand in zip(force.tolist(), friction.tolist(), strict=True):
            if math.isnan(normal):
                assert math.isnan(demand)
            elif normal <= 0.0:
                assert demand == math.inf
            else:
                assert demand * normal == pytest.approx(math.sqrt(x * x + y * y), rel=1e-12)


@pytest.mark.parametrize("seed", SEEDS)
def test_demands_are_taken_in_motion_from_a_thousandth_of_alpha_on(seed: int) -> None:
    trace = any_trace(seed)
    least = 1e-3 * math.atan(0.2)
    due = [
        not math.isnan(angle) and tilt >= least
        for angle, tilt in zip(trace.rolling_angle.tolist(), trace.tilt.tolist(), strict=True)
    ]
    assert trace.open_base.tolist() == due
    at_the_limit = any_trace(seed, tilt=np.full(len(trace.time), 1e-3 * trace.case.cylinder.alpha))
    assert at_the_limit.open_base.tolist() == (~np.isnan(trace.rolling_angle)).tolist()


@pytest.mark.parametrize("seed", SEEDS)
def test_lengths_follow_from_tilt_and_position(seed: int) -> None:
    """A tilt opens a gap by the chord of the base; the top of a column moves twice as far as its middle."""
    trace = any_trace(seed)
    body, tendon = trace.case.cylinder, trace.case.tendon
    h = body.semidiagonal * math.cos(math.atan(0.2))
    b = body.semidiagonal * math.sin(math.atan(0.2))
    x, y = trace.contact_point.T
    assert trace.contact_offset + b == pytest.approx(np.sqrt(x**2 + y**2), rel=1e-12)
    if body.carries_slab:
        top = 2.0 * trace.centre_of_mass
        assert trace.slab_displacement + np.array([0.0, 0.0, 2.0 * h]) == pytest.approx(top, rel=1e-12)
    else:
        assert np.isnan(trace.slab_displacement).all()
    if tendon is None:
        assert np.isnan(trace.elongation).all()
        assert np.isnan(trace.tendon_force).all()
        assert math.isnan(trace.peak_tendon_force)
        return
    # chord between both positions of a point of the base, by its corner at the axis
    chord = b * np.hypot(1.0 - np.cos(trace.tilt), np.sin(trace.tilt))
    gaps = 1 + (body.slab_mass_ratio > 0.0)
    assert trace.elongation == pytest.approx(gaps * chord, rel=1e-9)
    assert trace.tendon_force == pytest.approx(0.3 + tendon.stiffness * gaps * chord / b, rel=1e-9)
    assert trace.peak_tendon_force == pytest.approx(trace.tendon_force.max(), rel=1e-9)
    wandered = np.random.default_rng(seed).uniform(0.1, 0.2, len(trace.time))
    other = any_trace(seed, source=EagerSource({"elongation": wandered}))
    assert other.elongation.tolist() == wandered.tolist()
    assert other.peak_tendon_force == pytest.approx(0.3 + tendon.stiffness * wandered.max() / b, rel=1e-12)


@pytest.mark.parametrize("seed", SEEDS)
@pytest.mark.parametrize("beyond", [0.9, 1.1])
def test_the_peak_is_within_the_run_or_in_the_motion_followed_after(seed: int, beyond: float) -> None:
    trace = any_trace(seed)
    at = int(np.argmax(trace.tilt))
    assert (trace.peak_time, trace.peak_within_run) == (trace.time[at], trace.peak_tilt)
    largest = float(trace.tilt[at])
    turning = np.array([[0.013, beyond * largest, 0.0, 1.0]])
    within = max(largest, beyond * largest)
    followed = any_trace(seed, extrema=turning, followed_until=99.5, peak_tilt=1.2 * largest)
    assert (followed.peak_within_run, followed.peak_time) == (within, 99.5)
    # motion after the end with a smaller maximum
    ended = any_trace(seed, extrema=turning, followed_until=99.5, peak_tilt=within)
    assert (ended.peak_within_run, ended.peak_time) == (within, trace.time[at])
    assert trace.residual_twist == trace.twist[-1]


def test_the_summary_has_the_values_of_the_trace() -> None:
    passes = pd.DataFrame({"time": [0.1, 0.2]})
    facts = [Diagnostic(code=code, time=at) for code, at in (("slip", 0.5), ("energy", 0.2), ("slip", 0.1))]
    trace = any_trace(
        1, peak_tilt=0.4321 * math.atan(0.2), passes=passes, outcome="overturned", facts=tuple(facts)
    )
    end = f"{trace.time[-1]:.4g} s"
    assert trace.summary() == {
        **{"case": "free response", "run": "mujoco recess", "outcome": f"overturned at {end}"},
        **{"mode": trace.mode, "peak tilt": "0.4321 alpha", "uplift": "0.125 s", "passes": "2"},
        "diagnostics": "slip, energy",
    }
    for rests, until, words in (
        (True, math.nan, ""),
        (False, math.nan, ", moving"),
        (False, 7.5, ", moving, followed to 7.5 s"),
    ):
        stands = any_trace(1, rests=rests, followed_until=until, uplift_time=math.nan)
        said = stands.summary()
        assert (said["outcome"], said["uplift"]) == (f"stands at {end}{words}", "none")
        assert "diagnostics" not in said
        assert repr(stands).startswith(f"Trace(mujoco recess: outcome stands at {end}{words}, mode ")


def test_a_lost_run_has_failed_with_a_reason() -> None:
    case, run = Case(Cylinder(semidiagonal=6.0, tan_alpha=0.2), duration=1.0), Run("mujoco", "flat")
    trace = lost_trace(case, run, "signal 9")
    said = {"outcome": "failed", "mode": "not known", "peak tilt": "not known", "diagnostics": "died"}
    assert said.items() <= trace.summary().items()
    assert [fact.detail for fact in trace.diagnostics] == ["signal 9"]
    assert math.isnan(trace.residual_twist)


def test_the_first_of_several_diagnostics_is_the_earliest_of_its_codes() -> None:
    facts = tuple(
        Diagnostic(code=code, time=at) for code, at in (("slip", 0.5), ("energy", 0.2), ("slip", 0.3))
    )
    held = Assumptions(breaches=(Diagnostic(code="tension", time=0.1),), friction=1.0)
    trace = any_trace(0, facts=facts, source=EagerSource({}, held))
    for codes, time in ((("slip",), 0.3), (("slip", "energy"), 0.2), (("slip", "tension"), 0.1)):
        assert trace.first(*codes) == time
    assert trace.first("wall_contact") == math.inf


@pytest.mark.parametrize("seed", SEEDS)
def test_a_stored_trace_is_read_with_the_same_bits(seed: int, tmp_path: Path) -> None:
    trace = any_trace(seed, followed_until=3.5, step_count=7, error_estimate=1e-9, settings={"cone": "round"})
    path = tmp_path / "a.parquet"
    trace.save(path)
    pq.write_table(pq.read_table(path), path, write_page_checksum=seed > 0)  # 0.2 wrote none
    again = Trace.load(path)
    pd.testing.assert_frame_equal(again.to_frame(), trace.to_frame(), check_exact=True)
    assert plain_json.dumps(again.to_plain()) == plain_json.dumps(trace.to_plain())
    assert again.case == trace.case
    columns = trace.to_frame().columns
    assert ("top_force_x" in columns) == trace.case.cylinder.carries_slab
    assert ("elongation" in columns) == (trace.case.tendon is not None)
    for place, name in enumerate(("force_x", "force_y", "force_z")):
        assert columns.get_loc(name) == columns.get_loc("force_x") + place
        np.testing.assert_array_equal(trace.to_frame()[name], trace.contact_force[:, place])
    for place, name in enumerate(("centre_x", "centre_y", "centre_z")):
        np.testing.assert_array_equal(trace.to_frame()[name], trace.centre_of_mass[:, place])


def test_a_foreign_damaged_or_old_file_is_refused(tmp_path: Path) -> None:
    trace, path = any_trace(1), tmp_path / "run.parquet"
    trace.save(path)
    whole = path.read_bytes()
    place = len(whole) // 4  # among the samples; the case is at the end
    table = pd.DataFrame({"x": [1.0]})
    for content in (b"time,tilt", table.to_parquet(), whole[:place] + b"XXXX" + whole[place + 4 :]):
        path.write_bytes(content)
        with pytest.raises(ValueError, match="must be the file of a trace, cannot read it as one"):
            Trace.load(path)
    facts = plain_json.loads(plain_json.dumps(trace.to_plain()))
    del facts["rest_intervals"]
    with pytest.raises(ValueError, match=r"a trace of 0\.2 or older must be run again"):
        Trace.from_plain(facts, trace.to_frame(), trace.case)
