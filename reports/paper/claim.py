"""What the paper says, what this run finds, and whether the one bears the other out."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

HOLDS, HOLDS_IN_PART, DOES_NOT_HOLD = "holds", "holds in part", "does not hold"


@dataclass(frozen=True, slots=True, kw_only=True)
class Claim:
    """A statement of the paper held against numbers.

    Attributes
    ----------
    says : str
        What the paper says, in a sentence.
    found : str
        What this run finds, in numbers.
    verdict : {"holds", "holds in part", "does not hold"}
    """

    says: str
    found: str
    verdict: str

    def markdown(self) -> str:
        """Return the claim as an item of a list."""
        return f"- The paper: {self.says} This run: {self.found} **It {self.verdict}.**"


def verdict_of(*parts: bool) -> str:
    """Return the verdict on a claim with several parts."""
    if all(parts):
        return HOLDS
    return HOLDS_IN_PART if any(parts) else DOES_NOT_HOLD


def in_words(values: Sequence[str]) -> str:
    """Return "a, b and c"."""
    return values[0] if len(values) == 1 else f"{', '.join(values[:-1])} and {values[-1]}"
