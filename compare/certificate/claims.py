"""Claims of a certificate: statement, range, bound and evidence of each, and what no evidence covers."""

from __future__ import annotations

import math
from collections.abc import Iterable
from dataclasses import dataclass
from typing import Literal

from ..check import NOT_RUN, Finding

Status = Literal["verified", "cross-validated", "validated"]
# layers that hold two formulations, ours and that of an engine, against each other
_BETWEEN = frozenset({"traces", "agreement"})
# layers that say something of the models and engines, and not of reading files or of stored numbers
_OF_MODELS = frozenset(
    {"equations", "conserved", "exact", "rest", "invariance", "properties", "order", "residual"}
)
CLAIMING = _OF_MODELS | _BETWEEN
DOMAINS = {
    "equations": "random states, tan alpha 0.1 to 3",
    "traces": "cases of the suite",
    "agreement": "cases of the suite",
}
NOT_COVERED = (
    "no claim is validated: no experiment was compared",
    "ground that deforms, or is not plane; a base that is not rigid",
    "sliding of the reduced models: they say how much friction is needed, and do not slide",
    "single peaks and traces after the agreement time: there only distributions are compared",
)


@dataclass(frozen=True, slots=True, kw_only=True)
class Claim:
    """One claim.

    Parameters
    ----------
    quantity : str
    domain : str
        For which problems.
    bound, measured : float
        The claim holds where what is measured is at most the bound.
    unit : str
    evidence : str
        What was done to measure it.
    status : {"verified", "cross-validated", "validated"}
        Against exact solutions; between independent formulations; against an experiment.
    data_sha256 : str
        Of the data of the experiment, which "validated" needs.

    Raises
    ------
    ValueError
        If it does not hold, or is called validated without the hash of external data.
    """

    quantity: str
    domain: str
    bound: float
    measured: float
    unit: str
    evidence: str
    status: Status
    data_sha256: str = ""

    def __post_init__(self) -> None:
        digest = self.data_sha256
        known = len(digest) == 64 and set(digest) <= set("0123456789abcdef")
        if (self.status == "validated") != known:
            raise ValueError(
                "a claim is validated if, and only if, it has the SHA-256 of external data; "
                f"got {self.status!r} with {digest!r}"
            )
        if not (math.isfinite(self.measured) and self.measured <= self.bound):
            raise ValueError(
                f"a claim must hold, got {self.measured!r} above {self.bound!r}: {self.quantity}"
            )


def claims_of(findings: Iterable[Finding]) -> tuple[list[Claim], list[str]]:
    """Return the claims that findings bear out, and what they do not cover.

    Raises
    ------
    ValueError
        If one of them failed: nothing is certified then.
    """
    claims, open_points = [], list(NOT_COVERED)
    for finding in findings:
        if finding.failed:
            raise ValueError(f"a check failed, and nothing is certified: {finding.name}")
        if finding.outcome == NOT_RUN:
            open_points.append(f"{finding.name}: {finding.note}")
        elif finding.layer in CLAIMING and math.isfinite(finding.value):
            claims.append(
                Claim(
                    quantity=finding.name,
                    domain=DOMAINS.get(finding.layer, "the problems of this check"),
                    bound=finding.bound,
                    measured=finding.value,
                    unit=finding.unit,
                    evidence=f"rockwobble check --only {finding.layer}: {finding.reason}",
                    status="cross-validated" if finding.layer in _BETWEEN else "verified",
                )
            )
    return claims, open_points
