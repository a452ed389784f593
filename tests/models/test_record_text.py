"""Free text in many layouts, of invented values: read correctly, or refused in one line."""

from __future__ import annotations

import itertools
import json
import re
from collections.abc import Callable, Mapping
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from numpy.typing import NDArray

from rockwobble.models import read_record

Write = Callable[..., Path]
Values = NDArray[np.float64]
COUNT, STEP, EXACT = 60, 0.01, 1e-12
TIME = np.arange(COUNT) * STEP
MOTION = (np.random.default_rng(7).normal(size=(COUNT, 3)) * [120.0, 80.0, 40.0]).round(3)  # [cm/s^2]
EAST, NORTH, UP = MOTION.T
ALL, TWO, ONE = {"x": EAST, "y": NORTH, "z": UP}, {"x": EAST, "y": NORTH}, {"x": EAST}


def table(
    header: str,
    *columns: Values,
    first: Values | None = TIME,
    separator: str = ",",
    comma: str = ".",
    form: str = "%.12g",
) -> str:
    parts = columns if first is None else (first, *columns)
    rows = [
        separator.join(form % value for value in row).replace(".", comma) for row in zip(*parts, strict=True)
    ]
    return "\n".join([*([header] if header else []), *rows]) + "\n"


def semicolons(header: str, *columns: Values) -> str:
    """Text of a spreadsheet in which the comma is the decimal point."""
    return table(header, *columns, separator=";", comma=",").replace("\n", "\r\n")


def stamped(before: str, behind: str = "") -> str:
    rows = zip(TIME, EAST, NORTH, UP, strict=True)
    return "timestamp,E [gal],N [gal],Z [gal]\n" + "".join(
        f"{before}10:20:{29.7 + t:06.3f}{behind},{x:.12g},{y:.12g},{z:.12g}\n" for t, x, y, z in rows
    )


def lines(values: Values, width: int, form: str = "%12.3f") -> str:
    texts = [form % value for value in values]
    return "".join("".join(texts[i : i + width]) + "\n" for i in range(0, len(texts), width))


