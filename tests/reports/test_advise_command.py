"""`rockwobble advise` from the outside, without an engine, and its page."""

from __future__ import annotations

import dataclasses
import io
import itertools
import math
from collections.abc import Mapping
from functools import partial
from pathlib import Path
from typing import Any, get_args, get_type_hints

import numpy as np
import pytest
from rich.console import Console
from showing import call as command_line
from showing import is_golden

from rockwobble import advise
from rockwobble.compare.comparison.prediction import UNTESTED, Prediction, verdict
from rockwobble.models import Case, Cylinder, InitialState, WobblingFrame, el_centro_1940
from rockwobble.reports.figures.advice import parts_of, pictures
from rockwobble.reports.figures.picture import Line
from rockwobble.reports.pages import stored_page
from rockwobble.reports.pages.advice import page_of
from rockwobble.studies import Advice
from rockwobble.studies.advice.trust import Trust

call = partial(command_line, "advise")

PAGE_LIMIT = 2e6  # bytes, of every page
# lines: an answer, its grades, its numbers, what the recess must carry, the record, and what to do next
SCREEN = 60
PRINTED = 5e-3  # three digits
FAST = ["--engine", "none", "--copies", "20"]
TABLES = ("members", "groups", "demands", "weaker", "band", "scales", "as_strong", "lowest", "planar")
TABLES += ("trace", "engine")
DATA = {f"{name}.parquet" for name in TABLES}


@pytest.fixture(scope="module")
def records(tmp_path_factory: pytest.TempPathFactory) -> Path:
    folder = tmp_path_factory.mktemp("records")
    strong = el_centro_1940(vertical=True).acceleration[:800] / 9.81
    columns = {name: strong[:, i] for i, name in enumerate("xyz")} | {"still": np.zeros(len(strong))}
    for name, values in columns.items():
        rows = "\n".join(f"{0.01 * i:.2f}, {value:.8f}" for i, value in enumerate(values))
        (folder / f"{name}.csv").write_text(f"time [s], acceleration [g]\n{rows}\n")
    return folder


def options_of(records: Path, **names: str) -> list[str]:
    return [
        word for axis, name in names.items() for word in (f"--record-{axis}", str(records / f"{name}.csv"))
    ]


@pytest.mark.slow
@pytest.mark.parametrize(
    ("names", "more", "expected"),
    [
        ({"x": "x", "y": "y"}, [], {"friction": "caution", "engine": "not tested"}),
        ({"x": "x", "y": "y", "z": "z"}, ["--scale", "2"], {"overturning": "not satisfied"}),
        ({"x": "x", "y": "y"}, ["--scale", "0.3"], {}),
        ({"x": "still", "y": "y"}, ["--scale", "2"], {"engine": "not tested"}),
        (
            {"x": "still", "y": "still", "z": "z"},
            ["--scale", "7"],
            {"overturning": "not tested", "intensity": "not tested"},
        ),
        ({"x": "x", "y": "y"}, ["--support", "recess", "--friction", "0.1"], {"friction": "not satisfied"}),
        # one of six is more than 5 %: a one-sample spike at a near pass counts
        ({"x": "x", "y": "y"}, ["--support", "flat", "--friction", "3"], {"friction": "satisfied"}),
        ({}, ["--release-tilt-deg", "5", "--rolling-rate", "0.5"], {"overturning": "satisfied"}),
    ],
)
def test_advice_page_is_drawn_for_every_kind_of_case(names, more, expected, records, tmp_path, capsys):
    assert call(*options_of(records, **names), *more, *FAST, "--out", str(tmp_path)) == 0
    printed = capsys.readouterr().out
    assert printed.count("\n") <= SCREEN
    loaded, again = Advice.load(tmp_path), stored_page("advice", tmp_path)
    text = again.markdown()
    grades = loaded.grades
    assert {topic: grades[topic] for topic in expected} == expected
    assert loaded.moves == bool(grades) == bool(expected)
    assert text.count("\n## ") == 1  # section of details
    for cells in (text, printed):
        assert not {"nan", "inf", "None"} & set(cells.replace("|", " ").split())
    html = (tmp_path / "advice.html").read_text()
    assert len(html) < PAGE_LIMIT
    assert html.count('<details class="fold">') == html.count("</details>") == 1
    # a document is drawn by a report alone
    tables = DATA | ({"slides.parquet"} if loaded.slides else set())
    written = {path.name for path in tmp_path.iterdir()}
    assert written == tables | {"advice.html", "advice.json", "manifest.json"}
    if more == ["--scale", "2"]:  # twice: with vertical component, and in one plane
        assert again.html() == html  # with all that the pictures show


