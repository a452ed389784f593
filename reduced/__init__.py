"""The reduced models of a cylinder that rocks and wobbles, and their exact solutions."""

from .problem import MODELS, SEATING, restitution_from_momentum
from .response import Response
from .simulate import simulate

__all__ = ["MODELS", "SEATING", "Response", "restitution_from_momentum", "simulate"]