GAL = "t [s],E [gal],N [gal]"
APP = np.round(1.7e9 + TIME, 2)
# name: content, expected values [cm/s^2], options
READ: Mapping[str, tuple[str | bytes, Mapping[str, Values], dict[str, Any]]] = {
    "units_row.csv": (
        "\ufeff"
        + semicolons(
            "Zeit;Beschl. Ost;Beschl. Nord;Beschl. vertikal\r\n[s];[m/s²];[m/s²];[m/s²]",
            *(MOTION.T / 100),
        ),
        ALL,
        {},
    ),
    "quoted.csv": (
        semicolons('"Zeit, s";"Beschl., Ost [cm/s²]";"Beschl., Nord [cm/s²]"', EAST, NORTH),
        TWO,
        {},
    ),
    "turkish_cp1254.csv": (
        semicolons("Zaman (sn);Düşey İvme (gal);Doğu (gal);Kuzey (gal)", UP, EAST, NORTH).encode("cp1254"),
        ALL,
        {},
    ),
    "utf_16.txt": (
        ("\ufeff" + table("Time [s]\tE [gal]\tN [gal]\tZ [gal]", *MOTION.T, separator="\t")).encode(
            "utf-16-le"
        ),
        ALL,
        {},
    ),
    "microseconds.csv": (table("t_us,ax_mm_s2,ay_mm_s2", 10 * EAST, 10 * NORTH, first=1e6 * TIME), TWO, {}),
    "unit_in_words.txt": (table("# acc in mm/s2\n# t E N", 10 * EAST, 10 * NORTH, separator=" "), TWO, {}),
    "index.csv": (table(",time_s,acc_e_gal,acc_n_gal", TIME, EAST, NORTH, first=np.arange(60.0)), TWO, {}),
    "displacement_first.csv": (table("Time (s),Disp (cm),Vel (cm/s),Acc (cm/s2)", NORTH, UP, EAST), ONE, {}),
    "azimuths.csv": (table("time (s),360 (gal),090 (gal),UP (gal)", NORTH, EAST, UP), ALL, {}),
    "turned_senses.csv": (table("time [s],S [gal],W [gal],D [gal]", -NORTH, -EAST, -UP), ALL, {}),
    "comments.txt": (table("; by hand\n! units cm/s2\n% time x y z", *MOTION.T, separator=" "), ALL, {}),
    "rate.txt": (
        table(
            "MUESTREO (muestras/seg) : 100\nUNIDADES : cm/s2\n EW  NS  UD",
            *MOTION.T,
            first=None,
            separator=" ",
        ),
        ALL,
        {},
    ),
    "iso_8601.csv": (stamped("2023-02-06T", "Z"), ALL, {}),
    "epoch.csv": (
        table("time,seconds_elapsed,E [gal],N [gal]", TIME, EAST, NORTH, first=1e9 * APP),
        TWO,
        {"columns": "seconds_elapsed,E,N"},
    ),
    "sample_numbers.csv": (
        table("# fs = 100 Hz\nsample,E [gal],N [gal]", EAST, NORTH, first=np.arange(60.0)),
        TWO,
        {},
    ),
    "fortran.txt": (
        table("# time (s)  acc (gal)", EAST, separator="  ", form="%.9E").replace("E", "D"),
        ONE,
        {},
    ),
    "values.txt": ("dt = 0.01 sec, acc in gal\n" + lines(EAST, 8), ONE, {"columns": "values"}),
    "values_alone.txt": (table("", EAST, first=None), ONE, {"units": "gal", "time_step": STEP}),
    "option.csv": (
        table("time,Hoch,Laengs,Quer", UP, NORTH, EAST),
        TWO,
        {"units": "gal", "columns": "time,Quer,Laengs"},
    ),
    "numbers.csv": (table("H1,H2", NORTH, EAST), TWO, {"units": "gal", "columns": [1, 3, 2]}),
    "row_by_row.txt": (lines(EAST, 3), ONE, {"units": "gal", "time_step": STEP, "columns": "values"}),
    "spaced.csv": (table(GAL, EAST, NORTH).replace(",", " , ").replace("\n", ",\n") + "# end\n", TWO, {}),
}
REFUSED: Mapping[str, tuple[str | bytes, str]] = {
    "lengths.csv": (table("t (s),E (mm),N (mm)", EAST, NORTH), "no column is an acceleration.*2 E"),
    "velocities.csv": (table("t (s),Acc E (mm/s),Acc N (mm/s)", EAST, NORTH), "mm/s"),
    "two_units.csv": (table("# units: g\n" + GAL, EAST, NORTH), "states two units"),
    "factor.txt": (table("ACCELERATION IN G*100\nTime EW NS", EAST, NORTH, separator=" "), "factor"),
    "minutes.csv": (table("time [min],E [g],N [g]", EAST, NORTH), "allowed are times in s, ms"),
    "h1_h2.csv": (table("time (s),H1 (gal),H2 (gal),V (gal)", *MOTION.T), "--record-columns.*2 H1"),
    "one_direction.csv": (table("time (s),E (gal),E (gal)", EAST, NORTH), "two columns have one direction"),
    "no_names.txt": (table("", *MOTION.T, separator=" "), "--record-columns"),
    "epoch_alone.csv": (table("time,E [gal],N [gal]", EAST, NORTH, first=APP), "epoch.*--record-step"),
    "two_clocks.csv": (table("time,seconds_elapsed,E [g],N [g]", TIME, EAST, NORTH), "may be times"),
    "rows.txt": (lines(EAST, 3), "--record-columns.*or all as values"),
    "uneven.csv": (table(GAL, EAST, NORTH, first=TIME**1.1), "line .*even steps.*--resample"),
    "numbers_alone.csv": (
        table("sample,E [gal],N [gal]", EAST, NORTH, first=np.arange(60.0)),
        "--record-step",
    ),
    "missing.csv": (table(GAL, np.where(TIME == 0.2, -9999.0, EAST), NORTH), "-9999"),
    "nan_at_the_end.csv": (table(GAL, EAST, NORTH) + "0.6,NaN,NaN\n", "line 62.*3 finite numbers"),
    "empty_cell.csv": (table(GAL, EAST, NORTH) + "0.60,,0.1\n", "line 62.*cell is empty"),
    "damaged.csv": (table(GAL, EAST, NORTH).replace("\n0.01,", "\n0.01,x"), "line 2.*whole row|line 3"),
    "japanese_cp932.csv": (
        table("時刻(s),南北(gal),東西(gal)", NORTH, EAST).encode("cp932"),
        "save it as UTF-8",
    ),
    "clock.csv": (stamped(""), "0 rows of numbers"),
    "touching.txt": (
        "DT = 0.01 SEC   UNITS: CM/SEC2\n" + lines(-EAST - 900.0, 8, "%9.4f"),
        "0 rows of numbers",
    ),
    "stacked.txt": (
        "Acceleration, dt = 0.01 s\n" + lines(EAST, 5) + "Velocity\n" + lines(NORTH, 5),
        "line 14",
    ),
    "counted.txt": ("60\n" + table("", EAST, first=None), "their number"),
    "paired.txt": (
        table("", EAST[::2], TIME[1::2], EAST[1::2], TIME[::2], UP[::2], first=TIME[::2]),
        "times",
    ),
    "opensees.tcl": (
        "timeSeries Path 1 -dt 0.01 -values {" + " ".join(map(str, EAST)) + "} -factor 9.81\n",
        "list of",
    ),
    "python.py": (f"acc = np.array({json.dumps(EAST.tolist())})\n", "list of a program"),
    "slist.txt": ("TIMESERIES XX_A__HNE_R, 60 samples, 100 sps, 2001, SLIST, FLOAT, G\n", "TIMESERIES"),
    "pairs.json": (json.dumps([[t, a] for t, a in zip(TIME, EAST, strict=True)]), "JSON"),
    "sheet.xlsx": (b"PK\x03\x04" + bytes(300), "Excel"),
}