@pytest.fixture(scope="module")
def advice(six_records: None) -> Advice:
    """Advice on a strong record, with the manifest that its page needs."""
    motion = el_centro_1940().acceleration[:800]
    case = Case(Cylinder(semidiagonal=6.0, tan_alpha=0.2), type(el_centro_1940())(motion, 0.01, "short"))
    return advise(case, copies=20, friction_given=False).made_by()


def changed(advice: Advice, **facts: Any) -> Advice:
    return dataclasses.replace(advice, facts={**advice.facts, **facts})


def with_table(advice: Advice, name: str, **columns: Any) -> Advice:
    return dataclasses.replace(advice, tables={**advice.tables, name: advice.tables[name].assign(**columns)})


def printed(advice: Advice, *, details: bool = False) -> str:
    console = Console(width=100, file=io.StringIO(), record=True)
    page_of(advice).show(console, details=details)
    return console.export_text()


def test_details_are_printed_only_with_the_option(advice):
    assert ["Assumptions" in printed(advice, details=details) for details in (False, True)] == [False, True]


def test_printed_numbers_equal_the_group_table(advice):
    given, *groups = page_of(advice).values["numbers"]
    alpha = np.degrees(advice.cylinder.alpha)
    # digits follow the scatter of copies
    assert float(given["tilt"]) == pytest.approx(alpha * advice.peak, rel=0.05)
    assert float(given["top"]) == pytest.approx(advice.top(advice.peak), rel=0.05)
    assert len(groups) == len(advice.groups)
    for row, group in zip(groups, advice.groups.to_dict("records"), strict=True):
        if np.isfinite(group["peak_tilt_95"]):
            assert float(row["tilt"]) == pytest.approx(alpha * group["peak_tilt_95"], rel=PRINTED)
        # overturning count and order statistic of the tilt in one statement
        assert row["overturn"].startswith(f"{group['overturned']} of {group['runs']} (")
        if row["covered"] == "":  # with over 95 % overturned there is no tilt, and no count beside it
            assert np.isinf(group["peak_tilt_95"])
            continue
        rank, count = map(int, row["covered"].split(" of "))
        peaks = advice.members[advice.members["group"] == group["group"]]["peak_tilt"]
        assert (peaks <= group["peak_tilt_95"] * (1.0 + 1e-12)).sum() >= rank >= 0.95 * count
    _, *rows = page_of(with_table(advice, "groups", peak_tilt_95=np.inf)).values["numbers"]
    # a count would read as the overturning count
    assert {(row["covered"], row["tilt"], row["top"]) for row in rows} == {("", "no limit", "no limit")}


def finding_of(advice: Advice, group: str) -> tuple[str, Mapping[str, Any]]:
    """Key and values of the first finding of a group."""
    finding = advice.findings().of(group)[0]
    return finding.key, finding.values


def test_each_grade_states_its_deciding_numbers(advice):
    """Numbers of tables and facts stand in the finding with the key of the grade's reason."""
    needed = advice.demands.set_index("demand")["value"]["friction"]
    assert finding_of(advice, "friction") == ("friction.not_given", {"demand": needed})
    low, high = advice.range_as_strong
    key, values = finding_of(advice, "intensity")
    assert (key, values["count"]) == ("intensity.ratio", len(advice.as_strong))
    assert values["ratio_least"] == pytest.approx(low / advice.peak)
    assert values["ratio_largest"] == pytest.approx(high / advice.peak)
    slides = changed(advice, friction=0.1)
    assert finding_of(slides, "friction")[0] == "friction.below_border"
    assert finding_of(slides, "friction")[1] == {"given": 0.1, "demand": needed, "bound": pytest.approx(0.2)}
    slips = with_table(changed(advice, friction=0.3), "groups", slip_95=0.02)
    assert finding_of(slips, "friction")[0] == "friction.too_little"
    assert finding_of(slips, "friction")[1] == {"given": 0.3, "demand": needed, "share": 0.02}
    for each in advice.findings().of("overturning"):
        assert each.level == advice.grades["overturning"]


ENGINE = {
    "label": "mujoco recess",
    "version": "4.0.0",
    "time_step": 1e-4,
    "outcome": "stands",
    "diagnostics": "",
    "peak_tilt": 0.25,
    "moves": True,
    "agreed_until": 22.0,
    "diverged": True,
    "divergence": "in time",
}
DIVERGENCES = {
    verdict(measured, diverged, predicted, reason)
    for measured, diverged, predicted, reason in itertools.product(
        (1.0, 3.0, 20.0), (True, False), (1.0, 10.0), ("", "pass")
    )
}


