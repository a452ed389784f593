"""Checks of what somebody else made: a model that can be called, or the file of a trajectory."""

from .model import check_model
from .outputs import load_model
from .trajectory import check_trajectory

__all__ = ["check_model", "check_trajectory", "load_model"]
