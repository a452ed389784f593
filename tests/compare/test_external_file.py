from __future__ import annotations

import math
import re
from pathlib import Path

import numpy as np
import pytest
from external_files import ANGLES, PLACE, TURN, columns

from rockwobble import reduced
from rockwobble.compare import External, read_trajectory
from rockwobble.compare.external.mistakes import Mistake
from rockwobble.compare.external.table import read_tables
from rockwobble.compare.external.trajectory import measurement
from rockwobble.models import Case, Cylinder, InitialState

PIER = Cylinder(semidiagonal=6.0, tan_alpha=0.2)
START = InitialState(tilt=0.5 * PIER.alpha, rolling_rate=0.3, rolling_angle=1.0)
RELEASE = Case(PIER, initial=START, duration=4.0, name="release")
ROUNDING = 1e-9  # of degrees and quaternions in double precision [rad]

HEAD = "time,qw,qx,qy,qz"
GOOD = "time [s],tilt [deg],azimuth [deg]\n0,1,0\n0.01,2,1\n0.02,3,2\n0.03,2,3\n"
BAD = {
    "": "is empty",
    GOOD.replace("0.02,", "0.005,"): "line 4: time must rise [s], got 0.005 after 0.01",
    GOOD + "0.2,1,2\n": "line 6: a gap of 0.17 s where the usual step is 0.01 s",
    "# table 3\n" + GOOD.replace("3,2\n", "much,2\n"): "line 5: tilt [deg] must be a number, got 'much'",
    GOOD.replace("3,2\n", ",2\n"): "line 4: tilt is missing",
    GOOD.replace("3,2\n", "3,\n"): "line 4: azimuth must be given where the tilt is 0.05236 rad",
    GOOD.replace("3,2\n", "357,2\n"): "tilt must be between -pi and pi, got 6.231 rad",
    GOOD.replace("0,1,0", "0,120,0"): "line 2: it must not lie at the start, got a tilt of 2.094 rad",
    GOOD.replace("0.0", ""): "line 3: samples must be at most 0.39 s apart for this cylinder, got 1 s",
    f"{HEAD}\n0,0,0,0,1\n0.01,0,0,0,1\n0.02,0,0,0,1\n": (
        "line 2: the quaternion must not be turned about the axis at the start, got 180 deg"
    ),
    f"{HEAD}\n0,0,1,0,0\n0.01,0,1,0,0\n0.02,0,1,0,0\n": "the quaternion holds the cylinder upside down",
    "time,x [mm],y [mm],z [mm]\n0,0,0,5.88\n0.01,0,0,5.88\n0.02,0,0,5.88\n": (
        "line 2: the mass centre must be R = 6 m from the rim and above the ground, got 1.177 m"
    ),
    GOOD.replace("3,2\n", "3\n"): "line 4: expected 3 cells as in the header, got 2",
    GOOD.replace("tilt [deg]", "tilt"): "does not say the unit of tilt: name the column 'tilt [deg]'",
    GOOD.replace("tilt [deg]", "lean [deg]"): "must have tilt where it has azimuth, got no tilt",
    GOOD.replace("time [s]", "n"): "must have columns time, and tilt and azimuth, or qw, qx, qy and qz, or x",
    GOOD.replace("azimuth", "tilt"): "must have each column once, got tilt as 'tilt [deg]' and 'tilt [deg]'",
    GOOD.split("0.01")[0]: "must hold at least 3 samples, got 1",
    f"{HEAD}\n0,1,0,0,0\n0.01,2,0,0,0\n0.02,1,0,0,0\n": "line 3: a quaternion must have the length 1, got 2",
    f"{HEAD},tilt [rad],azimuth [rad]\n0,1,0,0,0,0,0\n.01,.99875,.04998,0,0,.1,0\n.02,0,0,0,1,.1,0\n": (
        "line 4: tilt and quaternion must agree, got tilts of 0.1 and 0 rad"
    ),
}  # fmt: skip


