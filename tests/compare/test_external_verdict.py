"""External trajectories with known mistakes, and right ones of all kinds."""

from __future__ import annotations

import dataclasses
import functools
import math
import types

import numpy as np
import pandas as pd
import pytest
from external_files import ANGLES, TURN, columns

from rockwobble import comparison, reduced
from rockwobble.compare import Comparison, read_trajectory
from rockwobble.compare.external.verdict import VERDICT_COLUMNS, judge, lists_in_words, mistakes_of
from rockwobble.models import Case, Cylinder, InitialState, el_centro_1940

PIER = Cylinder(semidiagonal=6.0, tan_alpha=0.2)
DRUM = Cylinder(semidiagonal=1.0, tan_alpha=0.35)
LITTLE = Cylinder(semidiagonal=0.3, tan_alpha=0.2)  # body with few samples in a swing
SQUAT = Cylinder(semidiagonal=3.0, tan_alpha=1.0)


def released(name, body, tilt, rate, azimuth=0.0, length=6.0):
    time = math.sqrt(body.semidiagonal / 6.0)  # Froude scale, from a cylinder of 6 m
    start = InitialState(tilt=tilt * body.alpha, rolling_rate=rate / time, rolling_angle=azimuth)
    return Case(body, initial=start, duration=length * time, name=name)


CASES = {
    case.name: case
    for case in (
        Case(PIER, el_centro_1940().scaled(2.0), duration=8.0, name="pier shaken"),
        Case(DRUM, el_centro_1940().scaled(2.5), duration=8.0, name="drum shaken"),
        Case(SQUAT, el_centro_1940().scaled(5.0), duration=8.0, name="squat shaken"),
        released("pier wobbles", PIER, 0.5, 0.3, 1.0),
        released("pier passes", PIER, 0.7, 0.02),
        released("pier falls", PIER, 0.5, 1.5, -2.0),
        released("squat wobbles", SQUAT, 0.5, 0.3, 1.0),
        released("planar", PIER, 0.3, 0.0, 0.5),
        Case(LITTLE, el_centro_1940().scaled(1.5), duration=12.0, name="little shaken"),
        released("little planar", LITTLE, 0.6, 0.0, -1.5, length=8.0),
        released("hardly moves", PIER, 0.03, 0.3),
    )
}
NOISE = 0.005  # of alpha


@functools.cache
def response(name, model="recess", sample_step=0.01):
    case = CASES[name]
    return reduced.simulate(
        Case(case.cylinder, case.motion, initial=case.initial, duration=case.duration),
        **reduced.MODELS[model],
        sample_step=sample_step,
    )


def samples(name, kind="both", *, model="recess", sample_step=0.01, noise=0.0, seed=0) -> pd.DataFrame:
    """Columns of a file: "angles", "both" with the path, "mass", which is the path alone, or "tilt"."""
    trace, body = response(name, model, sample_step), CASES[name].cylinder
    generator = np.random.default_rng(seed)
    lean = trace.tilt * np.exp(1j * np.nan_to_num(trace.rolling_angle))
    path, size = trace.centre_of_mass, noise * body.alpha
    lean = lean + size * (generator.normal(size=len(lean)) + 1j * generator.normal(size=len(lean)))
    path = path + size * body.semidiagonal * generator.normal(size=path.shape)
    table = {"time": trace.time}
    if kind != "mass":
        table["tilt [deg]"] = np.degrees(np.abs(lean))
    if kind in ("angles", "both"):
        table["azimuth [deg]"] = np.degrees(np.angle(lean)) % 360.0
    if kind in ("mass", "both"):
        table |= dict(zip("xyz", path.T, strict=True))
    return pd.DataFrame(table)


def judged(trajectory, model, case):
    row = types.SimpleNamespace(**judge(trajectory, model, case))
    row.mistakes = mistakes_of(row)
    return row


def verdict(name, path, model="recess"):
    return judged(read_trajectory(path, CASES[name]), response(name, model), CASES[name])


def named(judged):
    return [(mistake.concerns, mistake.code) for mistake in judged.mistakes]


