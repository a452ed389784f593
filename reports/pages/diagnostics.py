"""Diagnostics in words: each code of `rockwobble.models.diagnostic` has a line in `words.toml`."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterable

from rockwobble.models import Diagnostic
from rockwobble.models.diagnostic import CODES, FAILURES
from rockwobble.models.plain_json import Facts

from .wording import lines_of
from .wording import sentence as worded


def sentence(fact: Diagnostic) -> str:
    """Diagnostic in words, without capital and full stop."""
    return worded(fact.finding())


def remarks(facts: Iterable[Diagnostic]) -> str:
    """Return diagnostics in words, separated by semicolons."""
    return "; ".join(map(sentence, facts))


def warnings(doubts: Iterable[Facts]) -> list[str]:
    """Line on each doubt about records, lengths or gravity, as `doubts_of_cases` gives them."""
    lines = []
    for doubt in doubts:
        fields = {name: value for name, value in doubt.items() if name != "record"}
        text = sentence(Diagnostic(**fields))
        lines.append(f"Warning: {doubt['record']}: {text}.".replace("?.", "?"))
    return lines


def failure(facts: Iterable[Diagnostic]) -> str:
    """Reason of a failed run, in words."""
    return remarks(fact for fact in facts if fact.code in FAILURES) or lines_of("run.failed_unknown")[1]


def code_counts(codes: Iterable[Iterable[str]]) -> list[str]:
    """Number of runs with each diagnostic code, without the codes of failures."""
    counts = Counter(code for of_run in codes for code in set(of_run))
    shown = [code for code in CODES if code not in FAILURES and counts[code]]
    lines = {code: lines_of(f"diagnostic.{code}") for code in shown}
    return [f"{counts[code]} {short}" for code, (short, whole) in lines.items() if short != whole]