def notes(trajectory):
    return "; ".join(fact.detail for fact in trajectory.facts if fact.code == "note")


@pytest.mark.parametrize("text", BAD)
def test_every_error_of_a_trajectory_file_names_its_line(save, text):
    with pytest.raises(ValueError, match=r"table\.csv") as caught:
        read_trajectory(save(text), RELEASE)
    assert BAD[text] in str(caught.value)
    assert "\n" not in str(caught.value)


# unreadable files, and the mistake without which they can be read: factors of the columns
UNREADABLE = {
    "time_unit": ("time", ANGLES[:2], [1e3, 1.0], 1e3),
    "angle_unit": ("tilt", ANGLES[:2], [1.0, math.degrees(1.0)], math.degrees(1.0)),
    "length_unit": ("path", ["time", *PLACE], [1.0, 1e3, 1e3, 1e3], 1e3),
    "z_reversed": ("path", ["time", *PLACE], [1.0, 1.0, 1.0, -1.0], math.nan),
    "y_up": ("path", ["time", "x", "z", "y"], [1.0, 1.0, 1.0, -1.0], math.nan),
}


@pytest.mark.parametrize("code", UNREADABLE)
def test_the_mistake_in_an_unreadable_file_is_named(save, response, code):
    concerns, names, factors, value = UNREADABLE[code]
    table = columns(response)[names] * factors
    words = Mistake(code=code, concerns=concerns, value=value).words
    with pytest.raises(ValueError, match=f"; likely mistake: {re.escape(words)}$"):
        read_trajectory(save(table.set_axis([names[0], *sorted(names[1:])], axis=1)), RELEASE)


def test_other_separators_and_units_are_set_by_options(save):
    same = read_trajectory(save(GOOD), RELEASE)
    for mark in (";", "\t"):
        silent = GOOD.replace(" [deg]", "").replace(" [s]", "").replace(",", mark)
        trajectory = read_trajectory(External(path=save(silent), angle_unit="deg"), RELEASE)
        assert trajectory.tilt.tolist() == same.tilt.tolist()
        assert trajectory.tilt.max() == pytest.approx(math.radians(3.0))


def test_missing_files_and_options_out_of_range_are_refused(tmp_path):
    with pytest.raises(ValueError, match=r"cannot read the trajectory .*none\.csv: No such file"):
        read_trajectory(tmp_path / "none.csv", RELEASE)
    with pytest.raises(ValueError, match="time_offset must be finite"):
        External(path=tmp_path / "x.csv", time_offset=math.nan)
    with pytest.raises(ValueError, match=r"label of a trajectory must be one line, got 'a\\nb'"):
        External(path=tmp_path / "x.csv", label="a\nb")
    with pytest.raises(ValueError, match="noise must be above 0"):
        External(path=tmp_path / "x.csv", noise=0.0)


@pytest.fixture(scope="module")
def response():
    return reduced.simulate(Case(PIER, initial=START, duration=4.0))


TITLES = (
    "%time,field.orientation.w,field.orientation.x,field.orientation.y,field.orientation.z,x,y,z",
    "timestamp,can_qw,can_qx,can_qy,can_qz,can_tx,can_ty,can_tz",
    "t,q0,q1,q2,q3,posX,posY,posZ",
    "Time (Seconds),rotW,rotX,rotY,rotZ,a.position.x,a.position.y,a.position.z",
)


def test_columns_are_read_by_the_end_of_their_titles(save, response):
    table = columns(response)[[*TURN, *PLACE]]
    for titles in TITLES:
        trajectory = read_trajectory(save(table.set_axis(titles.split(","), axis=1)), RELEASE)
        assert trajectory.tilt == pytest.approx(response.tilt, abs=ROUNDING)
        assert trajectory.centre_of_mass == pytest.approx(response.centre_of_mass)
        assert "not read" not in notes(trajectory)


