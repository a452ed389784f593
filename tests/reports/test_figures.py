"""Figures as data: both renderers draw all data and nothing else."""

from __future__ import annotations

import base64
import html
import re
from typing import Any

import numpy as np
import pytest
from matplotlib.text import Text as Words

from rockwobble.models import Case, Cylinder, InitialState, el_centro_1940
from rockwobble.reduced import simulate
from rockwobble.reports.figures.heat import Gap, Heat, Shades, contour, names
from rockwobble.reports.figures.interactive import chart, charts
from rockwobble.reports.figures.palette import ORDER, Style, label_styles
from rockwobble.reports.figures.picture import (
    TIME,
    Axis,
    Band,
    Bars,
    Line,
    Panel,
    Picture,
    Rule,
    Text,
    ecdf,
    list_axis,
)
from rockwobble.reports.figures.svg import figure, svg
from rockwobble.reports.figures.thinning import POINTS, envelope, kept_samples
from rockwobble.reports.figures.trace import pictures as trace_pictures
from rockwobble.studies.advice.members import top_displacement

ALPHA = Axis(label="tilt / α", unit="-", low=0.0)
T = np.linspace(0.0, 10.0, 4001)


def lines(count: int = 3, **options: object) -> Picture:
    styles = label_styles([f"run {i}" for i in range(count)])
    layers = [
        Band(x=T, low=0.0 * T, high=0.0 * T + 0.5, name="band"),
        *(Line(x=T, y=np.abs(np.sin(T + i)), name=name, style=styles[name]) for i, name in enumerate(styles)),
        Rule(at=4.0, axis="x", text="until here"),
        Rule(at=1.0, until=2.0, axis="x", name="strong"),
        Text(x=5.0, y=0.5, text="a step of 0.0025 s"),
        Line(x=np.array([3.0]), y=np.array([0.2]), style=Style(colour="#000000", dash="none", symbol="star")),
    ]
    return Picture(name="lines", title="Lines", panels=[Panel(x=TIME, y=ALPHA, layers=layers)], **options)


def maps(values: np.ndarray, shades: Shades, **heat: object) -> Picture:
    x, x_ticks = names([0.1, 0.2])
    y, y_ticks = names(["low", "high"])
    panel = Panel(
        x=Axis(label="tan α", unit="", ticks=x_ticks),
        y=Axis(label="kind", unit="", ticks=y_ticks),
        layers=[Heat(x=x, y=y, values=values, written=".1f", **heat)],
    )
    return Picture(name="maps", title="Maps", panels=[panel], shades=shades)


def drawn_on_a_page(picture: Picture) -> dict[str, Any]:
    (panel,) = picture.panels
    return chart(panel, picture)


def numbers(packed: str) -> np.ndarray:
    return np.frombuffer(base64.b64decode(packed), dtype="<f4")


def words(content: bytes) -> str:
    return " ".join(
        html.unescape(each) for each in re.findall(r"<text.*?>(.*?)</text>", content.decode(), re.S)
    )


def test_svg_is_reproducible_and_contains_its_words():
    content = svg(lines())
    assert content == svg(lines())
    for said in ("time [s]", "tilt / α [-]", "run 0", "band", "strong", "until here", "a step of 0.0025 s"):
        assert said in words(content)


@pytest.mark.parametrize(("width", "least", "most"), [(None, 8.0, 12.0), (89.0, 6.0, 8.0), (183.0, 6.0, 8.0)])
def test_text_is_legible_at_figure_width(width: float | None, least: float, most: float):
    inches = width and width / 25.4  # [mm] in print, that of a screen by default
    drawn = figure(lines(columns=2), width=inches)
    sizes = [each.get_fontsize() for each in drawn.findobj(Words) if each.get_text()]
    assert drawn.get_figwidth() == pytest.approx(inches or 8.6)
    assert least <= min(sizes) <= max(sizes) <= most


def test_legend_has_at_most_eight_entries_and_says_that_there_are_more():
    drawn = figure(lines(12))
    said = [text.get_text() for text in drawn.legends[0].get_texts()]
    assert len(said) == 8
    assert said[-1] == "and 7 more"  # of 14: a band, a strip and 12 runs
    page = drawn_on_a_page(lines(12))
    assert (len(page["legend"]), page["more"]) == (7, 7)


