"""A certificate: a baseline with a verdict, made here and compared with another installation.

It holds claims with their evidence, what no evidence covers, and the fingerprint of twelve short motions.
"""

from __future__ import annotations

import json
import math
from collections.abc import Iterable
from dataclasses import asdict, dataclass
from pathlib import Path
from types import ModuleType
from typing import Literal

from rockwobble import reduced
from rockwobble.models import Run

from ..check import GROUPS, NOT_RUN, Result, Subject, engine, reduced_model
from ..storage.files import replace_files
from ..storage.provenance import commit, package_versions
from .fingerprint import fingerprint, repeated, short_cases
from .verdict import KIND, Certificate, Described, FingerprintVerdict, compare, read, require_whole

FORMAT = 3
_RTOL = 1e-8  # the default of `reduced.simulate`
Status = Literal["verified", "cross-validated", "validated"]
# groups of checks that say something of the motion, and not of a protocol or of stored numbers
CLAIMING = tuple(group for group in GROUPS if group not in ("protocol", "baseline"))
_BETWEEN = "agreement"  # compares two independent formulations
NOT_COVERED = (
    "no claim is validated: no experiment was compared",
    "ground that deforms, or is not plane; a base that is not rigid",
    "sliding of the reduced models: they say how much friction is needed, and do not slide",
    "single peaks and traces after the agreement time: there only distributions are compared",
)


def certify(subject: Subject, results: Iterable[Result]) -> Certificate:
    """Make a certificate.

    Parameters
    ----------
    subject : Subject
        The reduced models, or an engine.
    results : iterable of Result
        Results of its checks, which become claims.

    Returns
    -------
    dict

    Raises
    ------
    ValueError
        If a check failed, or none bears a claim out.
    """
    claims, open_points = claims_of(results)
    if not claims:
        raise ValueError("a certificate needs a claim, and none of the checks makes one")
    return {
        "kind": KIND,
        "format": FORMAT,
        "method": described(subject),
        "versions": package_versions(),
        "commit": commit(),
        "claims": [asdict(claim) for claim in claims],
        "not_covered": open_points,
        "fingerprint": list(fingerprint(subject)),
    }


def described(subject: Subject) -> Described:
    """Return the method of a subject as a certificate has it."""
    run = subject.run or Run(None, "recess")
    return {"engine": run.engine, "time_step": run.time_step, "settings": dict(run.settings)}


def subject_of(certificate: Certificate) -> Subject:
    """Return the subject that a certificate is of, as it is installed here.

    Raises
    ------
    ValueError
        If it is not installed.
    """
    given = certificate["method"]
    if given["engine"] is None:
        return models()
    return engine(given["engine"], given["time_step"], reference=None, **given["settings"])


def models(module: ModuleType = reduced) -> Subject:
    """Return the reduced models at their default tolerance; of a copy of the package, for its tests."""
    return reduced_model(module, rtol=_RTOL)


def verify(certificate: Certificate, subject: Subject | None = None) -> FingerprintVerdict:
    """Compute the fingerprint here, up to the first change, and return the verdict.

    Parameters
    ----------
    certificate : mapping
    subject : Subject, optional
        Default: that of the certificate, as it is installed here.

    Returns
    -------
    FingerprintVerdict

    Raises
    ------
    ValueError
        If the subject is not installed, or its cases are others than in this version.
    """
    old = certificate["fingerprint"]
    if [one["name"] for one in old] != [short.name for short in short_cases()]:
        raise ValueError("the certificate has other cases than this version: make it anew")
    return compare(old, repeated(subject_of(certificate) if subject is None else subject, old))


def read_certificate(path: Path) -> Certificate:
    """Read a certificate.

    Raises
    ------
    ValueError
        If the file cannot be read, is no certificate, or one of a later format.
    """
    found = read(path)
    if found["format"] != FORMAT:
        raise ValueError(f"{path} has format {found['format']}, this version reads {FORMAT}")
    require_whole(found, path)
    return found


def write_certificate(certificate: Certificate, path: Path) -> None:
    """Write it whole, or not at all."""
    replace_files(path.parent, {path.name: (json.dumps(certificate, indent=1) + "\n").encode()})


@dataclass(frozen=True, slots=True, kw_only=True)
class Claim:
    """One claim.

    Parameters
    ----------
    quantity : str
    domain : str
        Problems for which it was measured.
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


def claims_of(results: Iterable[Result]) -> tuple[list[Claim], list[str]]:
    """Return the claims that results bear out, and what they do not cover.

    Raises
    ------
    ValueError
        If one of them failed: nothing is certified then.
    """
    claims, open_points = [], list(NOT_COVERED)
    for result in results:
        if result.failed:
            raise ValueError(f"a check failed, and nothing is certified: {result.name}")
        if result.outcome == NOT_RUN:
            open_points.append(f"{result.name}: {result.note}")
        elif result.group in CLAIMING and math.isfinite(result.value):
            claims.append(
                Claim(
                    quantity=result.name,
                    domain="the problems of this check",
                    bound=result.bound,
                    measured=result.value,
                    unit=result.unit,
                    evidence=f"rockwobble check --only {result.group}: {result.reason}",
                    status="cross-validated" if result.group == _BETWEEN else "verified",
                )
            )
    return claims, open_points
