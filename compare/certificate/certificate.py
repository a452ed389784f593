"""A certificate: a baseline with a verdict, made here and compared with another installation.

It holds claims with their evidence, what no evidence covers, and the fingerprint of a subject.
"""

from __future__ import annotations

import math
from collections.abc import Iterable, Mapping
from pathlib import Path
from types import ModuleType

from rockwobble import reduced
from rockwobble.models.case import RECESS_MODEL

from ..check import GROUPS, NOT_RUN, Result, Subject, engine, reduced_model
from ..check.fingerprint import as_json, fingerprint, repeat, short_cases
from ..check.verdict import (
    KIND,
    Certificate,
    Described,
    FingerprintVerdict,
    compare,
    read,
    require_whole,
)
from ..runs.progress import ProgressCallback
from ..storage.files import replace_files
from ..storage.provenance import commit, package_versions

FORMAT = 3
_RTOL = 1e-8  # the default of `reduced.simulate`
# groups of checks that say something of the motion, and not of a protocol or of a baseline
CLAIMING = tuple(group for group in GROUPS if group not in ("protocol", "baseline"))
_BETWEEN = "agreement"  # compares two independent formulations
NOT_COVERED = (
    "no claim is validated: no experiment was compared",
    "ground that deforms, or is not plane; a base that is not rigid",
    "sliding of the reduced models: they say how much friction is needed, and do not slide",
    "single peaks and traces after the agreement time: there only distributions are compared",
)


def certify(
    subject: Subject, results: Iterable[Result], progress: ProgressCallback | None = None
) -> Certificate:
    """Make a certificate.

    Parameters
    ----------
    subject : Subject
        The reduced models, or an engine.
    results : iterable of Result
        Results of its checks, which become claims.
    progress : callable, optional
        Called with a `Progress` at the start and the end of each case of the fingerprint.

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
        "method": description(subject),
        "versions": package_versions(),
        "commit": commit(),
        "claims": claims,
        "not_covered": open_points,
        "fingerprint": list(fingerprint(subject, progress)),
    }


def description(subject: Subject) -> Described:
    """Return the method of a subject as a certificate has it."""
    run = subject.run or RECESS_MODEL
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
    return engine(given["engine"], given["time_step"], **given["settings"])


def models(module: ModuleType = reduced) -> Subject:
    """Return the reduced models at their default tolerance; of a copy of the package, for its tests."""
    return reduced_model(module, rtol=_RTOL)


def verify(
    certificate: Certificate, subject: Subject | None = None, progress: ProgressCallback | None = None
) -> FingerprintVerdict:
    """Compute the fingerprint here, up to the first change, and return the verdict.

    Parameters
    ----------
    certificate : mapping
    subject : Subject, optional
        Default: that of the certificate, as it is installed here.
    progress : callable, optional
        Called with a `Progress` at the start and the end of each case.

    Returns
    -------
    FingerprintVerdict

    Raises
    ------
    ValueError
        If the subject is not installed, or its cases are others than in this version.
    """
    old = certificate["fingerprint"]
    known = {short.name for short in short_cases()}
    if unknown := [one["name"] for one in old if one["name"] not in known]:
        raise ValueError(f"the certificate has a case {unknown[0]}, this version has none: make it anew")
    own = subject_of(certificate) if subject is None else subject
    return compare(old, repeat(own, old, progress))


def read_certificate(path: Path) -> Certificate:
    """Read a certificate.

    Raises
    ------
    ValueError
        If the file cannot be read, is no certificate, or one of a later format.
    """
    if path.is_file() and path.read_bytes().lstrip()[:1] != b"{":
        raise ValueError(f"{path} is not a certificate (JSON, written by rockwobble certify)")
    found = read(path)
    if found["format"] != FORMAT:
        raise ValueError(f"{path} has format {found['format']}, this version reads {FORMAT}")
    require_whole(found, path)
    return found


def write_certificate(certificate: Mapping[str, object], path: Path) -> None:
    """Write a certificate, perhaps with more, whole or not at all; a claim is a line."""
    replace_files(path.parent, {path.name: as_json(certificate).encode()})


def claims_of(results: Iterable[Result]) -> tuple[list[dict[str, object]], list[str]]:
    """Return the claims that results bear out, and what they do not cover.

    A claim is verified, against exact solutions, or cross-validated, between independent formulations; none
    is validated, against an experiment.

    Raises
    ------
    ValueError
        If one of them failed: nothing is certified then.
    """
    claims, open_points = list[dict[str, object]](), list(NOT_COVERED)
    for result in results:
        if result.failed:
            raise ValueError(f"a check failed, and nothing is certified: {result.name}")
        if result.outcome == NOT_RUN:
            open_points.append(f"{result.name}: {result.note}")
        elif result.group in CLAIMING and math.isfinite(result.value):
            claims.append(
                {
                    "quantity": result.name,
                    "domain": "the problems of this check",
                    "bound": result.bound,
                    "measured": result.value,
                    "unit": result.unit,
                    "evidence": f"rockwobble check --only {result.group}: {result.reason}",
                    "status": "cross-validated" if result.group == _BETWEEN else "verified",
                    "data_sha256": "",  # of an experiment
                }
            )
    return claims, open_points