def test_both_renderers_draw_equally_thinned_data():
    (drawn,) = (each for each in drawn_on_a_page(lines(1))["layers"] if each.get("name") == "run 0")
    line = next(each for each in figure(lines(1)).axes[0].lines if each.get_label() == "run 0")
    for x, y in ((numbers(drawn["x"]), numbers(drawn["y"])), line.get_data()):
        assert len(x) < len(T)
        np.testing.assert_allclose(y, np.abs(np.sin(np.asarray(x, dtype=float))), atol=1e-5)
        assert np.max(y) == pytest.approx(1.0, abs=1e-6)  # extremes are kept


@pytest.mark.slow
def test_a_map_shows_values_gaps_by_kind_and_its_scale():
    values = np.array([[-2.0, 1.0], [np.nan, 9.0]])
    shades = Shades(label="bias", unit="%", low=-2.0, high=4.0, centre=0.0)
    np.testing.assert_allclose(shades.place(values), [[0.25, 0.625], [np.nan, 1.0]])
    picture = maps(values, shades, gaps=[Gap(name="falls", colour="#D55E00", cells=np.isnan(values))])
    assert picture.entries() == ["falls"]
    for said in ("bias [%]", "falls", "-2.0", "9.0", "low", "0.2"):
        assert said in words(svg(picture)).replace("−", "-")
    (heat,) = drawn_on_a_page(picture)["layers"]
    np.testing.assert_array_equal(numbers(heat["values"]), values.ravel())
    cells = list(base64.b64decode(heat["cells"]))
    # of 64 colours, and the one of the gap
    assert cells == [16, 40, 64, 63]
    assert heat["gaps"] == {64: "falls"}
    assert heat["palette"][64] == "#D55E00"
    assert heat["written"] == ["-2.0", "1.0", "", "9.0"]


def test_a_logarithmic_scale_shows_decades_and_clips_values_beyond():
    shades = Shades(label="difference", unit="%", low=0.1, high=100.0, log=True)
    assert [name for _, name in shades.ticks()] == ["0.1", "1", "10", "100"]
    np.testing.assert_allclose(shades.place(np.array([1e-9, 1.0, 1e9])), [0.0, 1.0 / 3.0, 1.0])


def test_cells_reach_from_edge_to_edge_on_a_logarithmic_axis():
    heat = Heat(x=np.array([1.0, 10.0, 100.0]), y=np.array([0.0, 1.0]), values=np.zeros((2, 3)))
    x, y = heat.edges(log_x=True)
    np.testing.assert_allclose(x, 10.0 ** np.array([-0.5, 0.5, 1.5, 2.5]))
    np.testing.assert_allclose(y, [-0.5, 0.5, 1.5])


def test_contour_follows_its_level():
    x, y = np.linspace(0.0, 2.0, 41), np.linspace(0.0, 1.0, 21)
    at = contour(x, y, np.add.outer(y, x), 1.25)
    np.testing.assert_allclose(at[0] + at[1], 1.25, atol=1e-12)
    assert np.ptp(at[1]) == pytest.approx(1.0)
    assert len(contour(x, y, np.add.outer(y, x), 9.0)[0]) == 0


def test_distribution_steps_count_members_without_a_value():
    x, share = ecdf(np.array([0.4, 0.1]), total=4, end=1.0)
    assert [*zip(x, share, strict=True)] == [(0.0, 0.0), (0.1, 0.25), (0.4, 0.5), (1.0, 0.5)]


def test_bars_are_drawn_from_start_to_end():
    places = np.zeros(1)
    bars = Bars(places=places, start=places + 0.4, end=places + 1.0, colours=["#000000"], texts=["1e-3"])
    panel = Panel(x=Axis(label="share", unit="-"), y=list_axis(["run"]), layers=[bars])
    picture = Picture(name="bars", title="Bars", panels=[panel])
    page = drawn_on_a_page(picture)
    (drawn,) = page["layers"]
    assert [*numbers(drawn["start"]), *numbers(drawn["end"])] == pytest.approx([0.4, 1.0])
    assert page["y"]["reverse"]
    assert "1e-3" in words(svg(picture))


