"""External trajectories held against the models, and the likely mistake named."""
