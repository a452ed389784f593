"""Sweeps whose processes are killed: `python tests/stress --help`."""
