"""The reduced models of a cylinder that rocks and wobbles, and their exact solutions."""

from .batch import peak_tilts
from .problem import MODELS, SEATING, restitution_from_momentum
from .response import Response
from .simulate import simulate

__all__ = ["MODELS", "SEATING", "Response", "peak_tilts", "restitution_from_momentum", "simulate"]
