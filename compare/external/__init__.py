"""External trajectories, read, compared with a model, and the likely mistakes named."""
