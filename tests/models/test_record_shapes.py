"""Files as people's disks have them, of invented values: each is read rightly, or refused in one line."""

from __future__ import annotations

import json
import re
from collections.abc import Mapping
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from numpy.typing import NDArray

from rockwobble.models import read_record

Values = NDArray[np.float64]
COUNT, STEP = 60, 0.01
TIME = np.arange(COUNT) * STEP
PULSE = np.exp(-(((TIME - 0.25) / 0.12) ** 2))
RNG = np.random.default_rng(7)
# [cm/s^2]; three digits behind the point
EAST, NORTH, UP = (
    np.round(size * PULSE * np.sin(rate * TIME + 0.3) + 0.3 * RNG.normal(size=COUNT), 3)
    for size, rate in ((120.0, 37.0), (80.0, 51.0), (40.0, 90.0))
)
ALL = {"x": EAST, "y": NORTH, "z": UP}
TWO = {"x": EAST, "y": NORTH}
ONE = {"x": EAST}
DIGITS = 2e-8  # [m/s^2]; of the numbers of these files, each written with at least nine digits or exactly


def table(
    header: str,
    *columns: Values,
    first: Values | None = TIME,
    separator: str = ",",
    comma: str = ".",
    form: str = "%.12g",
) -> str:
    """Return columns as text under a header."""
    parts = columns if first is None else (first, *columns)
    rows = [
        separator.join([form % value for value in row]).replace(".", comma)
        for row in zip(*parts, strict=True)
    ]
    return "\n".join([*([header] if header else []), *rows]) + "\n"


def semicolons(header: str, *columns: Values) -> str:
    """Return what a spreadsheet writes where the comma is the decimal point."""
    return table(header, *columns, separator=";", comma=",").replace("\n", "\r\n")


def lines(values: Values, form: str, width: int) -> str:
    """Return values of a width in lines of several."""
    texts = [form % value for value in values]
    return "".join("".join(texts[i : i + width]) + "\n" for i in range(0, len(texts), width))


def clock(hour: int) -> list[str]:
    return [f"{hour:02d}:20:{29.7 + t:06.3f}" for t in TIME]


def clocked(header: str, before: str, behind: str = "") -> str:
    rows = zip(clock(10), EAST, NORTH, UP, strict=True)
    return f"{header}\n" + "".join(
        f"{before}{at}{behind},{x:.12g},{y:.12g},{z:.12g}\n" for at, x, y, z in rows
    )


def stacked(*parts: tuple[str, Values]) -> str:
    title = "Component: {}\nAcceleration (cm/s2), dt = 0.01 s\n"
    return "".join(title.format(name) + lines(values, "%12.3f", 5) for name, values in parts)


def with_end(cell: str) -> str:
    """Return two columns and, for three more times, what stands in the place of a sample."""
    return table("t [s],E [gal],N [gal]", EAST, NORTH) + "".join(f"0.6{i},{cell},{cell}\n" for i in range(3))


