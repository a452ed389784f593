"""Certificate of an installation: claims with their evidence, and a fingerprint to verify it by."""

from .certificate import (
    CLAIMING,
    Claim,
    certify,
    claims_of,
    models,
    read_certificate,
    verify,
    write_certificate,
)
from .verdict import Certificate, FingerprintVerdict

__all__ = [
    "CLAIMING",
    "Certificate",
    "Claim",
    "FingerprintVerdict",
    "certify",
    "claims_of",
    "models",
    "read_certificate",
    "verify",
    "write_certificate",
]