# a mass centre alone is read as that of a cylinder in a recess
KINDS = [("mass", "recess")] + [(k, m) for k in ("angles", "both", "tilt") for m in ("recess", "flat")]


@pytest.mark.slow
@pytest.mark.parametrize("number", range(len(CASES)))
def test_a_right_trajectory_follows_its_model_without_mistakes(save, number):
    name = list(CASES)[number]
    for kind, model in (KINDS[number % len(KINDS)], KINDS[(number + 3) % len(KINDS)]):
        case, other = CASES[name], {"recess": "flat", "flat": "recess"}[model]
        # the easiest to judge and the hardest: few samples, with noise
        for sample_step, noise in ((0.01, 0.0), (0.02, NOISE)):
            table = samples(name, kind, model=model, sample_step=sample_step, noise=noise)
            trajectory = read_trajectory(save(table), case)
            assert judged(trajectory, response(name, model), case).differs_in == (), (kind, sample_step)
            # the model of the other support may differ, but by no mistake of the file
            assert judged(trajectory, response(name, other), case).mistakes == (), (kind, sample_step)


def turned(table, angle=0.0, *, mirrored=False, of=("azimuth [deg]", "x")):
    table = table.copy()
    if "azimuth [deg]" in of and "azimuth [deg]" in table:
        table["azimuth [deg]"] = (-1.0 if mirrored else 1.0) * table["azimuth [deg]"] + angle
    if "x" in of and "x" in table:
        flat = (table["x"] + (-1j if mirrored else 1j) * table["y"]).to_numpy()
        flat = flat * np.exp(1j * math.radians(angle))
        table["x"], table["y"] = flat.real, flat.imag
    return table


def scaled(table, factor, *names):
    return table.assign(**{name: factor * table[name] for name in names})


def later(table, delay):
    table = table.assign(time=table["time"] + delay)
    if delay < 0.0:
        return table[table["time"] > -1e-9]
    waits = np.arange(0.0, delay - 1e-9, 0.01)
    return pd.concat([table.iloc[[0] * len(waits)].assign(time=waits), table])


@pytest.mark.slow
@pytest.mark.parametrize(
    ("start", "code"),
    [
        # beyond the balance motion scales with the rate p: the size is wrong, or gravity
        (InitialState(1.2 * PIER.alpha), ["time_scale"]),
        (InitialState(1.02 * PIER.alpha, rolling_rate=0.1), ["time_scale"]),
        # spin and a rate of the tilt have other time scales: the delay grows during the fall
        (InitialState(0.5 * PIER.alpha, rolling_rate=1.5), []),
        (InitialState(0.9 * PIER.alpha, tilt_rate=0.3, rolling_rate=0.2), []),
    ],
)
def test_a_fall_of_another_size_is_no_offset_of_the_clock(save, start, code):
    case = Case(PIER, initial=start, duration=6.0, name="falls")
    model = reduced.simulate(case)
    for size, delay, expected in ((0.99, 0.0, code), (1.01, 0.0, code), (1.0, 0.3, ["time_offset"])):
        body = dataclasses.replace(PIER, semidiagonal=size * PIER.semidiagonal)
        trace = reduced.simulate(dataclasses.replace(case, cylinder=body))
        trajectory = read_trajectory(save(later(columns(trace)[ANGLES], delay)), case)
        assert [mistake.code for mistake in judged(trajectory, model, case).mistakes] == expected, size