def test_axis_without_a_unit_is_refused():
    with pytest.raises(ValueError, match="must have a unit"):
        Axis(label="tilt", unit="")


def test_page_elements_name_their_panel_and_linked_axis():
    ((title, element),) = charts(lines(link_x=True))
    assert title == ""
    assert 'id="lines-0"' in element
    assert '"link":"time [s]"' in element


def test_trace_plot_shows_tilt_and_path():
    pier = Cylinder(semidiagonal=6.0, tan_alpha=0.2)
    release = InitialState(tilt=0.5 * pier.alpha, rolling_rate=0.5)
    drawn = simulate(Case(pier, initial=release, duration=1.0)).plot()
    tilt, path = drawn.axes
    assert tilt.lines[0].get_ydata()[0] == pytest.approx(0.5)
    # the top leans towards the rim by as much as the axis does
    assert np.hypot(*path.lines[1].get_data())[0] == pytest.approx(top_displacement(pier, release.tilt))


def test_model_style_depends_on_the_run_and_not_on_its_label() -> None:
    labels = ["recess model", "clay model", "recess model rtol=1e-06", "planar model plane=0.3"]
    styles = label_styles(labels, [label for label in labels if label != "clay model"])
    assert styles["recess model"] == Style(colour="#000000", dash="solid")
    assert styles["clay model"].colour in ORDER
    assert len(set(styles.values())) == len(labels)


def test_the_contact_path_is_joined_along_the_rim_only_when_flat():
    pier = Cylinder(semidiagonal=6.0, tan_alpha=0.2)
    names = {}
    for support in ("recess", "flat"):
        trace = simulate(Case(pier, el_centro_1940()), support=support)
        (picture,) = trace_pictures(trace)
        names[support] = [layer.name for layer in picture.panels[1].layers]
    assert names == {"recess": ["base", "top"], "flat": ["base", "top", "contact point"]}
    angle = trace.rolling_angle[:, None]
    centres = trace.contact_point - pier.base_radius * np.hstack([np.cos(angle), np.sin(angle)])
    path = np.column_stack([picture.panels[1].layers[2].x, picture.panels[1].layers[2].y])
    path, centres = (places[np.isfinite(places[:, 0])] for places in (path, centres))
    for points in (path, 0.5 * (path[1:] + path[:-1])):  # no chord leaves the rim
        apart = np.hypot(*(points[:, None] - centres[::20]).T)
        assert np.abs(apart - pier.base_radius).min(axis=0).max() < 0.05 * pier.base_radius


@pytest.mark.parametrize("count", [POINTS, POINTS + 1, 5346, 1_000_000])
def test_at_most_the_limit_of_samples_is_drawn_with_their_extremes(count: int):
    values = np.random.default_rng(1).normal(size=count)
    at = count // 3
    values[at], values[at + 1] = 50.0, -50.0  # two samples wide
    keep = kept_samples(values)
    assert (keep[0], keep[-1]) == (0, count - 1)
    assert POINTS // 2 < len(keep) <= POINTS
    assert len(keep) == count or count > POINTS
    assert (np.diff(keep) > 0).all()
    assert {at, at + 1} <= set(keep.tolist())


def test_thinning_keeps_edges_of_gaps_and_extremes_of_a_path():
    values = np.sin(np.linspace(0.0, 20.0, 10_000))
    values[4000:6000] = np.nan
    keep = kept_samples(values)
    assert {3999, 4000, 5999, 6000} <= set(keep.tolist())  # a line without the gap would bridge it
    path = np.linspace(0.0, 40.0, 20_000)
    both = np.cos(path), np.sin(path)
    keep = kept_samples(*both)
    assert len(keep) <= POINTS
    assert [np.ptp(each[keep]) for each in both] == [np.ptp(each) for each in both]


def test_the_envelope_is_the_maximum_over_the_last_second():
    time = np.arange(1001) * 0.01
    values = np.abs(np.sin(np.pi * time)) * np.exp(0.5 * time)
    upper = envelope(time, values)
    assert np.argmax(upper > 5.0) == np.argmax(values > 5.0)
    assert (upper[500], upper[0]) == (values[401:501].max(), values[0])
    assert (upper >= values).all()
    assert envelope(time[:1], values[:1]).tolist() == values[:1].tolist()
