from __future__ import annotations

import math
import re
import subprocess
import sys
from pathlib import Path

import pytest

from rockwobble import models
from rockwobble.models import el_centro_1940, read_suite

CASE = """
[[cases]]
name = "release"
cylinder = { semidiagonal = 6, tan_alpha = 0.2 }
release = { tilt_over_alpha = 0.5 }
duration = 8
"""
RECORD = 'motion = { record = "el_centro_1940" }'
STILL = "release = { tilt_over_alpha = 0.5 }"


def replaced(old: str, new: str) -> str:
    assert old in CASE
    return CASE.replace(old, new)


def test_every_key_of_a_suite_file_is_used(write):
    text = """
    [[runs]]
    engine = "mujoco"
    support = "flat"
    time_step = 1e-4
    settings = { iterations = 50 }

    [[cases]]
    name = "all of it"
    cylinder = { semidiagonal = 5, tan_alpha = 0.25, height = 8, transverse_inertia = 7, axial_inertia = 1.5 }
    motion = { record = "el_centro_1940", vertical = true, scale = 2, rotation_deg = 30, time_shift = -0.5 }
    release = { tilt_deg = 3, tilt_rate = 0.1, rolling_angle_deg = 90, rolling_rate = 0.2 }
    duration = 4
    gravity = 9.8
    friction = 0.7
    """
    suite = read_suite(write(text, "all.suite.toml"))
    (case,), (run,) = suite.cases, suite.runs
    assert (run.engine, run.support, run.time_step, dict(run.settings)) == (
        "mujoco",
        "flat",
        1e-4,
        {"iterations": 50},
    )
    body = case.cylinder
    assert (body.semidiagonal, body.tan_alpha, body.height) == (5.0, 0.25, 8.0)
    assert (body.transverse_inertia, body.axial_inertia) == (7.0, 1.5)
    whole = el_centro_1940(vertical=True).scaled(2.0).rotated(math.radians(30.0))
    assert case.motion.acceleration.tolist() == whole.acceleration[50:].tolist()
    assert (case.initial.tilt, case.initial.tilt_rate) == (math.radians(3.0), 0.1)
    assert (case.initial.rolling_angle, case.initial.rolling_rate) == (math.radians(90.0), 0.2)
    assert (case.name, case.duration, case.gravity, case.friction) == ("all of it", 4.0, 9.8, 0.7)


def test_lists_and_ranges_give_each_combination_one_named_case(write):
    text = replaced("tan_alpha = 0.2", "tan_alpha = [0.1, 0.2]").replace(
        "tilt_over_alpha = 0.5", "tilt_over_alpha = { from = 0.2, to = 0.6, step = 0.2 }"
    )
    suite = read_suite(write(text))
    assert [case.name for case in suite.cases] == [
        f"release: tan_alpha {slope}, tilt_over_alpha {tilt}"
        for slope in (0.1, 0.2)
        for tilt in (0.2, 0.4, 0.6)
    ]
    for case in suite.cases:
        assert case.name == (
            f"release: tan_alpha {case.cylinder.tan_alpha:g}, "
            f"tilt_over_alpha {case.initial.tilt / case.cylinder.alpha:g}"
        )
    assert suite.runs == ()


RANGES = {
    "{ from = 1, to = 3, step = 0.5 }": [1.0, 1.5, 2.0, 2.5, 3.0],
    "{ from = 0.1, to = 0.4, step = 0.1 }": [0.1, 0.2, 0.3, 0.4],
    "{ from = 1, to = 2, count = 3 }": [1.0, 1.5, 2.0],
    '{ from = 1, to = 100, count = 3, spacing = "log" }': [1.0, 10.0, 100.0],
    "[3, 1.0000001, 1]": [3.0, 1.0000001, 1.0],
}


@pytest.mark.parametrize("given", RANGES)
def test_a_range_includes_its_end(write, given):
    suite = read_suite(write(replaced("semidiagonal = 6", f"semidiagonal = {given}")))
    assert [case.cylinder.semidiagonal for case in suite.cases] == RANGES[given]
    assert len({case.name for case in suite.cases}) == len(RANGES[given])


def test_lists_of_runs_give_each_combination_once(write):
    text = '[[runs]]\nengine = ["mujoco", "pybullet"]\ntime_step = [1e-4, 2e-4]\n' + CASE
    runs = [(run.engine, run.support, run.time_step) for run in read_suite(write(text)).runs]
    assert runs == [(name, "recess", step) for name in ("mujoco", "pybullet") for step in (1e-4, 2e-4)]


def test_record_files_are_relative_to_the_suite(write, tmp_path, monkeypatch):
    (tmp_path / "records").mkdir()
    for name, peak in (("x", 1.0), ("y", 2.0)):
        (tmp_path / "records" / f"{name}.csv").write_text(f"0, 0\n0.1, {peak}\n0.2, 0\n")
    files = 'motion = { x = "records/x.csv", y = "records/y.csv", units = "m/s2", scale = 3 }'
    path = write(replaced(STILL, files))
    monkeypatch.chdir("/")
    (case,) = read_suite(path).cases
    assert case.motion.acceleration.tolist() == [[0.0, 0.0], [3.0, 6.0], [0.0, 0.0]]