DEG, XYZ = ("tilt [deg]", "azimuth [deg]"), ("x", "y", "z")
DEGREES, RADIAN = math.degrees(1.0), math.radians(1.0)
# change of a file, and the mistake expected: its quantity, code, value (None: no value)
MISTAKES = {
    "a quarter": (lambda t: turned(t, 90.0), "axes", "turned_counterclockwise", None),
    "a quarter back": (lambda t: turned(t, -90.0), "axes", "turned_clockwise", None),
    "turned back": (lambda t: turned(t, 180.0), "axes", "turned_back", None),
    "clockwise": (lambda t: turned(t, mirrored=True), "axes", "y_reversed", None),
    "x reversed": (lambda t: turned(t, 180.0, mirrored=True), "axes", "x_reversed", None),
    "exchanged": (lambda t: turned(t, 90.0, mirrored=True), "axes", "axes_exchanged", None),
    "north east down": (lambda t: turned(t, -90.0, mirrored=True), "axes", "axes_exchanged_reversed", None),
    "azimuth alone": (lambda t: turned(t, -90.0, of=[DEG[1]]), "azimuth", "turned_clockwise", None),
    "path alone": (lambda t: turned(t, 90.0, mirrored=True, of=["x"]), "path", "axes_exchanged", None),
    "late": (lambda t: later(t, 0.3), "time", "time_offset", -0.3),
    "early": (lambda t: later(t, -0.3), "time", "time_offset", 0.3),
    "slow motion": (lambda t: scaled(t, 2.0, "time"), "time", "clock", 2.0),
    "radians": (lambda t: scaled(t, RADIAN, *DEG), "tilt and azimuth", "angle_unit", RADIAN),
    "degrees of azimuth": (lambda t: scaled(t, DEGREES, DEG[1]), "azimuth", "angle_unit", DEGREES),
    "mm": (lambda t: scaled(t, 1e3, *XYZ), "path", "length_unit", 1e3),
    "m for mm": (lambda t: scaled(t, 1e-3, *XYZ), "path", "length_unit", 1e-3),
    "z down": (lambda t: scaled(t, -1.0, "z"), "path", "z_reversed", None),
    "from its place at rest": (lambda t: t.assign(z=t["z"] - 5.0), "path", "origin", 5.0),
}  # fmt: skip


@pytest.mark.slow
@pytest.mark.parametrize("mistake", MISTAKES)
def test_a_mistake_is_named_with_its_value(save, mistake):
    change, concerns, code, value = MISTAKES[mistake]
    for name, noise in (("pier wobbles", 0.0), ("pier shaken", NOISE)):
        judged = verdict(name, save(change(samples(name, noise=noise))))
        assert judged.differs_in
        assert named(judged) == [(concerns, code)]
        wanted = math.nan if value is None else value
        # accuracy of the fit: a fiftieth
        assert judged.mistakes[0].value == pytest.approx(wanted, rel=0.02, nan_ok=True)
        assert judged.differs_without_mistake == ()


def test_two_mistakes_are_both_named(save):
    table = scaled(turned(samples("pier shaken"), 90.0, mirrored=True), 1e3, *XYZ)
    judged = verdict("pier shaken", save(table))
    assert named(judged) == [("axes", "axes_exchanged"), ("path", "length_unit")]
    assert judged.likely_mistake_value == pytest.approx((math.nan, 1000.0), nan_ok=True)
    assert judged.differs_without_mistake == ()
    words = lists_in_words(pd.DataFrame([vars(judged)])).iloc[0]
    texts = words["likely_mistake"], words["likely_mistake_value"]
    assert texts == ("axes_exchanged; length_unit", "; 1000")
    assert judged.agreement_without_mistake == pytest.approx(8.0)


@pytest.mark.parametrize("name", ["planar", "hardly moves"])
def test_a_sign_is_named_before_an_offset(save, name):
    # while the height hardly changes, an offset of twice its value would fit as well
    assert named(verdict(name, save(scaled(samples(name), -1.0, "z")))) == [("path", "z_reversed")]


def test_quaternions_of_another_order_and_axes_are_named(save):
    trace = response("pier wobbles")
    _, w, x, y, z = columns(trace)[TURN].to_numpy().T
    east, north, up = trace.centre_of_mass.T
    for turns, place, expected in (
        ((w, -x, -y, -z), {}, ("quaternion", "quaternion_inverse")),
        ((w, x, z, -y), {}, ("axes", "y_up")),
        ((w, x, z, -y), {"x": east, "y": up, "z": -north}, ("axes", "y_up")),
    ):
        table = {"time": trace.time, **dict(zip(TURN[1:], turns, strict=True)), **place}
        judged = verdict("pier wobbles", save(pd.DataFrame(table)))
        assert named(judged) == [expected]
        assert judged.mistakes[0].changes_tilt
        assert judged.differs_without_mistake == ()