CENTI_G = EAST / 9.81
# name: content, what it holds, options
READ: Mapping[str, tuple[str | bytes, Mapping[str, Values], dict[str, Any]]] = {
    # spreadsheets, in the languages of networks
    "units_row.csv": (
        "\ufeff"
        + semicolons(
            "Zeit;Beschl. Ost;Beschl. Nord;Beschl. vertikal\r\n[s];[m/s²];[m/s²];[m/s²]",
            *(v / 100 for v in ALL.values()),
        ),
        ALL,
        {},
    ),
    "quoted_commas.csv": (
        semicolons('"Zeit, s";"Beschl., Ost [cm/s²]";"Beschl., Nord [cm/s²]"', EAST, NORTH),
        TWO,
        {},
    ),
    "quoted_cells.csv": (
        table('"Time (s)","E (gal)","N (gal)"', EAST, NORTH, separator='","', form="%.12g")
        .replace("\n", '"\n"')
        .removesuffix('"')
        .replace('""', '"'),
        TWO,
        {},
    ),
    "italian.csv": (
        semicolons("Tempo (s);Accelerazione E-O (cm/s2);Accelerazione N-S (cm/s2)", EAST, NORTH),
        TWO,
        {},
    ),
    "spanish.csv": (
        semicolons(
            "Tiempo (s);Aceleración V (cm/s2);Aceleración N-S (cm/s2);Aceleración E-O (cm/s2)",
            UP,
            NORTH,
            EAST,
        ),
        ALL,
        {},
    ),
    "turkish_cp1254.csv": (
        semicolons("Zaman (sn);Düşey İvme (gal);Doğu (gal);Kuzey (gal)", UP, EAST, NORTH).encode("cp1254"),
        ALL,
        {},
    ),
    "japanese_cp932.csv": (
        table("時刻(s),南北(gal),東西(gal),上下(gal)", NORTH, EAST, UP).encode("cp932"),
        ALL,
        {},
    ),
    "chinese_gb18030.csv": (
        table("时间(s),东西向(gal),南北向(gal),竖直向(gal)", EAST, NORTH, UP).encode("gb18030"),
        ALL,
        {},
    ),
    "korean_cp949.csv": (table("시간(s),동서(gal),남북(gal)", EAST, NORTH).encode("cp949"), TWO, {}),
    "greek_cp1253.csv": (
        table("Χρόνος (s),Ανατολή (gal),Βορράς (gal)", EAST, NORTH).encode("cp1253"),
        TWO,
        {},
    ),
    "russian_cp1251.csv": (
        table("Время (с),Ускорение восток (см/с2) [gal],Ускорение север [gal]", EAST, NORTH).encode("cp1251"),
        TWO,
        {},
    ),
    "unicode.txt": (
        ("\ufeff" + table("Time [s]\tE [gal]\tN [gal]\tZ [gal]", EAST, NORTH, UP, separator="\t")).encode(
            "utf-16-le"
        ),
        ALL,
        {},
    ),
    # units
    "milli_g.csv": (table("Time (s),E (mg),N (milli-g)", EAST / 0.981, NORTH / 0.981), TWO, {}),
    "percent_of_g.csv": (table("Time (s),E (%g),N (% g)", CENTI_G, NORTH / 9.81), TWO, {}),
    "millimetres_and_us.csv": (
        table("t_us,ax_mm_s2,ay_mm_s2", 10 * EAST, 10 * NORTH, first=1e6 * TIME),
        TWO,
        {},
    ),
    "millimetres_and_ms.csv": (
        table("time (ms),E (mm/s^2),N (mm/s/s)", 10 * EAST, 10 * NORTH, first=1e3 * TIME),
        TWO,
        {},
    ),
    "feet.csv": (table("t [s],E [ft/s2],N [ft/sec^2]", EAST / 30.48, NORTH / 30.48), TWO, {}),
    "inches.csv": (table("t [s],E [in/s2],N [in/sec/sec]", EAST / 2.54, NORTH / 2.54), TWO, {}),
    "unit_in_words.txt": (
        table("# acceleration in mm/s2\n# t E N", 10 * EAST, 10 * NORTH, separator=" "),
        TWO,
        {},
    ),
    "names_with_units.csv": (
        table(",time_s,acc_e_gal,acc_n_gal", TIME, EAST, NORTH, first=np.arange(60.0)),
        TWO,
        {},
    ),
    # names
    "seismosignal.txt": (
        table(
            "Time [sec]     Acceleration [gal]   Velocity [cm/sec]   Displacement [cm]",
            EAST,
            NORTH,
            UP,
            separator="     ",
        ),
        ONE,
        {},
    ),
    "displacement_first.csv": (table("Time (s),Disp (cm),Vel (cm/s),Acc (cm/s2)", NORTH, UP, EAST), ONE, {}),
    "channels.csv": (table("time (s),HNZ,HNN,HNE", UP, NORTH, EAST), ALL, {"units": "cm/s2"}),
    "azimuths.csv": (table("time (s),360 (gal),090 (gal),UP (gal)", NORTH, EAST, UP), ALL, {}),
    "channels_at_azimuths.csv": (
        table("time (s),CHAN 1: 90 DEG,CHAN 2: 360 DEG,CHAN 3: UP", EAST, NORTH, UP),
        ALL,
        {"units": "cm/s2"},
    ),
    "reversed.csv": (table("UD (gal),NS (gal),EW (gal),Time (s)", NORTH, EAST, TIME, first=UP), ALL, {}),
    "turned_senses.csv": (table("time [s],S [gal],W [gal],D [gal]", -NORTH, -EAST, -UP), ALL, {}),
    "comments.txt": (
        table("; by hand\n! units cm/s2\n// x is east\n% time x y z", EAST, NORTH, UP, separator=" "),
        ALL,
        {},
    ),
    "of_a_csv_of_knet.csv": (
        table(
            "Origin Time,2011/03/11 14:46:00\nSampling Freq(Hz),100\nUnit,gal\nEW,NS,UD",
            EAST,
            NORTH,
            UP,
            first=None,
        ),
        ALL,
        {},
    ),
    "cismid.txt": (
        table(
            "MUESTREO (muestras/seg) : 100\nUNIDADES : cm/s2\n   EW      NS      UD",
            EAST,
            NORTH,
            UP,
            first=None,
            separator="   ",
        ),
        ALL,
        {},
    ),
    # times
    "clock.csv": (clocked("time,E [gal],N [gal],Z [gal]", ""), ALL, {}),
    "iso8601.csv": (clocked("timestamp,E [gal],N [gal],Z [gal]", "2023-02-06T", "Z"), ALL, {}),
    "date_of_germany.csv": (clocked("Datum,E [gal],N [gal],Z [gal]", "06.02.2023 "), ALL, {}),
    "epoch.csv": (
        table("time,E [gal],N [gal]", EAST, NORTH, first=1675646250.0 + TIME),
        TWO,
        {"time_step": STEP},
    ),
    "sample_numbers.csv": (
        table("# fs = 100 Hz\nsample,E [gal],N [gal]", EAST, NORTH, first=np.arange(60.0)),
        TWO,
        {},
    ),
    # what stands behind the last sample
    "nan_at_the_end.csv": (with_end("NaN"), TWO, {}),
    "empty_at_the_end.csv": (table("t [s],E [gal],N [gal]", EAST, NORTH) + ",,\r\n,,\n", TWO, {}),
    "times_alone_at_the_end.csv": (with_end(""), TWO, {}),
    "minus_9999_at_the_end.csv": (with_end("-9999"), TWO, {}),
    "huge_at_the_end.csv": (with_end("1e10"), TWO, {}),
    "control_z.txt": (
        table("# t [s] E [gal] N [gal]", EAST, NORTH, separator=" ").replace("\n", "\r\n") + 9 * "\x1a",
        TWO,
        {},
    ),
    # digits
    "three_digits_of_exponent.txt": (
        table("dt=0.01 s, acc in gal", EAST, first=None, form="%.8E")
        .replace("E-0", "E-00")
        .replace("E+0", "E+00"),
        ONE,
        {},
    ),
    "exponents_of_fortran.txt": (
        table("# time (s)  acc (gal)", EAST, separator="  ", form="%.9E").replace("E", "D"),
        ONE,
        {},
    ),
    "touching_minus_signs.txt": (
        "DT = 0.01 SEC   UNITS: CM/SEC2\n" + lines(-EAST - 900.0, "%9.4f", 8),
        {"x": -EAST - 900.0},
        {},
    ),
    # several components, and lists
    "stacked.txt": (stacked(("UD", UP), ("NS", NORTH), ("EW", EAST)), ALL, {}),
    "stacked_azimuths.txt": (stacked(("090", EAST), ("000", NORTH), ("UP", UP)), ALL, {}),
    "opensees.tcl": (
        "timeSeries Path 1 -dt 0.01 -values {" + " ".join(map(str, EAST)) + "} -factor 9.81\n",
        ONE,
        {"units": "cm/s2"},
    ),
    "list.json": (json.dumps(EAST.tolist()), ONE, {"units": "cm/s2", "time_step": STEP}),
    "pairs.inp": (
        "*Amplitude, name=EQ\n" + "".join(f"{t:.2f}, {a},\n" for t, a in zip(TIME, EAST, strict=True)),
        ONE,
        {"units": "cm/s2"},
    ),
    "chile.txt": (
        "# Tasa de muestreo: 100 muestras/seg\n# Canal: HNE\n# Unidades: cm/s/s\n" + lines(EAST, "%.3f", 1),
        ONE,
        {},
    ),
}
REFUSED: Mapping[str, tuple[str | bytes, str]] = {
    "lengths.csv": (table("t (s),E (mm),N (mm)", EAST, NORTH), r"E \(mm\)"),
    "velocities.csv": (table("t (s),Acc E (mm/s),Acc N (mm/s)", EAST, NORTH), "mm/s"),
    "parts_of_g.txt": (table("ACCELERATION IN G*100\nTime EW NS", EAST, NORTH, separator=" "), "factor"),
    "powers_of_ten.txt": (
        table("# acceleration [10^-3 g]\nTime EW NS", EAST, NORTH, separator=" "),
        "factor",
    ),
    "scaled.tcl": (
        "timeSeries Path 1 -dt 0.01 -values {" + " ".join(map(str, EAST)) + "} -factor 0.35\n",
        "-factor",
    ),
    "h1_h2.csv": (
        table("time (s),H1 (gal),H2 (gal),V (gal)", EAST, NORTH, UP),
        "'H1 .*--record-columns.*2 H1",
    ),
    "quoted_names.csv": (
        semicolons('"Sensor A";"Sensor B";"Sensor C"', EAST, NORTH),
        "1 Sensor A, 2 Sensor B",
    ),
    "long_trans.csv": (
        table("Time (s),Long (gal),Trans (gal),Vert (gal)", EAST, NORTH, UP),
        "--record-columns",
    ),
    "no_names.txt": (table("", EAST, NORTH, UP, separator=" "), "--record-columns"),
    "epoch_alone.csv": (
        table("time,E [gal],N [gal]", EAST, NORTH, first=1675646250.0 + TIME),
        "epoch.*--record-step",
    ),
    "sample_numbers_alone.csv": (
        table("sample,E [gal],N [gal]", EAST, NORTH, first=np.arange(60.0)),
        "--record-step",
    ),
    "missing_within.csv": (
        table("t [s],E [gal],N [gal]", np.where(TIME == 0.2, -9999.0, EAST), NORTH),
        "-9999",
    ),
    "huge_within.csv": (table("t [s],E [gal],N [gal]", np.where(TIME == 0.2, 1e20, EAST), NORTH), r"1e\+20"),
    "half_a_row.csv": (table("t [s],E [gal],N [gal]", EAST, NORTH) + "0.60,,0.1\n", "line 62.*cell is empty"),
    "unknown_titles.txt": (stacked(("A", EAST), ("B", NORTH)), "blocks of numbers"),
    "pairs.json": (json.dumps([[t, a] for t, a in zip(TIME, EAST, strict=True)]), "JSON"),
    "array.npy": (b"\x93NUMPY\x01\0v\0" + bytes(300), "NumPy"),
    "arrays.npz": (b"PK\x03\x04" + bytes(300), "ZIP"),
    "sheet.xlsx": (b"PK\x03\x04" + bytes(300), "Excel"),
    "packed.AT2.gz": (b"\x1f\x8b\x08" + bytes(300), "gzip"),
}


