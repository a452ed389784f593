"""Certificate of an installation: claims with their evidence, and a fingerprint to verify it by."""

from ..check.verdict import Certificate as Certificate
from ..check.verdict import FingerprintVerdict as FingerprintVerdict
from .certificate import CLAIMING as CLAIMING
from .certificate import certify as certify
from .certificate import claims_of as claims_of
from .certificate import models as models
from .certificate import read_certificate as read_certificate
from .certificate import verify as verify
from .certificate import write_certificate as write_certificate
