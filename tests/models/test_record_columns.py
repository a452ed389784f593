"""Two columns, time and acceleration: text and CSV."""

from __future__ import annotations

import re
from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest

from rockwobble.models import read_record

Write = Callable[..., Path]

TEXT = "0.00 0.0\n0.02 1.5\n0.04 -2.5\n"
VALUES = [0.0, 1.5, -2.5]


@pytest.mark.parametrize(
    "text",
    [
        TEXT,
        TEXT.replace("\n", "  \r\n"),
        TEXT.replace(" ", "\t"),
        "   " + TEXT.replace(" ", "     ").replace("\n", "\n\n  "),
        TEXT.replace(" ", ","),
        TEXT.replace(" ", " , ").replace("\n", ",\n"),
        TEXT.replace(" ", ";"),
        TEXT.replace(" ", '","').replace("\n", '"\n"').join('"\n')[:-1],
        "\ufeff" + TEXT,
        TEXT.rstrip("\n"),
        "0 0\n2D-2 1.5E0\n.4e-1 -25.d-1\n",
        "-0.02 0.0\n0.0 +1.5\n0.02 -2.5\n",
    ],
)
def test_each_way_to_write_two_columns(write: Write, text: str) -> None:
    path = write(text)
    motion = read_record(path, path, units="m/s2")
    assert motion.acceleration[:, 0] == pytest.approx(VALUES, rel=1e-15)
    assert motion.time_step == pytest.approx(0.02, rel=1e-9)


@pytest.mark.parametrize("mark", ["#", "%", "!"])
def test_comment_lines_stand_anywhere(write: Write, mark: str) -> None:
    lines = TEXT.splitlines()
    path = write(
        f"{mark} station 12, 1940\n{mark}\n{lines[0]}\n{mark} 9 9\n{lines[1]}\n{lines[2]}\n{mark} end"
    )
    assert read_record(path, path, units="m/s2").acceleration[:, 1] == pytest.approx(VALUES, rel=1e-15)


@pytest.mark.parametrize(
    ("header", "factor"),
    [
        ("time [s],acceleration [g]", 9.81),
        ("Time (s);Acc. (cm/s^2)", 0.01),
        ("t,a [m/s²]", 1.0),
        ("# units: m/s2", 1.0),
        ("# Units = g\n# from a table", 9.81),
        ("time acc in gal", 0.01),
        ("# acceleration [g], peak velocity 20 cm/s", 9.81),
        ('"time [s]","acceleration [cm/sec/sec]"', 0.01),
        ("Peak acceleration: 0.35 g\nEl Centro 1940\n# time (UTC) 04:36\ntime (sec),acc [g]", 9.81),
    ],
)
def test_the_unit_that_the_header_states(write: Write, header: str, factor: float) -> None:
    path = write(f"{header}\n{TEXT}")
    assert read_record(path, path).acceleration[2, 0] == pytest.approx(-2.5 * factor, rel=1e-15)


def test_a_superscript_of_an_older_encoding(tmp_path: Path) -> None:
    path = tmp_path / "latin.txt"
    path.write_bytes(f"t,a [m/s²]\n{TEXT}".encode("cp1252"))
    assert read_record(path, path).acceleration[2, 0] == -2.5


@pytest.mark.parametrize(
    "header",
    [
        "",
        "time,acceleration",
        "# peak 0.3 g at station G",
        "# g = 9.81 m/s^2",
        "t [s], a",
        "# acceleration of the ground",
    ],
)
def test_a_silent_header_needs_units(write: Write, header: str) -> None:
    path = write(f"{header}\n{TEXT}")
    with pytest.raises(ValueError, match=r"^x.txt does not say its unit: give units, such as g, m/s2, cm"):
        read_record(path, path)
    assert read_record(path, path, units="cm/s2").acceleration[2, 0] == pytest.approx(-0.025, rel=1e-15)