def test_times_since_1970_are_from_the_first(save, response):
    for unit in (1.0, 1e3, 1e6, 1e9):
        table = columns(response)[TURN].assign(time=unit * (1.7e9 + response.time))
        trajectory = read_trajectory(save(table), RELEASE)
        assert trajectory.tilt == pytest.approx(response.tilt, abs=1e-6)  # digits of such a time
        assert "since 1970" in notes(trajectory)


MOTIVE = """Format Version,1.23
,,Rigid Body,
frame,n,lean,to
5,0,1,0
5,0.01,2,1
5,0.02,3,2
5,0.03,2,3
"""


def test_columns_named_by_an_option_are_read_under_any_header(save):
    for asked in ("2,3 [deg],4 [deg]", "n,lean [deg],to [deg]"):
        trajectory = read_trajectory(External(path=save(MOTIVE), columns=asked.split(",")), RELEASE)
        assert trajectory.tilt.max() == pytest.approx(math.radians(3.0))


def test_missing_columns_are_named(save):
    for asked, words in (
        {"n,az": "no line with the columns n, az", "n": "must be time, tilt; time, "}
    ).items():
        with pytest.raises(ValueError, match=words):
            read_trajectory(External(path=save(MOTIVE), columns=asked.split(",")), RELEASE)
    with pytest.raises(ValueError, match=r"got Format Version, 1\.23; --trajectory-columns names them"):
        read_trajectory(save(MOTIVE), RELEASE)


def test_an_azimuth_may_be_wrapped_at_any_angle(save, response):
    azimuth = np.degrees(response.rolling_angle)
    for wrapped in (azimuth, azimuth % 360.0, (azimuth + 180.0) % 360.0 - 180.0):
        table = columns(response)[ANGLES[:2]].assign(**{"azimuth [deg]": wrapped})
        trajectory = read_trajectory(save(table), RELEASE)
        assert trajectory.rolling_angle == pytest.approx(response.rolling_angle, abs=ROUNDING)


def test_a_negative_tilt_is_towards_the_opposite_azimuth(save):
    start = InitialState(tilt=0.5 * PIER.alpha, rolling_angle=0.4)
    planar = reduced.simulate(Case(PIER, initial=start, duration=4.0))
    signed = np.copysign(planar.tilt, np.cos(planar.rolling_angle - 0.4))
    assert signed.min() < -0.4 * PIER.alpha
    table = columns(planar)[ANGLES].assign(**{"tilt [rad]": signed, "azimuth [rad]": 0.4})
    case = Case(PIER, initial=start, duration=4.0, name="planar")
    trajectory = read_trajectory(save(table), case)
    assert trajectory.tilt == pytest.approx(planar.tilt, abs=ROUNDING)
    apart = np.exp(1j * trajectory.rolling_angle) - np.exp(1j * planar.rolling_angle)
    assert np.abs(apart[planar.tilt > 1e-3]).max() < ROUNDING
    assert f"{(signed < 0.0).sum()} negative tilts are read as a lean to" in notes(trajectory)
    alone = read_trajectory(save(table.drop(columns="azimuth [rad]")), case)
    assert alone.tilt == pytest.approx(planar.tilt, abs=ROUNDING)
    assert np.isnan(alone.rolling_angle).all()
    assert np.isnan(alone.contact_point).all()


def test_mass_centre_alone_determines_the_pose_in_a_recess(save, response):
    table = (100.0 * columns(response)[PLACE]).add_suffix(" [cm]").assign(time=response.time)
    trajectory = read_trajectory(save(table), RELEASE)
    assert measurement(trajectory).poses.given == ("path",)
    assert trajectory.tilt == pytest.approx(response.tilt, abs=ROUNDING)
    assert trajectory.rolling_angle == pytest.approx(response.rolling_angle, abs=ROUNDING)
    assert "tilt and azimuth are those of a cylinder in a recess" in notes(trajectory)