def path_of(folder: Path, name: str, content: str | bytes) -> Path:
    path = folder / name
    path.write_bytes(content if isinstance(content, bytes) else content.encode())
    return path


@pytest.mark.parametrize("name", READ)
def test_text_records_of_any_layout_are_read(tmp_path: Path, name: str) -> None:
    content, parts, options = READ[name]
    motion = read_record(path_of(tmp_path, name, content), *(["zero"] if "y" not in parts else []), **options)
    assert motion.time_step == pytest.approx(STEP, rel=1e-9)
    assert motion.acceleration.shape == (COUNT, max(len(parts), 2))
    for column, values in zip(motion.acceleration.T, parts.values(), strict=False):
        assert column == pytest.approx(values / 100.0, rel=EXACT, abs=1e-10)
    assert name in str(motion.source)
    assert str(motion.source).isprintable()


@pytest.mark.parametrize("name", REFUSED)
def test_bad_text_records_are_refused_in_one_line(tmp_path: Path, name: str) -> None:
    content, words = REFUSED[name]
    with pytest.raises(ValueError, match=f"^{re.escape(name)}") as caught:
        read_record(path_of(tmp_path, name, content))
    message = str(caught.value)
    assert re.search(words, message), message
    assert message.isprintable()
    assert len(message) < 300


@pytest.mark.parametrize("row", [2, 3, 4, 30, COUNT])
@pytest.mark.parametrize("cut", ["0.5", "0.5,x", "0.5,1,2,3"])
def test_the_line_of_a_damaged_row_is_named(write: Write, row: int, cut: str) -> None:
    whole = table(GAL, EAST, NORTH).splitlines()
    whole[row] = cut
    with pytest.raises(ValueError, match=f"line {row + 1}: expected|rows that begin in line {row + 2}"):
        read_record(write("\n".join(whole)))


