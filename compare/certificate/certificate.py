"""A certificate: made here, and held against another installation."""

from __future__ import annotations

import json
from collections.abc import Iterable
from dataclasses import asdict
from pathlib import Path

from rockwobble.models import Run

from ..check import Finding
from ..storage.files import replace_files
from ..storage.provenance import commit, package_versions
from .claims import claims_of
from .fingerprint import Method, engine_method, fingerprint, reduced_method, repeated
from .short_cases import short_cases
from .verdict import KIND, Certificate, Described, FingerprintVerdict, compare, read, require_whole

FORMAT = 3


def certify(method: Method, findings: Iterable[Finding]) -> Certificate:
    """Make a certificate.

    Parameters
    ----------
    method : Method
    findings : iterable of Finding
        Of the checks, which become claims.

    Raises
    ------
    ValueError
        If a check failed, or none bears a claim out.
    """
    claims, open_points = claims_of(findings)
    if not claims:
        raise ValueError("a certificate needs a claim, and none of the checks makes one")
    return {
        "kind": KIND,
        "format": FORMAT,
        "method": described(method.run),
        "versions": package_versions(),
        "commit": commit(),
        "claims": [asdict(claim) for claim in claims],
        "not_covered": open_points,
        "fingerprint": list(fingerprint(method)),
    }


def described(run: Run) -> Described:
    """Return a method as a certificate has it."""
    return {"engine": run.engine, "time_step": run.time_step, "settings": dict(run.settings)}


def method_of(certificate: Certificate) -> Method:
    """Return the method that a certificate is of.

    Raises
    ------
    ValueError
        If it is not installed.
    """
    given = certificate["method"]
    if given["engine"] is None:
        return reduced_method()
    return engine_method(given["engine"], given["time_step"], **given["settings"])


def verify(certificate: Certificate, method: Method | None = None) -> FingerprintVerdict:
    """Compute the fingerprint here, up to the first change, and return the verdict.

    Parameters
    ----------
    certificate : mapping
    method : Method, optional
        Default: that of the certificate, as it is installed here.

    Raises
    ------
    ValueError
        If the method is not installed, or its cases are others than in this version.
    """
    old = certificate["fingerprint"]
    if [one["name"] for one in old] != [short.name for short in short_cases()]:
        raise ValueError("the certificate has other cases than this version: make it anew")
    return compare(old, repeated(method_of(certificate) if method is None else method, old))


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
