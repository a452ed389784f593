"""`rockwobble advise` from the outside, without an engine, and its page."""

from __future__ import annotations

import dataclasses
import io
import itertools
import math
import re
from collections.abc import Iterator
from pathlib import Path
from typing import Any, get_args, get_type_hints

import numpy as np
import pytest
from rich.console import Console

from rockwobble import advise
from rockwobble.compare.comparison.prediction import UNTESTED, Prediction, verdict
from rockwobble.models import Case, Cylinder, InitialState, WobblingFrame, el_centro_1940
from rockwobble.models.diagnostic import CODES
from rockwobble.models.records import p695
from rockwobble.reports.cli.main import main
from rockwobble.reports.figures.advice import pictures
from rockwobble.reports.figures.picture import Line
from rockwobble.reports.pages import stored_page
from rockwobble.reports.pages.advice import page_of
from rockwobble.reports.pages.advised_case import assumptions, opening, problem_lines, weight_words
from rockwobble.studies import Advice
from rockwobble.studies.advice import scales
from rockwobble.studies.advice.trust import Trust

PAGE_LIMIT = 2e6  # bytes, of every page
# lines: an answer, its grades, its numbers, what the recess must carry, the record, and what to do next
SCREEN = 60
PRINTED = 5e-3  # three digits
FAST = ["--engine", "none", "--copies", "20"]
TABLES = ("members", "groups", "demands", "weaker", "band", "scales", "as_strong", "lowest", "planar")
TABLES += ("trace", "engine")
DATA = {f"{name}.parquet" for name in TABLES}
GOLDEN = Path(__file__).parent / "golden" / "advice.md"


def call(*arguments: str) -> int:
    with pytest.raises(SystemExit) as ended:
        main(["advise", *arguments])
    assert isinstance(ended.value.code, int)
    return ended.value.code


@pytest.fixture(scope="module", autouse=True)
def few_runs() -> Iterator[None]:
    """Planar analysis at two intensities and six other records: more of them show no more."""
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(scales, "PLANAR_SCALES", (1.0, 2.0))
        patch.setattr(p695, "PAIRS", 6)
        yield


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
        ({"x": "x", "y": "y"}, ["--friction", "0.23"], {"friction": "not satisfied"}),
        # of six records one is more than 95 %: a spike of one sample at a near pass counts
        ({"x": "x", "y": "y"}, ["--support", "flat", "--friction", "3"], {"friction": "satisfied"}),
        ({}, ["--release-tilt-deg", "5", "--rolling-rate", "0.5"], {"overturning": "satisfied"}),
    ],
)
def test_every_kind_of_case_gets_its_page(names, more, expected, records, tmp_path, capsys):
    assert call(*options_of(records, **names), *more, *FAST, "--out", str(tmp_path)) == 0
    printed = capsys.readouterr().out
    assert printed.count("\n") <= SCREEN
    found, again = Advice.load(tmp_path), stored_page("advice", tmp_path)
    text = again.markdown()
    grades = found.grades
    assert {topic: grades[topic] for topic in expected} == expected
    assert found.moves == bool(grades) == bool(expected)
    assert text.count("\n## ") == 1  # the details
    for cells in (text, printed):
        assert not {"nan", "inf", "None"} & set(cells.replace("|", " ").split())
    html = (tmp_path / "advice.html").read_text()
    assert len(html) < PAGE_LIMIT
    assert html.count('<details class="fold">') == html.count("</details>") == 1
    # a document is drawn by a report alone
    assert {path.name for path in tmp_path.iterdir()} == DATA | {"advice.html", "manifest.json"}
    if more == ["--scale", "2"]:  # twice: with a vertical component, and in one plane
        assert again.html() == html  # with all that the pictures show


@pytest.fixture(scope="module")
def found(records: Path) -> Advice:
    """Advice on a strong record; with a manifest, as its page needs one."""
    motion = el_centro_1940().acceleration[:800]
    case = Case(Cylinder(semidiagonal=6.0, tan_alpha=0.2), type(el_centro_1940())(motion, 0.01, "short"))
    return advise(case, copies=20, friction_given=False).made_by()


def changed(found: Advice, **facts: Any) -> Advice:
    return dataclasses.replace(found, facts={**found.facts, **facts})


def printed(found: Advice, *, details: bool = False) -> str:
    console = Console(width=100, file=io.StringIO(), record=True)
    page_of(found).show(console, details=details)
    return console.export_text()


