"""The problem, with no mechanics: bodies, ground motions, initial states, cases and runs."""

from .case import Case, Run, Suite, run_duration
from .cylinder import Cylinder
from .el_centro import el_centro_1940
from .ground_motion import GroundMotion
from .initial_state import InitialState
from .record_files import read_record

__all__ = [
    "Case",
    "Cylinder",
    "GroundMotion",
    "InitialState",
    "Run",
    "Suite",
    "el_centro_1940",
    "read_record",
    "run_duration",
]
