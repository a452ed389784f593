"""Two traces on one time axis, and trajectories from elsewhere."""
