"""Moves of sliders in a browser: each is seen from its event to the painted trace."""

from __future__ import annotations

import pytest

from benchmarks.slider_moves import PARTS, chromium, main, measure

ROUNDING = 0.5  # of the browser's clocks, of which a part takes two [ms]


@pytest.mark.skipif(chromium() is None, reason="needs Chromium")
def test_the_parts_of_a_move_are_within_it() -> None:
    rows, spent = measure(4, beside="stronger")
    assert len(rows) == 4
    for row in rows:
        assert set(row) == set(PARTS)
        parts = [row[name] for name in PARTS[1:]]
        assert min(parts) > -ROUNDING
        assert row["solver"] > ROUNDING
        # the handler of the event comes besides, before the problem is posted
        assert sum(parts) <= row["total"] + ROUNDING
    assert spent["DedicatedWorker"] > ROUNDING


def test_without_a_browser_it_says_so(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("PATH", "")
    with pytest.raises(ValueError, match="needs Chromium"):
        main([])
