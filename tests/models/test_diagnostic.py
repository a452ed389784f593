"""Diagnostics in words."""

from __future__ import annotations

from rockwobble.models import Diagnostic
from rockwobble.models.diagnostic import CODES, REASONS


def test_every_code_has_words_of_its_own() -> None:
    details = {code: REASONS[code][0] if code in REASONS else "" for code in CODES}
    meanings = [Diagnostic(code=code, detail=detail).meaning for code, detail in details.items()]
    assert all(" " in meaning for meaning in meanings)
    assert len(set(meanings)) == len(CODES)
