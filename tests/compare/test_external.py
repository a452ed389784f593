from __future__ import annotations

import dataclasses
import math
from collections.abc import Callable
from pathlib import Path

import numpy as np
import pandas as pd
import pytest
from external_files import ANGLES, PLACE, TURN, columns

from rockwobble import comparison, multibody, reduced
from rockwobble.compare import External, read_trajectory
from rockwobble.compare.metrics.pair import make_pair
from rockwobble.models import Case, Cylinder, InitialState, Run, Suite, el_centro_1940

PIER = Cylinder(semidiagonal=6.0, tan_alpha=0.2)
RELEASE = Case(
    PIER,
    initial=InitialState(tilt=0.5 * PIER.alpha, rolling_rate=0.3, rolling_angle=1.0),
    duration=4.0,
    name="release",
)
SHAKEN = Case(PIER, el_centro_1940().scaled(2.0), duration=8.0, name="shaken")
CASES = {"release": RELEASE, "shaken": SHAKEN}
ROUNDING = 1e-9  # of degrees and quaternions in double precision, [alpha] and [rad]


@pytest.fixture(scope="module")
def in_recess():
    return {
        name: multibody.simulate(
            Case(PIER, case.motion, initial=case.initial, duration=case.duration), time_step=0.0005
        )
        for name, case in CASES.items()
    }


def rows(case, path, **given):
    """Rows of the engine, run again as in `in_recess`, and of the file."""
    results = comparison(
        case,
        runs=[Run("mujoco", "recess", 5e-4)],
        external=[External(path=path, **given)],
        workers=1,
    )
    table = results.rows(case.name).set_index("run")
    return table.loc["mujoco recess"], table.loc[path.stem]


def in_other_units(table: pd.DataFrame) -> pd.DataFrame:
    """Times in ms and positions in mm."""
    units = {"time": "time [ms]", **{name: f"{name} [mm]" for name in PLACE}}
    return (1e3 * table[[*units]]).rename(columns=units).join(table[TURN[1:]])


@pytest.mark.slow
@pytest.mark.parametrize("name", CASES)
def test_an_exported_trajectory_has_the_metrics_of_its_run(in_recess, save, name):
    engine, external = rows(CASES[name], save(columns(in_recess[name])[ANGLES]))
    assert external["support"] == "external"
    # the soft turn of an engine at the first passes of a shaken cylinder is no mistake of a file
    assert (external["differs_in"], external["likely_mistake"]) == ((), ())
    for column in ("tilt_rms", "tilt_rms_relative"):
        assert external[column] == pytest.approx(engine[column], abs=ROUNDING)
    # a parabola through samples 0.01 s apart in place of the engine's steps: (p dt)^4 of the tilt
    assert external["peak_tilt"] == pytest.approx(engine["peak_tilt"], abs=1e-5)
    assert external["turn_difference"] == pytest.approx(engine["turn_difference"], abs=1e-6)
    same = ["agreement_time", "diverged", "agreed_passes", "outcome", "closest_pass"]
    assert external[same].tolist() == engine[same].tolist()
    assert math.isnan(external["energy_loss"])


def test_twist_and_position_follow_from_quaternions_and_mass_centre(in_recess, save):
    engine, external = rows(SHAKEN, save(in_other_units(columns(in_recess["shaken"])[[*TURN, *PLACE]])))
    assert external["tilt_rms"] == pytest.approx(engine["tilt_rms"], abs=ROUNDING)
    for column in ("residual_twist", "residual_displacement", "contact_rms"):
        assert engine[column] != 0.0
        assert external[column] == pytest.approx(engine[column], abs=1e-6)  # rounding at small tilt
    assert not math.isnan(external["contact_rms"])