@pytest.mark.parametrize("name", READ)
def test_is_read(tmp_path: Path, name: str) -> None:
    content, parts, options = READ[name]
    path = tmp_path / name
    path.write_bytes(content if isinstance(content, bytes) else content.encode())
    motion = read_record(path, *(["zero"] if "y" not in parts else []), **options)
    assert motion.time_step == pytest.approx(STEP, rel=1e-9)
    assert motion.acceleration.shape == (COUNT, max(len(parts), 2))
    for column, values in zip(motion.acceleration.T, parts.values(), strict=False):
        np.testing.assert_allclose(column, values / 100.0, rtol=0, atol=DIGITS)
    assert name in str(motion.source)
    assert str(motion.source).isprintable()


@pytest.mark.parametrize("name", REFUSED)
def test_is_refused_in_a_line(tmp_path: Path, name: str) -> None:
    content, words = REFUSED[name]
    path = tmp_path / name
    path.write_bytes(content if isinstance(content, bytes) else content.encode())
    with pytest.raises(ValueError, match=f"^{re.escape(name)}") as caught:
        read_record(path)
    message = str(caught.value)
    assert re.search(words, message), message
    assert message.isprintable()
    assert len(message) < 250


@pytest.mark.parametrize("unit", ["mm/s2", "mg", "ft/s2", "%g"])
def test_the_unit_of_the_file_is_said(tmp_path: Path, unit: str) -> None:
    path = tmp_path / "a.csv"
    path.write_text(table(f"t [s],E [{unit}],N [{unit}]", EAST, NORTH))
    assert str(read_record(path).source).count(f"[{unit}]") == 2
    with pytest.raises(ValueError, match=f"says that it is in {unit}, but units is 'g'"):
        read_record(path, units="g")


def test_what_is_left_out_at_the_end_is_said(tmp_path: Path) -> None:
    path = tmp_path / "a.csv"
    for cell, words in {"NaN": "3 rows without samples", "1e10": "3 fill values of 1e+10"}.items():
        path.write_text(with_end(cell))
        assert words in str(read_record(path).source)


def test_clock_times_at_one_place_and_at_several_are_alike(tmp_path: Path) -> None:
    # one blank more in some rows: these are read row by row, the others all at once
    even = clocked("time,E [gal],N [gal],Z [gal]", "").replace(",10:", "10:")
    night = even.replace("10:20:29", "23:59:59").replace("10:20:30", "00:00:00")
    for text in (even, night):
        rows = text.splitlines()
        motions = []
        for each in (rows, [f" {row}" if at % 7 == 3 else row for at, row in enumerate(rows)]):
            path = tmp_path / "a.csv"
            path.write_text("\n".join(each) + "\n")
            motions.append(read_record(path))
        assert motions[0].time_step == motions[1].time_step
        np.testing.assert_array_equal(motions[0].acceleration, motions[1].acceleration)
