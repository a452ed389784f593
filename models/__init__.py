"""The problem, with no mechanics: bodies, ground motions, initial states, cases and runs."""

from .assumptions import Assumptions
from .bounds import AGREEMENT, Bounds
from .case import Case, Run, Suite, run_duration
from .cylinder import Cylinder
from .diagnostic import Diagnostic
from .ground_motion import GroundMotion
from .initial_state import InitialState
from .pulses import pulse
from .records.el_centro import el_centro_1940
from .records.files import read_record
from .records.p695 import p695_far_field
from .suites.file import read_suite, shipped_suites
from .traces.trace import Trace

__all__ = [
    "AGREEMENT",
    "Assumptions",
    "Bounds",
    "Case",
    "Cylinder",
    "Diagnostic",
    "GroundMotion",
    "InitialState",
    "Run",
    "Suite",
    "Trace",
    "el_centro_1940",
    "p695_far_field",
    "pulse",
    "read_record",
    "read_suite",
    "run_duration",
    "shipped_suites",
]


def __dir__() -> list[str]:
    return sorted(__all__)