@pytest.mark.slow
def test_every_finding_code_has_words(advice):
    assert {*DIVERGENCES} >= {"in time", "later", "much later", "earlier", "never, as predicted"}
    engines = [ENGINE | {"divergence": each} for each in (*DIVERGENCES, *UNTESTED)]
    engines += [ENGINE | {"outcome": "overturned"}, ENGINE | {"moves": False}]
    engines += [ENGINE | {"outcome": "failed", "diagnostics": "energy_gain", "divergence": ""}]
    keys = set()
    for engine in engines:
        verified = changed(advice, verification=engine)
        keys.add(finding_of(verified, "engine")[0])
        words = page_of(verified).markdown()
        assert "divergence_" not in words
        assert "mujoco recess 4.0.0" in words
    assert keys >= {f"engine.{name}" for name in ("earlier", "rests", "overturns", "little", "failed")}
    assert keys & {"engine.agrees", "engine.as_predicted"}
    failed = {**advice.facts["response"], "outcome": "failed", "diagnostics": ["step_budget"]}
    again = changed(advice, response=failed)
    assert again.grades == {"trace": "not satisfied"}
    assert (finding_of(again, "verdict")[0], len(page_of(again).markdown()) > 0) == ("verdict.failed", True)
    trust = {"kind": "statistics", "until": 3.0, "because": "methods"}
    for verification, reason in ((None, "methods_predicted"), (ENGINE, "methods_diverge")):
        findings = changed(advice, trust=trust, verification=verification).findings()
        trusted = next(each for each in findings if each.key == "evidence.trusted")
        assert (trusted.values["until"], trusted.values["reason"]) == (3.0, reason)
    for kind, because in (("trace", ""), ("peak", "data"), ("statistics", "methods")):
        assert page_of(changed(advice, trust={"kind": kind, "until": 3.0, "because": because})).markdown()
    assert get_args(get_type_hints(Trust)["because"]) == ("", "methods", "data")
    for reason in ("", "pass", "growth", "model form"):
        prediction = dataclasses.asdict(Prediction(length=5.0, reason=reason))
        assert page_of(changed(advice, prediction=prediction)).markdown()


def with_columns(advice: Advice, columns: int) -> Advice:
    return changed(advice, cylinder=advice.facts["cylinder"] | {"columns": columns, "slab_mass_ratio": 0.5})


def test_a_frame_states_its_columns_and_their_limit(advice):
    for columns in (1, 3, 4):
        findings = with_columns(advice, columns).findings()
        assert next(each for each in findings if each.key == "case.frame").values["count"] == columns
        assert [each.key for each in findings.of("caution")] == ["caution.uneven_load"] * (columns > 3)
    mass = changed(with_columns(advice, 4), mass=45.0)
    assert "| one column |" in page_of(mass).markdown()
    assert finding_of(mass, "weight") == ("weight.column", {"mass": 67.5, "mass_column": 45.0})


def test_chatter_of_a_closed_base_is_not_reported_as_sensitivity(advice):
    """Tilts of 1e-6 alpha and 5e-6 alpha leave the base closed: their ratio is no sensitivity."""
    tilts = np.geomspace(1e-6, 5e-6, len(advice.as_strong))
    response = {**advice.facts["response"], "peak_tilt": 1e-5}
    still = with_table(changed(advice, response=response), "as_strong", peak_tilt=tilts)
    assert still.grades["intensity"] == "satisfied"
    assert finding_of(still, "intensity")[0] == "intensity.hardly"
    trust = {"kind": "statistics", "until": 3.0, "because": "methods"}
    assert finding_of(changed(still, trust=trust), "trace") == ("trace.hardly", {"peak": 1e-5})
    assert with_table(still, "as_strong", peak_tilt=0.1).grades["intensity"] == "caution"


def test_forces_of_a_body_at_rest_have_units_where_its_mass_is_given():
    still = Case(Cylinder.from_dimensions(base_radius=0.8, height=9.0), el_centro_1940().scaled(0.3))
    demanded = {row["demand"]: row for row in page_of(advise(still, copies=20, mass=45.0)).values["demanded"]}
    assert (demanded["shear"]["mass"], demanded["shear"]["peak"]) == ("0 kN", "0 kN")
    assert (demanded["force"]["mass"], demanded["force"]["peak"]) == ("441 kN", "441 kN")


def test_a_sliding_body_without_uplift_is_not_called_at_rest(advice):
    at_rest = {**advice.facts["response"], "uplift_time": math.inf, "peak_tilt": 0.0}
    motion = {**advice.facts["motion"], "friction_at_rest": 0.0859}
    still = changed(advice, response=at_rest, motion=motion)
    for friction, slides in ((None, False), (0.0859, False), (0.05, True)):
        given = changed(still, friction=friction)
        assert given.grades == ({"friction": "not satisfied"} if slides else {})
        assert finding_of(given, "verdict")[0] == f"verdict.{'slides_at_rest' if slides else 'at_rest'}"
        assert finding_of(given, "rest")[1]["demand"] == 0.0859
        if slides:
            assert finding_of(given, "friction")[1] == {"given": 0.05, "demand": 0.0859}
    del motion["friction_at_rest"]  # of an earlier version
    assert finding_of(changed(still, friction=0.05), "verdict")[0] == "verdict.at_rest"