def test_times_uplift_is_the_peak_over_g_tan_alpha(write):
    motion = 'motion = { record = "el_centro_1940", times_uplift = [1.5, 2] }'
    for case in read_suite(write(replaced(STILL, motion) + "gravity = 3.7\n")).cases:
        ratio = case.motion.peak / (3.7 * case.cylinder.tan_alpha)
        assert ratio == pytest.approx(float(case.name.split()[-1]), rel=1e-14)  # rounding of one scaling


def test_a_pulse_of_a_suite_file_is_that_of_the_function(write):
    motion = (
        'motion = { pulse = "one-sine", period = 2, times_uplift = 3, azimuth_deg = 90, time_shift = 0.5 }'
    )
    (case,) = read_suite(write(replaced(STILL, motion))).cases
    ay = case.motion.acceleration[:, 1]
    at_quarter = round((0.5 + 0.5) / case.motion.time_step)
    assert ay[at_quarter] == pytest.approx(3.0 * 9.81 * 0.2, rel=1e-12)
    assert abs(ay[: round(0.5 / case.motion.time_step) + 1]).max() == 0.0
    assert case.length == 8.0


@pytest.mark.parametrize("width", ["base_radius = 1", "diameter = 2"])
def test_a_body_may_be_given_by_its_dimensions(write, width):
    body = f"cylinder = {{ {width}, height = 10, mass_centre_height = [4, 6] }}"
    low, high = read_suite(write(replaced("cylinder = { semidiagonal = 6, tan_alpha = 0.2 }", body))).cases
    assert low.cylinder.base_radius == pytest.approx(1.0)
    assert (low.cylinder.mass_centre_height, high.cylinder.mass_centre_height) == pytest.approx((4.0, 6.0))
    assert low.cylinder.height == high.cylinder.height == 10.0


SLOPE, LENGTH = "tan_alpha = 0.2", "duration = 8"
ENGINE = '[[runs]]\nengine = "mujoco"\n'
# replacement in a part of the case: message of the error
WRONG_PARTS = {
    (SLOPE, "tan_alpha = -0.2"): "cases[0].cylinder.tan_alpha: must be positive, got -0.2",
    (SLOPE, "tan_alpha = [0.2, 0.2]"): "tan_alpha[1]: must differ from the others, got 0.2",
    (SLOPE, "tan_alpha = []"): "tan_alpha: must hold at least one value, got []",
    (SLOPE, "tan_alpha = true"): "tan_alpha: must be a number, a list, or a range such",
    (SLOPE, "tan_alfa = 0.2"): "cases[0].cylinder.tan_alfa: is not known here, did you mean tan_alpha?",
    (SLOPE, "tan_alpha = 0.2, base_radius = 1"): "cylinder.semidiagonal: must be left out: it does not go",
    (SLOPE, "tan_alpha = 0.2, axial_inertia = 99"): "cases[0].cylinder: axial_inertia must not exceed twice",
    (SLOPE, "tan_alpha = { from = 1, to = 3, step = 0.7 }"): "step must divide the range from 1 to 3, in",
    (SLOPE, "tan_alpha = { from = 3, to = 1, step = 1 }"): "range must be above its begin, 3, got 1",
    (SLOPE, "tan_alpha = { from = 1, to = 3 }"): "tan_alpha: a range must have from, to, either",
    (
        SLOPE,
        "tan_alpha = { from = 0, to = 3, count = 4, spacing = 'log' }",
    ): "tan_alpha: must be positive, got 0",
    (
        SLOPE,
        "tan_alpha = { from = 1, to = 2, step = 1e-9 }",
    ): "step must divide the range from 1 to 2, in at most",
    (LENGTH, ""): "cases[0].duration: must be given [s]: only a record has a length",
    (LENGTH, "duration = 8\ncolour = 1"): "colour: is not known here, allowed are name, cylinder, motion",
    (
        "tilt_over_alpha = 0.5",
        "tilt = 0.1, tilt_deg = 5",
    ): "must have exactly one of tilt, tilt_deg, tilt_over",
    ("tilt_over_alpha = 0.5", "tilt_deg = 95"): "cases[0].release: tilt must be at least 0 and below pi/2",
    (STILL, ""): "cases[0]: must have a motion or a release, got neither",
    (STILL, "release = 5"): "cases[0].release: must be a table of keys and values, got 5",
    (STILL, 'motion = { record = "el_centro" }'): "record: must be one of el_centro_1940, p695, got",
    (STILL, 'motion = { record = "el_centro_1940", scale = 2, times_uplift = 2 }'): "it replaces scale",
    (
        STILL,
        'motion = { record = "el_centro_1940", time_shift = 0.005 }',
    ): "must be a whole number of the rec",
    (STILL, 'motion = { x = "x.csv", y = "y.csv" }'): "cases[0].motion: cannot read the record ",
    (
        STILL,
        'motion = { x = "x.csv", y = "y.csv", units = "ft" }',
    ): "cases[0].motion: units must be one of g, m/s2, ",
    (STILL, 'motion = { pulse = "one-sine", amplitude = 1 }'): "motion.period: must be given with a pulse",
    (
        STILL,
        'motion = { pulse = "one-sine", period = 1 }',
    ): "exactly one of amplitude, times_uplift, got none",
    ('"release"', '"a: b"'): "cases[0].name: must not hold a colon",
    ('"release"', "5"): "cases[0].name: must be text, got 5",
}
WRONG = {replaced(*part): words for part, words in WRONG_PARTS.items()} | {
    replaced(LENGTH, "duration = { from = 1, to = 200, step = 1 }").replace(
        SLOPE, "tan_alpha = { from = 1, to = 2, count = 200 }"
    ): "cases[0]: must make at most 10000 cases, got 40000",
    replaced(SLOPE, "tan_alpha = -0.2").replace(LENGTH, "duration = -8"): "got -0.2 (and 1 more error)",
    CASE + CASE: "the cases of a suite must have different names, got 'release' twice",
    "": "cases: must be given",
    "cases = []": "cases: List should have at least 1 item",
    '[[runs]]\nsupport = "flat"\n' + CASE: "runs[0].engine: must be given",
    ENGINE + 'suport = "flat"\n' + CASE: "runs[0].suport: is not known here, did you mean support?",
    ENGINE + "time_step = -1\n" + CASE: "runs[0].time_step: must be positive, got -1",
    ENGINE + "settings = { time_step = 3 }\n" + CASE: "settings.time_step: must be left out: it is a key of",
    "[[cases]\n": "is not a TOML file: ",
}


