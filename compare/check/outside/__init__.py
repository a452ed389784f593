"""Checks of what somebody else made: a model that can be called, or the file of a trajectory."""

from .model import check_model
from .outputs import Outputs, load_model, read_outputs
from .trajectory import check_trajectory

__all__ = ["Outputs", "check_model", "check_trajectory", "load_model", "read_outputs"]