# one motion with column names in many languages, in any order and separator: x is east, y north, z up
NAMES = {
    "Time (s);U-D (gal);N-S (gal);E-W (gal)": "zyx",
    "Zeit [ms],Vertikal [gal],Ost-West [gal],Nord-Süd [gal]": "zxy",
    "tiempo Norte[gal] Este[gal] Vertical[gal]": "yxz",
    "Zaman [s]\tDoğu [cm/s2]\tDikey [cm/s2]\tKuzey [cm/s2]": "xzy",
    "czas,Północ,Wschód,Pionowo": "yxz",
    "время;Восток;Север;Вертикаль": "xyz",
    "t,HNZ,HNN,HNE": "zyx",
    "time_us,acc_z,acc_x,acc_y": "zxy",
    "時間,上下,南北,東西": "zyx",
    "Temps (s), accélération N-S (cm/s²), accélération V (cm/s²), accélération E-W (cm/s²)": "yzx",
    "time_ns,NS,EW,UD": "yxz",
    "time,z,x,y\ns,m/s2,m/s2,m/s2": "zxy",
    "time x y z\n# a line of words\n# t\tz\tx\ty": "zxy",
    "CHAN: time,CHAN 1: 90 DEG,CHAN 2: 360 DEG,CHAN 3: UP": "xyz",
}
UNIT_OF_TIME = {"Zeit": 1e-3, "time_us": 1e-6, "time_ns": 1e-9}


@pytest.mark.parametrize("header", NAMES)
def test_column_names_decide_in_any_language_and_order(write: Write, header: str) -> None:
    seconds = next((unit for word, unit in UNIT_OF_TIME.items() if header.startswith(word)), 1.0)
    unit = "m/s2" if "m/s2\n" in header + "\n" and "cm" not in header else "cm/s2"
    columns = [ALL[axis] for axis in NAMES[header]]
    separator = next((mark for mark in ";\t," if mark in header.splitlines()[-1]), " ")
    motion = read_record(
        write(table(header, *columns, first=TIME / seconds, separator=separator)), units=unit
    )
    assert motion.time_step == pytest.approx(STEP, rel=1e-9)
    assert motion.acceleration == pytest.approx((1.0 if unit == "m/s2" else 0.01) * MOTION, rel=EXACT)


def test_the_columns_that_the_user_numbers_are_read_in_any_order(write: Write) -> None:
    for time_at, order in itertools.product((0, 2, 3), itertools.permutations(range(3), 2)):
        columns = [*MOTION.T[:time_at], TIME, *MOTION.T[time_at:]]
        places = [place + 1 + (place >= time_at) for place in order]
        path = write(table("", *columns, first=None, separator=" "))
        for named, step in (([time_at + 1, *places], None), (places, STEP)):
            motion = read_record(path, columns=named, units="cm/s2", time_step=step)
            assert motion.acceleration == pytest.approx(0.01 * MOTION[:, list(order)], rel=EXACT)


@pytest.mark.parametrize("late", [1, COUNT - 2])
def test_resampling_interpolates_a_late_sample_at_its_even_time(write: Write, late: int) -> None:
    """Linear interpolation between the samples of the file; a gap is refused all the same."""
    time = TIME.copy()
    time[late] += 0.3 * STEP
    path = write(table(GAL, EAST, NORTH, first=time))
    with pytest.raises(ValueError, match="--resample"):
        read_record(path)
    motion = read_record(path, resample=True)
    due = np.column_stack([np.interp(TIME, time, column) for column in (EAST, NORTH)])
    assert motion.time_step == pytest.approx(STEP, rel=1e-9)
    assert motion.acceleration == pytest.approx(0.01 * due, rel=1e-9)
    assert "resampled" in str(motion.source)
    time[late + 1 :] += 2.5 * STEP
    with pytest.raises(ValueError, match="2 times the median"):
        read_record(write(table(GAL, EAST, NORTH, first=time)), resample=True)