def test_page_at_rest_states_first_why_nothing_moves(advice):
    at_rest = {**advice.facts["response"], "uplift_time": math.inf, "diagnostics": []}
    still = changed(advice, response=at_rest, vertical={**advice.facts["vertical"], "source": "other"})
    weak = {**advice.facts["motion"], "friction_at_rest": 0.0, "uplift_factor": 2.5}
    shipped = {**advice.facts["vertical"], "source": "shipped", "uplift_factor": 2.25}
    for facts, expected in (
        ({"motion": None}, ("rest.nothing", None, None)),
        ({"motion": {**weak, "uplift_factor": math.inf}}, ("rest.no_scale", None, None)),
        ({"motion": weak}, ("rest.factor", 2.5, None)),
        ({"motion": weak, "vertical": shipped}, ("rest.factor", 2.5, 2.25)),
    ):
        key, values = finding_of(changed(still, **facts), "rest")
        vertical = values.get("factor_vertical", math.nan)
        assert (key, values.get("factor"), None if math.isnan(vertical) else vertical) == expected
    moved = (advice.members[advice.members["group"] == "velocity"]["peak_tilt"] > 0.0).sum()
    (fell,) = advice.groups[advice.groups["group"] == "velocity"]["overturned"]
    key, values = finding_of(still, "compared")
    assert (key, values["runs_velocity"], values["overturned_velocity"]) == ("compared.at_rest", moved, fell)
    failed = {**still.facts["response"], "diagnostics": ["step_budget"]}
    assert finding_of(changed(still, response=failed), "rest")[1] == {"names": ("step_budget",)}
    assert not advice.findings().of("rest")


def test_page_states_the_given_case_and_its_assumptions(advice):
    asked = changed(with_columns(advice, 3), rolling_resistance=0.012, friction=None, support="flat")
    for each, keys, length in (
        (advice, {"assumption.recess"}, math.nan),
        (asked, {"assumption.slab", "assumption.flat"}, 0.012),
    ):
        findings = each.findings()
        common = {f"assumption.{name}" for name in ("rigid", "ground", "as_strong", "verified")}
        assert {one.key for one in findings.of("assumption")} == common | keys
        support = next(one for one in findings if one.key == "case.support").values
        assert support["name"] == each.facts["support"]
        assert support["length"] == pytest.approx(length, nan_ok=True)


def test_the_overturning_range_is_stated_with_its_lowest_scale(advice):
    factors = advice.as_strong["factor"].to_numpy()
    fallen = with_table(advice, "as_strong", peak_tilt=np.where(factors > 1.08, 0.5 * np.pi, 0.1))
    key, values = finding_of(fallen, "intensity")
    share = np.log(factors[-1] / 1.08) / np.log(factors[-1] / factors[0])
    assert key == "intensity.overturns"
    assert values["share"] == pytest.approx(share, abs=0.006)
    assert values["factor"] == factors[factors > 1.08].min()


@pytest.mark.parametrize(("balance", "drawn"), [(None, 1.2), (1.63, 1.5), (1.2, 1.2 * 1.2), (math.inf, 1.5)])
def test_picture_shows_tilts_that_a_tendon_recentres(
    advice: Advice, balance: float | None, drawn: float
) -> None:
    tendon = None if balance is None else {"balance_tilt": balance}
    tied = changed(with_table(advice, "scales", peak_tilt=1.5 * advice.cylinder.alpha), tendon=tendon)
    (picture,) = pictures(tied)
    peaks, details = parts_of(picture)  # panel beside the grades, and panels of details
    assert [*peaks.panels[0].layers, *details.panels] == [*picture.panels[0].layers, *picture.panels[1:]]
    panel = next(each for each in details.panels if each.title.startswith("Other scales"))
    tilts = np.concatenate([layer.y for layer in panel.layers if isinstance(layer, Line)])
    assert tilts == pytest.approx(drawn, rel=1e-12)
    *levels, (side, _) = panel.y.ticks
    assert tilts.max() < side < panel.y.high
    # labels that stand apart, up to the balance
    steps = np.diff([tick for tick, _ in levels] + [side])
    assert steps.min() > 0.1 * panel.y.high


def test_page_of_a_release_matches_golden_file():
    frame = WobblingFrame(Cylinder(semidiagonal=6.0, tan_alpha=0.2), slab_mass_ratio=0.5)
    case = Case(frame, initial=InitialState(0.08, rolling_rate=0.3), duration=3.0, friction=0.5)
    is_golden(advise(case, copies=20))
