"""The table of what a ring costs: its runs, and its lines."""

from __future__ import annotations

import math

from benchmarks.ring_losses import ring_runs, table
from rockwobble.compare.studies.validity.ring_losses import RingRow


def row(support: str, loss: float, **settings: float) -> RingRow:
    return RingRow(
        case="short", support=support, settings=settings, outcome="completed", first_contact=math.nan,
        contact_time=0.0, passes=2, loss=loss, rolled_out=0.0, at_end=0.0, residual=0.0, twist=0.0, peak=0.5,
        recess_peak=0.5, against_recess=1e-5, against_flat=1e-2,
    )  # fmt: skip


def test_every_run_of_the_table_differs() -> None:
    runs = ring_runs()
    assert [run.support for run in runs[:2]] == ["recess", "flat"]
    assert len({(run.support, *run.settings.items()) for run in runs}) == len(runs)


def test_a_line_holds_the_medians_of_the_turns() -> None:
    rings = [row("ring", loss, ring_clearance=0.01) for loss in (0.01, 0.02, 0.06)]
    lines = table([row("recess", 0.0), *rings]).splitlines()
    assert lines[1] == "short"
    assert [line.split()[0] for line in lines[4:]] == ["recess", "clearance"]
    # percent: median, least and most, and the median over two passes
    assert lines[-1].split()[5:9] == ["2.000", "1.000", "6.000", "1.000"]