@pytest.mark.slow
def test_details_are_printed_where_they_are_asked_for(found):
    short, long = printed(found), printed(found, details=True)
    assert short.count("\n") <= SCREEN < long.count("\n")
    assert "Assumptions" in long
    assert "Assumptions" not in short


def test_the_numbers_are_those_of_the_groups(found):
    given, *groups = page_of(found).values["numbers"]
    alpha = np.degrees(found.cylinder.alpha)
    # its digits follow the scatter of its copies
    assert float(given["tilt"]) == pytest.approx(alpha * found.peak, rel=0.05)
    assert float(given["top"]) == pytest.approx(found.top(found.peak), rel=0.05)
    assert len(groups) == len(found.groups)
    for row, group in zip(groups, found.groups.to_dict("records"), strict=True):
        if np.isfinite(group["peak_tilt_95"]):
            assert float(row["tilt"]) == pytest.approx(alpha * group["peak_tilt_95"], rel=PRINTED)
        # one statement: how many overturn, and which order statistic the tilt is
        assert row["overturn"].startswith(f"{group['overturned']} of {group['runs']} (")
        if row["covered"] == "":  # more than 95 % overturn: no tilt is theirs, and no count stands beside it
            assert np.isinf(group["peak_tilt_95"])
            continue
        rank, count = map(int, row["covered"].split(" of "))
        peaks = found.members[found.members["group"] == group["group"]]["peak_tilt"]
        assert (peaks <= group["peak_tilt_95"] * (1.0 + 1e-12)).sum() >= rank >= 0.95 * count


def test_an_overturned_group_moves_without_bound(found):
    groups = found.groups.assign(peak_tilt_95=np.inf)
    fallen = dataclasses.replace(found, tables={**found.tables, "groups": groups})
    _, *rows = page_of(fallen).values["numbers"]
    # a count beside it would read as the count of those that overturn
    assert {(row["covered"], row["tilt"], row["top"]) for row in rows} == {("", "no limit", "no limit")}


def reasons_of(found: Advice) -> dict[str, str]:
    return {row["topic"]: row["reason"] for row in page_of(found).values["criteria"]}


def numbers_in(words: str) -> list[float]:
    return [float(word) for word in re.findall(r"\d+(?:\.\d+)?", words)]


def test_a_reason_states_the_numbers_of_its_grade(found):
    reasons = reasons_of(found)
    needed = found.demands.set_index("demand")["value"]["friction"]
    assert numbers_in(reasons["friction"]) == [pytest.approx(needed, rel=PRINTED)]
    low, high = found.range_as_strong
    assert numbers_in(reasons["intensity"]) == [
        pytest.approx(low / found.peak, rel=PRINTED),
        pytest.approx(high / found.peak, rel=PRINTED),
        len(found.as_strong),
        11.0,
        12.0,
    ]
    prediction = dataclasses.asdict(Prediction(length=5.0, reason="pass"))
    engine = changed(found, verification=ENGINE, prediction=prediction)
    end = found.response["uplift_time"] + 5.0
    assert numbers_in(reasons_of(engine)["engine"]) == [22.0, pytest.approx(end, rel=PRINTED)]
    slides = reasons_of(changed(found, friction=0.1))["friction"]
    assert numbers_in(slides) == [0.1, 0.2]


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
def test_every_code_has_words(found):
    assert {*DIVERGENCES} >= {"in time", "later", "much later", "earlier", "never, as predicted"}
    engines = [ENGINE | {"divergence": each} for each in (*DIVERGENCES, *UNTESTED)]
    engines += [ENGINE | {"outcome": "overturned"}, ENGINE | {"moves": False}]
    engines += [ENGINE | {"outcome": "failed", "diagnostics": "energy_gain", "divergence": ""}]
    notes, reasons = set(), set()
    for engine in engines:
        values = page_of(changed(found, verification=engine)).values
        notes |= {row["note"] for row in values["checks"] if "mujoco" in row["name"]}
        reasons |= {row["reason"] for row in values["criteria"] if row["topic"] == "engine"}
    assert len(reasons) == 7  # as predicted in three ways
    assert len(notes) >= 7  # two verdicts are the same
    assert all(notes)
    for kind, because in (("trace", ""), ("peak", "data"), ("statistics", "methods")):
        assert page_of(changed(found, trust={"kind": kind, "until": 3.0, "because": because})).markdown()
    assert get_args(get_type_hints(Trust)["because"]) == ("", "methods", "data")
    for reason in ("", "pass", "growth", "model form"):
        prediction = dataclasses.asdict(Prediction(length=5.0, reason=reason))
        assert page_of(changed(found, prediction=prediction)).markdown()


