"""PEER AT2 in the forms that are in circulation."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest

from rockwobble.models import read_record

Write = Callable[..., Path]

TITLE = "PEER NGA STRONG MOTION DATABASE RECORD\nSomewhere, 1/1/1999, Station, 90\n"
UNITS = "ACCELERATION TIME SERIES IN UNITS OF G\n"
SIX = "  .1000000E-01  .2000000E-01  .3000000E-01  .4000000E-01  .5000000E-01\n -.6000000E-01\n"
IN_G = np.array([0.01, 0.02, 0.03, 0.04, 0.05, -0.06])


def values_in_g(path: Path, **options: str) -> list[float]:
    motion = read_record(path, path, **options)
    assert np.array_equal(motion.acceleration[:, 0], motion.acceleration[:, 1])
    return list(motion.acceleration[:, 0] / 9.81)


def test_each_form_of_the_header_line_is_read(write: Write) -> None:
    for header in (
        *("NPTS=      6, DT=   .0100 SEC,", "NPTS=6,DT=.01", "npts: 6, dt: 1.0E-02 sec"),
        *("NPTS=  6, DT= 1.D-2 SEC", "     6    .0100    NPTS, DT(SEC)", "6, 0.01, NPTS, DT"),
    ):
        path = write(TITLE + UNITS + header + "   \n" + SIX)
        assert values_in_g(path) == pytest.approx(IN_G, rel=1e-15)
        assert read_record(path, path).time_step == 0.01


@pytest.mark.parametrize(
    ("line", "factor"),
    [
        ("ACCELERATION TIME HISTORY IN UNITS OF G. FILTER POINTS: HP=0.1 Hz LP=40.0 Hz", 9.81),
        ("ACCELERATION TIME HISTORY IN UNITS OF CM/SEC/SEC.", 0.01),
        ("Acceleration time series, units: m/s^2", 1.0),
        ("ACCELERATION (CM/S**2)", 0.01),
        ("Acceleration in gal", 0.01),
    ],
)
def test_the_unit_in_the_title_is_used(write: Write, line: str, factor: float) -> None:
    path = write(f"{TITLE}{line}\nNPTS= 6, DT= .01 SEC\n{SIX}")
    motion = read_record(path, path)
    assert motion.acceleration[:, 1] == pytest.approx(factor * IN_G, rel=1e-15)


def test_columns_of_fixed_width_may_touch(write: Write) -> None:
    touching = (
        "-.1000000E-01-.2000000E-01 .3000000E-01-.4000000E-01\n0.5000000E-010.6000000E-021.7000000E-03\n"
    )
    path = write(f"{TITLE}{UNITS}NPTS= 7, DT= .01 SEC\n{touching}")
    assert values_in_g(path) == pytest.approx([-0.01, -0.02, 0.03, -0.04, 0.05, 0.006, 0.0017], rel=1e-15)


def test_exponents_blanks_fills_and_letters_are_read(write: Write, tmp_path: Path) -> None:
    path = write(f"{TITLE}{UNITS}NPTS= 4, DT= 1.0D-02 SEC\n 0.1D-01 2.d-2 -3D-2 0.4D+0\n")
    assert values_in_g(path) == pytest.approx([0.01, 0.02, -0.03, 0.4], rel=1e-15)
    text = f"{TITLE}{UNITS}NPTS= 6, DT= .01 SEC   \n{SIX}\n   \n".replace("\n", "  \r\n")
    filled = SIX.rstrip("\n") + "  .0  .0  .0  .0\n"
    for whole in ("\ufeff" + text, f"{TITLE}{UNITS}NPTS= 6, DT= .01 SEC\n{filled}"):
        assert values_in_g(write(whole)) == pytest.approx(IN_G, rel=1e-15)
    path = tmp_path / "latin.AT2"
    path.write_bytes(f"Erzincan, 3/13/1992, M\xe9xico\n{UNITS}NPTS= 6, DT= .01\n{SIX}".encode("latin-1"))
    assert values_in_g(path) == pytest.approx(IN_G)


def test_words_at_the_end_are_ignored(write: Write) -> None:
    for end in ("*** End Data ***\n", "  *** end of data ***"):
        assert values_in_g(write(record() + end)) == values_in_g(write(record()))
    with pytest.raises(ValueError, match=r"line \d: expected accelerations"):
        read_record(write(record() + "*** 0.5 ***\n"), "zero")


@pytest.mark.parametrize("turned", [1, 2])
def test_a_rotated_component_has_its_own_azimuth(write: Write, turned: int) -> None:
    sources = "".join(
        f"  H{at} for rotation: A 01/01/01, STATION, {90 * at:03d}\n" for at in range(1, turned + 1)
    )
    head = f"Orig filename = A/FN.acc, Scale factor = 2\n{sources}  rotation angle - clockwise   -50.0\n"
    for azimuth, due in {"  FN component, azimuth =   310.0\n": 310.0, "  FN component\n": None}.items():
        path = write(f"{head}{azimuth}Acceleration in g\n6 0.0200 NPTS, DT\n{SIX}")
        source = read_record(path, "zero").source
        assert source is not None
        assert (source.components[0].azimuth, source.time_step, source.samples) == (due, 0.02, 6)


def test_a_title_without_a_unit_takes_the_given_unit(write: Write) -> None:
    path = write(f"{TITLE}TIME SERIES\nNPTS= 6, DT= .01 SEC\n{SIX}")
    assert read_record(path, path, units="cm/s2").acceleration[5, 0] == pytest.approx(-0.0006, rel=1e-15)
    with pytest.raises(ValueError, match=r"^x.txt does not say its unit: give units, such as g, m/s2, cm"):
        read_record(path, path)
    with pytest.raises(ValueError, match=r"^x.txt says that it is in g, but units is 'm/s2'$"):
        read_record(write(record()), "zero", units="m/s2")


def record(header: str = "NPTS= 6, DT= .01 SEC", title: str = UNITS, values: str = SIX) -> str:
    return f"{TITLE}{title}{header}\n{values}"


@pytest.mark.parametrize(
    ("text", "message"),
    [
        (record("NPTS= 6"), r"x.txt, line 4: expected 'NPTS= n, DT= step SEC' or .*, got 'NPTS= 6'"),
        (record("NPTS= " + "9" * 5000 + ", DT= .01"), r"x.txt, line 4: expected 'NPTS= n"),
        (record("NPTS= 6, DT= 0.0 SEC"), r"x.txt: the time step must be positive and finite \[s\], got 0"),
        (record("NPTS= 6, DT= 1E999 SEC"), r"x.txt, line 4: .* finite number, got '1E999'"),
        (record("NPTS= 7, DT= .01"), r"x.txt, line 4: announces 7 samples, the file holds 6"),
        (record("NPTS= 5, DT= .01"), r"x.txt, line 4: announces 5 samples, the file holds 6"),
        (record("NPTS= 1, DT= .01", values=" .1\n"), r"x.txt must hold at least two samples, got 1"),
        (
            record(values=SIX.replace(".3000000E-01", "NaN")),
            r"x.txt, line 5: expected accelerations .*, got '.*NaN.*'",
        ),
        (
            record(values=SIX.replace("E-01", "E+999")),
            r"x.txt, line 5: .* finite number, got '.1000000E\+999'",
        ),
        (
            record(title="VELOCITY TIME SERIES IN UNITS OF CM/S\n"),
            r"x.txt is not an acceleration record, it says 'VELOCITY TIME SERIES IN UNITS OF CM/S'",
        ),
        (record(title="ACCELERATION IN UNITS OF KM/S2\n"), r"x.txt is in KM/S2, allowed are g, m/s2, cm/s2"),
        (record(title="ACCELERATION [m/s2], UNITS OF G\n"), r"x.txt states two units: m/s2 and G"),
    ],
)
def test_an_error_states_line_fault_and_allowed_values(write: Write, text: str, message: str) -> None:
    path = write(text)
    with pytest.raises(ValueError, match=f"^{message}") as caught:
        read_record(path, path)
    assert "\n" not in str(caught.value)
    assert len(str(caught.value)) < 200
