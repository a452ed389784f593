"""Checks of metrics, grids and sweeps."""
