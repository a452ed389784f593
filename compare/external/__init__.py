"""Trajectories from tests and other codes: read, held against the models, and the likely mistake named."""