@pytest.mark.parametrize(("text", "words"), WRONG.items(), ids=[*WRONG.values()])
def test_every_error_of_a_suite_file_names_its_key(write, text, words):
    with pytest.raises(ValueError, match=r"\S") as caught:
        read_suite(write(text, "mine.suite.toml"))
    message = str(caught.value)
    assert message.startswith("mine.suite.toml")
    assert words in message
    assert "\n" not in message
    assert "pydantic" not in message


@pytest.mark.slow
def test_importing_the_models_loads_no_pydantic():
    script = "import sys, rockwobble.models; print('pydantic' in sys.modules)"
    done = subprocess.run([sys.executable, "-c", script], capture_output=True, text=True, check=True)
    assert done.stdout.strip() == "False"


WAYS = {
    "units": '"g"', "record_columns": '"1,2,3"', "record_step": "0.01", "lengths": '"cut"',
    "remove_mean": "true", "rotate": '"north"', "resample": "true",
}  # fmt: skip
OF_ALL = {"times_uplift": "2", "time_shift": "1"}
# keys that identify a kind of motion, and which those of no other kind may accompany
KINDS = {
    'record = "el_centro_1940"': {"vertical": "true", "rotation_deg": "30"},
    'record = "p695", pair = 3': {"rotation_deg": "30"},
    'x = "a.AT2", y = "b.AT2"': {"z": '"c.AT2"', "rotation_deg": "30"} | WAYS,
    'files = "folder"': {"rotation_deg": "30"} | WAYS,
    'pulse = "one-sine", period = 1': {"azimuth_deg": "30"},
}
KEYS = {
    "record": '"el_centro_1940"', "vertical": "true", "pair": "3", "x": '"a"', "y": '"b"', "z": '"c"',
    "files": '"folder"', "pulse": '"one-sine"', "amplitude": "2", "period": "1", "azimuth_deg": "30",
    "rotation_deg": "30",
} | WAYS  # fmt: skip


@pytest.mark.parametrize("kind", KINDS)
def test_a_motion_has_the_keys_of_its_kind_and_of_no_other(write, kind):
    for key, value in (KEYS | KINDS[kind] | OF_ALL).items():
        scaled = "" if key in ("times_uplift", "amplitude") or "pulse" not in kind else ", times_uplift = 1"
        if f"{key} =" in kind:
            continue
        text = replaced(STILL, f"motion = {{ {kind}{scaled}, {key} = {value} }}")
        try:
            read_suite(write(text, "a.suite.toml"))
            said = ""
        except ValueError as error:
            said = str(error)
        own = key in KINDS[kind] | OF_ALL or ("pulse" in kind and key == "amplitude")
        if own:  # the file may be missing
            assert "must be" not in said, (key, said)
        else:
            assert re.search(r"cases\[0\]\.motion.*: must (be left out|have exactly one of)", said), (
                key,
                said,
            )


def test_shipped_suites_are_read_by_name(tmp_path):
    for name in ("quick", "canon"):
        suite = read_suite(name)
        again = read_suite(Path(models.__path__[0]) / "suites" / f"{name}.suite.toml")
        assert [case.name for case in suite.cases] == [case.name for case in again.cases]
        assert {run.engine for run in suite.runs} == {"mujoco", "pybullet"}
    assert len(suite.cases) >= 40
    with pytest.raises(ValueError, match=r"none\.toml: No such file.*that ship are canon, p695, quick"):
        read_suite(tmp_path / "none.toml")
