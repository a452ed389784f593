"""The problem, with no mechanics: bodies, ground motions, initial states, cases and runs."""

from .bounds import Bounds
from .case import Case, Run, Suite, run_duration
from .cylinder import Cylinder
from .el_centro import el_centro_1940
from .ground_motion import GroundMotion
from .initial_state import InitialState
from .p695 import p695_far_field
from .pulses import pulse
from .record_files import read_record
from .suite_file import read_suite, shipped_suites

__all__ = [
    "Bounds",
    "Case",
    "Cylinder",
    "GroundMotion",
    "InitialState",
    "Run",
    "Suite",
    "el_centro_1940",
    "p695_far_field",
    "pulse",
    "read_record",
    "read_suite",
    "run_duration",
    "shipped_suites",
]
