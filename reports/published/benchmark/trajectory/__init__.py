"""Trajectories: their files, differences and likely mistakes. Copies of compare/external."""
