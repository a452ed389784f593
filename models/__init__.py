"""The problem, with no mechanics: bodies, ground motions, initial states, cases and runs."""

from .bounds import AGREEMENT, CLOSED_TILT, Bounds
from .case import Case, InitialState, Run, Suite, run_duration
from .cylinder import Cylinder, RockingBody, WobblingFrame
from .diagnostic import Assumptions, Diagnostic
from .ground_motion import GroundMotion
from .hazard import HazardCurve
from .hazard_file import read_hazard
from .members import perturbed_copies, with_motions
from .records.files import el_centro_1940, read_record
from .records.folder import read_records, read_records_by_level
from .records.p695 import far_field_motions, p695_far_field
from .suites import read_suite, shipped_suites
from .synthetic import pulse, synthetic_motions
from .tendon import Tendon
from .trace import Trace

__all__ = [
    "AGREEMENT",
    "CLOSED_TILT",
    "Assumptions",
    "Bounds",
    "Case",
    "Cylinder",
    "Diagnostic",
    "GroundMotion",
    "HazardCurve",
    "InitialState",
    "RockingBody",
    "Run",
    "Suite",
    "Tendon",
    "Trace",
    "WobblingFrame",
    "el_centro_1940",
    "far_field_motions",
    "p695_far_field",
    "perturbed_copies",
    "pulse",
    "read_hazard",
    "read_record",
    "read_records",
    "read_records_by_level",
    "read_suite",
    "run_duration",
    "shipped_suites",
    "synthetic_motions",
    "with_motions",
]


def __dir__() -> list[str]:
    return sorted(__all__)