@pytest.mark.parametrize(("name", "model"), [("pier wobbles", "flat"), ("drum shaken", "recess")])
def test_any_steady_spin_about_the_axis_is_named(save, name, model):
    trace, chance = response(name, model), np.random.default_rng(11)
    for sign in (1.0, -1.0):
        rate = sign * 10.0 ** chance.uniform(-1.0, 1.0)
        judged = verdict(name, save(columns(trace, spin=rate)[TURN]), model)
        assert (judged.differs_in, named(judged)) == (("twist",), [("twist", "spin")])
        # at rest the azimuth, and with it the start of the spin, is a sample off
        assert judged.mistakes[0].value == pytest.approx(math.degrees(rate), rel=1e-3)


def test_y_that_points_up_in_the_path_alone_is_named(save):
    table = samples("pier wobbles")
    judged = verdict("pier wobbles", save(table.assign(y=table["z"], z=-table["y"])))
    assert named(judged) == [("path", "y_up")]


def test_planar_motion_names_a_rotation_where_a_mirror_fits_too(save):
    turn = 2.0 * math.degrees(0.5)  # of a mirror image: its plane is at 0.5 rad
    judged = verdict("planar", save(turned(samples("planar", "angles"), 90.0 + turn, mirrored=True)))
    assert named(judged) == [("azimuth", "turned_counterclockwise")]
    # mirrored in its own plane it is the same motion
    same = turned(samples("planar", "angles"), 2.0 * math.degrees(0.5), mirrored=True)
    assert verdict("planar", save(same)).differs_in == ()


def other_body(name, **changes):
    case = CASES[name]
    initial = changes.pop("initial", case.initial)
    body = {"gravity": case.gravity, "cylinder": case.cylinder} | changes
    trace = reduced.simulate(Case(motion=case.motion, initial=initial, duration=case.duration, **body))
    return columns(trace)[ANGLES]


SMALLER = Cylinder(semidiagonal=6.0 / 1.01, tan_alpha=0.2)
OTHERS = {"R 1 % smaller": ({"cylinder": SMALLER}, 1.0 / 1.01), "g = 10": ({"gravity": 10.0}, 9.81 / 10.0)}


@pytest.mark.parametrize("other", OTHERS)
@pytest.mark.parametrize("name", ["pier wobbles", "pier passes", "planar"])
def test_another_size_or_gravity_is_the_time_scale_of_a_release(save, name, other):
    changes, size = OTHERS[other]
    for azimuth, codes in ((0.0, []), (90.0, ["turned_counterclockwise"])):
        table = other_body(name, **changes)
        table["azimuth [rad]"] += math.radians(azimuth)
        judged = verdict(name, save(table))
        # a rotated azimuth is no cause of a tilt difference, and is named besides
        assert [mistake.code for mistake in judged.mistakes] == ["time_scale", *codes]
        # an unscaled spin adds a tenth
        assert judged.mistakes[0].value ** 2 - 1.0 == pytest.approx(size - 1.0, rel=0.12)
        assert [mistake.changes_tilt for mistake in judged.mistakes] == [True] + [False] * len(codes)


LARGER = {"cylinder": Cylinder(semidiagonal=6.3, tan_alpha=0.2)}


@pytest.mark.parametrize("changes", [LARGER, {"gravity": 9.3}])
def test_under_shaking_another_size_or_gravity_is_no_time_scale(save, changes):
    judged = verdict("pier shaken", save(other_body("pier shaken", **changes)))
    assert "tilt" in judged.differs_in
    assert judged.mistakes == ()


@pytest.mark.slow
@pytest.mark.parametrize("name", ["pier wobbles", "pier passes", "squat wobbles"])
def test_another_start_is_no_mistake_of_the_file(save, name):
    start = CASES[name].initial
    for key, factor in (("tilt", 1.02), ("tilt", 1.05), ("rolling_rate", 1.05), ("rolling_rate", 1.2)):
        initial = dataclasses.replace(start, **{key: factor * getattr(start, key)})
        judged = verdict(name, save(other_body(name, initial=initial)))
        assert judged.mistakes == (), (key, factor)


