"""Checks of an external model, which can be called, and of the file of an external trajectory."""

from .model import check_model
from .outputs import load_model
from .trajectory import check_trajectory

__all__ = ["check_model", "check_trajectory", "load_model"]
