"""Figures of a comparison, one concept a module."""
