"""Certificate of an installation: claims with their evidence, and a fingerprint to verify it by."""

from .certificate import certify, read_certificate, verify
from .claims import Claim, claims_of
from .fingerprint import engine_method, reduced_method
from .verdict import Certificate, FingerprintVerdict

__all__ = [
    "Certificate",
    "Claim",
    "FingerprintVerdict",
    "certify",
    "claims_of",
    "engine_method",
    "read_certificate",
    "reduced_method",
    "verify",
]