def test_printed_times_may_be_rounded(write: Write) -> None:
    path = write("\n".join(f"{i / 60.0:.3f} {i}" for i in range(601)))
    assert read_record(path, path, units="g").time_step == pytest.approx(1.0 / 60.0, rel=1e-11)


@pytest.mark.parametrize(
    ("text", "message"),
    [
        (TEXT.replace("1.5", "much"), r"x.txt, line 2: expected .*, got '0.02 much'"),
        (TEXT.replace("1.5", ""), r"x.txt, line 2: expected 2 numbers as in line 1, got '0.02'"),
        (TEXT.replace("1.5", "1.5 7"), r"x.txt, line 2: expected 2 numbers as in line 1, got '0.02 1.5 7'"),
        ("0.00,0.0\n0.02,,1.5\n", r"x.txt, line 2: a cell is empty, got '0.02,,1.5'"),
        ("t,a\n0.00,x\n0.02,1\n", r"x.txt, line 2: expected numbers alone, got '0.00,x'"),
        (TEXT.replace("1.5", "nan"), r"x.txt, line 2: a sample must be a finite number, got 'nan'"),
        (TEXT.replace("1.5", "-Inf"), r"x.txt, line 2: a sample must be a finite number, got '-Inf'"),
        (TEXT.replace("0.02", "NaN"), r"x.txt, line 2: a sample must be a finite number, got 'NaN'"),
        (TEXT.replace("1.5", "1e999"), r"x.txt, line 2: a sample must be a finite number, got '1e999'"),
        ("# only words\n", r"x.txt must hold at least two samples, got 0"),
        ("0.0 1.0\n", r"x.txt must hold at least two samples, got 1"),
        ("0 0\n0 1\n0 2\n", r"x.txt: times must rise \[s\], got 0 s first and 0 s last"),
        ("0.2 0\n0.1 1\n0.0 2\n", r"x.txt: times must rise \[s\], got 0.2 s first and 0 s last"),
        (
            "# t a\n0 0\n.1 1\n.2 2\n.4 3\n",
            r"x.txt, line 5: .* even steps, got 0.4 s after 0.2 s .* 0.133333 s",
        ),
        ("0 0\n1 0\n1e308 0\n", r"x.txt, line \d: times must rise in even steps"),
        (
            "t,velocity [cm/s]\n" + TEXT,
            r"x.txt: no column is an acceleration, .* 'velocity \[cm/s\]' \(velocity",
        ),
        ("# velocity\n" + TEXT, r"x.txt is not an acceleration record, it says 'velocity'"),
        ("t [s],acc [km/s2]\n" + TEXT, r"x.txt is in km/s2, allowed are g, m/s2, cm/s2"),
        ("t,acc [mg]\n" + TEXT, r"x.txt says that it is in mg, but units is 'g'"),
        ("time [min],acc [g]\n" + TEXT, r"x.txt gives times in min, allowed are s, ms, us and ns"),
        ("# time in minutes\n" + TEXT, r"x.txt gives times in minutes, allowed are s, ms, us and ns"),
        ("t,acc [g]\n# units: cm/s2\n" + TEXT, r"x.txt states two units: g and cm/s2"),
    ],
)
def test_says_what_is_wrong_where_and_what_is_allowed(write: Write, text: str, message: str) -> None:
    path = write(text)
    with pytest.raises(ValueError, match=f"^{message}") as caught:
        read_record(path, path, units="g")
    assert "\n" not in str(caught.value)


def test_steps_that_creep_are_uneven_too(write: Write) -> None:
    time = np.cumsum(np.where(np.arange(400) < 200, 0.01, 0.0103))
    path = write("\n".join(f"{t:.5f} 0" for t in time))
    with pytest.raises(ValueError, match=r"^x.txt, line \d+: times must rise in even steps"):
        read_record(path, path, units="g")


ALL = "t,x [g],y,z\n0,0.1,0.2,0.3\n0.01,0.4,0.5,0.6\n0.02,0.7,0.8,0.9\n"


