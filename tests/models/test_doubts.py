"""Doubts about records, lengths, gravity, mass and tendons, probably in another unit or given twice."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from rockwobble.models import Case, Cylinder, GroundMotion, Tendon, el_centro_1940, read_record
from rockwobble.models.doubts import LARGEST_PEAK, doubts, doubts_about, doubts_of_cases


def codes(
    cylinder: Cylinder, gravity: float = 9.81, motion: GroundMotion | None = None
) -> list[tuple[str, str]]:
    """Return code and detail of the doubts about a case."""
    doubts = doubts_of_cases([Case(cylinder, motion, duration=1.0, gravity=gravity)])
    return [(str(each["code"]), str(each["detail"])) for each in doubts]


@pytest.mark.parametrize("factor", [1e-3, 1.0, 1e3])
def test_mass_and_tendon_in_another_unit_are_doubted(factor: float) -> None:
    pier = Cylinder.from_dimensions(base_radius=0.8, height=9.0)
    steel = Tendon(prestress=4.19 * factor, stiffness=59.4 * factor)
    doubts = doubts_of_cases([Case(pier, duration=1.0, tendon=steel)], 45.0 * factor)
    expected = [] if factor == 1.0 else ["unlikely_mass", "unlikely_tendon"]
    assert [each["code"] for each in doubts] == expected


LENGTHS = {"mm": 1e-3, "cm": 1e-2, "in": 0.0254, "ft": 0.3048, "km": 1e3}
GRAVITIES = {"ft/s2": 0.3048, "in/s2": 0.0254, "cm/s2": 1e-2, "mm/s2": 1e-3}


def likely(number: float, units: dict[str, float], usual: float) -> str:
    """Unit in which a number is nearest to a usual one, by their ratio."""
    return min(units, key=lambda unit: max(number * units[unit] / usual, usual / (number * units[unit])))


def test_a_doubtful_length_is_stated_with_its_limit() -> None:
    """Any body: the height of its outline first, then its diameter; 1 mm to 300 m are usual."""
    chance = np.random.default_rng(2)
    seen = set()
    for height, slenderness, centre in zip(
        10.0 ** chance.uniform(-4.5, 4.5, 300),
        10.0 ** chance.uniform(-1.5, 1.5, 300),
        chance.uniform(0.2, 0.9, 300),
        strict=True,
    ):
        radius = height * slenderness
        body = Cylinder.from_dimensions(base_radius=radius, height=height, mass_centre_height=centre * height)
        rows = [each for each in doubts_of_cases([Case(body, duration=1.0)]) if each["record"] == "cylinder"]
        beyond = [length for length in (height, 2.0 * radius) if not 1e-3 <= length <= 300.0]
        assert len(rows) == bool(beyond)
        for each, length in zip(rows, beyond, strict=False):
            assert each["size"] == pytest.approx(length, rel=1e-12)
            assert each["bound"] == (300.0 if length > 1.0 else 1e-3)
            assert each["detail"] == likely(length, LENGTHS, 8.0)
            seen.add((length == height, length > 1.0, each["detail"]))
    assert len(seen) >= 6  # heights and diameters, below and above, in several units


def test_the_doubt_about_a_gravity_states_it_and_its_limit() -> None:
    pier = Cylinder(semidiagonal=6.0, tan_alpha=0.2)
    for gravity in 10.0 ** np.random.default_rng(3).uniform(-1.0, 5.0, 100):
        doubts = doubts_of_cases([Case(pier, duration=1.0, gravity=gravity)])
        assert len(doubts) == (gravity > 25.0)
        for each in doubts:
            assert (each["record"], each["size"], each["bound"]) == ("gravity", gravity, 25.0)
            assert each["detail"] == likely(gravity, GRAVITIES, 9.81)


@pytest.mark.parametrize(("one", "other", "columns"), [(0, 1, 2), (0, 1, 3), (0, 2, 3), (1, 2, 3)])
def test_equal_components_of_a_record_are_doubted(one: int, other: int, columns: int) -> None:
    pier = Cylinder(semidiagonal=6.0, tan_alpha=0.2)
    samples = np.random.default_rng(4).uniform(-1.0, 1.0, (60, columns))
    samples[:, other] = samples[:, one]
    assert codes(pier, motion=GroundMotion(samples, 0.1)) == [
        ("same_components", f"{'xyz'[one]} and {'xyz'[other]}")
    ]
    samples[37, other] += 1e-9
    assert codes(pier, motion=GroundMotion(samples, 0.1)) == []
    samples[:, [one, other]] = 0.0  # motion along the third direction
    assert codes(pier, motion=GroundMotion(samples, 0.1)) == []


RECORD = el_centro_1940()
G = 9.81  # [m/s^2]


def times(x: float, y: float) -> GroundMotion:
    return GroundMotion(RECORD.acceleration * [x, y], RECORD.time_step, "made")


def test_measured_records_are_plausible() -> None:
    strong = RECORD.scaled(0.99 * LARGEST_PEAK * G / RECORD.peak)
    planar = times(1.0, 0.0)
    for motion in (RECORD, el_centro_1940(vertical=True), strong, planar, times(1.0, 0.03)):
        assert doubts(motion) == ()
    # a planar motion stays planar after a rotation by a degree or by rounding
    for angle in (0.01, 0.5 * np.pi):
        assert doubts(planar.rotated(angle)) == ()


def test_doubts_about_one_record_appear_once() -> None:
    doubts = doubts_about(motions=[times(981.0, 981.0), None, times(2000.0, 2000.0), RECORD])
    assert [(doubt["record"], doubt["code"]) for doubt in doubts] == [("made", "large_peak")]


@pytest.mark.parametrize("degrees", [-450.0, 1e4])
def test_degrees_beyond_a_full_turn_are_the_same_rotation(degrees: float, tmp_path: Path) -> None:
    path = tmp_path / "record.csv"
    times = np.arange(50) * 0.01
    np.savetxt(path, np.column_stack([times, np.sin(9.0 * times), np.cos(7.0 * times)]), delimiter=",",
        header="time [s],x [m/s2],y [m/s2]", comments="")  # fmt: skip
    beyond, within = (read_record(path, rotate=angle) for angle in (degrees, degrees % 360.0))
    assert np.allclose(beyond.acceleration, within.acceleration, atol=1e-9)  # rounding of the angle


def record(
    folder: Path, x: np.ndarray, y: np.ndarray, step: float = 0.01, unit: str = "m/s2"
) -> GroundMotion:
    """Record as read from columns [`unit`]."""
    path = folder / "record.csv"
    rows = zip((step * np.arange(len(x))).tolist(), x.tolist(), y.tolist(), strict=True)
    path.write_text(
        f"time [s],x [{unit}],y [{unit}]\n" + "".join(f"{t:.9g},{a!r},{b!r}\n" for t, a, b in rows)
    )
    return read_record(path)


COUNT = 400
TIMES = np.linspace(0.0, 1.0, COUNT)
# strong in the middle and still at both ends, without a mean, and with a peak of 1
STILL = np.sin(np.pi * np.clip((TIMES - 0.1) / 0.8, 0.0, 1.0)) ** 2
X, Y = STILL * np.sin(61.0 * TIMES), STILL * np.sin(47.0 * (1.0 - TIMES))
X, Y = (each - STILL * each.sum() / STILL.sum() for each in (X, Y))
X, Y = X / np.abs(X).max(), Y / np.abs(Y).max()


def found(motion: GroundMotion) -> dict[str, tuple[float, float, str]]:
    """Size, bound and detail of each doubt by its code."""
    facts = motion.diagnostics
    assert len({fact.code for fact in facts}) == len(facts)
    return {fact.code: (fact.size, fact.bound, fact.detail) for fact in facts}


@pytest.mark.parametrize("axis", ["x", "y"])
@pytest.mark.parametrize("part", [-0.0505, 0.0495])
def test_an_offset_above_a_twentieth_of_the_peak_is_doubted(tmp_path: Path, axis: str, part: float) -> None:
    """Size of the doubt: mean over the peak, of the component where it is largest."""
    # an offset changes the peak, too: part = offset/(largest + offset) of the larger side
    offset = part / (1.0 - abs(part))
    components = {"x": 0.8 * X, "y": 0.8 * Y}
    moved = components[axis]
    moved = moved if (moved.max() > -moved.min()) == (part >= 0.0) else -moved
    components[axis] = moved + 0.8 * offset
    doubts_found = found(record(tmp_path, components["x"], components["y"]))
    if abs(part) < 0.05:
        assert doubts_found == {}
        return
    size, bound, detail = doubts_found.pop("offset")
    assert (size, bound, detail) == (pytest.approx(abs(part), rel=1e-9), 0.05, axis)
    assert doubts_found.keys() <= {"unlike_components"}


@pytest.mark.parametrize("axis", ["x", "y"])
@pytest.mark.parametrize(("mean", "doubted"), [(0.79, False), (0.81, True), (-1.19, True), (1.21, False)])
def test_a_mean_of_about_1_g_is_doubted_as_gravity(
    tmp_path: Path, axis: str, mean: float, doubted: bool
) -> None:
    components = {"x": 0.5 * G * X, "y": 0.5 * G * Y}
    components[axis] = components[axis] + mean * G
    facts = found(record(tmp_path, components["x"], components["y"]))
    assert ("gravity_in_record" in facts, "offset" in facts) == (doubted, not doubted)
    if doubted:
        assert facts["gravity_in_record"] == (pytest.approx(abs(mean), rel=1e-9), 1.0, axis)


@pytest.mark.parametrize("ratio", [29.9, 30.1])
@pytest.mark.parametrize("axis", ["x", "y"])
def test_peaks_of_components_that_differ_by_a_factor_of_30_are_doubted(
    tmp_path: Path, axis: str, ratio: float
) -> None:
    x, y = (X, Y / ratio) if axis == "x" else (X / ratio, Y)
    facts = found(record(tmp_path, x, y))
    assert facts == (
        {} if ratio < 30.0 else {"unlike_components": (pytest.approx(ratio, rel=1e-9), 30.0, axis)}
    )
    # components in proportion are one motion along a line, in any direction
    assert found(record(tmp_path, X, X / ratio)) == {}


@pytest.mark.parametrize("unit", ["g", "m/s2", "cm/s2"])
@pytest.mark.parametrize("peak", [1.99, 2.01, 39.5])
def test_a_peak_above_2_g_is_doubted_with_a_plausible_unit(tmp_path: Path, unit: str, peak: float) -> None:
    """Advice: the unit in which the peak is nearest to 0.4 g; none where the unit is already the smallest."""
    metre = {"g": G, "m/s2": 1.0, "cm/s2": 0.01}
    resultant = np.hypot(X, Y).max()
    size = peak * G / metre[unit] / resultant
    facts = found(record(tmp_path, size * X, size * Y, unit=unit))
    if peak < 2.0:
        assert facts == {}
        return
    smaller = {other: peak * metre[other] / metre[unit] for other in metre if metre[other] < metre[unit]}
    likely = min(smaller, key=lambda other: max(smaller[other] / 0.4, 0.4 / smaller[other]), default=None)
    detail = f"{likely} for {unit}" if likely else ""
    assert facts == {"large_peak": (pytest.approx(peak, rel=1e-9), 2.0, detail)}


@pytest.mark.parametrize("step", [0.99e-4, 1e-4, 0.1, 0.101])
def test_a_time_step_that_no_recorder_has_is_doubted(tmp_path: Path, step: float) -> None:
    facts = found(record(tmp_path, X, Y, step))
    due = {} if 1e-4 <= step <= 0.1 else {"unlikely_step": (step, 0.1 if step > 0.1 else 1e-4, "")}
    assert facts == due


@pytest.mark.parametrize("part", [0.29, 0.31])
@pytest.mark.parametrize("sample", [-9, -8, -1])
def test_strong_motion_in_the_last_fiftieth_is_doubted(tmp_path: Path, part: float, sample: int) -> None:
    """Strong motion after the means are removed."""
    x = 0.8 * X
    x[sample] = 0.8 * part
    x[0] = -0.8 * part  # so that the mean is 0
    facts = found(record(tmp_path, x, 0.8 * Y))
    doubted = part > 0.3 and sample >= -8  # 8 of 400 samples
    assert facts == ({"ends_in_strong_motion": (pytest.approx(part, rel=1e-9), 0.3, "")} if doubted else {})


@pytest.mark.parametrize(("factor", "doubted"), [(1.0, False), (4.9, False), (5.1, True)])
def test_a_record_that_is_scaled_beyond_5_g_is_doubted(tmp_path: Path, factor: float, doubted: bool) -> None:
    resultant = np.hypot(X, Y).max()
    motion = record(tmp_path, G * X / resultant, G * Y / resultant).scaled(factor)
    facts = [(fact.code, fact.size, fact.bound, fact.detail) for fact in doubts(motion)]
    assert facts == ([("large_peak", pytest.approx(factor, rel=1e-9), 5.0, "")] if doubted else [])