def with_columns(found: Advice, columns: int) -> Advice:
    return changed(found, cylinder=found.facts["cylinder"] | {"columns": columns, "slab_mass_ratio": 0.5})


def test_the_first_screen_states_the_columns_and_their_limit(found):
    for columns in (1, 3, 4):
        words = " ".join(printed(with_columns(found, columns)).split())
        assert f"{columns} columns under a slab" in words or (columns == 1 and "One column under" in words)
        assert ("share the load unevenly" in words) == (columns > 3)
    mass = dataclasses.replace(with_columns(found, 4), facts=with_columns(found, 4).facts | {"mass": 45.0})
    assert "| one column |" in page_of(mass).markdown()


def test_chatter_of_a_closed_base_is_no_change_of_the_response(found):
    """Of a tilt of 1e-6 alpha and one of 5e-6 alpha neither opens the base: it is not five times as much."""
    strong = found.as_strong.assign(peak_tilt=np.geomspace(1e-6, 5e-6, len(found.as_strong)))
    response = {**found.facts["response"], "peak_tilt": 1e-5}
    tables = {**found.tables, "as_strong": strong}
    still = dataclasses.replace(changed(found, response=response), tables=tables)
    assert still.grades["intensity"] == "satisfied"
    assert "the base hardly opens, by at most 2.53e-5 α" in reasons_of(still)["intensity"]
    trust = {"kind": "statistics", "until": 3.0, "because": "methods"}
    assert "the base hardly opens, by 1e-5 α" in reasons_of(changed(still, trust=trust))["trace"]
    opens = dataclasses.replace(still, tables={**tables, "as_strong": strong.assign(peak_tilt=0.1)})
    assert opens.grades["intensity"] == "caution"


def test_what_stays_at_rest_is_told_from_what_others_do_to_it(found):
    still = changed(found, response={**found.facts["response"], "uplift_time": math.inf, "peak_tilt": 0.0})
    assert not still.moves
    words = page_of(still).markdown()
    moved = (found.members[found.members["group"] == "velocity"]["peak_tilt"] > 0.0).sum()
    (fell,) = found.groups[found.groups["group"] == "velocity"]["overturned"]
    assert f"scaled to its PGV {moved} uplift it and {fell} overturn it" in " ".join(words.split())


def test_what_slides_at_rest_is_not_said_to_stay_there(found):
    at_rest = {**found.facts["response"], "uplift_time": math.inf, "peak_tilt": 0.0}
    motion = {**found.facts["motion"], "friction_at_rest": 0.0859}
    still = changed(found, response=at_rest, motion=motion)
    for friction, slides in ((None, False), (0.0859, False), (0.05, True)):
        given = changed(still, friction=friction)
        assert given.grades == ({"friction": "not satisfied"} if slides else {})
        assert ("stays at rest" in given.verdict) == (not slides)
        words = " ".join(page_of(given).markdown().split())
        assert "At rest the friction demand is 0.0859" in words
        assert ("0.05 is below the demand at rest, 0.0859: it slides" in words) == slides
    del motion["friction_at_rest"]  # of an earlier version
    assert changed(still, friction=0.05).verdict == "the cylinder stays at rest"


def test_a_case_at_rest_begins_with_what_keeps_it_there(found):
    at_rest = {**found.facts["response"], "uplift_time": math.inf, "diagnostics": []}
    still = changed(found, response=at_rest, vertical={**found.facts["vertical"], "source": "other"})
    weak = {**found.facts["motion"], "friction_at_rest": 0.0, "uplift_factor": 2.5}
    shipped = {**found.facts["vertical"], "source": "shipped", "uplift_factor": 2.25}
    times = "It takes 2.5 times this shaking to uplift it"
    for facts, words in (
        ({"motion": None}, "Nothing moves it."),
        ({"motion": {**weak, "uplift_factor": math.inf}}, "This ground motion uplifts it at no scale."),
        ({"motion": weak}, f"{times}."),
        (
            {"motion": weak, "vertical": shipped},
            f"{times}, 2.25 times with the vertical component of the record.",
        ),
        ({"motion": {**weak, "friction_at_rest": 0.1}}, f"At rest the friction demand is 0.1. {times}."),
    ):
        assert list(opening(changed(still, **facts))) == [words]
    failed = {**still.facts["response"], "diagnostics": ["step_budget"]}
    (words,) = opening(changed(still, response=failed))
    assert words.startswith(CODES["step_budget"][1].capitalize())
    assert list(opening(found)) == []