def test_one_file_of_all_components_is_read_by_the_names_of_its_columns(write: Write) -> None:
    whole = read_record(write(ALL))
    assert (whole.acceleration / 9.81)[1].tolist() == pytest.approx([0.4, 0.5, 0.6], rel=1e-15)
    assert whole.time_step == 0.01
    turned = read_record(write(ALL.replace("t,x [g],y,z", "t,z [g],x,y")))
    assert (turned.acceleration / 9.81)[1].tolist() == pytest.approx([0.5, 0.6, 0.4], rel=1e-15)
    flat = read_record(write("# no names\n0 1 2\n0.5 3 4\n"), units="m/s2", columns="time,x,y")
    assert flat.acceleration.tolist() == [[1.0, 2.0], [3.0, 4.0]]


@pytest.mark.parametrize(
    "header",
    [
        "time,z,x,y\n\n",
        "time,z,x,y\ns,m/s2,m/s2,m/s2\n",
        "time,z,x,y\n# unit: m/s2\n",
        "# time z x y\n",
        "#time;z acc;x acc;y acc\n# Measured along x\n# 1940\n",
        "time [s] z [m/s2] x [m/s2] y [m/s2]\n",
        "El Centro 1940\ntime,z,x,y\n",
    ],
)
def test_names_of_columns_stand_in_any_line_of_the_header(write: Write, header: str) -> None:
    path = write(f"{header}0 0.1 0.2 0.3\n0.01 0.4 0.5 0.6\n")
    assert read_record(path, units="m/s2").acceleration[1].tolist() == [0.5, 0.6, 0.4]


@pytest.mark.parametrize(
    ("text", "words"),
    [
        ("0 1\n.1 2\n", "x.txt holds one component: give one file for each horizontal direction, or zero"),
        ("0 1 2\n1 2 3 4\n", "line 2: expected 3 numbers as in line 1, got '1 2 3 4'"),
        (ALL.replace("t,x [g],y,z", "t,x [g],y,y"), "two columns have one direction.*, 3 y, 4 y"),
        ("0 1 2\n.1 2 2\n", "name them by --record-columns .*it has 3 columns without names"),
        ("NPTS= 2, DT= .01 SEC\n1 2\n", "x.txt holds one component"),
    ],
)
def test_one_file_of_all_components_says_what_is_wrong(write: Write, text: str, words: str) -> None:
    with pytest.raises(ValueError, match=words):
        read_record(write(text), units="g")


def test_a_device_is_no_record() -> None:
    with pytest.raises(ValueError, match="/dev/null: it is a device, which may never end"):
        read_record(Path("/dev/null"), Path("/dev/null"), units="g")


# the same motion under names of many languages, in any order and separator: x is east, y north, z up
NAMES = {
    "Time (s);U-D (gal);N-S (gal);E-W (gal)": "uyx",
    "Zeit [ms],Vertikal [gal],Ost-West [gal],Nord-Süd [gal]": "zxy",
    "tiempo Norte[gal] Este[gal] Vertical[gal]": "yxz",
    "Zaman [s]\tDoğu [cm/s2]\tDikey [cm/s2]\tKuzey [cm/s2]": "xzy",
    "czas,Północ,Wschód,Pionowo": "yxz",
    "время;Восток;Север;Вертикаль": "xyz",
    "t,HNZ,HNN,HNE": "zyx",
    "time_us,acc_z,acc_x,acc_y": "zxy",
    "時間,上下,南北,東西": "zyx",
    "Temps (s), accélération N-S (cm/s²), accélération V (cm/s²), accélération E-W (cm/s²)": "yzx",
}
UNIT_OF_TIME = {"Zeit": 1e-3, "time_us": 1e-6}