def test_uplift_passes_and_whole_turns_are_those_of_the_engine(in_recess, save):
    engine = in_recess["shaken"]
    trajectory = read_trajectory(save(columns(engine)[ANGLES]), SHAKEN)
    # one sample: error of the cube root for an uplift that is not a pure ramp
    assert trajectory.uplift_time == pytest.approx(engine.uplift_time, abs=0.01)
    # the direction turns at its own rate until the first tilted sample
    assert trajectory.uplift_direction == pytest.approx(engine.uplift_direction, abs=0.05)
    assert np.isnan(trajectory.rolling_angle[trajectory.time < trajectory.uplift_time]).all()
    assert read_trajectory(save(columns(in_recess["release"])[ANGLES]), RELEASE).uplift_time == 0.0
    # the first pass dips by 3e-6 rad, below the noise threshold
    passes, back = engine.passes[engine.passes["time"] > 2.0], trajectory.passes
    assert len(back) == len(passes) >= 2
    for name in ("time", "angle_of_turn"):  # a tenth of a sample
        assert back[name].to_numpy() == pytest.approx(passes[name].to_numpy(), abs=1e-3)
    assert back["resolved"].all()


def test_samples_are_interpolated_to_those_of_the_comparison(save):
    case = Case(PIER, initial=RELEASE.initial, duration=4.0)
    fine, reference = reduced.simulate(case, sample_step=0.004), reduced.simulate(case)
    for every in (2, 3):
        trajectory = read_trajectory(save(columns(fine)[ANGLES].iloc[::every]), RELEASE)
        pair = make_pair(PIER, reference, trajectory)
        assert len(pair.time) >= 400
        # a local cubic through samples at most 0.012 s apart, times p^3 of the tilt
        assert np.abs(pair.tilt_difference).max() < 2e-5
        assert np.nanmax(np.abs(pair.rolling_angle - pair.reference_rolling_angle)) < 2e-3


def test_a_pass_between_samples_is_inferred_from_the_rotation_sense(save):
    start = InitialState(tilt=0.5 * PIER.alpha, rolling_rate=0.01)
    case = Case(PIER, initial=start, duration=5.0, name="near")
    response = reduced.simulate(Case(PIER, initial=start, duration=5.0))
    trajectory = read_trajectory(save(columns(response)[ANGLES]), case)
    assert not trajectory.passes["resolved"].all()
    (missed,) = trajectory.facts
    assert (missed.code, missed.size) == ("missed_pass", 1.0)
    assert trajectory.rolling_angle[-1] == pytest.approx(response.rolling_angle[-1], abs=1e-9)


def test_a_time_offset_corrects_a_late_clock(in_recess, save):
    table = columns(in_recess["shaken"])[ANGLES]
    late = table.assign(time=table["time"] + 3.0)
    with pytest.raises(ValueError, match=r"table\.csv, line 2: the trajectory begins 3 s after the start"):
        read_trajectory(save(late), SHAKEN)
    trajectory = read_trajectory(External(path=save(late), time_offset=-3.0), SHAKEN)
    assert trajectory.tilt == pytest.approx(in_recess["shaken"].tilt, abs=1e-7)  # times rounded by the shift


def test_noise_of_a_measurement_is_no_uplift(in_recess, save):
    table = columns(in_recess["shaken"])[ANGLES]
    generator = np.random.default_rng(1)
    noisy = table.assign(**{"tilt [rad]": table["tilt [rad]"] + generator.uniform(0.0, 1.7e-4, len(table))})
    noisy["azimuth [rad]"] = noisy["azimuth [rad]"].fillna(0.0)
    path = save(noisy)
    assert read_trajectory(External(path=path, noise=1e-6), SHAKEN).uplift_time == 0.0
    for noise in (None, math.radians(0.02)):  # by its own scatter, and as stated by the user
        quiet = read_trajectory(External(path=path, noise=noise), SHAKEN)
        # a ramp to 0.02 deg
        assert quiet.uplift_time == pytest.approx(in_recess["shaken"].uplift_time, abs=0.15)


