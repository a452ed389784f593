"""Checks of the reduced models."""