@pytest.mark.slow
@pytest.mark.parametrize("name", ["pier wobbles", "pier passes", "planar"])
def test_decaying_motion_loses_energy_and_has_no_other_time_scale(save, name):
    for loss in (0.005, 0.03):  # share of the tilt lost in a second
        table = samples(name)
        table["tilt [deg]"] *= np.exp(-loss * table["time"])
        codes = {each.code for each in verdict(name, save(table)).mistakes}
        assert codes <= {"energy_loss", "rolling_resistance"}


@pytest.mark.parametrize("resistance", [0.01, 0.03])
def test_the_rolling_resistance_of_a_trajectory_is_identified(save, resistance):
    judged = verdict("pier wobbles", save(other_body("pier wobbles", rolling_resistance=resistance)))
    assert judged.likely_mistake == ("energy_loss", "rolling_resistance")
    # the finest lengths tried are 2 % apart
    assert judged.likely_mistake_value[1] == pytest.approx(resistance, rel=0.05)


def test_missing_columns_are_reported_and_not_compared(save):
    alone = verdict("pier shaken", save(samples("pier shaken", "tilt")))
    assert alone.not_compared == alone.not_given == ("azimuth", "path")
    assert math.isnan(alone.azimuth_rms)
    assert verdict("pier shaken", save(samples("pier shaken", "angles"))).not_given == ("path",)
    assert verdict("pier shaken", save(samples("pier shaken", "mass"))).not_compared == ()
    small = scaled(samples("pier shaken"), 1e-3, "tilt [deg]")
    judged = verdict("pier shaken", save(small))
    assert (judged.not_compared, judged.not_given) == (("azimuth",), ())


def test_a_trajectory_of_another_problem_gets_no_explanation(save):
    judged = verdict("pier wobbles", save(samples("pier shaken")))
    # one sample at which an offset would fit is no path that agrees
    assert (judged.differs_in, judged.mistakes) == (("tilt",), ())
    assert (judged.not_compared, judged.not_given) == (("azimuth", "path"), ())


def test_a_verdict_is_a_row_of_a_separate_table(save, tmp_path):
    path = save(turned(samples("pier shaken", "angles"), 90.0))
    results = comparison(CASES["pier shaken"], runs=[], external=[path], workers=1, out=tmp_path / "out")
    (row,) = results.external.to_dict("records")
    again = Comparison.load(tmp_path / "out").external
    pd.testing.assert_frame_equal(results.external, again, check_exact=True)
    text = pd.read_csv(tmp_path / "out" / "external.csv").iloc[0]
    assert (text["differs_in"], text["likely_mistake"]) == (
        "azimuth; uplift_direction",
        "turned_counterclockwise",
    )
    assert set(VERDICT_COLUMNS) <= set(row)
    assert not results.summary["diverged"].any()  # the tilts agree
    assert row["differs_in"] == ("azimuth", "uplift_direction")
    assert row["azimuth_rms"] == pytest.approx(90.0, abs=0.1)
    # from the first tilt of more than 5 % of the largest on
    assert response("pier shaken").uplift_time < row["azimuth_differs_from"] < 3.0
    assert (row["likely_mistake"], row["likely_mistake_in"]) == (("turned_counterclockwise",), ("azimuth",))
    assert row["not_compared"] == row["not_given"] == ("path",)


def test_noise_is_no_divergence(save):
    path = save(samples("pier wobbles", "angles", noise=NOISE))
    results = comparison(CASES["pier wobbles"], runs=[], external=[path], workers=1)
    (row,) = results.external.to_dict("records")
    assert not results.summary["diverged"].any()
    assert row["noise"] == pytest.approx(NOISE, rel=0.2)
    assert row["tilt_bound"] == pytest.approx(0.01 + 5.0 * row["noise"])
