"""A trace as a file: the same bits, whichever version wrote it, and no damaged one."""

from __future__ import annotations

from pathlib import Path

import pandas as pd
import pyarrow.parquet as pq
import pytest

from rockwobble import reduced
from rockwobble.models import Case, Cylinder, InitialState, Trace, plain_json

PIER = Cylinder(semidiagonal=6.0, tan_alpha=0.2)


@pytest.fixture(scope="module")
def trace() -> Trace:
    release = InitialState(0.5 * PIER.alpha, rolling_rate=0.5)
    return reduced.simulate(Case(PIER, initial=release, duration=2.0))


@pytest.mark.parametrize("checksums", [True, False])  # 0.2 wrote none
def test_a_trace_comes_back_with_the_same_bits(trace: Trace, tmp_path: Path, checksums: bool) -> None:
    path = tmp_path / "run.parquet"
    trace.save(path)
    pq.write_table(pq.read_table(path), path, write_page_checksum=checksums)
    again = Trace.load(path)
    pd.testing.assert_frame_equal(again.to_frame(), trace.to_frame(), check_exact=True)
    pd.testing.assert_frame_equal(again.passes, trace.passes, check_exact=True)
    assert plain_json.dumps(again.to_plain()) == plain_json.dumps(trace.to_plain())
    assert again.case == trace.case


def test_a_trace_of_version_0_2_is_refused(trace: Trace) -> None:
    facts = plain_json.loads(plain_json.dumps(trace.to_plain()))
    del facts["rest_intervals"]
    with pytest.raises(ValueError, match=r"a trace of 0\.2 or older must be run again"):
        Trace.from_plain(facts, trace.to_frame(), trace.case)


def test_a_file_that_is_none_or_damaged_is_refused(trace: Trace, tmp_path: Path) -> None:
    path = tmp_path / "run.parquet"
    trace.save(path)
    whole = path.read_bytes()
    place = len(whole) // 4  # among the samples; the case is at the end
    table = pd.DataFrame({"x": [1.0]})
    for content in (b"time,tilt", table.to_parquet(), whole[:place] + b"XXXX" + whole[place + 4 :]):
        path.write_bytes(content)
        with pytest.raises(ValueError, match="must be the file of a trace, cannot read it as one"):
            Trace.load(path)
