from __future__ import annotations

import base64

import numpy as np
import pytest
from showing import call

import rockwobble as rw
from rockwobble.compare.comparison.result import View
from rockwobble.models import Case, Cylinder, GroundMotion, InitialState, Run
from rockwobble.reports.figures.case_view import case_views
from rockwobble.reports.figures.comparison import _reach
from rockwobble.reports.figures.playback import _largest_upright_tilt, playback
from rockwobble.reports.pages.view import page_of

PIER = Cylinder(semidiagonal=6.0, tan_alpha=0.2)
RECESS = [Run("mujoco", "recess", 1e-3)]
# a page plays in float32: seven digits of some metres
SINGLE = 1e-6


def _numbers(text):
    return np.frombuffer(base64.b64decode(text), dtype="<f4").astype(float)


@pytest.fixture(scope="module")
def comparison():
    release = InitialState(tilt=0.5 * PIER.alpha, rolling_rate=0.5)
    case = Case(PIER, initial=release, duration=1.0, name="release")
    return rw.comparison(case, runs=[Run("mujoco", "flat", 1e-3)], workers=1)


def test_playback_data_reproduce_the_mass_centre(comparison):
    spec = playback(case_views(comparison)[0])
    b, h = spec["base_radius"], 0.5 * spec["height"]
    assert spec["models"][spec["partners"][0]]["label"] == "flat-ground model"  # the model of its support
    for body in (*spec["models"], *spec["runs"]):
        trace = comparison.traces["release", body["label"]]
        names = ("time", "tilt", "rolling_angle", "contact_x", "contact_y")
        time, tilt, phi, x, y = (_numbers(body[name]) for name in names)
        # as playback.js: the base stands on its rim at the contact point
        radial = h * np.sin(tilt) - b * np.cos(tilt)
        centre = np.column_stack([x + radial * np.cos(phi), y + radial * np.sin(phi)])
        # an engine sinks in by 1e-6 m
        np.testing.assert_allclose(centre, trace.centre_of_mass[::4, :2], atol=10.0 * SINGLE)
        np.testing.assert_allclose(time, trace.time[::4], atol=SINGLE)


def test_a_fall_after_the_end_of_the_case_is_played():
    release = InitialState(tilt=1.1 * PIER.alpha, rolling_rate=0.1)
    gone = Case(PIER, initial=release, duration=0.5, name="gone")
    comparison = rw.comparison(gone, runs=RECESS, workers=1)
    end = max(float(trace.time[-1]) for trace in comparison.traces.values())
    assert playback(case_views(comparison)[0])["length"] == end > 1.0
    # traces of different length are compared as far as both reach
    row = comparison.summary.iloc[0]
    assert (row["outcome"], row["reference_outcome"]) == ("overturned", "overturned")
    assert 0.0 < row["agreement_time"] <= end


def test_playback_starts_at_uplift_with_slab_and_tendon():
    push = np.zeros((300, 2))
    push[200:, 0] = np.linspace(0.0, 1.5, 100) * 9.81 * PIER.tan_alpha
    frame = rw.WobblingFrame(PIER, 1.0, columns=1)
    case = Case(frame, GroundMotion(push, 0.01), tendon=rw.Tendon(prestress=0.1), name="pushed")
    comparison = rw.comparison(case, runs=RECESS, workers=1)
    spec = playback(case_views(comparison)[0])
    uplift = min(trace.uplift_time for trace in comparison.traces.values())
    assert spec["start"] == pytest.approx(uplift - 0.5)
    assert spec["slab"] is spec["tendon"] is True
    largest = max(float(trace.tilt.max()) for trace in comparison.traces.values())
    assert spec["shown"] * largest < np.radians(25.0) or spec["shown"] == 1
    assert all(factor * largest >= np.radians(25.0) for factor in spec["magnify"] if factor > spec["shown"])


def test_playback_shows_no_fall_where_a_tendon_recentres():
    release, tendon = InitialState(tilt=1.55 * PIER.alpha), rw.Tendon(stiffness=2.0)
    case = Case(PIER, initial=release, duration=0.5, tendon=tendon)
    view = case_views(rw.comparison(case, runs=RECESS, workers=1))[0]
    assert _largest_upright_tilt(view) == release.tilt
    beside = max(np.hypot(*trace.centre_of_mass[:, :2].T).max() for trace in view.traces.values())
    assert _reach(view) == pytest.approx(1.08 * beside / PIER.base_radius, rel=1e-12)


def test_playback_refuses_cases_at_rest(tmp_path, monkeypatch, capsys):
    still = GroundMotion(np.zeros((20, 2)), 0.01, "still")
    made = rw.comparison(Case(PIER, still, name="still"), runs=RECESS, workers=1)
    assert playback(case_views(made)[0]) is None
    with pytest.raises(ValueError, match="there is nothing to play in 'still'"):
        page_of(View.of(made, "still"))
    made.save(tmp_path / "stored")
    monkeypatch.chdir(tmp_path)
    assert call("view", "stored", "--out", "out") == 2
    assert capsys.readouterr().err.count("\n") == 1
    assert not (tmp_path / "out").exists()


@pytest.mark.slow
def test_stored_results_are_played_and_redrawn_without_new_runs(comparison, tmp_path, monkeypatch, capsys):
    stored = tmp_path / "stored"
    comparison.save(stored)

    def refuse(*_, **__):
        raise AssertionError("something ran")

    monkeypatch.setattr("rockwobble.reduced.simulate", refuse)
    monkeypatch.setattr("rockwobble.multibody.simulate", refuse)
    assert call("report", str(stored)) == 0
    assert "release" in (stored / "report.html").read_text()
    assert (stored / "figure.svg").read_bytes().startswith(b"<?xml")
    played = tmp_path / "played"
    assert call("view", str(stored), "--no-open", "--out", str(played)) == 0
    page = (played / "view.html").read_text()
    assert "rockwobblePlayback" in page
    (played / "view.html").unlink()
    assert [call(command, str(played)) for command in ("show", "report")] == [0, 0]
    assert (played / "view.html").read_text() == page
    assert list(View.load(played).comparison.cases) == ["release"]


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        (["view", "{folder}", "--scale", "2"], "--scale states a run and does not go with a stored one"),
        (["view", "{folder}/missing"], "does not hold results of rockwobble: it has no manifest.json"),
        (["view", "{folder}", "--case", "x"], "--case must be one of release, got 'x'"),
    ],
)
def test_bad_input_is_one_line(comparison, tmp_path, capsys, arguments, message):
    comparison.save(tmp_path / "stored")
    given = [text.format(folder=tmp_path / "stored") for text in arguments]
    assert call(*given, "--out", str(tmp_path / "out")) == 2
    said = capsys.readouterr().err
    assert message in said
    assert len(said.strip().splitlines()) == 1
    assert not (tmp_path / "out").exists()
