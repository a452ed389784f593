"""Source of a record: one line in motion, stored results, pages and terminal."""

from __future__ import annotations

from html import unescape
from pathlib import Path

import numpy as np
import pytest

import rockwobble as rw
from rockwobble.models import Case, Cylinder, Run, Suite, Trace, read_record, read_suite
from rockwobble.reports.cli.main import main
from rockwobble.reports.pages.cases import source_lines

STEP, COUNT = 0.01, 60
LABELS = ("Ost", "Nord")
# suite option equal to a read_record argument
KEYS = {
    "record_columns": ("columns", "1,3,2"),
    "record_step": ("time_step", 0.01),
    "lengths": ("lengths", "pad"),
    "remove_mean": ("remove_mean", True),
    "rotate": ("rotate", 30.0),
    "units": ("units", "cm/s2"),
}


@pytest.fixture
def record(tmp_path: Path) -> Path:
    """Record with a peak of 3.1 m/s^2 and columns in another order than the axes."""
    time = np.arange(COUNT) * STEP
    east = 310.0 * np.sin(2.0 * np.pi * time / 0.6)
    rows = [f"{t:.2f},{0.3 * a:.6f},{a:.6f}" for t, a in zip(time, east, strict=True)]
    path = tmp_path / "station 12.csv"
    path.write_text("\n".join([f"Zeit [s],{LABELS[1]} [gal],{LABELS[0]} [gal]", *rows]) + "\n")
    return path


@pytest.mark.parametrize(("count", "last"), [(12, "Record: 11"), (13, "and 1 record more, in manifest.json")])
def test_the_first_sources_are_listed_and_the_others_counted(count: int, last: str) -> None:
    lines = source_lines([str(place) for place in range(count)])
    assert lines[:12] == [f"Record: {place}" for place in range(12)]
    assert (len(lines), lines[-1]) == (count, last)


def test_suite_passes_each_reading_option_to_read_record(tmp_path: Path, record: Path) -> None:
    silent = tmp_path / "silent.txt"
    silent.write_text("".join(f"{STEP * at:.2f} {at % 5} {at % 7}\n" for at in range(COUNT)))
    for key, (option, value) in KEYS.items():
        path = record if key in ("rotate", "remove_mean", "lengths", "record_step") else silent
        more = 'units = "cm/s2", ' if path is silent and key != "units" else ""
        columns = 'record_columns = "1,2,3", ' if path is silent and key != "record_columns" else ""
        toml = str(value).lower() if isinstance(value, bool) else repr(value)
        suite = tmp_path / f"{key}.suite.toml"
        suite.write_text(
            '[[cases]]\nname = "a"\ncylinder = { semidiagonal = 6, tan_alpha = 0.2 }\n'
            f'motion = {{ files = "{path.name}", {more}{columns}{key} = {toml} }}\n'
        )
        (case,) = read_suite(suite).cases
        options = {option: value}
        options |= {"units": "cm/s2"} if more else {}
        options |= {"columns": "1,2,3"} if columns else {}
        due = read_record(path, **options)
        assert case.motion is not None
        np.testing.assert_array_equal(case.motion.acceleration, due.acceleration)
        assert case.motion.source == due.source


def test_stored_results_keep_the_record_source(tmp_path: Path, record: Path) -> None:
    motion = read_record(record).scaled(2.0).rotated(0.3)
    case = Case(Cylinder(semidiagonal=6.0, tan_alpha=0.2), motion, name="shaken", duration=0.4)
    assert motion.source is not None
    assert all(word in motion.source.line for word in (record.name, *LABELS, "scaled by 2", "rotated by"))
    trace = rw.simulate(case)
    trace.save(tmp_path / "run.parquet")
    loaded = Trace.load(tmp_path / "run.parquet").case.motion
    assert loaded is not None
    assert loaded.source == motion.source
    rw.comparison(Suite([case], [Run(None, "flat")]), workers=1, out=tmp_path / "comparison")
    again = rw.compare.Comparison.load(tmp_path / "comparison").cases["shaken"].motion
    assert again is not None
    assert again.source == motion.source


@pytest.mark.slow
@pytest.mark.parametrize(
    ("command", "page"),
    [
        (["simulate"], "run"),
        (["spectrum", "--semidiagonal", "5:6:2", "--intensity", "2:3:2"], "spectrum"),
        (["ensemble", "--engine", "none"], "ensemble"),
        (["sweep", "--semidiagonal", "5,6"], "sweep"),
    ],
    ids=lambda value: value[0] if isinstance(value, list) else value,
)
@pytest.mark.usefixtures("in_this_process")
def test_new_and_redrawn_pages_state_the_record_source(
    tmp_path: Path, record: Path, capsys: pytest.CaptureFixture[str], command: list[str], page: str
) -> None:
    line = str(read_record(record).source)
    out = tmp_path / "out"
    for arguments in ([*command, "--record", str(record), "--out", str(out)], ["report", str(out)]):
        with pytest.raises(SystemExit) as ended:
            main(arguments)
        assert ended.value.code == 0, capsys.readouterr().err
        written = capsys.readouterr()
        # lines of a terminal break where they are full; a report names its files alone
        assert arguments[0] == "report" or "".join(line.split()) in "".join(
            (written.out + written.err).replace("│", "").split()
        )
        # the document is drawn by `report` alone
        for ending in ("html", "md")[: 1 + (arguments[0] == "report")]:
            path = out / f"{page}.{ending}"
            assert line in unescape(path.read_text(encoding="utf-8")).replace("\\", ""), path.name
            path.unlink()
