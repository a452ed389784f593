"""The page of the paper's figures, in Markdown."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING

from ..pages.provenance import made_by
from .claim import Claim

if TYPE_CHECKING:
    import pandas as pd

SOURCE = (
    "M. F. Vassiliou, S. Burger, M. Egger, J. A. Bachmann, M. Broccardo, B. Stojadinovic, *Behavior of "
    "inverted pendulum cylindrical structures that rock and wobble during earthquakes*, 16th World "
    "Conference on Earthquake Engineering, Santiago, 2017"
)


@dataclass(frozen=True, slots=True, kw_only=True)
class Section:
    """A figure of the paper.

    Attributes
    ----------
    number : int
        Of the figure in the paper.
    title, text : str
        The text stands under the picture, before the claims.
    claims : sequence of Claim
    svg : bytes
    tables : mapping of file name to DataFrame
        What the picture shows.
    """

    number: int
    title: str
    text: str
    claims: Sequence[Claim]
    svg: bytes
    tables: dict[str, pd.DataFrame]

    @property
    def picture(self) -> str:
        """File name of the picture."""
        return f"figure-{self.number}.svg"


def paper_page(sections: Sequence[Section]) -> str:
    """Return the page; pictures and tables are beside it."""
    parts = [
        "# The paper's figures, computed again",
        f"Figures {sections[0].number} to {sections[-1].number} of {SOURCE}, from the equations of motion "
        "(18) and (19) as they are printed, and (24) without its misprints. Under each figure stands "
        "what the paper says of it, what this run finds, and whether the one bears the other out: every "
        "number and every verdict is computed from the run.",
    ]
    for section in sections:
        tables = ", ".join(f"[{name}]({name})" for name in section.tables)
        parts += [
            f"## Figure {section.number}: {section.title}",
            f"![Figure {section.number}: {section.title}]({section.picture})",
            section.text,
            "\n".join(claim.markdown() for claim in section.claims),
            f"Data: {tables}",
        ]
    return "\n\n".join([*parts, "---", made_by(), ""])


def claims_frame(sections: Sequence[Section]) -> pd.DataFrame:
    """Return the claims as a table: figure, paper, run, verdict."""
    import pandas as pd

    rows = [
        (section.number, claim.says, claim.found, claim.verdict)
        for section in sections
        for claim in section.claims
    ]
    return pd.DataFrame(rows, columns=["figure", "paper", "run", "verdict"])