@pytest.mark.parametrize(("tilt", "outcome"), [(1.2, "overturned"), (0.9, "stands")])
def test_a_fall_that_outlasts_the_run_is_followed_to_the_ground(save, tilt, outcome):
    start = InitialState(tilt=tilt * PIER.alpha, tilt_rate=0.01)
    response = reduced.simulate(Case(PIER, initial=start, duration=20.0))
    length = 0.5 * float(response.time[-1]) if outcome == "overturned" else 1.0
    case = Case(PIER, initial=start, duration=length, name="short")
    trajectory = read_trajectory(save(columns(response)[ANGLES]), case)
    assert trajectory.outcome == outcome
    if outcome == "overturned":
        assert (trajectory.peak_tilt, trajectory.time[-1]) == (0.5 * math.pi, response.time[-1])
        whole = dataclasses.replace(case, duration=20.0)
        path = save(columns(response)[ANGLES])
        row = comparison(whole, runs=[], external=[path], workers=1).summary.iloc[0]
        assert (row["outcome"], row["reference_outcome"]) == ("overturned", "overturned")
        assert row["peak_tilt"] == row["reference_peak_tilt"]
    else:
        assert trajectory.time[-1] == length
        # motion after the end is not read
        assert (trajectory.passes["time"] <= length).all()
        # a vertex is above the samples next to it by its curvature, p^2 theta dt^2/8 at most
        largest = response.tilt[response.time <= length].max()
        assert trajectory.peak_tilt == pytest.approx(largest, abs=3e-6)


def test_ambiguous_labels_and_cases_are_refused(in_recess, save):
    path = save(columns(in_recess["release"])[ANGLES])
    with pytest.raises(ValueError, match="each run must have its own label, got 'table' twice"):
        comparison(RELEASE, runs=[], external=[path, path])
    with pytest.raises(ValueError, match="each run must have its own label, got 'recess model' twice"):
        comparison(RELEASE, runs=[], external=[External(path=path, label="recess model")])
    with pytest.raises(ValueError, match="a trajectory belongs to one case, got 2 cases"):
        comparison(Suite([RELEASE, SHAKEN], []), external=[path])


def test_half_turns_of_planar_motion_are_passes_without_twist(save: Callable[..., Path]) -> None:
    start = InitialState(0.5 * PIER.alpha)
    case = Case(PIER, initial=start, duration=6.0, name="planar")
    planar = reduced.simulate(Case(PIER, initial=start, duration=6.0), sample_step=0.005)
    signed = np.copysign(planar.tilt, np.cos(planar.rolling_angle))
    path = save(pd.DataFrame({"time": planar.time, "tilt [rad]": signed, "azimuth [rad]": 0.0}))
    assert len(read_trajectory(path, case).passes) == len(planar.passes) == 2
    (row,) = comparison(case, runs=[], external=[path], workers=1).summary.to_dict("records")
    assert row["turn_difference"] == pytest.approx(0.0, abs=1e-6)  # as above


def test_peak_is_a_vertex_and_of_a_short_file_over_its_duration(save) -> None:
    trace, coarse = reduced.simulate(SHAKEN), reduced.simulate(SHAKEN, sample_step=0.04)
    trajectory = read_trajectory(save(columns(coarse)[ANGLES]), SHAKEN)
    # vertex of a parabola; the highest of these samples is 4e-5 lower
    assert trajectory.peak_tilt == pytest.approx(trace.peak_tilt, abs=1e-5)
    early = columns(trace)[ANGLES][trace.time <= 0.7 * trace.time[int(np.argmax(trace.tilt))]]
    row = comparison(SHAKEN, runs=[], external=[save(early)], workers=1).summary.iloc[0]
    assert row["reference_peak_tilt"] > 1.1 * row["peak_tilt"]
    assert row["peak_tilt_difference"] == pytest.approx(0.0, abs=1e-6)  # samples of a smooth tilt
