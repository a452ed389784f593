"""Folders of records as the database of PEER gives them out: files by their numbers, and their table."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from pathlib import Path

import numpy as np
import pytest

from rockwobble.models import GroundMotion, read_records

STEP, COUNT, G = 0.01, 40, 9.81
PREAMBLE = (
    ' "-- PEER Ground Motion Database --"\n\n -- Summary of Search Criteria --\nMagnitude, "6.0,7.5"\n\n'
    " -- Summary of Metadata of Selected Records --\n"
)
HEADER = (
    ' Result ID, Spectral Ordinate, Record Sequence Number, Scale Factor," Earthquake Name"," Year",'
    '" Station Name"," Magnitude"," Horizontal-1 Acc. Filename"," Horizontal-2 Acc. Filename",'
    '" Vertical Acc. Filename"\n'
)
SPECTRA = (
    '\n -- Scaled Spectra used in Search & Scaling --\nPeriod (sec),"RSN-12 Horizontal-1 pSa (g)"\n0.01,0.2\n'
)
# record sequence number: endings of its files, horizontal 1 and 2 and vertical
COMPONENTS = {12: ("000", "090", "UP"), 6: ("180", "270", "-UP"), 1040: ("NS", "EW", "DWN")}


def samples(number: int, place: int) -> np.ndarray:
    """Acceleration [g], different for each file."""
    decay = np.exp(-np.arange(COUNT) / 6.0)
    return np.round(0.01 * (1 + number % 7) * (place + 1) * decay * np.sin(np.arange(COUNT) + place), 9)


def at2(values: np.ndarray, event: str, component: str) -> str:
    rows = ["".join(f"{value:15.7E}" for value in row) for row in np.split(values, len(values) // 5)]
    return (
        f"PEER NGA STRONG MOTION DATABASE RECORD\n{event}, 1/2/1999, Station, {component}\n"
        f"ACCELERATION TIME SERIES IN UNITS OF G\nNPTS=  {len(values)}, DT=   {STEP:.4f} SEC,\n"
        + "\n".join(rows)
        + "\n"
    )


def name_of(number: int, ending: str) -> str:
    return f"RSN{number}_EVENT_STA{ending}.AT2"


def download(folder: Path, without: Sequence[str] = (), cells: Mapping[str, str] | None = None) -> Path:
    """Write a PEER folder without some files, and with changed cells in its table."""
    rows = []
    for place, (number, endings) in enumerate(COMPONENTS.items(), start=1):
        names = [name_of(number, ending) for ending in endings]
        for at, name in enumerate(names):
            # files of velocities and displacements beside each
            for kind in ("VT2", "DT2"):
                (folder / name.replace("AT2", kind)).write_text("VELOCITY TIME SERIES IN UNITS OF CM/S\n")
            if name not in without:
                (folder / name).write_text(at2(samples(number, at), "Quake", endings[at]))
        quoted = ",".join(f'" {(cells or {}).get(name, name)}"' for name in names)
        rows.append(
            f'{place}, SRSS, {number}, {1.5 + place},"Quake, {place}", 1999,"Station {place}", 6.5,{quoted}\n'
        )
    (folder / "_SearchResults.csv").write_text(PREAMBLE + HEADER + "".join(rows) + SPECTRA)
    return folder


def assert_components(motion: GroundMotion, number: int, count: int = 3) -> None:
    """East is x, north y and up z, although the first horizontal component is north."""
    endings = COMPONENTS[number]
    assert endings[0] in ("000", "NS", "180")
    signs = (1.0, 1.0, -1.0 if endings[2] == "DWN" else 1.0)
    due = np.column_stack([signs[place] * samples(number, place) for place in (1, 0, 2)[:count]]) * G
    assert motion.acceleration.shape == due.shape
    np.testing.assert_allclose(motion.acceleration, due, rtol=0, atol=1e-7)
    assert motion.time_step == STEP


@pytest.mark.parametrize("table", [True, False], ids=["table", "names alone"])
def test_a_download_from_peer_is_read_unchanged(tmp_path: Path, table: bool) -> None:
    path = download(tmp_path) / "_SearchResults.csv"
    path.write_text(path.read_text().replace(',"', ', "'))  # blanks before quotes
    if not table:
        path.unlink()
    motions = read_records(path if table else tmp_path)
    numbers = list(COMPONENTS) if table else sorted(COMPONENTS)
    assert len(motions) == len(numbers)
    for motion, number in zip(motions, numbers, strict=True):
        assert motion.name.startswith(f"RSN{number}")
        assert_components(motion, number)
        for ending in COMPONENTS[number]:
            assert name_of(number, ending) in str(motion.source)
    if table:
        assert motions[0].name == "RSN12, Quake, 1, Station 1"


def test_a_download_of_horizontal_components_has_no_vertical(tmp_path: Path) -> None:
    verticals = [name_of(number, endings[2]) for number, endings in COMPONENTS.items()]
    for motion, number in zip(read_records(download(tmp_path, verticals)), COMPONENTS, strict=True):
        assert_components(motion, number, 2)


@pytest.mark.parametrize("word", ["NONE", ""])
def test_a_record_without_a_vertical_is_horizontal(tmp_path: Path, word: str) -> None:
    missing = name_of(6, "-UP")
    one, two, three = read_records(download(tmp_path, [missing], {missing: word}))
    assert_components(one, 12)
    assert_components(two, 6, 2)
    assert_components(three, 1040)


@pytest.mark.parametrize("missing", [name_of(6, "270"), name_of(6, "-UP")])
def test_a_missing_file_is_named_with_its_record(tmp_path: Path, missing: str) -> None:
    with pytest.raises(ValueError, match=r"RSN6.*" + missing) as caught:
        read_records(download(tmp_path, [missing]))
    assert str(caught.value).isprintable()


def test_the_table_identifies_horizontal_components_without_azimuth(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setitem(COMPONENTS, 6, ("L", "T", "VRT"))
    motion = read_records(download(tmp_path))[1]
    np.testing.assert_allclose(
        motion.acceleration, np.column_stack([samples(6, place) for place in range(3)]) * G, rtol=0, atol=1e-7
    )
    assert "x is horizontal 1" in str(motion.source)
    (tmp_path / "_SearchResults.csv").unlink()  # names of files alone do not tell
    with pytest.raises(ValueError, match=r"RSN6.*does not say which component"):
        read_records(tmp_path)


@pytest.mark.parametrize("text", ["", "nothing\n", PREAMBLE + HEADER + SPECTRA])
def test_a_table_without_records_is_refused(tmp_path: Path, text: str) -> None:
    (tmp_path / "_SearchResults.csv").write_text(text)
    with pytest.raises(ValueError, match="PEER"):
        read_records(tmp_path)