def test_lost_samples_are_left_out_and_counted(save, response):
    table = columns(response)[ANGLES]
    table.iloc[[50, 120], 1:] = np.nan
    trajectory = read_trajectory(save(table), RELEASE)
    # a local cubic over 0.02 s: (phi' dt)^3/24 of the tilt of 0.018 rad at the pass, where phi' is 9 rad/s
    assert trajectory.tilt == pytest.approx(response.tilt, abs=5e-6)
    assert "2 lost samples are left out" in notes(trajectory)
    table.iloc[51:53, 1:] = np.nan
    with pytest.raises(ValueError, match=r"a gap of 0\.04 s where the usual step is 0\.01 s"):
        read_trajectory(save(table), RELEASE)


def test_uneven_samples_and_a_late_first_sample_are_read(save):
    fine = reduced.simulate(Case(PIER, initial=START, duration=4.0), sample_step=0.001)
    uneven = np.cumsum(np.tile([8, 13, 9, 12], 95))
    table = columns(fine)[ANGLES].iloc[[0, *uneven]]
    table["time"] += 7.0
    with pytest.raises(ValueError, match="if that is the start, give its time an offset of -7 s"):
        read_trajectory(save(table), RELEASE)
    trajectory = read_trajectory(External(path=save(table), time_offset=-7.0), RELEASE)
    wanted = np.interp(trajectory.time, fine.time, fine.tilt)
    # a local cubic through samples up to 0.013 s apart, times p^3 of the tilt
    assert trajectory.tilt == pytest.approx(wanted, abs=2e-5)
    assert measurement(trajectory).poses.noise < 1e-4 * PIER.alpha


def test_noise_is_estimated_from_the_samples(save, response):
    random = np.random.default_rng(2)
    for share in (0.001, 0.005):
        noise = share * PIER.alpha * random.normal(size=(2, len(response.time)))
        lean = np.sin(response.tilt) * np.exp(1j * response.rolling_angle) + noise[0] + 1j * noise[1]
        table = {"tilt [rad]": np.arcsin(np.abs(lean)), "azimuth [rad]": np.angle(lean)}
        poses = measurement(read_trajectory(save(columns(response)[ANGLES].assign(**table)), RELEASE)).poses
        # the median of 400 normal numbers, to three of its standard deviations
        assert poses.noise == pytest.approx(share * PIER.alpha, rel=0.2)
        assert poses.stands == pytest.approx(5.0 * poses.noise)


def test_samples_of_a_rockwobble_run_are_read_unchanged(tmp_path):
    run = reduced.simulate(RELEASE)
    run.to_frame().to_csv(tmp_path / "run.csv", index=False)
    trajectory = read_trajectory(tmp_path / "run.csv", RELEASE)
    assert trajectory.tilt == pytest.approx(run.tilt, abs=ROUNDING)
    assert trajectory.rolling_angle == pytest.approx(run.rolling_angle, abs=ROUNDING)
    assert trajectory.centre_of_mass == pytest.approx(run.centre_of_mass, abs=ROUNDING)


def test_ignored_columns_are_named_in_full(tmp_path):
    more = [f"gauge_{number}" for number in range(30)]
    path = tmp_path / "can.csv"
    head, *samples = GOOD.splitlines()
    path.write_text("\n".join([",".join([head, *more]), *(line + ",0" * len(more) for line in samples)]))
    trajectory = read_trajectory(path, RELEASE)
    assert measurement(trajectory).poses.given == ("tilt", "azimuth")
    said = notes(trajectory).removeprefix("columns not read: ")
    listed, _, rest = said.partition(" and ")
    assert set(listed.split(", ")) <= set(more)
    assert rest == f"{len(more) - len(listed.split(', '))} more"
    path.write_text("time [s]," + ",".join(more) + "\n0" + ",0" * len(more))
    with pytest.raises(ValueError, match=r", got time \[s\], gauge_0, .*, gauge_\d+ and \d+ more;"):
        read_trajectory(path, RELEASE)


def test_a_device_is_no_trajectory() -> None:
    with pytest.raises(ValueError, match="it is no file"):
        read_tables(Path("/dev/zero"))
