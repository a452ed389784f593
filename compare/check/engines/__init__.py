"""Checks of the engines."""
