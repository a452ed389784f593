"""Sweeps: grids of runs in chunks that are kept as they are finished."""