@pytest.mark.parametrize("header", NAMES)
def test_names_decide_in_any_language_and_order(write: Write, header: str) -> None:
    random = np.random.default_rng(5)
    order = NAMES[header].replace("u", "z")
    values = dict(zip("xyz", random.normal(size=(3, 50)).round(4), strict=True))
    seconds = next((unit for word, unit in UNIT_OF_TIME.items() if header.startswith(word)), 1.0)
    separator = next((mark for mark in ";\t," if mark in header), " ")
    rows = [
        separator.join([f"{0.02 * i / seconds:g}", *(f"{values[axis][i]}" for axis in order)])
        for i in range(50)
    ]
    motion = read_record(write(header + "\n" + "\n".join(rows) + "\n"), units="cm/s2")
    assert motion.time_step == pytest.approx(0.02, rel=1e-9)
    for place, axis in enumerate("xyz"):
        assert motion.acceleration[:, place] == pytest.approx(0.01 * values[axis], rel=1e-12)
    assert motion.source is not None
    assert [part.axis for part in motion.source.components] == ["x", "y", "z"]


NUMBERS = "\n".join(f"{i * 0.01:.2f},{np.sin(i):.4f},{np.cos(i):.4f}" for i in range(30))


@pytest.mark.parametrize(
    ("header", "words"),
    [
        ("time,H1,H2", "which direction 'H1' has is not known"),
        ("time,velocity E,velocity N", "no column is an acceleration"),
        ("time,E (mm),N (mm)", "no column is an acceleration"),
        (",Time,Acceleration (g)", "times must rise|holds one component"),
        ("time,E,E", "two columns have one direction"),
        ("", "which column is which is not said"),
    ],
)
def test_a_doubtful_name_is_refused_with_the_option(write: Write, header: str, words: str) -> None:
    with pytest.raises(ValueError, match=words):
        read_record(write(f"{header}\n{NUMBERS}\n".lstrip("\n")), units="g")


@pytest.mark.parametrize("columns", ["time,Quer,Laengs", "1,3,2", [1, 3, 2]])
def test_the_user_names_columns_by_name_or_number(write: Write, columns: str | list[str | int]) -> None:
    motion = read_record(write(f"time,Laengs,Quer\n{NUMBERS}\n"), units="m/s2", columns=columns)
    assert motion.acceleration[:, 0] == pytest.approx(np.cos(np.arange(30)), abs=1e-4)
    with pytest.raises(ValueError, match=r"no column 'Hoch' of --record-columns .* it has 1 time, 2 Laengs"):
        read_record(write(f"time,Laengs,Quer\n{NUMBERS}\n"), units="m/s2", columns="time,Hoch,Quer")


@pytest.mark.parametrize(
    "header",
    [
        "time,NS,EW,UD",
        "UD,time,NS,EW",
        "Time EW NS",
        "time,acc_NS,acc_EW",
        "time (s),NS (g),EW (g)",
    ],
)
def test_ns_is_north_south_and_no_nanosecond(header: str, tmp_path: Path) -> None:
    names = re.split(r"[ ,](?!\()", header)
    values = {"n": 0.3, "e": 0.2, "u": 0.1}
    rows = []
    for step in range(5):
        row = []
        for name in names:
            key = next((each for each in ("ns", "ew", "ud") if each in name.lower()), "")
            row.append(f"{0.01 * step:.2f}" if not key else f"{values[key[0]] * (step % 2):.3f}")
        rows.append((" " if " EW" in header else ",").join(row))
    path = tmp_path / "record.csv"
    path.write_text("\n".join([header, *rows]))
    motion = read_record(path, units="g")
    peaks = np.abs(motion.acceleration).max(axis=0) / 9.81
    assert peaks[:2] == pytest.approx([0.2, 0.3])
    assert motion.time_step == pytest.approx(0.01)


def test_ns_behind_a_time_are_nanoseconds(tmp_path: Path) -> None:
    path = tmp_path / "record.csv"
    path.write_text("time_ns,E,N\n0,0,0\n10000000,0.1,0.2\n20000000,0,0\n")
    assert read_record(path, units="g").time_step == pytest.approx(0.01)
