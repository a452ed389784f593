"""Diagnostics in words."""

from __future__ import annotations

import numpy as np

from rockwobble.models import Diagnostic
from rockwobble.models.diagnostic import CODES, REASONS


def test_every_code_has_its_words() -> None:
    details = {code: REASONS[code][0] if code in REASONS else "a detail" for code in CODES}
    meanings = [Diagnostic(code=code, detail=detail).meaning for code, detail in details.items()]
    assert all(" " in meaning for meaning in meanings)
    assert len(set(meanings)) == len(CODES)


def test_equal_facts_compare_equal_for_any_number_type() -> None:
    first = Diagnostic(code="slip", time=float("nan"), size=np.float64(2.0))
    assert first == Diagnostic(code="slip", duration=np.float64("nan"), size=2)
    assert first != Diagnostic(code="slip", size=2.0, time=1.0)
    assert repr(first.size) == "2.0"