def test_the_case_and_its_assumptions_are_stated_as_they_were_asked(found):
    asked = changed(
        with_columns(found, 3), rolling_resistance=0.012, friction=None, support="flat", mass=45.0
    )
    lines = list(problem_lines(asked))
    assert "3 columns under a slab of 0.5 times their mass:" in lines
    assert "Flat ground, friction not given, rolling resistance 0.012 m." in lines
    assert weight_words(asked).startswith("weight of one column with its share of the slab, a mass of 67.5 t")
    assert weight_words(found) == "weight of the cylinder"
    plain, other = " ".join(assumptions(found)), " ".join(assumptions(asked))
    for words, there, here in (
        ("no other damping", True, False),
        ("3 equal columns", True, False),
        ("Flat ground: the rim rolls", True, False),
        ("Ideal recess", False, True),
        ("Unbonded tendon", False, False),
        (f"{len(found.as_strong)} scales from 11 % weaker to 12 % stronger", True, True),
    ):
        assert (words in other, words in plain) == (there, here), words


def test_the_part_of_the_range_that_overturns_is_stated_with_its_lowest_scale(found):
    factors = found.as_strong["factor"].to_numpy()
    falls = found.as_strong.assign(peak_tilt=np.where(factors > 1.08, 0.5 * np.pi, 0.1))
    words = reasons_of(dataclasses.replace(found, tables={**found.tables, "as_strong": falls}))["intensity"]
    share = 100.0 * np.log(factors[-1] / 1.08) / np.log(factors[-1] / factors[0])
    lowest = factors[factors > 1.08].min()
    assert numbers_in(words) == [
        11.0,
        12.0,
        pytest.approx(share, abs=0.6),
        pytest.approx(lowest, rel=PRINTED),
    ]


def test_an_engine_that_was_not_run_is_not_said_to_diverge(found):
    trust = {"kind": "statistics", "until": 3.0, "because": "methods"}
    for verification, word in ((None, "are predicted to diverge"), (ENGINE, "engine diverge")):
        text = page_of(changed(found, trust=trust, verification=verification)).markdown()
        (row,) = [line for line in text.splitlines() if line.startswith("| the trace can be trusted")]
        assert word in row


def test_a_failed_run_gets_no_advice(found, tmp_path):
    failed = {**found.facts["response"], "outcome": "failed", "diagnostics": ["step_budget"]}
    again = changed(found, response=failed)
    assert again.grades == {"trace": "not satisfied"}
    assert "no advice, the recess model failed" in page_of(again).markdown()


@pytest.mark.parametrize(("balance", "drawn"), [(None, 1.2), (1.63, 1.5), (1.2, 1.2 * 1.2), (math.inf, 1.5)])
def test_the_picture_cuts_no_tilt_that_a_tendon_brings_back(
    found: Advice, balance: float | None, drawn: float
) -> None:
    leans = found.scales.assign(peak_tilt=1.5 * found.cylinder.alpha)
    tendon = None if balance is None else {"balance_tilt": balance}
    tied = changed(dataclasses.replace(found, tables={**found.tables, "scales": leans}), tendon=tendon)
    panel = next(each for each in pictures(tied)[0].panels if each.title.startswith("Other scales"))
    tilts = np.concatenate([layer.y for layer in panel.layers if isinstance(layer, Line)])
    assert tilts == pytest.approx(drawn, rel=1e-12)
    *levels, (side, _) = panel.y.ticks
    assert tilts.max() < side < panel.y.high
    # labels that stand apart, up to the balance
    steps = np.diff([tick for tick, _ in levels] + [side])
    assert steps.min() > 0.1 * panel.y.high


def test_the_page_of_a_release_is_the_golden_one():
    frame = WobblingFrame(Cylinder(semidiagonal=6.0, tan_alpha=0.2), slab_mass_ratio=0.5)
    case = Case(frame, initial=InitialState(0.08, rolling_rate=0.3), duration=3.0, friction=0.5)
    text = page_of(advise(case, copies=20).made_by()).markdown()
    text = text[: text.index("\n---\n")]  # what made it is of this machine
    assert text == GOLDEN.read_text()
